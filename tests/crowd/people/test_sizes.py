"""Sizes of bodies that differ from person to person."""

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType
from mesa_mobility.distributions import Constant, Normal, Uniform
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.results import Trajectories, check_safety, read_parquet
from tests.fixtures.maps import shipped_map

PLACES = [(0.6 + 0.7 * (k % 6), 0.6 + 0.7 * (k // 6)) for k in range(24)]


def model_of(core_radius, seed=1, plan=None) -> PedestrianModel:
    kind = PedestrianType(mobility_map=shipped_map(), core_radius=core_radius)
    plan = plan or FloorPlan(box(0, 0, 7, 4), exits=[Exit("out", (7, 0.5), (7, 3.5))])
    return PedestrianModel(plan, pedestrian_types=[kind], rng=seed, record=True)


def test_radii_are_drawn_in_strata(tmp_path):
    model = model_of(Uniform(0.12, 0.24))
    model.add_pedestrians(PLACES)
    # One from each of 24 equal parts of 5 mm.
    parts = np.floor((np.sort(model.core_radii) - 0.12) / 0.005 + 1e-9)
    assert parts.tolist() == list(range(24))
    model.run(max_seconds=6.0)
    tracks = Trajectories.of(model)
    report = check_safety(tracks, model.floor_plan.walls)
    assert (report.overlaps, report.wall_crossings) == (0, 0)
    tracks.to_parquet(tmp_path / "run.parquet")
    again = read_parquet(tmp_path / "run.parquet")
    assert again.radii.tolist() == model.core_radii.tolist()
    column = again.to_pandas().groupby("person")["core_radius"].first()
    assert column.tolist() == model.core_radii.tolist()


def test_one_radius_draws_nothing():
    # The same numbers from the generator, so the same run, and no column.
    tracks = []
    for core in (0.14, Constant(0.14)):
        model = model_of(core)
        model.add_pedestrians(PLACES)
        model.run(max_seconds=2.0)
        tracks.append(Trajectories.of(model))
    assert tracks[0].x.tobytes() == tracks[1].x.tobytes()
    assert "core_radius" not in tracks[0].person_data


def test_all_keep_to_ways_for_the_widest():
    floor = union_all([box(0, 0, 3, 3), box(3, 1, 3.2, 1.5), box(3.2, 0, 6, 3)])
    plan = FloorPlan(floor, exits=[Exit("out", (6, 1), (6, 2))])
    model_of(Uniform(0.15, 0.2), plan=plan).add_pedestrians([(1.0, 1.0)])
    with pytest.raises(FloorPlanError, match=r"too narrow for bodies of 0\.3 m radius"):
        model_of(Uniform(0.15, 0.3), plan=plan).add_pedestrians([(1.0, 1.0)])


@pytest.mark.parametrize(
    "core", [Normal(0.2, 0.05), Uniform(-0.1, 0.2), Uniform(0.5, 1.2), 1e-308, 0.01]
)
def test_radii_out_of_range_are_refused(core):
    with pytest.raises(ModelError, match=r"core_radius .*, expected 0\.02 to 1 m"):
        PedestrianType(mobility_map=shipped_map(), core_radius=core)
