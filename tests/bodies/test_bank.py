from contextlib import suppress

import numpy as np
import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.bodies.bankfile import poses_path, shipped_banks
from mesa_mobility.bodies.skeleton import JOINT, TURN_OF
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import MobilityMap, shipped_map_path
from tests.bodies.conftest import make_bank
from tests.fixtures.maps import shipped_map

LEFT, RIGHT = (TURN_OF[JOINT[f"{side}_elbow"]] for side in ("left", "right"))


def test_the_bank_that_ships_belongs_to_the_map_that_ships():
    mobility_map = shipped_map()
    bank = PoseBank.of(mobility_map.digest)
    assert bank.n_options == mobility_map.n_options
    assert len(bank.rotations) == 11_989
    assert len(bank.metadata["clips"]) == 92
    assert all(clip["sha256"] and clip["licence"] for clip in bank.metadata["clips"])
    # At most three transitions; the frames of stretches lie within their option.
    counts = np.diff(bank.offsets)
    assert (counts.min(), counts.max()) == (1, 3)
    last = bank.frames[bank.offsets[1:] - 1]
    assert (last <= mobility_map.durations).all()


def test_banks_that_ship_are_small_and_come_with_their_licences():
    banks = shipped_banks()
    assert sum(path.stat().st_size for path in banks) < 15e6
    for path in banks:
        bank = PoseBank.load(path)
        assert bank.pedestrian_type == path.name.removesuffix(".poses.npz")
        assert all(clip["sha256"] and clip["licence"] for clip in bank.metadata["clips"])


@pytest.mark.thorough
@pytest.mark.parametrize("path", shipped_banks(), ids=lambda path: path.name)
def test_each_bank_that_ships_belongs_to_its_map(path):
    mobility_map = MobilityMap.load(shipped_map_path(path.name.removesuffix(".poses.npz")))
    bank = PoseBank.load(path)
    bank.check_map(mobility_map.digest)
    assert bank.n_options == mobility_map.n_options
    assert len(bank.cluster_poses) == mobility_map.n_clusters
    # Lengths of a child are 1.25 / 1.75 of an adult's.
    if bank.pedestrian_type == "child":
        assert bank.scale == pytest.approx(1.25 / 1.75, abs=1e-4)


def test_a_saved_bank_reads_back_unchanged_and_in_the_same_bytes(bank, tmp_path):
    one, two = tmp_path / "one.poses.npz", tmp_path / "two.poses.npz"
    bank.save(one)
    again = PoseBank.load(one)
    again.save(two)
    assert one.read_bytes() == two.read_bytes()
    for name in ("rotations", "heights", "contacts", "clips", "offsets", "frames", "poses"):
        np.testing.assert_array_equal(getattr(again, name), getattr(bank, name))


def test_a_mirrored_pose_bends_the_other_arm(bank):
    turns = bank.turns(np.array([2, 3]))  # row 1, as recorded and mirrored: 10 degrees
    bent = [np.rad2deg(np.arccos((np.trace(t) - 1) / 2)) for t in (turns[0, LEFT], turns[1, RIGHT])]
    np.testing.assert_allclose(bent, 10.0, atol=0.01)
    np.testing.assert_allclose(turns[0, RIGHT], np.eye(3), atol=1e-4)
    np.testing.assert_allclose(turns[1, LEFT], np.eye(3), atol=1e-4)
    # Bending forward stays bending forward.
    np.testing.assert_allclose(turns[0, LEFT], turns[1, RIGHT], atol=1e-9)
    assert bank.bearing(np.array([2, 3])).tolist() == [
        [True, True, False, False],
        [False, False, True, True],
    ]


def test_later_poses_stay_within_their_clip(bank):
    assert bank.later(np.array([0, 1, 4]), np.array([1, 9, 9])).tolist() == [2, 3, 6]
    assert bank.source_of(5) == ("two", 0, True)


def test_poses_stand_beside_their_map():
    assert poses_path("maps/limping.npz").name == "limping.poses.npz"


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"heights": np.zeros(3, np.int16)}, "heights"),
        ({"poses": np.array([0, 0, 99], np.int32)}, "poses"),
        ({"strides": np.full((2, 1), 100, np.uint8)}, "'strides': shape"),
        ({"strides": np.array(100, np.uint8)}, "'strides': shape"),
        ({"frames": np.array([1, 0, 1], np.int16)}, "frames"),
        ({"rotations": np.zeros((4, 17, 4), np.int16)}, "rotations"),
        ({"metadata": {}}, "map_digest"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(changes, what):
    with pytest.raises(MapError, match=what):
        make_bank(**changes)


def test_damaged_files_give_one_line(bank, tmp_path):
    path = tmp_path / "bad.poses.npz"
    bank.save(path)
    content = path.read_bytes()
    rng = np.random.default_rng(1)
    for place in rng.integers(0, len(content), 60):
        spoilt = bytearray(content)
        spoilt[place] ^= 0xFF
        path.write_bytes(bytes(spoilt))
        with suppress(MapError):  # anything else would be a fault of the reader
            PoseBank.load(path)
    path.write_bytes(content[:100])
    with pytest.raises(MapError, match=r"bad\.poses\.npz"):
        PoseBank.load(path)


def test_poses_of_another_map_are_refused(bank, tmp_path):
    path = tmp_path / "own.poses.npz"
    bank.save(path)
    assert PoseBank.of("abc", path).n_options == 2
    with pytest.raises(MapError, match="expected those of the map"):
        PoseBank.of("other", path)
    with pytest.raises(MapError, match="map poses"):
        PoseBank.of("unknown")
