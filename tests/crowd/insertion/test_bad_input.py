"""Impossible input is refused in one line that says what was given and what was expected."""

import math

import numpy as np
import pytest
from shapely import box

from mesa_mobility import PedestrianModel, PedestrianType
from mesa_mobility.errors import FloorPlanError, MapError, MobilityError, ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of


@pytest.fixture
def model():
    return model_of(corridor(), strider())


def refuses(error, match, call):
    with pytest.raises(error, match=match) as refused:
        call()
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("frames", [0, -3])
def test_frames_per_step(frames):
    refuses(
        ModelError,
        f"frames_per_step.*{frames}",
        lambda: model_of(corridor(), strider(), frames_per_step=frames),
    )


def test_a_map_and_types_at_once():
    kinds = [PedestrianType(mobility_map=strider())]
    refuses(
        ModelError,
        "both",
        lambda: PedestrianModel(corridor(), mobility_map=strider(), pedestrian_types=kinds),
    )


def test_no_types_at_all():
    refuses(
        ModelError, "pedestrian_types", lambda: PedestrianModel(corridor(), pedestrian_types=[])
    )


def test_a_map_file_that_is_not_there(tmp_path):
    missing = tmp_path / "nobody.npz"
    refuses(MapError, "nobody.npz", lambda: PedestrianModel(corridor(), mobility_map=missing))


def test_a_map_file_that_is_none(tmp_path):
    file = tmp_path / "letter.npz"
    file.write_text("Dear map,")
    refuses(MapError, "letter.npz", lambda: PedestrianModel(corridor(), mobility_map=str(file)))


@pytest.mark.parametrize(
    "place", [(-1.0, 2.0), (21.0, 2.0), (5.0, 4.5), (math.nan, 2.0), (5.0, math.inf)]
)
def test_places_off_the_floor(model, place):
    refuses(ModelError, "pedestrian 1 .*floor", lambda: model.add_pedestrians([(1.0, 1.0), place]))
    assert model.inside == 0


def test_a_place_inside_an_obstacle(model):
    model.floor_plan.add_obstacle("POLYGON((5 1,6 1,6 2,5 2,5 1))")
    refuses(ModelError, "pedestrian 0", lambda: model.add_pedestrians([(5.5, 1.5)]))


@pytest.mark.parametrize("shape", [(4, 3), (3,), (2, 2, 2), (1, 4)])
def test_places_that_are_not_pairs(model, shape):
    refuses(ModelError, "positions", lambda: model.add_pedestrians(np.ones(shape)))
    assert model.inside == 0


@pytest.mark.parametrize("name", ["headings", "preferred_speeds"])
@pytest.mark.parametrize("values", [[1.0], [1.0, 1.0, 1.0], [1.0, math.nan], [1.0, math.inf]])
def test_columns_of_other_lengths_or_not_finite(model, name, values):
    refuses(ModelError, name, lambda: model.add_pedestrians([(1, 1), (2, 2)], **{name: values}))


@pytest.mark.parametrize("speed", [0.0, -1.2])
def test_preferred_speeds_that_nobody_can_have(model, speed):
    refuses(
        ModelError,
        "preferred_speeds",
        lambda: model.add_pedestrians([(1, 1)], preferred_speeds=[speed]),
    )


def test_people_refused_leave_no_trace(model):
    model.add_pedestrians([(1.0, 1.0)])
    for wrong in ({"headings": [1.0]}, {"preferred_speeds": [1.0]}, {"exits": ["north"]}):
        with pytest.raises(MobilityError):
            model.add_pedestrians([(2.0, 1.0), (3.0, 1.0)], **wrong)
    (second,) = model.add_pedestrians([(4.0, 1.0)])
    assert second.row == 1
    assert model.inside == len(model.agents) == 2
    assert not model.crowd.active[2:].any()
    model.run(max_seconds=2.0)
    assert model.inside == 2


def test_exits_that_there_are_not(model):
    refuses(
        FloorPlanError, "'north'.*'east'", lambda: model.add_pedestrians([(1, 1)], exits=["north"])
    )
    refuses(FloorPlanError, "exit", lambda: model.add_pedestrians([(1, 1)], exits=[]))
    refuses(
        ModelError,
        r"exits: got 'east'.*\['east'\]",
        lambda: model.add_pedestrians([(1, 1)], exits="east"),
    )


def test_places_from_where_no_exit_can_be_reached(model):
    # A cabin with a slit of 0.2 m, too narrow for anybody.
    for x0, y0, x1, y1 in (
        (4, 1, 6, 1.2),
        (4, 3, 6, 3.2),
        (4, 1, 4.2, 3.2),
        (5.8, 1, 6, 1.9),
        (5.8, 2.1, 6, 3.2),
    ):
        model.floor_plan.add_obstacle(box(x0, y0, x1, y1))
    for close in (lambda: None, lambda: model.floor_plan.close_gate("east")):
        close()
        refuses(
            FloorPlanError,
            r"1 of 2 people.*any exit.*\(5.00, 2.00\)",
            lambda: model.add_pedestrians([(1, 1), (5, 2)]),
        )
    assert model.inside == 0


@pytest.mark.parametrize("kind", [1, 7, -1])
def test_types_that_there_are_not(model, kind):
    refuses(
        ModelError, f"type_index.*{kind}", lambda: model.add_pedestrians([(1, 1)], type_index=kind)
    )


def test_more_people_than_fit(model):
    rng = np.random.default_rng(0)
    refuses(
        FloorPlanError,
        "room for [0-9]+ of 2000",
        lambda: model.floor_plan.random_points(2000, rng, spacing=0.5, clearance=0.3),
    )
