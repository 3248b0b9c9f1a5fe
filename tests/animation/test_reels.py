"""Pictures as films, and the paths of their cameras."""

import json

import numpy as np
import pytest
from PIL import Image

from mesa_mobility.animation import Selection
from mesa_mobility.animation.film import write_film_of_bodies
from mesa_mobility.animation.film_bodies import camera_path
from mesa_mobility.animation.reels import write_reel
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Excerpt

COLOURS = [(200, 30, 30), (30, 180, 60), (40, 60, 210)]


def plain(colour):
    return np.full((20, 33, 4), [*colour, 255], dtype=np.uint8)


@pytest.mark.parametrize("suffix", [".webp", ".gif"])
def test_a_film_has_all_pictures_for_their_times(tmp_path, suffix):
    path = tmp_path / f"film{suffix}"
    write_reel(map(plain, COLOURS), path, suffix, 15)
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


def test_what_does_not_change_stays_as_it_was(tmp_path):
    # A red square of 6 x 4 pixels moves by 10 and then rests, in an array that is used again.
    path, sheet = tmp_path / "film.webp", plain((255, 255, 255))

    def pictures():
        for x in (3, 13, 13):
            sheet[:] = 255
            sheet[5:9, x : x + 6, :3] = (200, 30, 30)
            yield sheet

    write_reel(pictures(), path, ".webp", 15)
    places = []
    with Image.open(path) as film:
        assert film.n_frames == 3
        for number in range(3):
            film.seek(number)
            green = np.asarray(film.convert("RGB"), dtype=int)[..., 1]
            places.append((green[6, 5], green[6, 15], green[15, 5], green[1, 30]))
    for found, (left, right) in zip(places, [(30, 255), (255, 30), (255, 30)], strict=True):
        assert np.abs(np.subtract(found, (left, right, 255, 255))).max() < 40
    # Frames of the file: x and y in units of two pixels, width and height less one.
    content, boxes = path.read_bytes(), []
    at = content.index(b"ANMF")
    while at >= 0:
        boxes.append(
            tuple(int.from_bytes(content[k : k + 3], "little") for k in range(at + 8, at + 20, 3))
        )
        at = content.find(b"ANMF", at + 1)
    assert boxes == [(0, 0, 32, 19), (1, 2, 16, 4), (0, 0, 0, 0)]


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


def test_films_of_bodies_are_checked_first(run, plan, tmp_path, monkeypatch):
    excerpt = Excerpt(run, plan, Selection(end=1.0))
    for keywords, suffix, what in (
        ({"size": (15, 100)}, ".webp", "even numbers from 16 to 4096"),
        ({"size": (640, 361)}, ".webp", "even numbers"),
        ({"speed": 0.0}, ".webp", "speed 0"),
        ({"camera": tmp_path / "none.json"}, ".webp", "cannot be read as a camera path"),
        ({}, ".avi", "films end with"),
    ):
        with pytest.raises(ResultsError, match=what):
            write_film_of_bodies(excerpt, tmp_path / f"film{suffix}", **keywords)
    monkeypatch.setenv("MESA_MOBILITY_BROWSER", "no-such-browser")
    with pytest.raises(ResultsError, match="no browser to draw a film in three dimensions"):
        write_film_of_bodies(excerpt, tmp_path / "film.webp")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_a_browser_draws_a_film_in_three_dimensions(run, plan, tmp_path, browser_program):
    path, camera = tmp_path / "film.webp", tmp_path / "camera.json"
    # From above the room, from beside it, and off it.
    views = [
        {"time": 0.0, "eye": [4, -6, 6], "target": [4, 2, 0]},
        {"time": 1.0, "eye": [4, -60, 60], "target": [4, -120, 60]},
    ]
    camera.write_text(json.dumps({"views": views}))
    told = []
    excerpt = Excerpt(
        run, plan, Selection(end=1.0), progress=lambda done, of: told.append((done, of))
    )
    write_film_of_bodies(excerpt, path, camera=camera, size=(320, 180))
    assert told == [(k, 16) for k in range(1, 17)]
    with Image.open(path) as film:
        assert (film.size, film.n_frames) == ((320, 180), 16)
        shown = []
        for number in (0, 15):
            film.seek(number)
            # Below the caption: how much there is to see.
            shown.append(np.asarray(film.convert("L").crop((0, 40, 320, 180)), dtype=float).std())
    assert shown[0] > 15
    assert shown[1] < 3
