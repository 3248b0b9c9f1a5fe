"""Files whose content is changed and whose checksums fit: refused in one line, or sound.

``python -m tests.fixtures.damage.tampering FOLDER FIRST_SEED COUNT`` goes through as many as
one likes.
"""

import functools

import numpy as np
import pytest

from tests.fixtures.damage import tampering
from tests.fixtures.damage.contents import ArchiveContents

QUICK = ("bank by_hand", "decisions by_hand", "map strider")


def check(outcome):
    assert "crash" not in outcome, outcome
    assert outcome["traceback"] == outcome["fault"] == "", outcome
    assert "\n" not in outcome["error"] + outcome["late"], outcome
    assert len(outcome["error"]) < 1000, outcome
    assert outcome["megabytes"] < 500, outcome


@pytest.mark.parametrize("kind", QUICK)
def test_tampered_files(tmp_path, kind):
    contents, read, _, _ = tampering.prepare(kind, tmp_path)
    refused = 0
    for seed in range(20):
        contents.mangled(tmp_path / "f", np.random.default_rng([seed, 99]))
        outcome = tampering.judge(tmp_path / "f", read, lambda found: "")
        check(outcome)
        refused += outcome["error"] != ""
    assert refused >= 5


def test_tampered_checkpoints(tmp_path):
    from mesa_mobility import PedestrianModel
    from tests.fixtures.maps import wanderer
    from tests.fixtures.scenes import advance, corridor

    map_ = wanderer(5, options=20)
    model = PedestrianModel(corridor(), mobility_map=map_, rng=1, record=True)
    model.add_pedestrians([(1.0, 1.0), (2.0, 2.0), (4.0, 3.0)], group="friends")
    advance(model, 20)
    model.save(tmp_path / "sound")
    contents = ArchiveContents(tmp_path / "sound")
    load = functools.partial(PedestrianModel.load, mobility_map=map_)
    refused = 0
    for seed in range(30):
        contents.mangled(tmp_path / "f", np.random.default_rng([seed, 98]))
        outcome = tampering.judge(tmp_path / "f", load, lambda found: advance(found, 15) or "")
        check(outcome)
        refused += outcome["error"] != ""
    assert refused >= 10


@pytest.mark.slow
def test_thousands_of_tampered_files(tmp_path):
    refused = 0
    for outcome in tampering.outcomes(tampering.KINDS, range(1000, 1500), tmp_path):
        check(outcome)
        refused += outcome["error"] != ""
    assert refused > 2000
