"""What a page offers to set, and what it asks about."""

import re
from pathlib import Path
from typing import Annotated

import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.models import Doorway

from mesa_mobility import Files, Range
from mesa_mobility.dashboard.offered import blamed, large, recipe_of, settable
from mesa_mobility.errors import ModelError


def test_recipes_come_from_what_the_constructor_takes():
    recipe = recipe_of(Doorway, {"pedestrians": "7", "door_width": "1.5", "rng": "4"})
    assert recipe.keywords == {"pedestrians": 7, "door_width": 1.5, "rng": 4}
    assert "record" not in settable(Doorway)
    with pytest.raises(ModelError, match="preset: got 'fast', expected paper or default"):
        recipe_of(Doorway, {"preset": "fast"})


def test_maps_come_from_the_folder_and_from_nowhere_else(tmp_path, monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.offered.FOLDER", tmp_path)
    outside = tmp_path.parent / "outside.npz"
    outside.write_bytes(b"")
    assert "mobility_map" not in settable(Doorway)
    (tmp_path / "small.npz").write_bytes(b"")
    (tmp_path / "secret.txt").write_text("")
    assert settable(Doorway)["mobility_map"].kinds == (("none", "small.npz"),)
    recipe = recipe_of(Doorway, {"mobility_map": "small.npz"})
    assert recipe.keywords == {"mobility_map": str(tmp_path / "small.npz")}
    assert recipe_of(Doorway, {"mobility_map": "none"}).keywords == {"mobility_map": None}
    said = set()
    for text in ("../outside.npz", "../nowhere.npz", str(outside), "/etc/passwd", "secret.txt"):
        with pytest.raises(ModelError) as refused:
            recipe_of(Doorway, {"mobility_map": text})
        said.add(re.sub("'.*'", "FILE", str(refused.value)))
    # Nothing tells a file that is there from one that is not.
    assert said == {"mobility_map: got FILE, expected none or small.npz"}


def test_the_page_offers_no_file_that_the_author_has_not_offered(tmp_path, monkeypatch):
    monkeypatch.setattr("mesa_mobility.dashboard.offered.FOLDER", tmp_path)
    (tmp_path / "hall.geojson").write_text("")

    class Reader(Doorway):
        def __init__(
            self,
            plan: Annotated[Path | None, Files("*.geojson")] = None,
            notes: Path = Path("notes.txt"),
            rng=None,
        ):
            pass

    known = settable(Reader)
    assert known["plan"].kinds == (("none", "hall.geojson"),)
    assert "notes" not in known
    assert "plan" not in settable(Reader, {"plan": "hall.geojson"})


@pytest.mark.parametrize(
    ("message", "names"),
    [
        ("pedestrians: got 0, expected 1 or more", ["pedestrians"]),
        ("slowest and fastest: got 2 and 1 m/s, expected 0 < slowest", ["slowest", "fastest"]),
        ("the plan leaves room for 3 of 9 pedestrians", []),
        ("TypeError: pedestrians", []),
    ],
)
def test_an_error_is_about_the_parameters_that_its_beginning_names(message, names):
    assert blamed(message, ["slowest", "fastest", "pedestrians"]) == names


def test_large_numbers_are_asked_about_unless_the_author_has_named_them():
    class Hall(Doorway):
        def __init__(
            self,
            pedestrians: Annotated[int, Range(1, 50_000)] = 60,
            visitors: int = 20_000,
            size: float = 1.0,
            rng=None,
        ):
            pass

    def asked(**texts):
        return large(settable(Hall), recipe_of(Hall, texts))

    assert asked(pedestrians="50000", visitors="20000", size="10000", rng="99999999") == {}
    assert asked(pedestrians="50001", visitors="20001", size="10000.5") == {
        "pedestrians": 50001,
        "visitors": 20001,
        "size": 10000.5,
    }
    with pytest.raises(ModelError, match="visitors: got 1000001, expected at most 1000000"):
        asked(visitors="1000001")
