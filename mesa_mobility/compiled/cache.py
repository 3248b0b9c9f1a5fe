"""Cache of compiled code on disk, which never prevents a start.

Files are in Numba's format; this module decides where they lie and what happens to damaged ones.
The folder is named after the package's version and source. A changed source thus has another
folder, since Numba does not notice when a function that a compiled one calls has changed.
"""

from __future__ import annotations

import hashlib
import logging
import os
import platform
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.ccallback import CFunc
from numba.core.runtime import rtsys

from mesa_mobility._version import __version__
from mesa_mobility.compiled import shipped

PACKAGE = Path(__file__).parents[1]

PLAIN_WANTED: bool = os.environ.get("MESA_MOBILITY_PLAIN") == "1"
"""Whether plain Numba is to take the place of hand-written code; see ``compiled.twins``."""

PREFIX = "mesa-mobility-"

_MOST = 8
"""Folders of other versions that are kept beside a new one."""

_DIGEST = 32
"""Bytes of the checksum at the end of each file."""

_log = logging.getLogger(__name__)


@lru_cache
def say_once(message: str) -> None:
    """Warn of something about files, the first time that it is said."""
    # Without a logging configuration Python prints the message as it is on standard error.
    _log.warning(message)


def keep(dispatcher: Any) -> Any:
    """Keep a function's compiled code on disk; returns the function."""
    dispatcher._cache = _cache_of(dispatcher.py_func) or dispatcher._cache
    return dispatcher


def kept_cfunc(function: Callable[..., Any], signature: Any, **options: Any) -> Any:
    """A compiled C callback like that of ``numba.cfunc``, kept on disk if its source is in a file.

    Args:
        function: the function to compile.
        signature: its types.
        options: of Numba.
    """
    made: Any = CFunc(function, (signature.args, signature.return_type), locals={}, options=options)
    made._cache = _cache_of(function) or made._cache
    made.compile()
    return made


def _cache_of(function: Callable[..., Any]) -> FunctionCache | None:
    if folder() is None:
        return None
    try:
        return _Cache(function)
    except RuntimeError:  # its source is in no file
        return None


@lru_cache(maxsize=1)
def folder() -> Path | None:
    """The folder of compiled code, or None where nothing can be kept.

    It is below ``NUMBA_CACHE_DIR`` if that is set, else in the package's ``__pycache__``, else in
    the user's cache, else in a temporary folder: the first of them that has compiled code already,
    else the first that can be written.
    """
    name = PREFIX + _version()
    places = [place / name for place in _places()]
    for place in places:
        if any(place.glob("*/*.nbc")):
            with suppress(OSError):
                os.utime(place)
            return place
    for place in places:
        if _make(place):
            return place
    private = _temporary()
    if private is not None and _make(private / name):
        say_once(
            f"compiled code is kept in {private / name}: nothing can be written to "
            + " or ".join(str(place.parent) for place in places)
        )
        return private / name
    say_once("compiled code is not kept, and compiled at each start: no folder can be written")
    return None


def _places() -> Iterator[Path]:
    if numba.config.CACHE_DIR:
        yield Path(numba.config.CACHE_DIR)
        return
    yield PACKAGE / "__pycache__"
    with suppress(RuntimeError):  # nobody knows where home is
        home = Path.home()
        caches = {"darwin": home / "Library" / "Caches", "win32": home / "AppData" / "Local"}
        given = os.environ.get("XDG_CACHE_HOME", "")
        place = Path(given) if given else caches.get(sys.platform, home / ".cache")
        yield place / "mesa-mobility"


def _temporary() -> Path | None:
    """A temporary folder that no other user can write to, since code in it is executed."""
    user = os.getuid() if hasattr(os, "getuid") else None
    try:
        path = Path(tempfile.gettempdir()) / f"mesa-mobility-{'' if user is None else user}"
        path.mkdir(mode=0o700, exist_ok=True)
        found = path.lstat()
        others = stat.S_IRWXG | stat.S_IRWXO
    except OSError:
        return None
    private = user is None or (found.st_uid == user and not found.st_mode & others)
    return path if private and stat.S_ISDIR(found.st_mode) else None


def _make(place: Path) -> bool:
    """Whether a folder exists or can be made, and files can be written to it."""
    try:
        new = not place.is_dir()
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=place) as file:
            file.write(bytes(1 << 16))  # a full disk has room for names, but not for this
        if new:
            _prune(place)
    except OSError:
        return False
    return True


def _prune(place: Path) -> None:
    """Delete the least recently used folders of other versions."""
    others = [path for path in place.parent.glob(f"{PREFIX}*-*") if path != place]
    others.sort(key=lambda path: path.stat().st_mtime_ns, reverse=True)
    for path in others[_MOST:]:
        shutil.rmtree(path, ignore_errors=True)


_own_only = False


def compile_natively() -> None:
    """From here on, this process compiles for this processor what it would take from a wheel."""
    global _own_only
    _own_only = True


def shipped_code() -> shipped.Code | None:
    """The compiled code of the wheel that this process takes, if there is any."""
    kept_in = folder()
    if _own_only or kept_in is None:
        return None
    return shipped.code_for(kept_in.name.removeprefix(PREFIX))


def make_shipped() -> None:
    """Compile code for a wheel, into the package itself."""
    shipped.make(_version())


def _version() -> str:
    """The version of the package, and a digest of its source and of what compiles it."""
    made_with = (numba.__version__, llvmlite.__version__, platform.machine(), PLAIN_WANTED)
    digest = hashlib.sha256(repr(made_with).encode())
    for path in _sources():
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return f"{__version__}-{digest.hexdigest()[:16]}"


def _sources() -> Iterator[Path]:
    yield from sorted(PACKAGE.rglob("*.py"))
    if _behaviors().parent != PACKAGE:
        yield from sorted(_behaviors().rglob("*.py"))


@lru_cache
def _behaviors() -> Path:
    """The folder of shipped behaviours, which in a checkout lies beside the package."""
    inside = PACKAGE / "behaviors"
    return inside if inside.is_dir() else PACKAGE.parent / "behaviors"


class _Place:
    """Location of a function's compiled code, in the form that Numba expects."""

    def __init__(self, function: Any, source: str) -> None:
        self._py_file = source
        self._line = function.__code__.co_firstlineno
        path = Path(source)
        root = folder()
        assert root is not None
        self.shipped = path.is_relative_to(PACKAGE) or path.is_relative_to(_behaviors())
        if path.is_relative_to(PACKAGE):
            self._stamp = ""  # the folder's name is of all of the package's source
            self._path = root / ".".join(path.parent.relative_to(PACKAGE).parts or ["root"])
        else:
            self._stamp = _digest_of(path)
            where = hashlib.sha256(os.fsencode(path.parent)).hexdigest()[:16]
            self._path = root / f"{path.parent.name}-{where}"

    @classmethod
    def from_function(cls, function: Any, source: str) -> _Place | None:
        return cls(function, source) if os.path.exists(source) else None

    def ensure_cache_path(self) -> None:
        self._path.mkdir(parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        return str(self._path)

    def get_source_stamp(self) -> str:
        return self._stamp

    def get_disambiguator(self) -> str:
        return str(self._line)


@lru_cache
def _digest_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


class _Files(IndexDataCacheFile):
    """Numba's files with checksums; a damaged file counts as missing."""

    def _dump(self, content: Any) -> bytes:
        data: bytes = super()._dump(content)
        # Numba ignores what follows its data.
        return data + hashlib.sha256(data).digest()

    def _load_index(self) -> Any:
        try:
            return super()._load_index()
        # A damaged file may raise anything.
        except Exception:
            self._damaged()
            return {}

    def _load_data(self, name: str) -> Any:
        content = Path(self._data_path(name)).read_bytes()
        if hashlib.sha256(content[:-_DIGEST]).digest() != content[-_DIGEST:]:
            self._damaged()
            raise OSError(f"{name}: damaged")
        return super()._load_data(name)

    def load(self, key: Any) -> Any:
        found = super().load(key)
        if found is not None or self._source_stamp:  # code of others does not ship
            return found
        code, base = shipped_code(), self._index_name.removesuffix(".nbi")
        return None if code is None else code.find(Path(self._cache_path).name, base, key)

    def save(self, key: Any, data: Any) -> None:
        # Processes that compile a function for different types at the same time must not write to
        # the same name.
        name = hashlib.sha256(repr(key).encode()).hexdigest()[:16]
        self._data_name_pattern = self._index_name.removesuffix("nbi") + name + ".{number:d}.nbc"
        super().save(key, data)

    def _damaged(self) -> None:
        say_once(f"{folder()}: compiled code there is damaged, and compiled again")


class _Impl(CompileResultCacheImpl):
    _locator_classes = (_Place,)


class _Cache(FunctionCache):
    """The compiled code of a function on disk."""

    _impl_class = _Impl

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        self._cache_file = _Files(
            self._cache_path, self._impl.filename_base, self._impl.locator.get_source_stamp()
        )

    def load_overload(self, signature: Any, context: Any) -> Any:
        if not self._impl.locator.shipped:
            return super().load_overload(signature, context)
        # Numba would import first what it needs to compile, which takes a twentieth of a start. It
        # imports that anyway before it compiles. Code of others may call functions of it.
        rtsys.initialize(context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(signature, context)

    def save_overload(self, signature: Any, result: Any) -> None:
        try:
            super().save_overload(signature, result)
        except OSError as error:
            say_once(
                f"{folder()}: compiled code cannot be kept there: {error.strerror or error}; "
                "what is missing is compiled at each start"
            )
