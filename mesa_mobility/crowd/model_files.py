"""Models by name: installed ones, and those of Python files and of modules."""

from __future__ import annotations

import importlib.util
import re
import sys
import traceback
from pathlib import Path
from types import ModuleType

from mesa_mobility.errors import ModelError
from mesa_mobility.plugins import registry
from mesa_mobility.plugins.registry import did_you_mean

_FILE = re.compile(r"(?P<path>.*\.py)(?::(?P<name>[^:/\\]*))?")


def find_model(text: str) -> type:
    """The class of a model, however it is named.

    Args:
        text: the name of an installed model, ``FILE.py``, ``FILE.py:NAME``, or ``module:NAME`` of
            a module that can be imported.

    Raises:
        ModelError: there is no such model, or it cannot be loaded.
    """
    if is_installed_name(text):
        return registry.load_model(text)
    return load_model_file(text) if is_model_file(text) else _of_module(text)


def is_installed_name(text: str) -> bool:
    """Whether a text names an installed model rather than one of a file or a module."""
    return ":" not in text and not is_model_file(text)


def is_model_file(text: str) -> bool:
    """Whether a text names a Python file rather than an installed model."""
    return _FILE.fullmatch(text) is not None


def path_and_name(text: str) -> tuple[Path, str | None]:
    """The file and the model's name of ``FILE.py:NAME``, or of ``FILE.py``, which has no name.

    Raises:
        ModelError: neither of them.
    """
    found = _FILE.fullmatch(text)
    if found is None:
        raise ModelError(f"{text}: expected FILE.py or FILE.py:NAME")
    return Path(found["path"]), found["name"]


def load_model_file(text: str) -> type:
    """The class of a model in a Python file, which is executed.

    Args:
        text: path of the file; with ``:NAME`` where it has several models.

    Raises:
        ModelError: no such file, an error in it, or not exactly one model that could be meant.
    """
    path, name = path_and_name(text)
    if not path.is_file():
        raise ModelError(f"{path}: no such file, expected a Python file with a model")
    models = _models_of(_execute(path))
    if not models:
        raise ModelError(f"{path}: has no model, expected a subclass of PedestrianModel")
    listed = ", ".join(models)
    if name is None:
        if len(models) > 1:
            raise ModelError(f"{path}: has several models, expected {path}:NAME, one of {listed}")
        return next(iter(models.values()))
    if name not in models:
        raise ModelError(
            f"{path}: has no model {name!r}{did_you_mean(name, models)}; it has {listed}"
        )
    return models[name]


def _of_module(text: str) -> type:
    name, _, attribute = text.partition(":")
    try:
        found = getattr(importlib.import_module(name), attribute)
    # A module of somebody else may fail in any way when it is imported.
    except Exception as error:
        reason = " ".join(str(error).split())
        raise ModelError(
            f"model {text}: cannot be loaded: {type(error).__name__}: {reason}"
        ) from error
    if not isinstance(found, type):
        raise ModelError(f"model {text}: is not a class")
    return found


def _execute(path: Path) -> ModuleType:
    """The module that a file makes; what it imports from beside it is found."""
    # No other module has such a name, whatever the file is called.
    module_name = f"mesa_mobility_model_file_{path.stem}"
    spec = importlib.util.spec_from_file_location(module_name, path.resolve())
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    sys.modules[module_name] = module
    try:
        spec.loader.exec_module(module)
    except KeyboardInterrupt:
        raise
    # The file may fail in any way, and end with SystemExit as a script does.
    except BaseException as error:
        del sys.modules[module_name]
        reason = " ".join(str(error).split())
        raise ModelError(
            f"{path}{_line(path, error)}: cannot be loaded: {type(error).__name__}: {reason}"
        ) from error
    return module


def _line(path: Path, error: BaseException) -> str:
    """``:12`` for the line of the file at which an error came about, or nothing."""
    file = str(path.resolve())
    if isinstance(error, SyntaxError) and error.filename == file:
        return f":{error.lineno}"
    lines = [
        each.lineno for each in traceback.extract_tb(error.__traceback__) if each.filename == file
    ]
    return f":{lines[-1]}" if lines else ""


def _models_of(module: ModuleType) -> dict[str, type]:
    """The models that a module defines itself, not those that it imports."""
    from mesa_mobility.crowd.pedestrian_model import PedestrianModel

    return {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type)
        and issubclass(value, PedestrianModel)
        and value.__module__ == module.__name__
    }
