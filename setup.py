"""Puts compiled code into a wheel if MESA_MOBILITY_COMPILE is 1. All else is in pyproject.toml."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

HERE = Path(__file__).resolve().parent
MAKE = "from mesa_mobility.compiled.cache import make_shipped; make_shipped()"


class ForOnePlatform(Distribution):
    """A wheel with machine code."""

    def has_ext_modules(self):
        """Whether the wheel is for one platform."""
        return True


class Compiling(build_py):
    """Compiles what has been copied to the folder of the build."""

    def run(self):
        """Copy the modules, and compile them."""
        super().run()
        if self.editable_mode:
            return
        self.run_command("egg_info")  # has the names of models and behaviours
        built = Path(self.build_lib).resolve()
        paths = [str(built), str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])]
        found = os.environ | {"PYTHONPATH": os.pathsep.join(paths)}
        subprocess.run([sys.executable, "-c", MAKE], check=True, cwd=built, env=found)


if os.environ.get("MESA_MOBILITY_COMPILE") == "1":
    project = tomllib.loads((HERE / "pyproject.toml").read_text("utf-8"))["project"]
    setup(
        cmdclass={"build_py": Compiling},
        distclass=ForOnePlatform,
        setup_requires=project["dependencies"],
    )
else:
    setup()
