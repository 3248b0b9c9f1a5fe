"""Jams and wide necks, on figures made up by hand."""

import pytest

from mesa_mobility.validation.scenes import jams, wide_necks
from mesa_mobility.validation.scenes.corridors import corridor_plan


def unmet(verdict) -> list[str]:
    return [check.figure for check in verdict.checks if check.gates and not check.met]


def jammed(**changes) -> list[dict]:
    """Exits of 0.7 to 1.2 m with the mean flow of all studies, at 2.125 persons/m2."""
    flows = {"0.7": 1.236, "0.8": 1.457, "0.9": 1.713, "1": 2.175, "1.2": 2.349}
    runs = {width: {"density": 2.125, "speed": 0.66, "flow": flow} for width, flow in flows.items()}
    for width, change in changes.items():
        runs[width].update(change)
    return list(runs.values())


def test_jams_as_measured_pass():
    assert unmet(jams.judge([jammed()])) == []


@pytest.mark.parametrize(
    ("width", "change", "wrong"),
    [
        # Free walkers before an exit: no jam, whatever else.
        ("1.2", {"density": 1.1, "speed": 1}, ["condition of an exit of 1.2 m: density of a jam"]),
        # 1.222 to 1.251 were measured at 0.7 m.
        ("0.7", {"flow": 1.26}, ["exit of 0.7 m: flow"]),
        ("0.7", {"flow": 1.21}, ["exit of 0.7 m: flow"]),
        ("0.9", {"flow": None}, ["exit of 0.9 m: flow"]),
        ("1", {"speed": 1.3}, ["exit of 1 m: speed"]),
        ("1", {"speed": 0.05}, ["exit of 1 m: speed"]),
        (
            "1",
            {"density": None},
            ["condition of an exit of 1 m: density of a jam", "exit of 1 m: speed"],
        ),
    ],
)
def test_each_exit_is_judged_on_its_own(width, change, wrong):
    found = unmet(jams.judge([jammed(**{width: change})]))
    assert [each.rpartition(" ")[0] for each in found] == wrong


def necks(**changes) -> list[dict]:
    """Necks as measured: 6.07 1/s at 2.4 m to 13.82 1/s at 5.0 m."""
    measured = {
        "2.4": (6.07, 5.57),
        "3": (7.17, 5.07),
        "3.6": (8.96, 4.83),
        "4.4": (10.87, 4.02),
        "5": (13.82, 4.09),
    }
    runs = {
        width: {"flow": flow, "density": density, "start_density": 2.99}
        for width, (flow, density) in measured.items()
    }
    for width, change in changes.items():
        runs[width].update(change)
    return list(runs.values())


def test_wide_necks_as_measured_pass():
    assert unmet(wide_necks.judge([necks()])) == []


@pytest.mark.parametrize(
    ("width", "change", "wrong"),
    [
        # 12 % of 13.82 are 1.66; 0.7 times 4.09 are 2.86 and 1.4 times 5.73.
        ("5", {"flow": 12.1}, "neck of 5 m: flow 1/s"),
        ("5", {"flow": 15.6}, "neck of 5 m: flow 1/s"),
        ("5", {"density": 2.8}, "neck of 5 m: density in front 1/m2"),
        ("5", {"density": 5.8}, "neck of 5 m: density in front 1/m2"),
        ("3", {"density": None}, "neck of 3 m: density in front 1/m2"),
        ("2.4", {"start_density": 2.0}, "condition of a neck of 2.4 m: density at the start 1/m2"),
    ],
)
def test_each_neck_is_judged_on_its_own(width, change, wrong):
    assert unmet(wide_necks.judge([necks(**{width: change})])) == [wrong]


@pytest.mark.parametrize(("scene", "runs"), [(jams, jammed), (wide_necks, necks)])
def test_pictures_show_measured_and_simulated_flows(scene, runs):
    verdict = scene.judge([runs()])
    axes = scene.draw(verdict.figures).axes[0]
    assert {"experiments", "mesa-mobility"} <= set(axes.get_legend_handles_labels()[1])
    ours = next(each for each in axes.lines if each.get_label() == "mesa-mobility")
    assert ours.get_ydata().tolist() == [each["flow"] for each in runs()]


def test_there_is_floor_behind_a_narrow_exit_and_none_behind_an_open_end():
    plan = corridor_plan(1.2)
    # 24 m x 1.8 m, 0.1 m x 1.2 m and 2.5 m x 3.8 m.
    assert plan.area == pytest.approx(43.2 + 0.12 + 9.5)
    assert plan.exits[0].length == pytest.approx(3.8)
    assert corridor_plan(1.8).area == pytest.approx(43.2)
    assert corridor_plan(1.8).exits[0].length == pytest.approx(1.8)
