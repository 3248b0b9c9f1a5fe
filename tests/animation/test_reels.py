"""Pictures as films, and the paths of their cameras."""

import io
import json

import pytest
from PIL import Image

from mesa_mobility.animation.film_bodies import camera_path
from mesa_mobility.animation.reels import write_reel
from mesa_mobility.errors import ResultsError

COLOURS = [(200, 30, 30), (30, 180, 60), (40, 60, 210)]


def stills(kind):
    for colour in COLOURS:
        out = io.BytesIO()
        Image.new("RGB", (33, 20), colour).save(out, kind, quality=95)
        yield out.getvalue()


@pytest.mark.parametrize(("suffix", "kind"), [(".webp", "WEBP"), (".gif", "PNG")])
def test_a_film_has_all_pictures_for_their_times(tmp_path, suffix, kind):
    path = tmp_path / f"film{suffix}"
    write_reel(stills(kind), path, suffix, 15)
    with Image.open(path) as film:
        assert film.size == (33, 20)
        assert film.n_frames == 3
        lasts = []
        for number, colour in enumerate(COLOURS):
            film.seek(number)
            found = film.convert("RGB").getpixel((16, 10))
            assert max(abs(a - b) for a, b in zip(found, colour, strict=True)) < 12
            lasts.append(film.info["duration"])
    # 15 a second: 66.7 ms each; GIF counts in hundredths.
    assert sum(lasts) == pytest.approx(200, abs=0 if suffix == ".webp" else 20)


def test_what_is_no_picture_is_refused(tmp_path):
    with pytest.raises(ResultsError, match="no WebP picture"):
        write_reel(iter([next(stills("PNG"))]), tmp_path / "film.webp", ".webp", 15)


def test_a_camera_path_is_checked(tmp_path):
    path = tmp_path / "camera.json"
    view = {"time": 0, "eye": [1, 2, 3], "target": [0, 0, 1.5]}
    path.write_text(json.dumps({"views": [view]}))
    assert camera_path(path) == {"views": [view]}
    for content, what in (
        ("", "cannot be read"),
        ("[" * 100_000, "cannot be read"),
        ("[]", "expected 1 to 1000 views"),
        ('{"views": []}', "expected 1 to 1000 views"),
        ('{"views": [{"time": 0, "eye": [1, 2], "target": [0, 0, 0]}]}', "view 0: expected"),
        ('{"views": [{"time": NaN, "eye": [1, 2, 3], "target": [0, 0, 0]}]}', "view 0: expected"),
        ('{"views": [7]}', "view 0: expected"),
    ):
        path.write_text(content)
        with pytest.raises(ResultsError, match=what):
            camera_path(path)
    with pytest.raises(ResultsError, match="cannot be read"):
        camera_path(tmp_path / "missing.json")
