"""All of the package is installed, not only what a checkout happens to find beside it."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
BESIDE = ("behaviors", "models")
"""Packages that lie beside the framework and are installed below its name."""


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
