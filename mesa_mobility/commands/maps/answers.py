"""What `mesa-mobility map` says: progress, clips that are not used, what is in a map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mesa_mobility.commands.console import Report, answer_json, answer_table, say

if TYPE_CHECKING:
    from mesa_mobility.capture import LoadedClips
    from mesa_mobility.mobility import MobilityMap


def say_clips(loaded: LoadedClips) -> None:
    """Which clips are skipped or split, and why."""
    for clip, reason in loaded.skipped:
        say(f"skipped {clip}: {reason}")
    for clip, reason in loaded.split:
        say(f"split {clip}: {reason}")


def examine_map(
    map_: MobilityMap, report: Report, left_out: dict[str, Any] | None = None
) -> tuple[MobilityMap, dict[str, Any]]:
    """Examine a map; what fails goes to standard error.

    Args:
        map_: the map.
        report: of progress.
        left_out: how well clips left out are covered, if that was measured.

    Returns:
        A copy of the map that says what it has failed; what was measured, and ``warnings``, to be
        said. A map with which no model can be made stays as it is.
    """
    from mesa_mobility.errors import MobilityError
    from mesa_mobility.examination.examining import examine, with_findings

    try:
        found = examine(map_, left_out, report)
    except MobilityError as error:
        say(f"warning: the map cannot be examined: {error}")
        return map_, {"examination": {}, "warnings": [f"the map cannot be examined: {error}"]}
    failed = [each for each in found if not each.passed]
    for each in failed:
        say(f"warning: {each.warning}")
    said = {
        "examination": {each.test: each.answer() for each in found},
        "warnings": [each.warning for each in failed],
    }
    return with_findings(map_, found), said


def described(map_: MobilityMap) -> dict[str, Any]:
    """What is in a map and what its options let people do; what is borrowed, on standard error."""
    from mesa_mobility.mobility import abilities_of

    standing = map_.metadata.get("standing", "recorded")
    if standing != "recorded":
        say(standing)
    return {**map_.info(), "abilities": abilities_of(map_)}


def answer(values: dict[str, Any], *, as_json: bool) -> None:
    """The answer of a command, as JSON or as a table."""
    if as_json:
        answer_json(values)
    else:
        answer_table(_lines(values))


def _lines(values: dict[str, Any], prefix: str = "") -> dict[str, str]:
    lines: dict[str, str] = {}
    for name, value in values.items():
        label = f"{prefix}{name}".replace("_", " ")
        if isinstance(value, dict):
            lines |= _lines(value, f"{label}: ")
        elif isinstance(value, list) and not all(isinstance(each, int | float) for each in value):
            lines[label] = f"{len(value)} entries, see --json"
        else:
            values_here = value if isinstance(value, list) else [value]
            lines[label] = ", ".join(_text(each) for each in values_here) or "none"
    return lines


def _text(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
