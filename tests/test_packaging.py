"""All of the package is installed, not only what a checkout happens to find beside it."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
BESIDE = ("behaviors", "models")
"""Packages that lie beside the framework and are installed below its name."""

CONSTRAINED = ("test", "docs", "dev")
"""Extras of which constraints.txt has all packages."""


def packages_in(folder: Path, name: str) -> set[str]:
    """Names of the packages in a folder of this name, itself included."""
    return {
        ".".join([name, *file.parent.relative_to(folder).parts])
        for file in folder.rglob("__init__.py")
    }


def test_every_folder_with_modules_is_installed():
    setuptools = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    there = packages_in(ROOT / "mesa_mobility", "mesa_mobility")
    for folder in BESIDE:
        there |= packages_in(ROOT / folder, f"mesa_mobility.{folder}")
    assert set(setuptools["packages"]) == there
    assert len(setuptools["packages"]) == len(there)


def test_no_folder_with_modules_lacks_its_init_file():
    for root in (ROOT / "mesa_mobility", *(ROOT / folder for folder in BESIDE)):
        folders = {file.parent for file in root.rglob("*.py")}
        assert all((folder / "__init__.py").is_file() for folder in folders)


def test_every_file_that_is_no_module_is_installed():
    setuptools = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["setuptools"]
    installed = {
        file
        for package, patterns in setuptools["package-data"].items()
        for pattern in patterns
        for file in ROOT.joinpath(*package.split(".")).glob(pattern)
    }
    there = {
        file
        for file in (ROOT / "mesa_mobility").rglob("*")
        if file.is_file() and file.suffix != ".py" and "__pycache__" not in file.parts
    }
    assert there - installed == set()


def constraints() -> list[Requirement]:
    """What constraints.txt says, line by line."""
    lines = (ROOT / "constraints.txt").read_text("utf-8").splitlines()
    return [Requirement(line) for line in lines if not line.startswith("#")]


def asked_for() -> list[Requirement]:
    """The dependencies of the package and of the extras of which constraints.txt has all."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    found = list(project["dependencies"])
    ahead, seen = list(CONSTRAINED), set()
    while ahead:
        if (extra := ahead.pop()) in seen:
            continue
        seen.add(extra)
        for line in extras[extra]:
            if line.startswith("mesa-mobility["):
                ahead += Requirement(line).extras
            else:
                found.append(line)
    return [Requirement(line) for line in found]


@pytest.mark.parametrize("python", ["3.11", "3.12", "3.13"])
@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
def test_constraints_have_one_allowed_version_of_each_dependency(python, system):
    where = {
        "python_version": python,
        "python_full_version": f"{python}.7",
        "sys_platform": system,
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
    }
    pinned: dict[str, str] = {}
    for each in constraints():
        if each.marker is None or each.marker.evaluate(where):
            name = canonicalize_name(each.name)
            assert name not in pinned
            [version] = each.specifier
            assert version.operator == "=="
            pinned[name] = version.version
    for each in asked_for():
        assert each.specifier.contains(pinned[canonicalize_name(each.name)]), each


def test_constraints_name_no_registry_and_no_path():
    text = (ROOT / "constraints.txt").read_text("utf-8")
    assert not re.search(r"://|@|--index|--find|\\|/", text.replace(".ci/", "", 1))


def test_the_line_of_the_readme_installs_these_versions():
    lines = re.findall(r"^python3 -m venv .*pytest$", (ROOT / "README.md").read_text("utf-8"), re.M)
    assert ["-c constraints.txt" in line for line in lines] == [True]
