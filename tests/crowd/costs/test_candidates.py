import math

import numpy as np
import pytest

from mesa_mobility.errors import ModelError
from tests.fixtures.maps import make_map, stand, straight, strider
from tests.fixtures.options import Chooser, Ending, candidates
from tests.fixtures.scenes import advance, corridor, model_of, put, statues


@pytest.fixture
def turner():
    """Stand, or go a metre to the left in 24 frames and turn by half a radian meanwhile."""
    return make_map([[stand(), straight(1.0, 24, towards=math.pi / 2, turn=0.5, to=0)]])


def test_options_are_laid_down_where_the_person_stands(turner, whole):
    person = put(model_of(corridor(), turner, preset=whole), 3.0, 2.0, math.pi)
    options = person.movement_options()
    assert len(options) == 2
    # To the left of somebody who faces -x is -y.
    np.testing.assert_allclose(options.points, [(3.0, 2.0), (3.0, 1.0)], atol=1e-6)
    assert options.headings == pytest.approx([math.pi, math.pi + 0.5])
    assert options.displacements == pytest.approx([0.0, 1.0])
    assert options.durations == pytest.approx([0.4, 0.8])
    assert options.speeds == pytest.approx([0.0, 1.25])
    assert options.owner.tolist() == [0, 0]
    assert options.offsets.tolist() == [0, 2]
    assert options.pedestrians.tolist() == [person.row]
    assert options.positions.tolist() == [[3.0, 2.0]]
    assert options.facings.tolist() == [math.pi]
    assert options.targets.tolist() == [person.target.tolist()]
    assert options.types.tolist() == [0]


def test_options_are_those_of_the_cluster_the_person_is_in(whole):
    model = model_of(corridor(), strider(), preset=whole)
    person = put(model, 1.0, 2.0, preferred_speeds=[1.25])
    assert person.movement_options().displacements.tolist() == [0.0, 0.5, 1.0, 1.875]
    advance(model, 45)
    assert person.movement_options().displacements.tolist() == [0.5, 0.0, 1.0, 1.875]


def test_the_shortest_options_come_in_parts_too(in_parts):
    person = put(model_of(corridor(), strider(), preset=in_parts), 1.0, 2.0)
    options = person.movement_options()
    # Of stand and half a metre in 12 frames: a half, a quarter, and nothing of either.
    order = np.argsort(options.displacements, kind="stable")
    expected = [0.0] * 4 + [0.125, 0.25, 0.5, 1.0, 1.875]
    assert options.displacements[order] == pytest.approx(expected)
    assert options.durations[order] == pytest.approx([0.4] * 7 + [0.8, 1.5])
    assert options.speeds[order] == pytest.approx([0.0] * 4 + [0.3125, 0.625] + [1.25] * 3)
    assert options.points[order, 0] == pytest.approx([1.0 + step for step in expected])


def test_nobody_who_is_not_inside_has_options(whole):
    model = model_of(corridor(), strider(), preset=whole)
    gone, stays = put(model, 1.0, 2.0), put(model, 3.0, 2.0)
    row = gone.row
    gone.remove()
    with pytest.raises(
        ModelError, match=r"^candidates: got the rows \[0 1\], expected people inside"
    ):
        model.candidates(np.array([row, stays.row]))


def test_options_name_rows_of_the_persons_own_capability(whole):
    first, second = strider(), make_map([[stand(), straight(0.75, 12, to=0)]])
    model = model_of(corridor(), [first, second], preset=whole)
    for kind, reach in ((0, [0.0, 0.5, 1.0, 1.875]), (1, [0.0, 0.75])):
        person = put(model, 1.0, 1.0 + kind, type_index=kind)
        options = person.movement_options()
        assert options.types.tolist() == [kind]
        assert options.displacements.tolist() == reach
        assert options.options.tolist() == list(person.capability.options(person.cluster))
        table = person.capability.table
        ends = np.hypot(table.options.x[options.options], table.options.y[options.options])
        assert ends.tolist() == reach


def test_a_batch_of_several_people(whole):
    model = model_of(corridor(), [strider(), statues()], preset=whole)
    walker, statue = put(model, 2.0, 1.0), put(model, 3.0, 2.5, type_index=1)
    batch = model.candidates(np.array([statue.row, walker.row]))
    assert batch.owner.tolist() == [0, 1, 1, 1, 1]
    assert batch.offsets.tolist() == [0, 1, 5]
    assert batch.types.tolist() == [1, 0]
    np.testing.assert_allclose(batch.points[:, 0], [3.0, 2.0, 2.5, 3.0, 3.875])
    assert batch.neighbours.tolist() == [walker.row, statue.row]
    assert batch.neighbour_offsets.tolist() == [0, 1, 2]


def test_neighbours_come_with_the_mean_velocity_of_their_movement():
    model = model_of(corridor(), [strider(), statues()])
    statue = put(model, 3.5, 2.0, type_index=1)
    walker = put(model, 2.0, 1.0, preferred_speeds=[1.25])
    advance(model, 10)
    options = statue.movement_options()
    assert options.neighbours.tolist() == [walker.row]
    np.testing.assert_allclose(options.neighbour_positions, [walker.position])
    np.testing.assert_allclose(options.neighbour_velocities, [(1.25, 0.0)], atol=1e-6)
    np.testing.assert_allclose(walker.velocity, (1.25, 0.0), atol=1e-6)


def test_neighbours_come_with_where_they_go_and_how_much_less_way_they_have():
    # 16, 14 and 2.5 m from the exits in the east and, the last one, in the west.
    model = model_of(corridor(both_ends=True), strider())
    me = put(model, 4.0, 2.0, exits=["east"])
    put(model, 6.0, 2.0, exits=["east"])
    put(model, 2.5, 2.0, exits=["west"])
    options = me.movement_options()
    order = np.argsort(options.neighbours)
    expected = np.array([(1.0, 0.0), (-1.0, 0.0)])
    assert options.neighbour_directions[order] == pytest.approx(expected)
    assert options.leads[order] == pytest.approx([2.0, 13.5])


def test_everybody_comes_with_its_core_and_the_mean_velocity_of_its_movement():
    stout = make_map([[stand()]], core_radius=0.25)
    model = model_of(corridor(), [strider(), stout])
    walker, stands = (
        put(model, 1.0, 2.0, preferred_speeds=[1.25]),
        put(model, 9.0, 2.0, type_index=1),
    )
    batch = model.candidates(np.array([walker.row, stands.row]))
    assert batch.cores.tolist() == [0.15, 0.25]
    assert batch.velocities.tolist() == [[0.0, 0.0], [0.0, 0.0]]
    advance(model, 12)
    assert walker.movement_options().velocities == pytest.approx(np.array([(1.25, 0.0)]), abs=1e-6)
    assert stands.movement_options().velocities.tolist() == [[0.0, 0.0]]


def walls_of(batch, k: int) -> set[frozenset]:
    """Walls near one pedestrian of a batch, each as its two ends."""
    own = batch.walls[batch.wall_offsets[k] : batch.wall_offsets[k + 1]]
    walls = [frozenset([(x1, y1), (x2, y2)]) for x1, y1, x2, y2 in own.tolist()]
    assert len(walls) == len(set(walls))
    return set(walls)


BELOW, ABOVE = frozenset([(0.0, 0.0), (20.0, 0.0)]), frozenset([(0.0, 4.0), (20.0, 4.0)])
WEST, EAST = frozenset([(0.0, 0.0), (0.0, 4.0)]), frozenset([(20.0, 0.0), (20.0, 4.0)])


def test_walls_within_reach_come_with_each_person():
    # Longest option 1.875 m, core 0.15 m: within 2.035 m. People who only stand reach 0.16 m.
    model = model_of(corridor(), [strider(), statues()])
    places = [(5.0, 2.0), (7.0, 1.96), (2.03, 1.0), (19.5, 1.0)]
    rows = [put(model, *place).row for place in places]
    rows += [put(model, *place, type_index=1).row for place in ((9.0, 0.155), (9.0, 0.8))]
    batch = model.candidates(np.array(rows))
    expected = [{BELOW, ABOVE}, {BELOW}, {BELOW, WEST}, {BELOW}, {BELOW}, set()]
    assert [walls_of(batch, k) for k in range(6)] == expected
    assert batch.wall_offsets.tolist() == [0, 2, 3, 5, 6, 7, 7]
    # Whatever the order, and the part of a batch.
    assert walls_of(model.candidates(np.array(rows[2:3])), 0) == {BELOW, WEST}


def test_exits_that_do_not_lead_out_are_walls():
    model = model_of(corridor(both_ends=True), strider())
    places = ((19.0, 2.0, ["west"]), (19.0, 3.0, ["east"]), (19.0, 1.0, None), (1.0, 2.0, ["east"]))
    rows = [put(model, x, y, exits=exits).row for x, y, exits in places]
    batch = model.candidates(np.array(rows))
    expected = [{BELOW, ABOVE, EAST}, {ABOVE}, {BELOW}, {BELOW, ABOVE, WEST}]
    assert [walls_of(batch, k) for k in range(4)] == expected


def test_everybody_within_reach_is_a_neighbour_however_many():
    model = model_of(corridor(), strider(), preset="paper")  # bodies may overlap there
    rng = np.random.default_rng(3)
    model.add_pedestrians(rng.uniform((8.5, 0.5), (11.5, 3.5), (300, 2)))
    person = put(model, 10.0, 2.0)
    assert sorted(person.movement_options().neighbours.tolist()) == list(range(300))


def test_neighbours_reach_as_far_as_two_options_and_two_cores():
    # Longest option 1.875 m, core 0.15 m: 4.05 m.
    model = model_of(corridor(), strider())
    me = put(model, 10.0, 2.0)
    near, _far = put(model, 14.04, 2.0), put(model, 5.8, 2.0)
    assert me.movement_options().neighbours.tolist() == [near.row]


def test_who_cannot_come_together_within_a_movement_are_no_neighbours():
    # A walker gets 1.875 m, a statue nowhere; cores of 0.15 m: 2.185 m whoever of them decides.
    model = model_of(corridor(), [strider(), statues()])
    walker = put(model, 10.0, 2.0)
    near, far = put(model, 12.18, 2.0, type_index=1), put(model, 7.81, 2.0, type_index=1)
    assert walker.movement_options().neighbours.tolist() == [near.row]
    assert near.movement_options().neighbours.tolist() == [walker.row]
    assert far.movement_options().neighbours.tolist() == []


def test_pairs_of_options_and_neighbours():
    crowded = Chooser([Ending(), Ending()], neighbours=[((1, 0), (0, 0)), ((2, 0), (0, 0))])
    alone = Chooser([Ending()])
    one_by = Chooser([Ending()], neighbours=[((3, 0), (0, 0))])
    rows, neighbours = candidates(crowded, alone, one_by).pairs()
    assert list(zip(rows.tolist(), neighbours.tolist(), strict=True)) == [
        (0, 0),
        (0, 1),
        (1, 0),
        (1, 1),
        (3, 2),
    ]


def test_pairs_without_neighbours():
    rows, neighbours = candidates(Chooser([Ending()])).pairs()
    assert len(rows) == len(neighbours) == 0


def test_predicted_positions():
    batch = candidates(
        Chooser(
            [Ending(duration=0.4), Ending(duration=1.5)],
            neighbours=[((1.0, 2.0), (0.5, -1.0)), ((0.0, 0.0), (0.0, 2.0))],
        )
    )
    expected = [(1.2, 1.6), (0.0, 0.8), (1.75, 0.5), (0.0, 3.0)]
    np.testing.assert_allclose(batch.predicted(*batch.pairs()), expected)


def test_arrays_are_read_only():
    person = put(model_of(corridor(), strider()), 1.0, 2.0)
    options = person.movement_options()
    with pytest.raises(ValueError, match="read-only"):
        options.points[0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        options.targets[0] = 0.0
    for name in ("velocities", "cores", "walls", "wall_offsets"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(options, name)[:] = 0
