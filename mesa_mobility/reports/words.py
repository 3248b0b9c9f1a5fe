"""Names of figures in words, with their units."""

from __future__ import annotations

from collections.abc import Mapping

WORDS = {
    "egress_s": "time until everybody is out (s)",
    "flow_per_s": "mean flow (persons/s)",
    "flow_per_m_s": "specific flow (persons/(m s))",
    "mean_speed_mps": "mean speed, waiting included (m/s)",
    "mean_time_inside_s": "mean time that a person is inside (s)",
    "simulated_s": "simulated time (s)",
    "pedestrians": "number of people",
    "left_inside": "people left inside",
    "blocked": "people who stood for a minute without a reason",
    "t50_s": "time until 50 % of the people are out (s)",
    "t95_s": "time until 95 % of the people are out (s)",
    "t100_s": "time until 100 % of the people are out (s)",
    "first_s": "first passage (s)",
    "last_s": "last passage (s)",
    "people": "people who passed",
    "clear_s": "time when it is empty for good (s)",
    "mean_wait_s": "mean wait (s)",
    "longest_wait_s": "longest wait (s)",
    "mean_ride_s": "mean time in the car (s)",
    "most": "most people at a time",
    "cannot_leave": "people who cannot leave since they do not use stairs",
    "wall_s": "time to compute a run (s)",
    "cpu_s": "processor time of a run (s)",
    "decisions": "decisions taken",
    "fallback_time_share": "share of the time in the fallback movement",
    "fallback_decision_share": "share of the decisions for the fallback movement",
}
"""Of the columns that runs have."""

_PLACES = ("door", "room", "level", "stairs", "lift", "escalator", "refuge")

_INSIDE = {
    "people": "people who were ever there",
    "first_s": "time when the first person has left (s)",
    "last_s": "time when the last person has left (s)",
}

_UNITS = {"_per_m_s": "1/(m s)", "_per_s": "1/s", "_mps": "m/s", "_m2": "m²", "_s": "s", "_m": "m"}
"""By the end of a name; longer ends first."""


def words_of(name: str, labels: Mapping[str, str] | None = None) -> str:
    """The words for a figure in a report, with its unit.

    Args:
        name: of the column, such as ``egress_s`` or ``door.east.flow_per_s``.
        labels: names that somebody has given to columns.

    Returns:
        The name given, or known, or else the column's own without underscores.
    """
    if labels and name in labels:
        return labels[name]
    kind, dot, rest = name.partition(".")
    if dot and kind in _PLACES and "." in rest:
        place, _, figure = rest.rpartition(".")
        known = {} if kind == "door" else _INSIDE
        named = place if kind == "level" else f"“{place}”"
        return f"{kind} {named}: {known.get(figure) or words_of(figure)}"
    if name in WORDS:
        return WORDS[name]
    for end, unit in _UNITS.items():
        if name.endswith(end) and len(name) > len(end):
            return f"{name[: -len(end)].replace('_', ' ')} ({unit})"
    return name.replace("_", " ")


def with_value(label: str, value: str) -> str:
    """A label with its value: "door width 0.8 m" of "door width (m)"."""
    name, bracket, unit = label.removesuffix(")").rpartition(" (")
    return f"{name} {value} {unit}" if bracket and label.endswith(")") else f"{label} {value}"
