"""`mesa-mobility map build --poses` and `map poses`."""

import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.mobility import MobilityMap


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("kept", "choices", "frames"),
    [
        ("stored", ("--no-mirror",), 270),
        ("distribution", ("--other-side", "--name", "other"), 270),
        # Times x 118 / 121: 269 intervals become 262.
        ("distribution", ("--derive", "older_adult"), 263),
    ],
)
def test_poses_of_a_built_map_are_those_of_its_file(
    command, recordings, tmp_path, kept, choices, frames
):
    path, later = tmp_path / "a.npz", tmp_path / "later.poses.npz"
    build = ("map", "build", recordings, "-o", path, "--clusters", 12, "--options", kept)
    outcome = command(*build, *choices, "--poses")
    assert outcome.status == 0, outcome.err
    bank = PoseBank.load(tmp_path / "a.poses.npz")
    bank.check_map(MobilityMap.load(path).digest)
    assert bank.n_options == MobilityMap.load(path).n_options
    assert len(bank.rotations) == 2 * frames
    outcome = command("map", "poses", path, recordings, "-o", later)
    assert outcome.status == 0, outcome.err
    assert later.read_bytes() == (tmp_path / "a.poses.npz").read_bytes()
