"""Models that start where measured people were."""

import copy
import re

import numpy as np
import pytest

from mesa_mobility import Trajectories
from mesa_mobility.crowd.options.capability import ALIKE
from mesa_mobility.errors import ModelError
from mesa_mobility.results.reading.rows import JUMP, Fault, Reading
from tests.fixtures.maps import make_map, shipped_map, stand, straight, strider, through
from tests.fixtures.scenes import advance, corridor, model_of, same_rows

RATE = 10.0
WALK, AMBLE = 1, 2


def two_paces():
    """Standing, from which people speed up; walking at 1.25 m/s; ambling at 0.5 m/s."""
    off = through((0.5 * (k / 4) ** 2, 0.0, 0.0) for k in range(1, 5))
    on = (straight(0.5, 12), straight(1.0, 24), straight(1.875, 45))
    slow = (straight(0.2, 12, to=AMBLE), straight(0.4, 24, to=AMBLE), straight(0.75, 45, to=AMBLE))
    return make_map([(stand(), stand(24), stand(45), off), (*on, stand()), (*slow, stand())])


def tracks_of(walks, *, derived: bool = True, faults=()) -> Trajectories:
    """``{person: (first frame, x, y, vx, vy, frames)}`` at 10 frames a second."""
    rows = [
        (first + k, person, x + vx * k / RATE, y + vy * k / RATE, np.arctan2(vy, vx))
        for person, (first, x, y, vx, vy, frames) in walks.items()
        for k in range(frames)
    ]
    frame, person, x, y, heading = (np.array(column) for column in zip(*rows, strict=True))
    reading = Reading(
        "run.txt", "m", "file", RATE, "file", "way" if derived else "file", tuple(faults)
    )
    return Trajectories(frame, person, x, y, heading, frame_rate=RATE, reading=reading)


def test_people_start_at_their_places_with_their_velocities():
    tracks = tracks_of({4: (0, 2.0, 1.0, 1.25, 0.0, 60), 9: (0, 8.0, 3.0, 0.0, -0.5, 60)})
    model = model_of(corridor(), two_paces())
    replay = model.replay(tracks, from_frame=20)
    crowd = model.crowd
    assert (replay.persons.tolist(), replay.rows.tolist()) == ([4, 9], [0, 1])
    np.testing.assert_allclose([crowd.x[:2], crowd.y[:2]], [[4.5, 8.0], [1.0, 2.0]])
    np.testing.assert_allclose([crowd.vx[:2], crowd.vy[:2]], [[1.25, 0.0], [0.0, -0.5]], atol=1e-9)
    np.testing.assert_allclose(crowd.heading[:2], [0.0, -np.pi / 2])
    assert crowd.cluster[:2].tolist() == [WALK, AMBLE]
    assert replay.moved.tolist() == [0.0, 0.0]
    assert "2 people from frame 20 on at their places; 0 of 0 arrivals" in str(replay)
    advance(model, 1)
    assert same_rows(model)


def test_only_earlier_frames_count():
    """Frames after the start may be anything, as long as people leave by the same exit."""
    before = {1: (0, 2.0, 1.0, 1.0, 0.3, 21), 2: (0, 3.0, 3.0, 0.4, 0.0, 21)}
    records = []
    for later in ((1.0, 0.3), (-0.7, 0.0)):
        tracks = tracks_of(before).to_pandas()
        tail = tracks_of({p: (21, 3.0, 2.0 + p / 2, *later, 20) for p in before}).to_pandas()
        frame, person, x, y, heading = (
            np.concatenate([tracks[name], tail[name]])
            for name in ("frame", "person", "x", "y", "heading")
        )
        model = model_of(corridor(), two_paces())
        model.replay(Trajectories(frame, person, x, y, heading, frame_rate=RATE), from_frame=20)
        records.append(model.crowd.records[:2].tobytes())
    assert records[0] == records[1]


def test_arrivals_come_moving_at_their_time_and_place():
    tracks = tracks_of({1: (0, 2.0, 1.0, 1.25, 0.0, 99), 5: (27, 1.0, 3.0, 1.25, 0.0, 60)})
    model = model_of(corridor(), two_paces())
    replay = model.replay(tracks, from_frame=20)
    assert model.sources.expecting
    assert replay.row_of() == {1: 0}
    advance(model, 40)
    # 7 frames of 0.1 s are 21 frames of the model.
    run = Trajectories.of(model)
    rows = run.rows_of(1)
    assert run.frame[rows[0]] == 21
    assert (run.x[rows[0]], run.y[rows[0]]) == (1.0, 3.0)
    # At once at 1.25 m/s: 0.1 s later 0.125 m on.
    np.testing.assert_allclose(run.x[rows[3]], 1.125)
    [arrival] = replay.arrivals
    assert (arrival["row"], arrival["entered"], arrival["moved"]) == (1, 21, 0.0)
    assert replay.row_of() == {1: 0, 5: 1}
    assert not model.sources.expecting


def test_an_arrival_where_somebody_stands_comes_in_beside_them():
    model = model_of(corridor(), strider())
    model.add_pedestrians([(2.0, 2.0)], headings=[0.0], pre_movement=60.0)
    tracks = tracks_of({1: (0, 9.0, 1.0, 1.0, 0.0, 50), 2: (1, 2.1, 2.0, 1.0, 0.0, 50)})
    replay = model.replay(tracks)
    advance(model, 5)
    [arrival] = replay.arrivals
    row = arrival["row"]
    assert arrival["entered"] == 3
    # The nearest of the places tried, a ring each 0.05 m, is 0.2 m ahead.
    assert arrival["moved"] == pytest.approx(0.2)
    assert np.hypot(model.crowd.x[row] - 2.0, model.crowd.y[row] - 2.0) >= 0.3
    assert "1 of 1 arrivals have come, 1 of 1 moved for room, by 0.200 m" in str(replay)


def test_an_arrival_without_room_waits():
    model = model_of(corridor(length=8.0, width=0.5), strider())
    model.add_pedestrians([(1.85, 0.25), (2.35, 0.25)], headings=[0.0, 0.0], pre_movement=2.0)
    tracks = tracks_of({1: (0, 6.0, 0.25, 1.0, 0.0, 15), 2: (1, 2.1, 0.25, 1.0, 0.0, 50)})
    replay = model.replay(tracks)
    advance(model, 60)
    assert replay.arrivals["row"].tolist() == [-1]
    advance(model, 90)
    [arrival] = replay.arrivals
    assert arrival["entered"] > 60
    assert same_rows(model)


def test_bodies_that_heads_leave_no_room_for_are_moved_and_it_is_said():
    tracks = tracks_of({1: (0, 2.0, 2.0, 1.0, 0.0, 30), 2: (0, 2.0, 2.274, 1.0, 0.0, 30)})
    model = model_of(corridor(), two_paces())
    said = r"run.txt: 2 people, 2 of 2 moved for room, by 0.013 m at most and 0.0130 m on average"
    with pytest.warns(UserWarning, match=said):
        replay = model.replay(tracks, from_frame=10)
    # 0.3 m less 0.274 m, half of it each.
    np.testing.assert_allclose(replay.moved, 0.013, atol=1e-4)
    np.testing.assert_allclose(model.crowd.x[:2], 3.0, atol=1e-9)


def test_people_leave_by_the_exit_at_the_end_of_their_track():
    tracks = tracks_of({1: (0, 4.0, 1.0, 1.2, 0.0, 90), 2: (0, 16.0, 3.0, -1.2, 0.0, 90)})
    model = model_of(corridor(both_ends=True), two_paces())
    replay = model.replay(tracks)
    ways = {person: model.population.exits(row) for person, row in replay.row_of().items()}
    assert ways == {1: ("east",), 2: ("west",)}
    other = model_of(corridor(both_ends=True), two_paces())
    row = other.replay(tracks, exits={2: ["east", "west"]}).row_of()
    assert set(other.population.exits(row[2])) == {"east", "west"}
    assert other.population.exits(row[1]) == ("east",)


@pytest.mark.parametrize(("derived", "heading"), [(True, 0.0), (False, np.pi / 2)])
def test_who_has_not_walked_faces_their_target_unless_the_file_has_headings(derived, heading):
    tracks = tracks_of({1: (0, 4.0, 2.0, 0.0, 1e-9, 90), 2: (0, 9.0, 2.0, 1.0, 0.0, 90)})
    tracks = Trajectories(
        tracks.frame,
        tracks.person,
        tracks.x,
        tracks.y,
        np.where(tracks.person == 1, np.pi / 2, 0.0),
        frame_rate=RATE,
        reading=tracks_of({1: (0, 1, 1, 0, 0, 2)}, derived=derived).reading,
    )
    model = model_of(corridor(), two_paces())
    row = model.replay(tracks, from_frame=30).row_of()[1]
    assert model.crowd.heading[row] == pytest.approx(heading)
    assert (model.crowd.vx[row], model.crowd.cluster[row]) == (0.0, 0)


def test_preferred_speeds_are_given_by_person():
    tracks = tracks_of({1: (0, 4.0, 2.0, 1.0, 0.0, 90), 3: (0, 9.0, 2.0, 1.0, 0.0, 90)})
    model = model_of(corridor(), two_paces())
    model.replay(tracks, preferred_speeds=[0.0, 1.1, 0.0, 1.7])
    np.testing.assert_allclose(model.crowd.agenda["speed"][:2], [1.1, 1.7])
    with pytest.raises(ModelError, match="preferred_speeds: got 2, expected one for each number"):
        model_of(corridor(), two_paces()).replay(tracks, preferred_speeds=[1.0, 1.1])


WALKERS = {1: (0, 2.0, 1.0, 1.0, 0.0, 50), 2: (0, 2.0, 3.0, 1.0, 0.0, 50)}


@pytest.mark.parametrize(
    ("walks", "faults", "start", "said"),
    [
        (WALKERS, (), 50, "run.txt: from frame 50 on there is nobody"),
        (
            {p: (first, 100 * x, 100 * y, *v) for p, (first, x, y, *v) in WALKERS.items()},
            (),
            10,
            "run.txt: person 1, frame 10: at (201.00, 100.00) m, never on the floor (and 1 more",
        ),
        (
            WALKERS,
            [Fault(JUMP, "", 2, 15)],
            20,
            "run.txt: person 2 jumps after frame 15, so their velocity in frame 20 is not known",
        ),
        (
            WALKERS | {3: (0, 0.0, 2.0, 13.0, 0.0, 9)},
            (),
            5,
            "run.txt: person 3, frame 5: 13.0 m/s, expected at most 12.34 m/s",
        ),
        (
            {k: (0, 2.0 + k / 100, 2.0, 1.0, 0.0, 30) for k in range(40)},
            (),
            10,
            "frame 10: no room for a body of 0.15 m radius within 0.5 m",
        ),
    ],
)
def test_tracks_that_cannot_be_replayed_are_refused_in_one_line(walks, faults, start, said):
    model = model_of(corridor(), two_paces())
    with pytest.raises(ModelError, match=re.escape(said)) as caught:
        model.replay(tracks_of(walks, faults=faults), from_frame=start)
    assert "\n" not in str(caught.value)
    assert model.inside == 0


def test_jumps_before_and_after_the_window_do_not_matter():
    tracks = tracks_of(WALKERS, faults=[Fault(JUMP, "", 1, 11), Fault(JUMP, "", 1, 20)])
    assert len(model_of(corridor(), two_paces()).replay(tracks, from_frame=20).rows) == 2


def test_people_off_the_floor_are_named_or_come_later():
    walks = WALKERS | {3: (0, -3.0, 2.0, 1.0, 0.0, 60), 4: (0, 2.0, -9.0, 1.0, 0.0, 60)}
    model = model_of(corridor(), two_paces())
    with pytest.warns(UserWarning, match=r"run.txt: person 4, frame 10: .* never on the floor$"):
        replay = model.replay(tracks_of(walks), from_frame=10)
    assert replay.persons.tolist() == [1, 2]
    [arrival] = replay.arrivals
    # At x = -0.5 m, so near to the floor that heads may lean there, 2.5 s after x = -3 m.
    assert (arrival["person"], arrival["frame"]) == (3, 45)
    assert arrival["x"] == pytest.approx(-0.5)


def test_people_who_leave_the_floor_and_come_back_are_named():
    over = tracks_of({1: (0, 2.0, 3.5, 1.0, 0.5, 40), 2: (0, 2.0, 1.0, 1.0, 0.0, 90)}).to_pandas()
    back = over[over["person"] == 1].iloc[::-1].assign(frame=np.arange(40, 80))
    rows = {name: np.concatenate([over[name], back[name]]) for name in over.columns}
    tracks = Trajectories(**rows, frame_rate=RATE)
    # Up to 1.45 m above the wall at y = 4 m, in both ways.
    with pytest.warns(UserWarning, match=r"person 1, frame \d+: 1.45 m off the floor, as are 37"):
        model_of(corridor(), two_paces()).replay(tracks)


def test_a_checkpoint_before_arrivals_goes_on_to_the_same_rows(tmp_path):
    tracks = tracks_of(WALKERS | {7: (30, 1.0, 2.0, 1.25, 0.0, 30), 8: (40, 1.0, 3.0, 0.5, 0.0, 9)})
    model = model_of(corridor(), two_paces())
    replay = model.replay(tracks, from_frame=20)
    model.save(tmp_path / "start")
    copied = copy.deepcopy(model)
    loaded = type(model).load(tmp_path / "start", pedestrian_types=model.pedestrian_types)
    for each in (model, copied, loaded):
        advance(each, 90)
    assert replay.arrivals["row"].tolist() == [2, 3]
    for other in (copied, loaded):
        for name, values in model.recorder.arrays().items():
            assert values.tobytes() == other.recorder.arrays()[name].tobytes()


def test_poses_of_the_shipped_map_fit_the_velocities():
    model = model_of(corridor(), shipped_map())
    [capability] = model.capabilities
    mean, spread = capability.first_velocities
    wanted = np.column_stack([np.linspace(0.0, 1.8, 50), np.zeros(50)])
    found = capability.clusters_at(wanted, np.random.default_rng(1))
    off = np.hypot(np.linalg.norm(mean[found] - wanted, axis=1), spread[found])
    everywhere = np.hypot(np.linalg.norm(mean[None] - wanted[:, None], axis=2), spread)
    assert (off <= everywhere.min(axis=1) + ALIKE + 1e-12).all()
    assert found[0] == capability.standing
    # Several poses fit a walker's speed, so the phase of the gait is drawn.
    assert (
        len(
            np.unique(
                capability.clusters_at(np.tile([1.3, 0.0], (200, 1)), np.random.default_rng(2))
            )
        )
        > 1
    )
