"""All tests of a map, one after the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mesa_mobility.examination.crowds import crowd
from mesa_mobility.examination.finding import Finding
from mesa_mobility.examination.gaits import slowly, stop
from mesa_mobility.examination.subject import Subject
from mesa_mobility.examination.ways import corner, door, turn
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.judging.verdict import failed_tests, with_verdict

COVERAGE, SHARE = "coverage", "share_within_15cm_20deg"
"""The test that no model is needed for, and its figure."""

COVERED = 0.8
"""Least share of poses of clips left out that a map predicts within 15 cm and 20 degrees. Maps that
ship have 0.84 (crutches) to 0.96 (able-bodied); six clips of a man who carries a box have 0.65, and
37 clips of runners 0.52."""

TESTS = (door, corner, turn, stop, slowly, crowd)


def examine(
    map_: MobilityMap,
    left_out: Mapping[str, Any] | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> tuple[Finding, ...]:
    """Walk people of a map through all tests.

    Args:
        map_: the map.
        left_out: how well a map of some recordings covers the others, as ``coverage`` returns it;
            None if that has not been measured now.
        progress: called as ``progress(stage, tests done, tests)``.

    Returns:
        A finding for each test. The one of the coverage is there only if the coverage is known:
        from ``left_out``, or from the metadata of a map that has failed this test before. It
        cannot be measured without the recordings.

    Raises:
        MobilityError: no model can be made with the map.
    """
    subject, found = Subject.of(map_), []
    for done, test in enumerate(TESTS):
        if progress is not None:
            progress("examining", done, len(TESTS))
        found.append(test(subject))
    known = left_out if left_out is not None else (failed_tests(map_) or {}).get(COVERAGE)
    return (*found, *_coverage(known))


def examined(map_: MobilityMap, left_out: Mapping[str, Any] | None = None) -> MobilityMap:
    """Examine a map, and return a copy whose metadata say which tests the map has failed.

    Args:
        map_: the map, which is not changed.
        left_out: as for ``examine``.

    Raises:
        MobilityError: no model can be made with the map.
    """
    return with_findings(map_, examine(map_, left_out))


def with_findings(map_: MobilityMap, found: Sequence[Finding]) -> MobilityMap:
    """A copy of a map whose metadata say which of these tests it has failed."""
    return with_verdict(map_, {each.test: each.measured for each in found if not each.passed})


def _coverage(left_out: Any) -> list[Finding]:
    """How well clips that were left out are predicted, if that is known."""
    said = left_out if isinstance(left_out, Mapping) else {}
    share, poses = said.get(SHARE), said.get("poses")
    if not isinstance(share, float) or not isinstance(poses, int):
        return []
    return [
        Finding(
            COVERAGE,
            "an option within 15 cm and 20 degrees of where people of clips left out were 1.5 s "
            "later",
            {"poses": poses, SHARE: round(share, 3)},
            f"a share of {COVERED:g} or more",
            share >= COVERED,
            "add more recordings of each kind of movement, by more people",
        )
    ]
