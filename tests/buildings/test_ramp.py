"""Ramps. This one is 15 m long and leads 1.2 m down from a stage into a hall, towards -x: 8 %."""

import numpy as np
import pytest

from mesa_mobility import Building, Exit, Level, PedestrianModel, Ramp, Trajectories
from mesa_mobility.buildings.places import ON_STAIRS
from mesa_mobility.errors import FloorPlanError

HALL = "POLYGON ((0 0, 30 0, 30 6, 0 6, 0 0))"
STAGE = "POLYGON ((30 0, 42 0, 42 6, 30 6, 30 0))"
GROUND = Level(0, HALL, exits=[Exit("street", (0, 1), (0, 3))])
FIRST = Level(1, STAGE, elevation=1.2)
HEAD = ((30.0, 3.5), (30.0, 5.5))


def building(**given):
    return Building(
        [GROUND, FIRST], [Ramp.straight("ramp", FIRST, GROUND, HEAD, length=15.0, **given)]
    )


def test_it_is_a_slope_on_which_feet_are():
    office = building()
    (flight,) = office.flights
    assert (flight.going, flight.factor, flight.risers, flight.riser) == (15.0, 1.0, 0, 0.0)
    assert np.allclose(flight.foot, ((15.0, 3.5), (15.0, 5.5)))
    # A quarter of the way down.
    place = np.array([[26.25, 4.5, 0.9]])
    places, levels = office.true_places(office.plane_places(place))
    assert places == pytest.approx(place)
    assert levels.tolist() == [ON_STAIRS]
    assert office.footing.carried(place).tolist() == [0.9]
    heights, edges = office.footing.beneath(place, np.array([[25.75, 4.6]]))
    # Half a metre farther down it is 0.04 m lower.
    assert heights == pytest.approx([0.86])
    assert edges == pytest.approx([0.86])


def test_nobody_is_slower_on_it_unless_said():
    assert building().floor_plan.zones == ()
    assert {zone.factor for zone in building(factor=0.8).floor_plan.zones} == {0.8}


def test_people_in_wheelchairs_use_it():
    office = building()
    model = PedestrianModel(office, population="wheelchair_powered", rng=1, record=True)
    model.add_pedestrians(office.places([(32.0, 1.5), (40.0, 1.5)], level=1))
    model.run(max_seconds=120)
    assert model.inside == 0
    assert model.without_stairs == []


@pytest.mark.parametrize("factor", [1.0, 0.75])
def test_people_alone_walk_at_their_share_of_the_speed(factor):
    office = building(factor=factor)
    model = PedestrianModel(office, rng=3, record=True)
    model.add_pedestrians(
        office.places([(32.0, 4.5)], level=1), preferred_speeds=[1.2], headings=[np.pi]
    )
    model.run(max_seconds=60)
    tracks = Trajectories.of(model)
    on = (tracks.z < 1.0) & (tracks.z > 0.1)
    x, frame = tracks.x[on], tracks.frame[on]
    speed = (x.max() - x.min()) / (frame.max() - frame.min()) * 30.0
    assert speed == pytest.approx(1.2 * factor, rel=0.1)


def test_it_is_written_and_read():
    office = building(factor=0.9)
    read = Building.from_geojson(office.to_geojson())
    assert read.stairs == office.stairs
    assert read.to_geojson() == office.to_geojson()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"length": 4.0}, r"ramp 'a': 1.2 m down over 4 m is a slope of 0.300, expected more than"),
        ({"length": 0.1}, r"ramp 'a': expected a length of 0.5 to 200 m, found 0.1"),
        ({"length": float("nan")}, r"ramp 'a': expected a length of"),
        ({"factor": 1.5}, r"ramp 'a': expected a factor of 0.05 to 1, found 1.5"),
        ({"head": ((30, 4), (30, 4.5))}, r"ramp 'a': expected a clear width of 0.8 to 100 m"),
        ({"upper": 0, "lower": 1}, r"ramp 'a': -1.2 m down"),
    ],
)
def test_bad_ramps_get_one_line(given, said):
    values = {"upper": 1, "lower": 0, "head": HEAD, "length": 15.0} | given
    with pytest.raises(FloorPlanError, match=said) as caught:
        Building([GROUND, FIRST], [Ramp.straight("a", **values)])
    assert "\n" not in str(caught.value)


def test_bad_files_name_the_feature():
    collection = building().to_geojson()
    collection["features"][-1]["properties"]["length"] = "long"
    with pytest.raises(FloorPlanError, match=r"feature \d+: length must be a number, found 'long'"):
        Building.from_geojson(collection)
