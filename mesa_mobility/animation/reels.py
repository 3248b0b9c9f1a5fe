"""Pictures as files of films."""

from __future__ import annotations

import io
import shutil
import struct
import subprocess
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError


def write_reel(pictures: Iterable[bytes], path: Path, suffix: str, rate: int) -> None:
    """Write a film of pictures of one size.

    Args:
        pictures: files of pictures: WebP for ".webp", PNG for ".gif", JPEG for ".mp4".
        path: file to write.
        suffix: kind of film; ".mp4" needs ffmpeg on the path.
        rate: pictures a second.

    Raises:
        ResultsError: no ffmpeg, or it fails.
    """
    {".webp": _write_webp, ".gif": _write_gif, ".mp4": _write_mp4}[suffix](pictures, path, rate)


def still(colours: NDArray[np.uint8], suffix: str) -> bytes:
    """A picture as a file that ``write_reel`` takes.

    Args:
        colours: (high, wide, 4) red, green, blue and opacity.
        suffix: of the film.
    """
    from PIL import Image

    kind, options = _STILLS[suffix]
    high, wide = (length - length % 2 for length in colours.shape[:2])  # as MP4 needs
    out = io.BytesIO()
    Image.fromarray(colours[:high, :wide]).convert("RGB").save(out, kind, **options)
    return out.getvalue()


_STILLS: dict[str, tuple[str, dict[str, int]]] = {
    ".webp": ("WEBP", {"quality": 85, "method": 0}),
    ".gif": ("PNG", {"compress_level": 1}),
    ".mp4": ("JPEG", {"quality": 95}),
}


def _write_webp(pictures: Iterable[bytes], path: Path, rate: int) -> None:
    """Each picture as a frame of its own: the WebP container specification (Google, 2023)."""
    shown = 0
    with path.open("wb") as out:
        for number, picture in enumerate(pictures, start=1):
            end = round(1000 * number / rate)
            size, coded = _still(picture)
            if number == 1:
                canvas = struct.pack("<I", size[0] - 1)[:3] + struct.pack("<I", size[1] - 1)[:3]
                out.write(b"RIFF\0\0\0\0WEBP")
                out.write(_chunk(b"VP8X", b"\x02\0\0\0" + canvas))
                out.write(_chunk(b"ANIM", b"\xff\xff\xff\xff\0\0"))
            place = bytes(6) + canvas + struct.pack("<I", end - shown)[:3] + b"\x02"
            out.write(_chunk(b"ANMF", place + coded))
            shown = end
        length = out.tell() - 8
        out.seek(4)
        out.write(struct.pack("<I", length))


def _still(picture: bytes) -> tuple[tuple[int, int], bytes]:
    """Width and height of a WebP picture, and the chunk that has it without transparency."""
    from PIL import Image

    with Image.open(io.BytesIO(picture)) as opened:
        size = opened.size
    at = 12
    while at + 8 <= len(picture):
        name, length = picture[at : at + 4], struct.unpack_from("<I", picture, at + 4)[0]
        end = at + 8 + length + length % 2
        if name in (b"VP8 ", b"VP8L"):
            return size, picture[at:end]
        at = end
    raise ResultsError("the browser has sent no WebP picture")


def _chunk(name: bytes, content: bytes) -> bytes:
    return name + struct.pack("<I", len(content)) + content + bytes(len(content) % 2)


def _write_gif(pictures: Iterable[bytes], path: Path, rate: int) -> None:
    from PIL import Image

    found = []
    for picture in pictures:
        with Image.open(io.BytesIO(picture)) as opened:
            found.append(opened.convert("RGB").quantize(128, method=Image.Quantize.FASTOCTREE))
    first, *others = found
    duration = round(1000 / rate)
    first.save(path, "GIF", save_all=True, append_images=others, duration=duration, loop=0)


def _write_mp4(pictures: Iterable[bytes], path: Path, rate: int) -> None:
    program = shutil.which("ffmpeg")
    if program is None:
        raise ResultsError("MP4 needs ffmpeg on the path; .gif and .webp do not")
    command = [program, "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", str(rate)]
    command += ["-c:v", "mjpeg", "-i", "-", "-pix_fmt", "yuv420p", "-f", "mp4", str(path)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdin is not None
    try:
        for picture in pictures:
            process.stdin.write(picture)
    except BrokenPipeError:
        pass  # told below
    except BaseException:
        process.kill()
        raise
    _, said = process.communicate()
    if process.returncode:
        raise ResultsError(f"ffmpeg: {said.decode(errors='replace').strip()}")
