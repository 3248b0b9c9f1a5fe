"""Keeping Numba's cache of compiled kernels in step with the source."""

from __future__ import annotations

from pathlib import Path


def drop_stale_kernels(package: Path) -> None:
    """Delete compiled kernels that are older than the newest module of the package.

    Numba compares a cached kernel with its own module only and does not notice when a kernel
    that it calls, in another module, has changed.

    Args:
        package: folder of the package.
    """
    modules = [*package.rglob("*.py"), *package.parent.glob("behaviors/*.py")]
    newest = max((module.stat().st_mtime_ns for module in modules), default=0)
    for index in package.glob("*/__pycache__/*.nbi"):
        try:
            if index.stat().st_mtime_ns < newest:
                index.unlink(missing_ok=True)
        except OSError:  # somebody else's, or just removed by another process
            continue
