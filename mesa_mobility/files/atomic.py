"""Files that are complete or absent: written beside their place, then renamed."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from mesa_mobility.errors import MobilityError
from mesa_mobility.interrupts import cleaning_up


@contextmanager
def replacing(path: str | os.PathLike[str], error: type[MobilityError]) -> Iterator[Path]:
    """Give a temporary path in the same folder; on success it replaces `path`, else it goes.

    Args:
        path: the file to write.
        error: raised where the folder or the file cannot be written, or the disk is full.
    """
    target = Path(path)
    # Machines that share a folder may have processes of one number. The suffix stays last: writers
    # of pictures choose the format by it.
    mine = f"{os.getpid()}-{secrets.token_hex(4)}"
    temporary = target.with_name(f".{target.stem}.{mine}.tmp{target.suffix}")
    try:
        with cleaning_up(lambda: temporary.unlink(missing_ok=True)):
            yield temporary
            os.replace(temporary, target)
    except OSError as cause:
        raise error(f"{target}: cannot be written: {cause.strerror or cause}") from cause
    finally:
        with suppress(OSError):
            temporary.unlink()
