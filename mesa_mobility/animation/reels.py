"""Pictures as files of films."""

from __future__ import annotations

import io
import shutil
import struct
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError

if TYPE_CHECKING:
    from PIL.Image import Image

QUALITY = 85
"""Of pictures in WebP, of 100."""


def write_reel(pictures: Iterable[NDArray[np.uint8]], path: Path, suffix: str, rate: int) -> None:
    """Write a film of pictures of one size.

    Args:
        pictures: (high, wide, 4) red, green, blue and a byte that is ignored. An array may be
            reused for the next picture.
        path: file to write.
        suffix: kind of film: ".webp", ".gif" or ".mp4", which needs ffmpeg on the path.
        rate: pictures a second.

    Raises:
        ResultsError: no ffmpeg, or it fails.
    """
    {".webp": _write_webp, ".gif": _write_gif, ".mp4": _write_mp4}[suffix](pictures, path, rate)


def _write_webp(pictures: Iterable[NDArray[np.uint8]], path: Path, rate: int) -> None:
    """Of each picture the part that changes: the WebP container specification (Google, 2023)."""
    shown = 0
    with path.open("wb") as out:
        for number, (picture, (x, y)) in enumerate(_changed(pictures), start=1):
            end = round(1000 * number / rate)
            high, wide = picture.shape[:2]
            size = _in_24_bits(wide - 1) + _in_24_bits(high - 1)
            if number == 1:
                out.write(b"RIFF\0\0\0\0WEBP")
                out.write(_chunk(b"VP8X", b"\x02\0\0\0" + size))
                out.write(_chunk(b"ANIM", b"\xff\xff\xff\xff\0\0"))
            # Places are in units of two pixels.
            place = _in_24_bits(x // 2) + _in_24_bits(y // 2)
            head = place + size + _in_24_bits(end - shown) + b"\x02"
            out.write(_chunk(b"ANMF", head + _coded(picture)))
            shown = end
        length = out.tell() - 8
        out.seek(4)
        out.write(struct.pack("<I", length))


def _changed(
    pictures: Iterable[NDArray[np.uint8]],
) -> Iterator[tuple[NDArray[np.uint8], tuple[int, int]]]:
    """The first picture, and of others the rectangle that has changed; left and upper edge, even.

    A rectangle has a corner of the picture if nothing has changed.
    """
    before: NDArray[np.uint32] | None = None
    for picture in pictures:
        pixels = np.ascontiguousarray(picture).view(np.uint32)[..., 0]
        if before is None:
            before = pixels.copy()
            yield picture, (0, 0)
            continue
        new = before != pixels
        rows, columns = (np.flatnonzero(new.any(axis=axis)) for axis in (1, 0))
        (y, bottom), (x, right) = (
            (int(each[0]) & ~1, int(each[-1]) + 1) if len(each) else (0, 1)
            for each in (rows, columns)
        )
        before[y:bottom, x:right] = pixels[y:bottom, x:right]
        yield picture[y:bottom, x:right], (x, y)


def _image(picture: NDArray[np.uint8]) -> Image:
    from PIL import Image

    size = (picture.shape[1], picture.shape[0])
    return Image.frombuffer("RGBX", size, picture.tobytes(), "raw", "RGBX", 0, 1)


def _coded(picture: NDArray[np.uint8]) -> bytes:
    """The chunk of a WebP file that has a picture without transparency."""
    out = io.BytesIO()
    _image(picture).save(out, "WEBP", quality=QUALITY, method=0)
    return out.getvalue()[12:]


def _in_24_bits(number: int) -> bytes:
    return struct.pack("<I", number)[:3]


def _chunk(name: bytes, content: bytes) -> bytes:
    return name + struct.pack("<I", len(content)) + content + bytes(len(content) % 2)


def _write_gif(pictures: Iterable[NDArray[np.uint8]], path: Path, rate: int) -> None:
    from PIL import Image

    method = Image.Quantize.FASTOCTREE
    coded = (_image(each).convert("RGB").quantize(128, method=method) for each in pictures)
    duration = round(1000 / rate)
    next(coded).save(path, "GIF", save_all=True, append_images=coded, duration=duration, loop=0)


def _write_mp4(pictures: Iterable[NDArray[np.uint8]], path: Path, rate: int) -> None:
    program = shutil.which("ffmpeg")
    if program is None:
        raise ResultsError("MP4 needs ffmpeg on the path; .gif and .webp do not")
    process = None
    try:
        for picture in pictures:
            if process is None:
                high, wide = picture.shape[:2]
                command = [program, "-y", "-loglevel", "error", "-f", "rawvideo"]
                command += ["-pix_fmt", "rgb0", "-s", f"{wide}x{high}", "-framerate", str(rate)]
                command += ["-i", "-", "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0"]
                command += ["-pix_fmt", "yuv420p", "-f", "mp4", str(path)]
                process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
            assert process.stdin is not None
            process.stdin.write(picture.tobytes())
    except BrokenPipeError:
        pass  # told below
    except BaseException:
        if process is not None:
            process.kill()
        raise
    assert process is not None
    _, said = process.communicate()
    if process.returncode:
        raise ResultsError(f"ffmpeg: {said.decode(errors='replace').strip()}")
