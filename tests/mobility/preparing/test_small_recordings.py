"""Maps of a minute of recording: one woman, slow, limping and as she walks, acted."""

import numpy as np
import pytest

from mesa_mobility.capture import find_clips
from mesa_mobility.mobility import (
    abilities_of,
    build_map,
    left_out_one_at_a_time,
    prepare_recordings,
)

# Within 15 cm and 20 degrees; the limp of one clip is much quicker than those of the two others.
RECALL = {"limping": 0.88, "slow": 0.915, "control_105": 0.92}

pytestmark = pytest.mark.captures


def prepared(captures_dir, name, **options):
    return prepare_recordings(find_clips(captures_dir), name, **options)


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "mirrored"), [("limping", False), ("slow", True)])
def test_gaits_that_differ_from_side_to_side_are_not_mirrored(captures_dir, name, mirrored):
    found = prepared(captures_dir, name)
    assert len(found.recordings) == (6 if mirrored else 3)
    assert found.choices["mirrored"] == ("both sides" if mirrored else "as recorded")
    assert found.choices["acted_clips"] == 3
    assert found.remarks[0] == "3 of 3 clips are acted"
    assert any("not mirrored" in remark for remark in found.remarks) == (not mirrored)


@pytest.mark.thorough
def test_the_other_side_is_the_mirror_image(captures_dir):
    one = prepared(captures_dir, "limping").recordings
    other = prepared(captures_dir, "limping", other_side=True).recordings
    assert [r.name for r in other] == [f"{r.name}~mirror" for r in one]
    for a, b in zip(one, other, strict=True):
        # The world's x-z plane is the mirror.
        np.testing.assert_allclose(b.root_position, a.root_position * [1, -1, 1], atol=1e-9)


@pytest.mark.thorough
def test_a_minute_of_limping_gives_a_map_without_traps(captures_dir):
    built = build_map(prepared(captures_dir, "limping").recordings, type_name="limping")
    info = built.info()
    assert info["build"]["share_in_component"] >= 0.97
    assert info["options_per_cluster"]["median"] >= 100
    assert info["standing"] == "steps aside and back borrowed from the map 'able_bodied'"
    able = abilities_of(built)
    assert min(able["turn_on_the_spot_deg"]) >= 30
    # Half of the poses move at less than 0.4 m/s.
    assert info["walking_speed_m_s"]["p50"] == pytest.approx(0.4, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["limping", "slow", "control_105"])
def test_clips_left_out_one_at_a_time(captures_dir, name):
    figures = left_out_one_at_a_time(prepared(captures_dir, name).recordings)
    assert figures["share_within_15cm_20deg"] >= RECALL[name]
    assert figures["precision"] >= 0.9
    assert figures["poses"] == sum(clip["poses"] for clip in figures["clips"])
