"""Grounds: who walks by which map, and in which pose they go on."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import box

from mesa_mobility import PedestrianType
from mesa_mobility.crowd.options.repertoire import repertoire
from mesa_mobility.crowd.state.grounds import GroundMaps, Grounds, nearest_clusters
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import MapError
from mesa_mobility.floorplan import SpeedZone
from mesa_mobility.mobility import MobilityMap
from tests.fixtures.maps import WALKING, make_map, stand, straight, strider
from tests.fixtures.stairs import TREAD, climbing_type, stair_map


def stairs(x, tread=TREAD):
    """A flight from x to x + 3 m, which falls towards +x."""
    zone = box(x, 0.0, x + 3.0, 2.0)
    return SpeedZone(zone, 0.8, f"at {x:g}", uphill=0.6, downhill=(1.0, 0.0), tread=tread)


def test_maps_of_types_come_first_and_stairs_share_theirs():
    one, other = climbing_type(), PedestrianType(mobility_map=strider())
    third = PedestrianType(mobility_map=one.mobility_map, up=one.up, down=one.down)
    shop = SpeedZone(box(20, 0, 22, 2), 0.5)
    found = GroundMaps([stairs(0.0), stairs(5.0), shop], [one, other, third])
    assert found.maps[:3] == (one.mobility_map, other.mobility_map, third.mobility_map)
    assert found.maps[3:] == (one.up, one.down)
    assert found.used.tolist() == [[0, 1, 2], [3, 1, 3], [4, 1, 4]]
    # Options of the map of the type, then those up, then those down.
    a, b = one.mobility_map.n_options, one.up.n_options
    assert found.first_rows.tolist() == [[0, -1, -1, a, a + b], [-1, 0, -1, -1, -1],
                                         [-1, -1, 0, a, a + b]]  # fmt: skip
    assert found.longest(np.array([1.0, 2.0, 3.0, 0.5, 9.0])).tolist() == [9.0, 2.0, 9.0]


def test_each_depth_of_treads_has_maps_of_its_own():
    found = GroundMaps(
        [stairs(0.0, 0.25), stairs(5.0, 0.30), stairs(9.0, 0.254)], [climbing_type()]
    )
    assert found.used.tolist() == [[0], [1], [2], [3], [4]]
    assert [each.lengths for each in found.maps] == [1.0, 1.0, 1.0, 1.2, 1.2]
    assert [(up, down) for _, up, down in found.stairs] == [(1, 2), (3, 4), (1, 2)]


def test_a_plan_without_stairs_reads_no_map_for_stairs(monkeypatch):
    monkeypatch.setattr(MobilityMap, "named", None)
    able = strider(pedestrian_type="able_bodied")
    kind = PedestrianType(mobility_map=able)
    assert GroundMaps([SpeedZone(box(0, 0, 2, 2), 0.5)], [kind]).maps == (able,)
    with pytest.raises(TypeError):
        GroundMaps([stairs(0.0)], [kind])


@pytest.mark.parametrize(
    ("name", "climbs", "shipped"),
    [("able_bodied", True, True), ("child", True, True), ("older_adult", None, True),
     ("cane", True, False), ("slow", True, False), ("able_bodied", False, False)],
)  # fmt: skip
def test_who_puts_one_foot_on_each_tread_uses_the_maps_that_ship(name, climbs, shipped):
    map_ = strider(pedestrian_type=name)
    kind = PedestrianType(mobility_map=map_, climbs=climbs)
    for up in (True, False):
        found = kind.on_stairs(0.29, up=up)
        expected = f"able_bodied_{'up' if up else 'down'}" if shipped else name
        assert found.pedestrian_type == expected
        assert (found is map_) != shipped


def test_strides_are_as_long_as_the_treads():
    map_ = stair_map(0.5, "up")
    longer = map_.for_treads(0.30)
    assert map_.for_treads(TREAD) is map_
    assert longer is map_.for_treads(0.30)
    assert longer.end_points[1].tolist() == pytest.approx([0.5 * 0.4 * 0.30 / 0.25, 0.0])
    assert (longer.durations == map_.durations).all()
    assert (longer.digest, longer.lengths) == (map_.digest, 1.2)
    # Of other maps nobody knows.
    assert strider().for_treads(0.2).lengths == 1.0
    for wrong in (0.0, "0.3", None, float("nan")):
        metadata = {**map_.metadata, "derived": {"tread_m": wrong}}
        with pytest.raises(MapError, match=r"'tread_m' is .*, expected 0.1 to 1 m"):
            replace(map_, metadata=metadata).for_treads(0.3)


def test_people_go_on_from_the_pose_that_is_most_like_theirs():
    flat = make_map([(stand(),), (straight(0.5, 12),)])
    slow, fast = straight(0.1, 12), straight(0.6, 12)
    three = make_map([(stand(),), (slow,), (fast,), (fast,)])
    centres = np.zeros((4, 36), dtype=np.float32)
    centres[3, 0] = 1.0
    three = replace(three, centres=centres)
    found = nearest_clusters(repertoire((flat, three), (12, 24, 45)))
    # They stand, or walk 1.25 m/s. Of the two clusters at 1.5 m/s the first is as bent.
    assert found[1].tolist() == [2, 4, 2, 3, 4, 5]
    assert found[0].tolist() == [0, 1, 0, 0, 1, 1]


def test_the_ground_ahead_and_the_way_to_the_target_decide():
    kind = climbing_type()
    known = GroundMaps([stairs(10.0)], [kind])
    laid_out = repertoire(known.maps, (12, 24, 45))
    grounds = Grounds(known, laid_out, 0.4)
    crowd = Crowd(8)
    rows = np.arange(7, dtype=np.int64)
    level, up, down = laid_out.first_cluster.tolist()
    # Before the stairs; about to come; on them down, up, to the side; about to leave; behind.
    crowd.x[rows] = [9.0, 9.7, 11.0, 11.0, 11.0, 12.8, 13.5]
    crowd.vx[rows] = [1.0, 1.0, 0.5, -0.5, 0.0, 1.0, 1.0]
    crowd.y[rows] = 1.0
    crowd.target_x[rows] = [20.0, 20.0, 20.0, 0.0, 11.0, 20.0, 20.0]
    crowd.target_y[rows] = 1.0
    crowd.heading[4] = np.pi
    crowd.cluster[rows] = [WALKING] * 3 + [down + WALKING, 0, down + WALKING, down + WALKING]
    grounds.change(rows, crowd)
    expected = [level + 1, down + 1, down + 1, up + 1, up, level + 1, level + 1]
    assert crowd.cluster[rows].tolist() == expected
