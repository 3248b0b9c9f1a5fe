"""`mesa-mobility map build --poses` and `map poses`."""

import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.mobility import MobilityMap


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("kept", "side"), [("stored", "--no-mirror"), ("distribution", "--other-side")]
)
def test_poses_of_a_built_map_are_those_of_its_file(command, recordings, tmp_path, kept, side):
    path, later = tmp_path / "a.npz", tmp_path / "later.poses.npz"
    build = ("map", "build", recordings, "-o", path, "--clusters", 12, "--options", kept)
    outcome = command(*build, side, "--poses")
    assert outcome.status == 0, outcome.err
    bank = PoseBank.load(tmp_path / "a.poses.npz")
    bank.check_map(MobilityMap.load(path).digest)
    assert bank.n_options == MobilityMap.load(path).n_options
    # Two clips of 270 frames.
    assert len(bank.rotations) == 2 * 270
    outcome = command("map", "poses", path, recordings, "-o", later)
    assert outcome.status == 0, outcome.err
    assert later.read_bytes() == (tmp_path / "a.poses.npz").read_bytes()
