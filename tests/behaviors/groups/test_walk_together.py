"""Groups stay together, at the pace of the slowest."""

import numpy as np
import pytest
from mesa_mobility.behaviors import WalkTogether
from shapely import box

from mesa_mobility import Exit, FloorPlan, SpeedRule
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, wall_crossings
from tests.fixtures.scenes import core_of, corridor, model_of, put


def left(model, people):
    """Seconds at which people left."""
    rows = model.recorder.arrays()
    return [rows["frame"][rows["person"] == p.row].max() / 30 for p in people]


def wishes(model, people):
    return [float(model.crowd.preferred[p.row]) for p in people]


def test_everybody_at_the_pace_of_the_slowest():
    model = model_of(corridor(), strider())
    people = [
        put(model, 2.0, 0.5 + k, preferred_speeds=[v], group="family")
        for k, v in enumerate((1.4, 0.8, 1.2))
    ]
    alone = put(model, 4.0, 2.0, preferred_speeds=[1.5])
    other = put(model, 4.0, 3.0, preferred_speeds=[1.1], group="other")
    model.step()
    assert wishes(model, [*people, alone, other]) == [0.8, 0.8, 0.8, 1.5, 1.1]
    assert [p.preferred_speed for p in people] == [1.4, 0.8, 1.2]
    assert [p.group for p in (*people, alone, other)] == ["family"] * 3 + [None, "other"]


@pytest.mark.parametrize(
    # Ways to go of 18, 12 and 6 m: 12 in the middle, so 6 m behind and ahead; h is 1 m.
    ("x", "expected"),
    [
        ((2.0, 8.0, 14.0), [1.4, 0.8, 0.16]),
        # 0.5 m behind and ahead: all at the slowest one's pace.
        ((2.0, 2.5, 3.0), [0.8, 0.8, 0.8]),
        # 16.5 m in the middle: 1.5 m ahead is half way from h to 2 h.
        ((2.0, 3.5, 5.0), [1.4, 0.8, 0.4]),
    ],
)
def test_those_ahead_slow_down_and_those_behind_hurry(x, expected):
    model = model_of(corridor(), strider())
    people = [
        put(model, at, 1.0 + k, preferred_speeds=[v], group=1)
        for k, (at, v) in enumerate(zip(x, (1.4, 0.8, 1.2), strict=True))
    ]
    model.step()
    assert wishes(model, people) == pytest.approx(expected)


def test_members_who_go_elsewhere_are_not_waited_for():
    model = model_of(corridor(both_ends=True), strider())
    east = put(model, 5.0, 1.0, preferred_speeds=[1.4], exits=["east"], group=1)
    west = put(model, 15.0, 3.0, preferred_speeds=[1.0], exits=["west"], group=1)
    model.step()
    assert wishes(model, [east, west]) == [1.0, 1.0]


def test_four_fast_ones_and_a_slow_one_arrive_together():
    # NIST TN 1822 Verif.2.9: behind ten slow people; apart they would arrive 24 s apart.
    plan = FloorPlan(box(0, 0, 24, 4), exits=[Exit("out", (24, 0), (24, 4))])
    for group, apart in (("group 1", 0.0), (None, 1.0)):
        model = model_of(plan, shipped_map(), rng=2, frames_per_step=3)
        slow = [(4.0 + 0.8 * (k // 5), 0.4 + 0.8 * (k % 5)) for k in range(10)]
        model.add_pedestrians(slow, preferred_speeds=0.5, group="group 2" if group else None)
        first = model.add_pedestrians(
            [(1.0 + 0.7 * (k // 2), 1.4 + 0.9 * (k % 2)) for k in range(4)],
            preferred_speeds=1.25,
            group=group,
        )
        first += model.add_pedestrians([(0.5, 1.8)], preferred_speeds=0.5, group=group)
        model.run(max_seconds=150)
        assert model.inside == 0
        spread = np.ptp(left(model, first))
        assert (spread > 10.0) == bool(apart)
        rows = model.recorder.arrays()
        assert overlaps(rows, core_of(model)) == 0
        assert wall_crossings(rows, plan.walls) == 0


def test_groups_pass_a_narrow_door_that_their_first_members_reach_long_before():
    floor = box(0, 0, 8, 6).union(box(8, 2.6, 8.2, 3.4)).union(box(8.2, 0, 14, 6))
    plan = FloorPlan(floor, exits=[Exit("out", (14, 0), (14, 6))])
    model = model_of(plan, shipped_map(), rng=5, frames_per_step=3)
    for number in range(6):
        model.add_pedestrians(
            [(7.0 - 6.0 * k / 4, 0.5 + 0.9 * number + 0.1 * k) for k in range(5)],
            preferred_speeds=[1.4, 1.3, 1.2, 1.1, 0.6],
            group=number,
        )
    model.run(max_seconds=300)
    assert model.inside == 0


def test_groups_that_cannot_be():
    model = model_of(corridor(), strider())
    with pytest.raises(ModelError, match="group"):
        put(model, 2.0, 2.0, group=["a", "b"])
    assert model.speed_rules == []


def test_a_pace_must_give_speeds():
    class Backwards(SpeedRule):
        name = "backwards"

        def speeds(self, deciding, speeds):
            return -speeds

    model = model_of(corridor(), strider())
    model.speed_rules.append(Backwards())
    with pytest.raises(ModelError, match="'backwards'"):
        put(model, 2.0, 2.0)


def test_the_paces_of_a_model_are_asked_in_turn():
    class Half(SpeedRule):
        name = "half"

        def speeds(self, deciding, speeds):
            return 0.5 * speeds

    model = model_of(corridor(), strider())
    model.speed_rules += [Half(), Half(), WalkTogether()]
    person = put(model, 2.0, 2.0, preferred_speeds=[1.2])
    assert wishes(model, [person]) == pytest.approx([0.3])
