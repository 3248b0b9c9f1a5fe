"""Output of a run: the record, the summary, and PedPy's form."""

import json

import numpy as np
import pedpy
import pytest

from mesa_mobility import Trajectories
from mesa_mobility.errors import ModelError, ResultsError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import track
from tests.fixtures.scenes import advance, corridor, model_of, put, two_doors


@pytest.fixture(scope="module")
def evacuation():
    model = model_of(two_doors(), shipped_map(), rng=9, frames_per_step=3)
    places = model.floor_plan.random_points(20, model.rng, spacing=0.6, clearance=0.3)
    model.add_pedestrians(places)
    model.run(max_seconds=60)
    assert model.inside == 0
    return model


def test_everybody_is_recorded_in_each_frame_from_the_start_to_the_exit(evacuation):
    rows = evacuation.recorder.arrays()
    assert np.unique(rows["person"]).tolist() == list(range(20))
    for person in range(20):
        frames = track(rows, person)[:, 0]
        assert frames.tolist() == list(range(len(frames)))
    starts = rows["frame"] == 0
    assert starts.sum() == 20


def test_the_last_row_of_a_track_lies_beyond_the_exit(evacuation):
    rows = evacuation.recorder.arrays()
    for person in range(20):
        *_, before, last = track(rows, person)[:, 1]
        assert 0.0 < before < 8.0
        assert last <= 0.0 or last >= 8.0


def test_a_record_is_what_the_agents_showed():
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0, 0.25)
    shown = [(*person.position, person.heading)]
    for _ in range(40):
        advance(model, 1)
        shown.append((*person.position, person.heading))
    np.testing.assert_array_equal(track(model.recorder.arrays(), 0)[:, 1:], shown)


def test_nothing_recorded_unless_asked_for():
    model = model_of(corridor(), strider(), record=False)
    assert model.recorder is None
    with pytest.raises(ResultsError, match="record"):
        Trajectories.of(model)


def test_an_empty_record():
    rows = model_of(corridor(), strider()).recorder.arrays()
    assert {name: len(values) for name, values in rows.items()} == dict.fromkeys(
        ("frame", "person", "x", "y", "heading"), 0
    )


def test_trajectories_of_a_model(evacuation):
    trajectories = Trajectories.of(evacuation)
    rows = evacuation.recorder.arrays()
    assert trajectories.people == 20
    assert trajectories.frame_rate == 30.0
    assert trajectories.duration == pytest.approx(evacuation.elapsed)
    assert trajectories.radii.tolist() == [shipped_map().metadata["body"]["core_radius_m"]] * 20
    assert len(trajectories) == len(rows["x"])
    inside = dict(enumerate(trajectories.inside()))
    for seconds, people in evacuation.statistics.occupancy:
        assert inside[round(30 * seconds)] == people


def test_round_trip_to_pedpy(evacuation):
    data = Trajectories.of(evacuation).to_pedpy()
    assert isinstance(data, pedpy.TrajectoryData)
    assert data.frame_rate == 30.0
    frame = data.data.sort_values(["id", "frame"])
    # But for three rows beyond the exit of each of the 20 people.
    frame = frame[frame.groupby("id").cumcount(ascending=False) >= 3]
    rows = evacuation.recorder.arrays()
    order = np.lexsort((rows["frame"], rows["person"]))
    np.testing.assert_array_equal(frame["id"], rows["person"][order])
    np.testing.assert_array_equal(frame["frame"], rows["frame"][order])
    np.testing.assert_array_equal(frame["x"], rows["x"][order])
    np.testing.assert_array_equal(frame["y"], rows["y"][order])


def test_everybody_crosses_the_line_of_the_exit_in_pedpy(evacuation):
    data = Trajectories.of(evacuation).to_pedpy()
    passed = 0
    for door in evacuation.floor_plan.exits:
        line = pedpy.MeasurementLine([door.a, door.b])
        nt, _ = pedpy.compute_n_t(traj_data=data, measurement_line=line)
        passed += nt.cumulative_pedestrians.max()
    assert passed == 20


def test_pedpy_measures_what_was_walked():
    model = model_of(corridor(), strider())
    put(model, 2.0, 2.0, preferred_speeds=[1.25])
    advance(model, 90)
    speed = pedpy.compute_individual_speed(
        traj_data=Trajectories.of(model).to_pedpy(),
        frame_step=5,
        speed_calculation=pedpy.SpeedCalculation.BORDER_SINGLE_SIDED,
    )
    assert speed["speed"].to_numpy() == pytest.approx(np.full(91, 1.25), abs=1e-6)


def test_summary(evacuation):
    summary = evacuation.summary()
    assert summary == json.loads(json.dumps(summary))
    assert summary["model"] == "PedestrianModel"
    assert summary["preset"] == "default"
    assert summary["pedestrians"] == 20
    assert summary["left_inside"] == 0
    assert summary["stalled"] is False
    assert summary["simulated_s"] == pytest.approx(evacuation.elapsed)
    rows = evacuation.recorder.arrays()
    assert summary["egress_s"] == pytest.approx(rows["frame"].max() / 30)
    assert summary["occupancy"][0] == [0.0, 20]
    walked = seconds = 0.0
    for person in range(20):
        places = track(rows, person)[:, 1:3]
        walked += np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
        seconds += (len(places) - 1) / 30
    # Mean speeds of movements, not those along their swaying paths.
    assert summary["mean_speed_mps"] == pytest.approx(walked / seconds, rel=0.05)


def test_summary_of_people_still_inside():
    model = model_of(corridor(), strider())
    put(model, 2.0, 2.0, preferred_speeds=[1.25])
    advance(model, 30)
    summary = model.summary()
    assert summary["egress_s"] is None
    assert summary["left_inside"] == 1
    assert summary["mean_speed_mps"] == pytest.approx(1.25)
    assert summary["occupancy"] == [[0.0, 1], [1.0, 1]]


def test_recording_may_be_asked_for_before_the_first_step():
    model = model_of(corridor(), strider(), rng=1, record=False)
    put(model, 1.0, 1.0)
    model.start_recording("decisions")
    advance(model, 3)
    assert model.recorder.arrays()["frame"].tolist() == [0, 1, 2, 3]
    assert model.decided() is not None
    with pytest.raises(ModelError, match=r"has run for 0\.1 s, expected a call before"):
        model.start_recording()
