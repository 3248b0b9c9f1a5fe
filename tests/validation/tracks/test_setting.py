"""The setting of a comparison with measured tracks, and its verdict."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, Trajectories
from mesa_mobility.errors import ResultsError
from mesa_mobility.validation.tracks import setting_of
from mesa_mobility.validation.tracks.experiment import judge
from mesa_mobility.validation.tracks.pictures import draw, thinned

RATE = 10
LINE = ((10.0, 0.0), (10.0, 4.0))
PLAN = FloorPlan(box(0, 0, 20, 4), exits=[Exit("end", (20, 0), (20, 4))])


def text(people: int = 12, speed: float = 1.0, every: float = 1.0, x: float = 0.0) -> str:
    """People who cross the floor one after the other in lanes 0.5 m apart, in metres."""
    lines = [f"# framerate: {RATE} fps", "# id frame x/m y/m z/m"]
    for person in range(people):
        for k in range(round(19.5 / speed * RATE)):
            frame = round(every * person * RATE) + k
            along, across = x + 0.2 + speed * k / RATE, 0.8 + 0.5 * (person % 6)
            lines.append(f"{person} {frame} {along:.4f} {across:.4f} 1.7")
    return "\n".join(lines)


@pytest.fixture
def read(tmp_path):
    def tracks(**given) -> Trajectories:
        file = tmp_path / "run.txt"
        file.write_text(text(**given))
        return Trajectories.read(file)

    return tracks


def test_what_is_not_given_the_tracks_say(read):
    setting = setting_of(read(), PLAN, "plan.geojson")
    # In the middle of all places, which people reach after 9.75 s, the second of twelve 1 s later
    # and the tenth 9 s later, give or take the 0.05 m between cuts.
    assert setting.line[0][0] == pytest.approx(9.92, abs=0.06)
    assert setting.first == pytest.approx(107, abs=2)
    assert setting.last - setting.first == pytest.approx(80, abs=1)
    assert setting.first - setting.start == 60
    assert setting.seconds == pytest.approx(14.0, abs=0.1)
    assert setting.area.bounds == pytest.approx((2.15, 0.0, 17.7, 4.0), abs=0.06)
    view, replayed = setting.view(PLAN.free), setting.replayed_view(PLAN.free)
    assert (replayed.after, replayed.until) == pytest.approx((6.0, 14.0), abs=0.1)
    assert view.after - replayed.after == pytest.approx(setting.start / RATE)


def test_what_is_given_stays(read):
    given = {"start": 30, "first": 90, "last": 150, "line": ((8.0, 0.0), (8.0, 4.0))}
    setting = setting_of(read(), PLAN, "plan", area=box(5, -1, 9, 9), **given)
    assert {name: getattr(setting, name) for name in given} == given
    # Only the part on the floor counts, for densities.
    assert setting.area.bounds == (5.0, 0.0, 9.0, 4.0)


@pytest.mark.parametrize(
    ("tracks", "given", "message"),
    [
        ({"people": 1}, {}, "run.txt: person 0 is alone"),
        ({"people": 5}, {}, "run.txt: fewer than six people cross the line"),
        ({"x": 40.0}, {}, r"run.txt: person 0, frame 0: at \(40.20, 0.80\) m, off the floor"),
        # 12 m of 20 m are on the floor.
        ({"x": 8.0}, {}, r"person 0, frame 12\d: at .*, off the floor of plan, as 8\d\d of 2340"),
        ({}, {"line": ((30.0, 0.0), (30.0, 4.0))}, "fewer than six people cross the line"),
        ({}, {"first": 150, "last": 120}, "expected rising frames between 0 and 304"),
        ({}, {"start": 140, "first": 120}, "expected rising frames between 0 and 304"),
        ({}, {"last": 900}, "expected rising frames between 0 and 304"),
        ({}, {"first": 120, "last": 140}, "frames 120 to 140 are 2.0 s, expected 3 s or more"),
        ({}, {"area": box(50, 0, 60, 4)}, "plan: the area to measure is not on the floor"),
        ({}, {"area": box(0, 0, 5, 0.3)}, "nobody in the area from frame"),
    ],
)
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_setting_without_people_is_refused_in_one_line(read, tracks, given, message):
    with pytest.raises(ResultsError, match=message) as refused:
        setting_of(read(**tracks), PLAN, "plan", **given)
    assert "\n" not in str(refused.value)


def figures(tracks: Trajectories) -> dict:
    columns = ("frame", "person", "x", "y", "heading")
    return {
        "tracks": {name: getattr(tracks, name) for name in columns},
        "frame_rate": tracks.frame_rate,
        "moved_m": 0.03,
        "late": 1,
    }


def test_a_crowd_is_judged_by_ratios_to_the_measured_one(read):
    measured = read()
    setting = setting_of(measured, PLAN, "plan", start=0, first=100, last=250, line=LINE)
    same = judge([[figures(measured)]], setting=setting, plan=PLAN, tracks=measured)
    by_name = {check.figure: check for check in same.checks}
    assert all(check.gates for check in same.checks)
    # One person a second at 1 m/s on 15 m x 4 m.
    assert by_name["flow 1/s"].value == pytest.approx(1.0)
    assert by_name["flow 1/s"].wanted == "0.88 to 1.12"
    assert by_name["speed m/s"].value == pytest.approx(1.0)
    assert by_name["speed m/s"].wanted == "0.7 to 1.4"
    assert by_name["flow 1/s"].met
    assert by_name["speed m/s"].met
    assert by_name["density 1/m2"].met
    assert same.figures["density: distance 1/m2"] == 0.0
    assert same.figures["people who could not come in"] == 1

    slow = read(speed=0.6, every=1.3)
    found = judge([[figures(slow)]], setting=setting, plan=PLAN, tracks=measured)
    by_name = {check.figure: check for check in found.checks}
    assert by_name["speed m/s"].value == pytest.approx(0.6)
    assert not by_name["speed m/s"].met
    assert by_name["flow 1/s"].value == pytest.approx(1 / 1.3)
    assert not by_name["flow 1/s"].met
    assert found.figures["speed: distance m/s"] == pytest.approx(0.4)


def test_a_flow_of_nobody_is_no_flow(read):
    measured = read()
    setting = setting_of(measured, PLAN, "plan", start=0, first=100, last=250, line=LINE)
    early = np.asarray(measured.frame) < 120
    columns = {
        name: values[early & (measured.person < 2)]
        for name, values in figures(measured)["tracks"].items()
    }
    alone = {**figures(measured), "tracks": columns}
    verdict = judge([[alone]], setting=setting, plan=PLAN, tracks=measured)
    by_name = {check.figure: check for check in verdict.checks}
    assert by_name["flow 1/s"].value is None
    assert not verdict.passed


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_drawn_tracks_are_pieces_of_half_a_second(read):
    pieces = thinned(read(people=1).of_people([0]))
    np.testing.assert_allclose(pieces[0], [0.2, 0.8, 0.7, 0.8, 1.0])
    assert len(pieces) == 38  # 19.5 s less one frame


@pytest.mark.parametrize("floor", [box(0, 0, 20, 4), box(0, 0, 20, 40)])
def test_the_picture_shows_both_crowds_in_the_same_panels(read, floor):
    plan = FloorPlan(floor, exits=[Exit("end", (20, 0), (20, 4))])
    measured = read()
    setting = setting_of(measured, plan, "plan", start=0, first=100, last=250, line=LINE)
    verdict = judge([[figures(measured)]], setting=setting, plan=plan, tracks=measured)
    figure = draw(verdict.figures, setting=setting, plan=plan)
    by_title = {each.get_title(): each for each in figure.axes}
    both = [by_title[name].collections[-1] for name in ("measured", "simulated, seed 1")]
    lines = [[line.tolist() for line in each.get_segments()] for each in both]
    assert lines[0] == lines[1]
    assert len(lines[0]) > 100
    n_t = next(each for each in figure.axes if each.get_ylabel() == "people over the line")
    # One person a second crosses from 10.0 s on; the last of twelve after 21 s.
    counts = n_t.lines[0].get_ydata()
    assert counts[-1] == pytest.approx(11, abs=1)
    assert set(np.diff(counts)) <= {0.0, 1.0}
