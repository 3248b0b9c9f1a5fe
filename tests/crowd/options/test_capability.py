import numpy as np
import pytest

from mesa_mobility import Capability, PedestrianType
from mesa_mobility.crowd.options.table import stack_tables
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import STANDING, WALKING, make_map, stand, straight, strider, through
from tests.fixtures.scenes import corridor, model_of, put, statues


def test_all_options_of_the_map():
    capability = Capability(strider())
    assert capability.n_clusters == 2
    assert capability.standing == STANDING
    assert list(capability.options(STANDING)) == [0, 1, 2, 3]
    assert list(capability.options(WALKING)) == [4, 5, 6, 7]
    assert capability.table.options.x.tolist() == [0.0, 0.5, 1.0, 1.875, 0.5, 0.0, 1.0, 1.875]
    assert capability.table.options.frames.tolist() == [12, 12, 24, 45, 12, 12, 24, 45]
    assert capability.table.options.cluster.tolist() == [0, 1, 1, 1, 1, 0, 1, 1]
    assert capability.longest_reach == 1.875


def test_options_of_some_durations():
    capability = Capability(strider(), durations=(24, 45))
    assert [list(capability.options(c)) for c in (STANDING, WALKING)] == [[0, 1], [2, 3]]
    assert capability.table.options.x.tolist() == [1.0, 1.875, 1.0, 1.875]
    assert capability.table.options.frames.tolist() == [24, 45, 24, 45]
    assert capability.parts.rows.tolist() == [2, 3, 5, 6]


def test_paths_stay_with_their_options():
    table = Capability(strider(), durations=(24,)).table
    steps = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875]
    assert table.path[1, 0].tolist() == [*steps, *[1.0] * 8]


def test_options_start_where_a_line_of_the_cache_does():
    one, other = Capability(strider()).table, Capability(strider(), durations=(24, 45)).table
    for table in (one, other, stack_tables([one, other])):
        assert table.options.ctypes.data % 64 == 0
        assert table.path.ctypes.data % 64 == 0


def test_stacked_tables_follow_one_another():
    one, other = Capability(strider()).table, Capability(strider(), durations=(24, 45)).table
    both = stack_tables([one, other])
    assert both.options.x.tolist() == one.options.x.tolist() + other.options.x.tolist()
    assert both.options.cluster.tolist()[8:] == [c + 2 for c in other.options.cluster.tolist()]
    assert np.array_equal(both.path, np.concatenate([one.path, other.path]))


def test_reach_is_the_farthest_of_the_path_not_its_end():
    far_and_back = [(0.5, 0.0, 0.0), (0.75, 1.0, 0.0), (0.5, 0.0, 0.0), (0.25, 0.0, 0.0)]
    assert Capability(make_map([[stand(), through(far_and_back, to=0)]])).longest_reach == 1.25


def test_a_cluster_without_options_of_these_durations_is_refused():
    map_ = make_map([[stand(), straight(1.5, 45)], [straight(0.5, 12, to=0)]])
    with pytest.raises(ModelError, match=r"cluster 1 .*45"):
        Capability(map_, durations=(45,))


def test_people_of_a_type_share_one_capability():
    model = model_of(corridor(), [strider(), statues()])
    a, b, c = put(model, 1, 1), put(model, 1, 2), put(model, 1, 3, type_index=1)
    assert a.capability is b.capability
    assert a.capability is not c.capability
    assert c.capability.longest_reach == 0.0
    assert a.capability.map is a.pedestrian_type.mobility_map


@pytest.mark.parametrize(("in_map", "radius"), [(0.1875, 0.1875), (None, 0.14)])
def test_core_radius_is_the_maps_or_sixteen_centimetres(in_map, radius):
    kind = PedestrianType(mobility_map=strider(core_radius=in_map))
    assert kind.core_radius == radius
    assert kind.name == "made by hand"


def test_preferred_speeds_are_normal_within_bounds():
    kind = PedestrianType(mobility_map=strider())
    speeds = kind.draw_speeds(20_000, np.random.default_rng(1))
    # Weidmann: 1.34 +- 0.26 m/s, within 0.6 and 2.0.
    assert speeds.mean() == pytest.approx(1.34, abs=0.001)
    assert speeds.std() == pytest.approx(0.26, abs=0.001)
    assert speeds.min() > 0.6
    assert speeds.max() < 2.0


@pytest.mark.parametrize(
    "wrong",
    [
        {"core_radius": -0.1},
        {"core_radius": 1.5},
        {"core_radius": float("nan")},
        {"preferred_speed": 0.0},
        {"preferred_speed": -1.3},
        {"preferred_speed": float("nan")},
        {"preferred_speed": "1.3"},
    ],
)
def test_types_out_of_range_are_refused(wrong):
    with pytest.raises(ModelError, match="type 'tall'") as refused:
        PedestrianType(mobility_map=strider(), name="tall", **wrong)
    assert "\n" not in str(refused.value)
