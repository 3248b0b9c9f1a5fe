"""Formats of other packages: how they are found, and what is said of broken ones."""

import pytest

from mesa_mobility import FloorPlan
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan.formats.plan_format import PLANS, PlanFormat
from mesa_mobility.plugins.formats import READ, WRITE
from mesa_mobility.results.formats.output_format import OUTPUTS
from tests.commands.conftest import command, install, no_lines_of_progress

__all__ = ["command", "install", "no_lines_of_progress"]

MODULE = """
from shapely import box
from mesa_mobility import Exit
from mesa_mobility.floorplan import Content, PlanFormat

class Squares(PlanFormat):
    "Squares of one number."
    name = "squares"
    suffixes = (".sq", ".hall.sq")

    def read(self, path, *, doors: int = 1):
        side = float(path.read_text())
        exits = [Exit(f"door {k}", (0, k), (0, k + 0.8)) for k in range(doors)]
        return Content(box(0, 0, side, side), exits=exits)

class Drawings(Squares):
    name = "drawings"
    suffixes = (".wkt",)

class Misnamed(Squares):
    name = "other"

class Endless(Squares):
    name = "endless"
    suffixes = ("SQ",)

class Fails(Squares):
    name = "fails"
    def __init__(self):
        raise RuntimeError("not\\ntoday")

class NoFormat:
    pass
"""


@pytest.fixture
def squares(install, tmp_path):
    """Installs a package with some of the formats above."""

    def make(*entries: str) -> None:
        install("squares", "\n".join(["[mesa_mobility.plan_formats]", *entries]) + "\n")
        (tmp_path / "site" / "squares" / "square_formats.py").write_text(MODULE)

    return make


def test_what_ships_is_registered_like_any_plug_in():
    shipped = ["dxf", "geojson", "ifc", "imdf", "jupedsim_scenario", "osm", "vadere", "wkt"]
    assert list(PLANS.usable()) == shipped
    assert set(OUTPUTS.usable()) == {
        "bvh",
        "film",
        "glb",
        "html",
        "juelich",
        "jupedsim",
        "parquet",
        "picture",
        "usd",
    }
    assert PLANS.suffixes(WRITE) == [".geojson", ".json"]
    usual = [".dxf", ".geojson", ".ifc", ".zip", ".osm", ".scenario", ".wkt"]
    assert PLANS.usual(READ) == usual
    assert PLANS.broken() == OUTPUTS.broken() == []


def test_a_format_is_found_by_suffix_and_takes_its_options(squares, tmp_path):
    squares("squares = square_formats:Squares")
    path = tmp_path / "Room.SQ"
    path.write_text("4")
    assert FloorPlan.from_file(path).area == 16.0
    assert len(FloorPlan.from_file(path, doors=2).exits) == 2
    with pytest.raises(FloorPlanError, match="format squares: unknown option 'dors', did you mean"):
        FloorPlan.from_file(path, dors=2)
    with pytest.raises(FloorPlanError, match=r"expected a name that ends in \.geojson, \.json$"):
        FloorPlan.from_file(path).to_file(tmp_path / "out.sq")


def test_a_format_of_ones_own_may_need_neither_reader_nor_writer():
    class Neither(PlanFormat):
        name, suffixes = "neither", (".no",)

    for what in (READ, WRITE):
        with pytest.raises(NotImplementedError):
            getattr(Neither(), what)(None, *([None] if what == WRITE else []))


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("absent = no_such_module:Format", "cannot be loaded: ModuleNotFoundError"),
        ("squares = square_formats:Misnamed", "calls itself 'other', expected the name of its"),
        ("endless = square_formats:Endless", r"has suffixes \('SQ',\), expected a tuple such as"),
        ("fails = square_formats:Fails", "cannot be made: RuntimeError: not today"),
        ("none = square_formats:NoFormat", "is no PlanFormat"),
    ],
)
def test_a_broken_format_is_named_and_breaks_no_other(squares, command, tmp_path, entry, message):
    squares(entry)
    name, _, target = entry.partition(" = ")
    whole = rf"plan format {name} \({target}, from squares 1\.2\) {message}"
    with pytest.raises(ModelError, match=whole):
        PLANS.named(name)
    (tmp_path / "room.wkt").write_text(
        "walkable POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))\nexit a LINESTRING (0 0, 0 1)\n"
    )
    picture = tmp_path / "room.png"
    assert command("plan", tmp_path / "room.wkt", "--picture", picture).status == 0
    # Where its suffix is asked for, the reason stands behind those that are known.
    with pytest.raises(FloorPlanError, match=rf"ends in \.dxf, .*\.wkt; broken: {whole}"):
        FloorPlan.from_file(tmp_path / "room.sq")
    listed = command("formats")
    assert listed.status == 0
    assert listed.err.startswith(f"broken: plan format {name} (")
    assert listed.err.count("\n") == 1
    assert "geojson" in listed.out


def test_two_formats_for_one_suffix_spoil_only_that_suffix(squares, command, tmp_path):
    squares("squares = square_formats:Squares", "drawings = square_formats:Drawings")
    said = r"suffix \.wkt is offered both by drawings \(squares 1\.2\) and by wkt \(mesa-mobility"
    with pytest.raises(FloorPlanError, match=rf"room\.wkt: {said} .*: remove one of them"):
        FloorPlan.from_file(tmp_path / "room.wkt")
    (tmp_path / "room.hall.sq").write_text("3")
    assert FloorPlan.from_file(tmp_path / "room.hall.sq").area == 9.0
    assert "broken: suffix .wkt is offered both by" in command("formats").err


def test_options_of_a_format_are_listed(squares, command):
    squares("squares = square_formats:Squares")
    outcome = command("formats", "squares")
    lines = outcome.out.splitlines()
    assert lines[0] == "Squares of one number."
    assert lines[2].split() == ["doors", "1", "int"]
    wrong = command("formats", "square")
    assert wrong.status == 2
    assert "unknown format 'square', did you mean 'squares'?; installed: dxf, geo" in wrong.err
