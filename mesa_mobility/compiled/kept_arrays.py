"""Arrays that take long to compute, kept on disk beside the compiled code and mapped into memory.

A file is an ``.npy`` of bytes. In it the arrays follow each other, each in lines of the processor's
cache, then an index in JSON, its length, and a checksum of all. Processes share the memory of a
file that they map: what one of them writes to an array is its own.

The name of a file is that of its key, which the index has in full. The folder is that of one
version of the source. A file that is damaged, or whose content does not fit, is made again. Where
nothing can be written, arrays are computed at each start.

Files are complete or absent, and never changed: a process that replaces or deletes one leaves what
others have mapped as it was.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from llvmlite import binding
from numpy.typing import NDArray

from mesa_mobility.compiled import cache
from mesa_mobility.errors import ContentError, MobilityError
from mesa_mobility.files.atomic import replacing

LEAST = 4_000_000
"""Bytes of arrays that are worth a file: fewer are computed as fast as they are found."""

MOST = 1_000_000_000
"""Bytes of all files together, those of other versions included; the least recently used go."""

_LINE = 64
_LENGTH, _CHECK = 8, 4

Arrays = Mapping[str, NDArray[Any]]

Result = TypeVar("Result")


def kept_arrays(
    subject: str,
    key: object,
    dtypes: Mapping[str, np.dtype[Any]],
    make: Callable[[], tuple[Result, Arrays]],
    take: Callable[[Arrays], Result],
) -> Result:
    """What ``make`` computes, from the arrays of a file if it has been computed before.

    Args:
        subject: what the arrays are, the beginning of the file's name.
        key: all that they depend on besides the source, with a ``repr`` that tells it.
        dtypes: the arrays' types by name. Others are computed each time.
        make: computes the result, and the arrays to keep.
        take: checks the arrays of a file and makes the result of them. They are in C order, and
            may be written to. If it raises an error, the file is made again.
    """
    folder = cache.folder()
    if folder is None:
        return make()[0]
    written = _text(key, dtypes)
    name = f"{subject}-{hashlib.sha256(written.encode()).hexdigest()[:24]}.npy"
    path = folder / "arrays" / name
    try:
        found = take(_read(path, written, dtypes))
    except FileNotFoundError:
        pass
    # A file that is damaged may raise anything.
    except Exception:
        cache.say_once(f"{path}: damaged, and made again")
    else:
        with suppress(OSError):
            os.utime(path)
        return found
    found, arrays = make()
    if _fit(arrays, dtypes):
        _write(path, written, arrays)
    return found


def _text(key: object, dtypes: Mapping[str, np.dtype[Any]]) -> str:
    """The key of a file, with what decides about the last digits of computed numbers."""
    types = {name: np.dtype(each).descr for name, each in dtypes.items()}
    return repr((key, types, np.__version__, _processor()))


@lru_cache
def _processor() -> str:
    return str(binding.get_host_cpu_name())


def _fit(arrays: Arrays, dtypes: Mapping[str, np.dtype[Any]]) -> bool:
    """Whether arrays have these names and types, and are worth a file that may be kept."""
    typed = {name: each.dtype for name, each in arrays.items()}
    return typed == {name: np.dtype(each) for name, each in dtypes.items()} and (
        LEAST <= sum(each.nbytes for each in arrays.values()) <= MOST // 2
    )


def _read(path: Path, key: str, dtypes: Mapping[str, np.dtype[Any]]) -> Arrays:
    """The arrays of a file.

    Raises:
        FileNotFoundError: there is no such file.
        Exception: the file is damaged or of another key.
    """
    memory = np.asarray(np.load(path, mmap_mode="c", allow_pickle=False))
    if memory.dtype != np.uint8 or memory.ndim != 1:
        raise ContentError(f"{path}: expected bytes")
    content, check = memory[:-_CHECK], memory[-_CHECK:].tobytes()
    if zlib.crc32(content.data) != int.from_bytes(check, "little"):
        raise ContentError(f"{path}: its checksum is another")
    end = len(content) - _LENGTH
    begin = end - int.from_bytes(content[end:].tobytes(), "little")
    index = json.loads(content[begin:end].tobytes())
    if index["key"] != key:
        raise ContentError(f"{path}: its key is another")
    return {
        name: _taken(memory[:begin], index["arrays"][name], np.dtype(dtype))
        for name, dtype in dtypes.items()
    }


def _taken(
    memory: NDArray[np.uint8], where: tuple[int, list[int]], dtype: np.dtype[Any]
) -> NDArray[Any]:
    start, shape = where
    if start % _LINE or min(start, *shape) < 0:
        raise ContentError(f"got an array at {start} of {shape}, expected one in lines")
    size = math.prod(shape) * dtype.itemsize
    return memory[start : start + size].view(dtype).reshape(shape)


def _write(path: Path, key: str, arrays: Arrays) -> None:
    """Write a file if possible: complete or not at all."""
    with suppress(OSError, MobilityError):
        path.parent.mkdir(exist_ok=True)
        with replacing(path, MobilityError) as temporary, open(temporary, "wb") as file:
            parts = list(_parts(key, arrays))
            header = {"descr": "|u1", "fortran_order": False}
            length = sum(map(len, parts)) + _CHECK
            np.lib.format.write_array_header_1_0(file, header | {"shape": (length,)})
            check = 0
            for part in parts:
                file.write(part)
                check = zlib.crc32(part, check)
            file.write(check.to_bytes(_CHECK, "little"))
        _prune(path)


def _parts(key: str, arrays: Arrays) -> Iterator[bytes | memoryview]:
    """The bytes of a file after its header, but for the checksum."""
    start, index = 0, {}
    for name, array in arrays.items():
        index[name] = start, array.shape
        yield np.ascontiguousarray(array).reshape(-1).view(np.uint8).data
        gap = -array.nbytes % _LINE
        yield bytes(gap)
        start += array.nbytes + gap
    told = json.dumps({"key": key, "arrays": index}).encode()
    yield told
    yield len(told).to_bytes(_LENGTH, "little")


def _prune(new: Path) -> None:
    """Delete the least recently used files, of all versions, while they are too many."""
    aged = []
    for path in new.parents[2].glob(f"{cache.PREFIX}*/arrays/*.npy"):
        with suppress(OSError):
            aged.append((path != new, -path.stat().st_mtime_ns, path.stat().st_size, path))
    total = 0
    for _, _, size, path in sorted(aged):
        total += size
        if total > MOST:
            with suppress(OSError):
                path.unlink()
