"""Figure 7: a nearly full auditorium and adjacent offices."""

import numpy as np
import pytest
import shapely
from mesa_mobility.models import Auditorium
from shapely import Point

from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import crossings, overlaps, track, wall_crossings
from tests.fixtures.oracles.raster import Raster
from tests.fixtures.scenes import core_of


def make(**keywords):
    return Auditorium(mobility_map=shipped_map(), **keywords)


def test_seven_hundred_and_fifty_people_on_its_floor():
    model = make(rng=1)
    assert model.inside == 750
    places = np.array([person.position for person in model.agents])
    assert model.floor_plan.contains(places).all()
    gaps = shapely.STRtree(shapely.points(places)).query(
        shapely.points(places), predicate="dwithin", distance=2 * core_of(model)
    )
    assert len(gaps[0]) == 750  # each finds itself only


def test_people_sit_in_the_hall_and_in_every_office():
    model = make(rng=1)
    gates = [gate for gate in model.floor_plan.gates if gate.name.startswith("office")]
    y = np.array([person.position[1] for person in model.agents])
    in_offices = (y > min(gate.a[1] for gate in gates)).sum()
    assert len(gates) >= 2
    assert in_offices == 60
    assert (y < max(g.a[1] for g in model.floor_plan.gates if "hall" in g.name)).sum() == 690


def test_the_papers_figures_are_there_for_the_picture():
    assert Auditorium.reference_occupancy == {5.49: 746, 71.43: 552, 181.31: 222, 307.67: 9}


@pytest.mark.parametrize("people", [1, 13])
def test_few_people(people):
    model = make(pedestrians=people, rng=2)
    assert model.inside == people


@pytest.fixture(scope="module")
def sparse():
    model = make(pedestrians=60, record=True, rng=3)
    model.run(max_seconds=200)
    return model


def test_sixty_people_all_find_the_way_out(sparse):
    assert sparse.inside == 0
    assert sparse.statistics.last_left < 120


def test_people_leave_by_the_nearest_exit(sparse):
    rows = sparse.recorder.arrays()
    tracks = [track(rows, person)[:, 1:3] for person in range(60)]
    exits = sparse.floor_plan.exits
    starts = np.array([t[0] for t in tracks])
    raster = Raster(sparse.floor_plan)
    ways = np.column_stack([raster.distances(exit_, starts) for exit_ in exits])
    order = np.sort(ways, axis=1)
    # The raster's lengths are a little too long: only where the other way is clearly longer.
    clear = order[:, 1] > 1.1 * order[:, 0]
    assert clear.sum() > 30
    taken = [
        min(range(len(exits)), key=lambda e: exits[e].line.distance(Point(t[-1]))) for t in tracks
    ]
    # A person who overshoots the aisle on leaving a row may end up nearer to another aisle.
    assert (np.array(taken) == ways.argmin(axis=1))[clear].mean() >= 0.9


def test_nobody_overlaps_or_crosses_a_wall(sparse):
    rows = sparse.recorder.arrays()
    assert overlaps(rows, core_of(sparse)) == 0
    assert wall_crossings(rows, sparse.floor_plan.walls) == 0


def test_everybody_crosses_one_of_the_exits(sparse):
    rows = sparse.recorder.arrays()
    passed = [crossings(rows, e.a, e.b) for e in sparse.floor_plan.exits]
    assert [sum(one[p] for one in passed) for p in range(60)] == [1] * 60


@pytest.fixture(scope="module", params=[1, 2, 3, 4, 5])
def full(request):
    model = make(record=True, rng=request.param)
    model.run(max_seconds=600)
    return model


@pytest.mark.slow
def test_everybody_out_in_250_to_400_seconds(full):
    assert full.inside == 0
    assert 250.0 <= full.statistics.last_left <= 400.0


@pytest.mark.slow
@pytest.mark.parametrize(("seconds", "people"), [(71.43, 552), (181.31, 222)])
def test_occupancy_within_twenty_percent_of_the_papers(full, seconds, people):
    rows = full.recorder.arrays()
    last = np.zeros(750)
    np.maximum.at(last, rows["person"], rows["frame"])
    assert (last > seconds * 30).sum() == pytest.approx(people, rel=0.2)


@pytest.mark.slow
def test_nobody_of_750_overlaps_or_crosses_a_wall(full):
    rows = full.recorder.arrays()
    assert overlaps(rows, core_of(full)) == 0
    assert wall_crossings(rows, full.floor_plan.walls) == 0


@pytest.mark.slow
def test_the_paper_preset_runs_to_its_end():
    model = make(preset="paper", rng=1)
    model.run(max_seconds=1200)
    assert model.inside == 0 or model.stalled
