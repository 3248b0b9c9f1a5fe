"""Damaged copies of a file, always the same ones: bytes changed, cut, repeated and swapped."""

import random
import warnings
from collections.abc import Iterator

from mesa_mobility import FloorPlan
from mesa_mobility.errors import MobilityError

ODD = (b"", b"-", b"1e999", b"nan", b"((", b"))", b"0", b"null", b"{", b"]", b"\x00", b"\xff", b'"')


def damaged(whole: bytes, count: int, seed: int = 1) -> Iterator[bytes]:
    rng = random.Random(seed)
    for _ in range(count):
        data = bytearray(whole)
        for _ in range(rng.choice((1, 1, 1, 2, 4))):
            size = max(len(data), 1)
            a = rng.randrange(size)
            b = min(a + rng.choice((1, 2, 5, 20, 200)), size)
            what = rng.choice((0, 1, 2, 3, 4, 5, 5, 5, 5, 5))
            if what == 0:
                data[a:b] = rng.choice(ODD)
            elif what == 1:
                data[a:a] = data[a:b]
            elif what == 2:
                del data[a:b]
            elif what == 3:
                data[a : a + 1] = bytes([rng.randrange(256)])
            elif what == 4:
                del data[a:]
            else:
                digits = [k for k in range(size) if chr(data[k]).isdigit()] if data else []
                if digits:
                    k = rng.choice(digits)
                    data[k : k + 1] = rng.choice((b"9999999", b"-", b"0", b"3", b"8", b"."))
        yield bytes(data)


def read_all(whole: bytes, path, count: int, **options) -> int:
    """Read damaged copies; how many of them are floor plans. Errors are one line each."""
    plans = 0
    for data in damaged(whole, count):
        path.write_bytes(data)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                FloorPlan.from_file(path, exits="longest", **options)
            plans += 1
        except MobilityError as error:
            several_lines = "\n" in str(error)
            if several_lines:
                raise AssertionError(repr(error)) from error
    return plans
