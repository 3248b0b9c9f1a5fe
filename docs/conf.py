"""Settings of the documentation: `sphinx-build -W --keep-going -n docs docs/_build/html`.

Nothing is fetched from the internet, neither by the build nor by the pages.
"""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

from docutils.nodes import SkipNode
from latex2mathml.converter import convert
from sphinx.application import Sphinx

HERE = Path(__file__).parent

project = "mesa-mobility"
author = "the mesa-mobility developers"
version = release = installed_version("mesa-mobility")

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = [
    "_build",
    "figures",
    "reference/command_line_generated.md",
    "tutorials/recordings",
]

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["home.css"]
html_title = "mesa-mobility"
html_math_renderer = "mathml"

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3

# Tutorials run when they are built, and a cell that fails ends the build.
nb_execution_mode = "cache"
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_merge_streams = True

# Names of other projects: their inventories would have to be fetched.
nitpick_ignore_regex = [(r"py:.*", r"(?!mesa_mobility\.).*")]

default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # docstrings give shapes and units, which types do not
autodoc_class_signature = "mixed"
napoleon_use_ivar = True
napoleon_use_rtype = False


def _inline_math(self: Any, node: Any) -> None:
    self.body.append(convert(node.astext(), display="inline"))
    raise SkipNode


def _display_math(self: Any, node: Any) -> None:
    self.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise SkipNode


def _write_command_line(_: Sphinx) -> None:
    """Write each command's help, for the reference."""
    page = HERE / "reference" / "command_line_generated.md"
    words = [
        "mesa_mobility.commands.app",
        "utils",
        "docs",
        "--name",
        "mesa-mobility",
        "--output",
        page,
    ]
    subprocess.run([sys.executable, "-m", "typer", *words], check=True, stdout=subprocess.DEVNULL)


def setup(app: Sphinx) -> None:
    """Have formulas drawn by the browser itself, and the commands described."""
    app.add_html_math_renderer("mathml", (_inline_math, None), (_display_math, None))
    app.connect("builder-inited", _write_command_line)
