"""The maps that ship: names, sizes, sums, licences, and that nobody is trapped."""

import hashlib
import json
import re
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from mesa_mobility.mobility import WHEELCHAIRS, MobilityMap, abilities_of, shipped_map_path
from mesa_mobility.mobility.judging.verdict import with_verdict
from mesa_mobility.mobility.standing.ways_back import check_ways_back
from tests.fixtures.maps import ALL_TYPES, STAIR_MAPS

ALL_MAPS = (*ALL_TYPES, *STAIR_MAPS)
FOLDER = Path(str(files("mesa_mobility.maps")))


# Radii of the cores in metres, and free speeds of the sources in m/s.
BODIES = {"child": 0.128, "crutches": 0.22, "walking_frame": 0.2}
SPEEDS = {
    "child": 1.13,
    "older_adult": 1.23,
    "cane": 0.81,
    "crutches": 0.94,
    "walking_frame": 0.57,
    "wheelchair_manual": 0.69,
    "wheelchair_powered": 0.89,
    "wheelchair_assisted": 1.30,
}


def test_fourteen_maps_ship_in_at_most_20_megabytes():
    assert {path.stem for path in FOLDER.glob("*.npz")} == set(ALL_MAPS)
    assert sum(shipped_map_path(name).stat().st_size for name in ALL_MAPS) <= 20e6


def test_the_readme_has_their_sums():
    listed = dict(
        re.findall(
            r"^\| `(\w+)\.npz` \|.*\| `([0-9a-f]{64})` \|$",
            (FOLDER / "README.md").read_text(encoding="utf-8"),
            re.MULTILINE,
        )
    )
    assert listed == {
        name: hashlib.sha256(shipped_map_path(name).read_bytes()).hexdigest() for name in ALL_MAPS
    }


@pytest.mark.thorough
@pytest.mark.parametrize("name", [each for each in ALL_MAPS if each != "able_bodied"])
def test_each_says_what_it_is_and_traps_nobody(name):
    map_ = MobilityMap.load(shipped_map_path(name))
    assert map_.pedestrian_type == name
    metadata = map_.metadata
    assert f"-o {name}.npz" in metadata["command"]
    default = 0.35 if name in WHEELCHAIRS else 0.14
    assert metadata["body"]["core_radius_m"] == BODIES.get(name, default)
    assert metadata.get("preferred_speed_m_s", {}).get("mean") == SPEEDS.get(name)
    if name not in WHEELCHAIRS:
        assert all("NC" not in clip["licence"] for clip in metadata["provenance"])
        assert "EIA-0196217" in " ".join(metadata["acknowledgements"])
    check_ways_back(map_)
    if name not in WHEELCHAIRS:
        assert min(abilities_of(map_)["side_step_m"]) >= 0.14


@pytest.mark.parametrize("name", ALL_MAPS)
def test_each_has_passed_its_examination(name):
    with np.load(shipped_map_path(name)) as arrays:
        metadata = json.loads(arrays["metadata"].tobytes())
    assert metadata["examination"] == {"failed": {}}


def test_the_limps_are_mirror_images():
    one, other = (MobilityMap.load(shipped_map_path(f"limping_{s}")) for s in ("left", "right"))
    assert one.metadata["preparation"]["mirrored"] == "mirror images alone"
    assert other.metadata["preparation"]["mirrored"] == "as recorded"
    # Nearly as many options: cells are not symmetric, as their edges are rounded to one side.
    assert abs(one.n_options / other.n_options - 1.0) < 0.05


@pytest.mark.thorough
@pytest.mark.parametrize("name", WHEELCHAIRS)
def test_maps_of_wheelchairs_are_built_again_to_the_same_bytes(name, tmp_path):
    shipped = MobilityMap.load(shipped_map_path(name))
    command = {"command": shipped.metadata["command"]}
    built = WHEELCHAIRS[name].build(name, command)
    with_verdict(built, {}).save(tmp_path / "again.npz")  # tests/examination says that it passes
    assert (tmp_path / "again.npz").read_bytes() == shipped_map_path(name).read_bytes()


@pytest.mark.captures
@pytest.mark.slow
def test_a_map_of_recordings_is_built_again_to_the_same_bytes(captures_dir, tmp_path):
    from mesa_mobility.capture import find_clips
    from mesa_mobility.mobility import build_families, prepare_recordings

    prepared = prepare_recordings(find_clips(captures_dir), "limping", other_side=True)
    shipped = shipped_map_path("limping_left")
    metadata = {
        "command": MobilityMap.load(shipped).metadata["command"],
        "preparation": prepared.choices,
        "examination": {"failed": {}},
    }
    families = build_families(prepared.recordings, type_name="limping_left", metadata=metadata)
    families.save(tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == shipped.read_bytes()
    assert np.isclose(families.costs.max(), 3.3, atol=0.2)


@pytest.mark.parametrize("up", [True, False])
def test_people_on_stairs_go_as_far_as_a_tread_with_each_step(up):
    map_ = MobilityMap.named(f"able_bodied_{'up' if up else 'down'}")
    derived = map_.metadata["derived"]
    assert (derived["direction"], derived["tread_m"]) == ("up" if up else "down", 0.29)
    # Strides of 0.29 m at 0.6 to 3 steps a second.
    speeds = np.hypot(*map_.end_points.T) / map_.durations * 30.0
    walks = np.repeat(np.arange(map_.n_clusters), np.diff(map_.offsets)) != map_.standing
    assert np.percentile(speeds[walks], 95) <= 1.1 * 3.0 * 0.29
