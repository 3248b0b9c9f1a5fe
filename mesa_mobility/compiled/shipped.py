"""Compiled code that comes in a wheel, made for processors of a level.

The folder ``kernels`` of an installed package may have Numba's files for each level, and an index
in JSON: what they were made with, and a digest of each file. They are taken where a function has
not been compiled for this very processor. Whatever does not fit is compiled, as without them.

Code of a level is code for any x86-64 processor that may also use the features listed here. It is
taken only if the processor has each of them.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from llvmlite import binding
from numba import config
from numba.core.caching import IndexDataCacheFile

from mesa_mobility.compiled.processor import is_chosen

FOLDER = Path(__file__).parents[1] / "kernels"
INDEX = "index.json"

CPU = "x86-64"
"""The processor that each level is compiled for: any one with 64 bits."""

_V2 = ("sse3", "ssse3", "sse4.1", "sse4.2", "crc32", "popcnt", "cx16", "sahf")
_V3 = (*_V2, "avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave")
LEVELS: Mapping[str, tuple[str, ...]] = {
    "x86-64-v4": (*_V3, "avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"),
    "x86-64-v3": _V3,
}
"""Features of the levels, best one first, as LLVM names them."""


@dataclass(frozen=True)
class Code:
    """The compiled code of a level.

    Attributes:
        level: its name.
        folder: where its files are.
        digests: of the files, by their path below the folder.
    """

    level: str
    folder: Path
    digests: Mapping[str, str]

    def sound(self, path: Path) -> bool:
        """Whether a file is what was made."""
        digest = self.digests.get(path.relative_to(self.folder).as_posix())
        return digest == hashlib.sha256(path.read_bytes()).hexdigest()

    def find(self, module: str, base: str, key: tuple[Any, Any, Any]) -> Any:
        """What Numba keeps of a compiled function, or None.

        Args:
            module: folder of the function's module.
            base: beginning of the names of its files.
            key: Numba's key, of this processor.
        """
        signature, (triple, _, _), bytecode = key
        target = triple, CPU, _switched_on(self.level)
        try:
            return _Files(self, module, base).load((signature, target, bytecode))
        # Files of another version may raise anything.
        except Exception:
            return None


class _Files(IndexDataCacheFile):
    """Numba's files, each read only if its digest is that of the index: reading one runs it."""

    def __init__(self, code: Code, module: str, base: str) -> None:
        super().__init__(str(code.folder / module), base, "")
        self._code = code

    def _load_index(self) -> Any:
        return super()._load_index() if self._code.sound(Path(self._index_path)) else {}

    def _load_data(self, name: str) -> Any:
        if not self._code.sound(Path(self._data_path(name))):
            raise OSError(f"{name}: damaged")
        return super()._load_data(name)


@lru_cache(maxsize=1)
def code_for(version: str) -> Code | None:
    """The code that this processor can run, or None where none ships or it does not fit.

    Args:
        version: of the package, its source and its compiler.
    """
    if is_chosen():
        return None  # somebody wants code of another kind
    try:
        index = json.loads((FOLDER / INDEX).read_bytes())
        made_with, files = index["made_with"], dict(index["files"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    if made_with != _made_with(version):
        return None
    for level in _runnable():
        start = f"{level}/"
        digests = {
            name.removeprefix(start): digest
            for name, digest in files.items()
            if name.startswith(start)
        }
        if digests:
            return Code(level, FOLDER / level, digests)
    return None


def _made_with(version: str) -> list[object]:
    """The versions and the setting on which code depends, besides the processor."""
    numpy = np.__version__.split(".")[0]
    return [version, sys.implementation.cache_tag, numpy, bool(config.USING_SVML)]


def _runnable() -> Iterator[str]:
    """The levels all of whose features this processor and its system have."""
    try:
        features = binding.get_host_cpu_features()
    except RuntimeError:  # LLVM does not know
        return
    for level, needed in LEVELS.items():
        if all(features.get(feature) for feature in needed):
            yield level


def _switched_on(level: str) -> str:
    """The features of a level, in LLVM's form."""
    return ",".join(f"+{feature}" for feature in LEVELS[level])


RUNS = ("doorway", "auditorium --seconds 3")
"""Runs that call what most runs call."""


def make(version: str) -> None:
    """Compile what a run calls, for each level that this processor can run, into the folder.

    Args:
        version: of the package, its source and its compiler.
    """
    shutil.rmtree(FOLDER, ignore_errors=True)
    digests = {}
    for level in _runnable():
        with TemporaryDirectory() as place:
            print(f"compiling for {level}: takes a minute or two", flush=True)
            features = {"NUMBA_CPU_NAME": CPU, "NUMBA_CPU_FEATURES": _switched_on(level)}
            given = os.environ | features | {"NUMBA_CACHE_DIR": place}
            for run in RUNS:
                command = [sys.executable, "-m", "mesa_mobility", "run", *run.split()]
                subprocess.run([*command, "--seed", "1"], cwd=place, env=given, check=True)
            for path in sorted(Path(place).glob("*/*/*.nb[ci]")):
                kept = FOLDER / level / path.parent.name / path.name
                kept.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, kept)
                name = kept.relative_to(FOLDER).as_posix()
                digests[name] = hashlib.sha256(kept.read_bytes()).hexdigest()
    index = {"made_with": _made_with(version), "files": digests}
    (FOLDER / INDEX).write_text(json.dumps(index, indent=0))
