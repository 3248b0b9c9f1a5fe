"""`mesa-mobility new`: skeletons of behaviours, models and packages, with a test that passes."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import say, some_path
from mesa_mobility.commands.plugins.skeletons import (
    BEHAVIOR,
    BEHAVIOR_TEST,
    MODEL,
    MODEL_TEST,
    PACKAGE,
    PROJECT,
    README,
)
from mesa_mobility.errors import ModelError

app = typer.Typer(
    help="Write the skeleton of a behaviour, a model or a package.", no_args_is_help=True
)

_Name = Annotated[
    str, typer.Argument(metavar="NAME", help="Name in lower case, such as keep_left.")
]
_Folder = Annotated[
    Path,
    typer.Option("--in", help="Folder to write to.", parser=some_path, metavar="PATH"),
]


@app.command("behavior")
def behavior(name: _Name, folder: _Folder = Path()) -> None:
    """Write NAME.py with a cost term, and test_NAME.py."""
    words = _words(name)
    _write(folder, {f"{name}.py": BEHAVIOR, f"test_{name}.py": BEHAVIOR_TEST}, words)
    say(f"now: pytest {folder / f'test_{name}.py'}")


@app.command("model")
def model(name: _Name, folder: _Folder = Path()) -> None:
    """Write NAME.py with a model, and test_NAME.py."""
    words = _words(name)
    _write(folder, {f"{name}.py": MODEL, f"test_{name}.py": MODEL_TEST}, words)
    say(f"now: pytest {folder / f'test_{name}.py'}; mesa-mobility dashboard {folder / name}.py")


@app.command("package")
def package(name: _Name, folder: _Folder = Path()) -> None:
    """Write the folder NAME with a package of one behaviour and one model, and its tests."""
    words = _words(name)
    files = {
        "pyproject.toml": PROJECT,
        "README.md": README,
        f"{name}/__init__.py": PACKAGE,
        f"{name}/{name}_term.py": BEHAVIOR,
        f"{name}/{name}_room.py": MODEL,
        f"tests/test_{name}_term.py": BEHAVIOR_TEST,
        f"tests/test_{name}_room.py": MODEL_TEST,
    }
    for path, text in files.items():
        part = f"{name}_term" if "term" in path else f"{name}_room"
        inside = _words(part) if "_term" in path or "_room" in path else words
        _write(folder / name, {path: text}, {**inside, "module": f"{name}.{part}"})
    say(f"now: pip install -e {folder / name} && pytest {folder / name}")


def _words(name: str) -> dict[str, str]:
    """What stands for the placeholders of a skeleton."""
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name):
        raise ModelError(f"name {name!r}: expected lower-case letters, digits and _, as keep_left")
    camel = "".join(part.capitalize() for part in name.split("_"))
    return {"name": name, "class": camel, "module": name}


def _write(folder: Path, files: Mapping[str, str], words: Mapping[str, str]) -> None:
    """Write files, none of which may be there."""
    for path in files:
        if (folder / path).exists():
            raise ModelError(f"{folder / path}: is there already, expected a new name")
    for path, text in files.items():
        try:
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            for word, value in words.items():
                text = text.replace(f"@{word}@", value)
            (folder / path).write_text(text, encoding="utf-8")
        except OSError as error:
            raise ModelError(
                f"{folder / path}: cannot be written: {error.strerror or error}"
            ) from error
        say(f"written: {folder / path}")
