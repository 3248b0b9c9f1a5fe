"""A run in a building of two storeys as meshes, figures and a page.

The straight stair has 18 risers of 0.17 m and 17 treads of 0.29 m; its head is at x = 8.
"""

import numpy as np
import pytest
import shapely

from mesa_mobility import Building, Exit, Level, Lift, PedestrianModel, Stairs
from mesa_mobility.animation import Selection, walkers, write_glb, write_usd
from mesa_mobility.animation.buildings.storeys import drawn_building
from mesa_mobility.animation.scenery import surfaces
from mesa_mobility.bodies.feet import LEGS, soles
from mesa_mobility.bodies.rotations import matrices
from mesa_mobility.buildings import ON_STAIRS
from mesa_mobility.results import Trajectories
from tests.fixtures.buildings import HALL, RISE, two_storeys, with_refuge_and_lift

OFFICE = two_storeys()
HEAD, FOOT = 8.0, 12.93


@pytest.fixture(scope="module")
def tracks():
    """Four people who walk down the straight stair from the upper floor."""
    model = PedestrianModel(OFFICE, record="decisions", rng=3)
    model.add_pedestrians(OFFICE.places([(5.0, 0.6), (5.8, 0.6), (6.6, 0.6), (7.4, 0.6)], level=1))
    model.run(max_seconds=16)
    return Trajectories.of(model)


def test_refuges_are_areas_on_the_floor_of_their_level():
    building = with_refuge_and_lift()
    found = {surface.name: surface for surface in surfaces(building)}
    [refuge] = [each for name, each in found.items() if name.startswith("refuge")]
    assert refuge.name == "refuge_level_1_0_north_lobby"
    assert refuge.vertices[:, 2] == pytest.approx(3.065)
    assert area_of(refuge) == pytest.approx(4 * 3)
    ground, upper = drawn_building(building)["storeys"]
    assert ground["refuges"] == []
    [drawn] = upper["refuges"]
    assert drawn["name"] == "north lobby"
    assert shapely.Polygon(drawn["rings"][0]).bounds == (15, 1, 19, 4)
    assert drawn["middle"] == [17, 2.5]


def named():
    return {surface.name: surface for surface in surfaces(OFFICE)}


def area_of(surface):
    corners = surface.vertices[surface.triangles].astype(np.float64)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.linalg.norm(across, axis=1).sum() / 2


def test_each_tread_is_a_step():
    steps = named()["flight_0"]
    tops = steps.vertices[steps.normals[:, 2] == 1.0].reshape(-1, 4, 3)
    assert len(tops) == 17
    for number, top in enumerate(tops, start=1):
        assert top[:, 2] == pytest.approx(3.06 - 0.17 * number, abs=1e-6)
        assert top[:, 0].min() == pytest.approx(HEAD + 0.29 * (number - 1), abs=1e-5)
        assert top[:, 0].max() == pytest.approx(HEAD + 0.29 * number, abs=1e-5)
    assert steps.vertices[:, 2].min() == 0.0


def test_floors_have_their_elevations_and_the_upper_lets_one_see_through():
    found = named()
    ground, upper = found["floor_level_0"], found["floor_level_1"]
    assert (set(ground.vertices[:, 2]), ground.opacity) == ({0.0}, 1.0)
    assert upper.vertices[:, 2] == pytest.approx(3.06)
    assert upper.opacity < 1.0
    # Holes over the straight flight (4.93 m) and the upper flight of the dog-leg (8 treads).
    assert area_of(ground) == pytest.approx(24 * 8, rel=1e-6)
    assert area_of(upper) == pytest.approx(24 * 8 - 1.2 * (4.93 + 8 * 0.29), rel=1e-6)
    assert found["landing_0"].vertices[:, 2].max() == pytest.approx(1.53)
    # The exits, 2 m wide, are on the ground floor and not walled.
    assert {"opening_level_0_0", "opening_level_0_1"} < set(found)
    assert not any(name.startswith("opening_level_1") for name in found)
    # Walls of 0.15 m have an inner and an outer side, and two jambs at each exit.
    inner, outer = 64.0, 64 + 8 * 0.15
    sides = inner + outer - 2 * 4 + 4 * 0.15
    assert area_of(found["walls_level_0"]) == pytest.approx(1.2 * sides, rel=1e-6)
    assert area_of(found["walls_level_1"]) == pytest.approx(1.2 * (inner + outer), rel=1e-6)


def corners_of(surface, at):
    """Corners of a mesh at an x, metres."""
    return surface.vertices[np.abs(surface.vertices[:, 0] - at) < 1e-4]


def test_handrails_are_beside_the_flight_above_the_edges_of_its_treads():
    head = ((8, 1.4), (8, 0.2))
    for side, (low, high) in {
        "both": (0.16, 1.44),
        "left": (1.4, 1.44),
        "right": (0.16, 0.2),
    }.items():
        stairs = Stairs.straight("s", 1, 0, head, risers=18, tread=0.29, handrails=side)
        levels = Level(0, HALL, exits=[Exit("west", (0, 3), (0, 5))]), Level(1, HALL, RISE)
        found = {each.name: each for each in surfaces(Building(levels, [stairs]))}
        rails = found["handrails_level_0"]
        assert rails.vertices[:, 1].min() == pytest.approx(low, abs=1e-6)
        assert rails.vertices[:, 1].max() == pytest.approx(high, abs=1e-6)
        # The clear width is free.
        assert not ((rails.vertices[:, 1] > 0.2001) & (rails.vertices[:, 1] < 1.3999)).any()
        # Of the floor at the head, and of the last tread, 0.17 m above the ground.
        assert corners_of(rails, HEAD)[:, 2].max() == pytest.approx(3.06 + 0.9)
        assert corners_of(rails, FOOT)[:, 2].max() == pytest.approx(0.17 + 0.9)
        assert rails.vertices[:, 2].min() == pytest.approx(0.0)
        assert len(rails.triangles) <= (2 if side == "both" else 1) * 32
        # The edge of tread 9 is 2.61 m from the head, at 1.53 m.
        top = max(rails.vertices.tolist(), key=lambda each: each[2])
        slope = (0.17 + 0.9 - 3.06 - 0.9) / (FOOT - HEAD)
        assert top[2] + slope * 9 * 0.29 == pytest.approx(1.53 + 0.9)


def test_stairs_without_handrails_have_none():
    stairs = Stairs.dog_leg(
        "s", 1, 0, ((14, 8), (14, 6.8)), risers=18, turn="right", handrails="none"
    )
    levels = Level(0, HALL, exits=[Exit("west", (0, 3), (0, 5))]), Level(1, HALL, RISE)
    names = {each.name for each in surfaces(Building(levels, [stairs]))}
    assert {"flight_0", "landing_0"} < names
    assert not any(name.startswith("handrails") for name in names)


def test_shafts_of_lifts_have_holes_walls_and_doors():
    """A car of 1.1 m by 1.4 m behind a door of 0.9 m; the shaft is 1.5 m deep."""
    building = with_refuge_and_lift()
    found = {surface.name: surface for surface in surfaces(building)}
    assert area_of(found["floor_level_0"]) == pytest.approx(24 * 8, rel=1e-6)
    holes = 1.2 * 4.93 + 1.1 * 1.4
    assert area_of(found["floor_level_1"]) == pytest.approx(24 * 8 - holes, rel=1e-6)
    lower, upper = found["shafts_level_0"], found["shafts_level_1"]
    assert (lower.vertices[:, 2].min(), lower.vertices[:, 2].max()) == pytest.approx((0, 3.06))
    assert upper.vertices[:, 2].min() == pytest.approx(3.06)
    assert upper.vertices[:, 2].max() == pytest.approx(3.06 + 2.3)
    around, door = 2 * (1.1 + 1.5), 0.9 * 2.0
    assert area_of(lower) == pytest.approx(around * 3.06 - door, rel=1e-5)
    assert area_of(upper) == pytest.approx(around * 2.3 - door, rel=1e-5)
    assert lower.opacity < 1.0
    # Posts and bars are 6 cm thick.
    frame = found["shaft_frames_level_1"]
    assert frame.vertices[:, 0].min() == pytest.approx(20.45 - 0.55 - 0.03)
    assert frame.vertices[:, 1].max() == pytest.approx(6.5 + 1.5 + 0.03)
    assert frame.vertices[:, 2].max() == pytest.approx(3.06 + 2.3)
    assert len(lower.triangles) + len(frame.triangles) < 200
    drawn = [each for each in drawn_building(building)["fittings"] if each["opacity"] < 1.0]
    assert [each["bottom"] for each in drawn] == [0.0, 3.06]
    assert np.array(drawn[1]["vertices"])[2::3].max() == pytest.approx(5.36)


def test_a_level_that_a_lift_passes_has_a_hole_and_no_door():
    levels = [Level(k, HALL, RISE * k, exits=[Exit(f"west {k}", (0, 3), (0, 5))]) for k in range(3)]
    building = Building(levels, [], lifts=[Lift("lift", [0, 2], ((20.0, 6.0), (20.9, 6.0)))])
    found = {surface.name: surface for surface in surfaces(building)}
    assert area_of(found["floor_level_1"]) == pytest.approx(24 * 8 - 1.1 * 1.4, rel=1e-6)
    assert area_of(found["shafts_level_1"]) == pytest.approx(2 * (1.1 + 1.5) * 3.06, rel=1e-5)


def test_levels_have_no_wall_where_a_lift_leads_off_their_edge():
    exits = [Exit("west", (0, 3), (0, 5))]
    levels = [Level(0, HALL, exits=exits), Level(1, HALL, RISE)]
    building = Building(levels, [], lifts=[Lift("lift", [0, 1], ((20.0, 8.0), (20.9, 8.0)))])
    walls = np.array(drawn_building(building)["storeys"][1]["walls"])
    assert np.hypot(*(walls[:, 2:] - walls[:, :2]).T).sum() == pytest.approx(64 - 0.9)
    [wall] = [each for each in surfaces(building) if each.name == "walls_level_1"]
    # An inner and an outer side of 0.9 m are left out, and two jambs of 0.15 m are there.
    sides = 64 + 64 + 8 * 0.15 - 2 * 0.9 + 2 * 0.15
    assert area_of(wall) == pytest.approx(1.2 * sides, rel=1e-5)


def test_closed_exits_are_walls():
    office = two_storeys()
    office.floor_plan.close_gate("west")
    ground = drawn_building(office)["storeys"][0]
    assert [each["open"] for each in ground["openings"]] == [False, True]
    lengths = np.hypot(*(np.array(ground["walls"])[:, 2:] - np.array(ground["walls"])[:, :2]).T)
    assert lengths.sum() == pytest.approx(64 - 2)


def test_obstacles_are_those_of_now():
    office = two_storeys()
    office.floor_plan.add_obstacle(shapely.box(44 + 20, 3, 44 + 22, 5))
    ground, upper = drawn_building(office)["storeys"]
    assert [len(each["free"][0]) for each in (ground, upper)] == [1, 2]


def standing(tracks, person):
    """Lowest places of feet that have borne for 5 frames, of somebody on the stairs."""
    motion, rows = tracks.poses(person, building=OFFICE), tracks.rows_of(person)
    turned = matrices(motion.rotations.reshape(-1, 4)).reshape(len(rows), -1, 3, 3)
    for side, (_, _, ankle, _) in enumerate(LEGS):
        bears = motion.bearing[:, 2 * side : 2 * side + 2].any(axis=1)
        firm = np.convolve(bears, np.ones(5), mode="full")[: len(bears)] == 5
        on = firm & (tracks.level[rows] == ON_STAIRS)
        heel, ball = soles(motion.positions[:, ankle] / motion.scale, turned[:, ankle])
        yield from zip(motion.scale * heel[on], motion.scale * ball[on], strict=True)


def tread_at(x):
    return 3.06 - 0.17 * np.clip(np.ceil((x - HEAD - 1e-6) / 0.29), 0, 17) if x < FOOT else 0.0


def test_feet_stand_on_the_treads(tracks):
    away = [
        min(heel[2], ball[2]) - max(tread_at(heel[0]), tread_at(ball[0]))
        for person in range(4)
        for heel, ball in standing(tracks, person)
    ]
    assert len(away) > 200
    assert np.mean(np.abs(away) < 0.01) > 0.8
    assert np.quantile(away, [0.02, 0.95]) == pytest.approx([0.0, 0.0], abs=0.07)


def test_bodies_come_down_without_a_jump(tracks):
    for person in range(4):
        pelvis = tracks.poses(person, building=OFFICE).positions[:, 0, 2]
        assert 3.06 + 0.7 < pelvis[0] < 3.06 + 1.1
        assert pelvis[-1] < 1.1
        assert np.abs(np.diff(pelvis)).max() < 0.17 / 2


def test_gltf_has_storeys_and_people_at_their_elevation(tracks, tmp_path):
    gltf = pytest.importorskip("pygltflib")
    write_glb(walkers(tracks, Selection(), building=OFFICE), OFFICE, tmp_path / "run.glb")
    file = gltf.GLTF2().load(tmp_path / "run.glb")
    meshes = {mesh.name: mesh.primitives[0] for mesh in file.meshes}
    floor = meshes["floor_level_1"]
    assert file.accessors[floor.attributes.POSITION].max[2] == pytest.approx(3.06)
    assert file.materials[floor.material].alphaMode == "BLEND"
    assert file.materials[meshes["floor_level_0"].material].alphaMode == "OPAQUE"
    pelvis = next(node for node in file.nodes if node.name == "0.pelvis")
    assert 3.06 + 0.7 < pelvis.translation[2] < 3.06 + 1.1


def test_usd_has_storeys_and_people_at_their_elevation(tracks, tmp_path):
    usd = pytest.importorskip("pxr.Usd", reason="OpenUSD files need usd-core")
    write_usd(walkers(tracks, Selection(), building=OFFICE), OFFICE, tmp_path / "run.usdc")
    stage = usd.Stage.Open(str(tmp_path / "run.usdc"))
    points = stage.GetPrimAtPath("/world/floor_level_1").GetAttribute("points").Get()
    assert {round(point[2], 6) for point in points} == {3.06}
    shader = stage.GetPrimAtPath("/world/materials/colour_e6e6e2_through/surface")
    assert 0.0 < shader.GetAttribute("inputs:opacity").Get() < 1.0
    moved = stage.GetPrimAtPath("/world/person_0/walk").GetAttribute("translations")
    assert 3.06 + 0.7 < moved.Get(0)[0][2] < 3.06 + 1.1
