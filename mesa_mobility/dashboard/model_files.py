"""Models in Python files of the folder that the dashboard was started in."""

from __future__ import annotations

import ast
import threading
from pathlib import Path

from mesa_mobility.crowd.model_files import load_model_file, path_and_name
from mesa_mobility.dashboard import offered
from mesa_mobility.errors import ModelError

LARGEST = 1_000_000
"""Bytes of a file that is looked into."""

BASE, SHIPPED = "PedestrianModel", "mesa_mobility.models"

_lock = threading.Lock()
_loaded: dict[tuple[str, int], type] = {}


def offered_models() -> list[str]:
    """Models of the folder as ``FILE.py``, or ``FILE.py:NAME`` where a file has several.

    Files are read, not executed.
    """
    found = []
    for path in sorted(offered.FOLDER.glob("*.py")):
        names = _models_in(path)
        several = len(names) > 1
        found += [f"{path.name}:{name}" if several else path.name for name in names]
    return found


def load_offered(text: str) -> type:
    """The class of an offered model; its file is executed, once as long as it stays the same.

    Raises:
        ModelError: the model is not offered, or its file has an error.
    """
    if text not in offered_models():
        raise ModelError(f"{text}: expected a model of a file in {offered.FOLDER}")
    path, name = path_and_name(text)
    path = offered.FOLDER / path
    with _lock:
        key = (text, path.stat().st_mtime_ns)
        if key not in _loaded:
            _loaded[key] = load_model_file(str(path) if name is None else f"{path}:{name}")
        return _loaded[key]


def _models_in(path: Path) -> list[str]:
    """Names of a file's models; one empty name for a file that cannot be parsed but has some."""
    try:
        if path.stat().st_size > LARGEST:
            return []
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return []
    if BASE not in text and SHIPPED not in text:
        return []
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return [""]
    bases, names = {BASE}, []
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.module == SHIPPED:
            bases |= {each.asname or each.name for each in node.names}
        elif isinstance(node, ast.ClassDef) and bases & {_last_name(each) for each in node.bases}:
            bases.add(node.name)
            names.append(node.name)
    return names


def _last_name(node: ast.expr) -> str:
    """``PedestrianModel`` of ``mesa_mobility.PedestrianModel``."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""
