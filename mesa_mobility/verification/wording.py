"""Names of figures as a reader expects them, with their units."""

from __future__ import annotations

import re

_WHOLE = {
    "overlaps": "overlaps of bodies",
    "wall_crossings": "steps through walls",
    "left inside": "people left inside",
    "error": "run without an error",
    "T_B/T_A": "time with two exits over that with four",
    "T_A s": "time with four exits (s)",
    "T_B s": "time with two exits (s)",
    "flow_in": "flow into the corridor (persons/s)",
    "flow_up": "flow up the stair (persons/s)",
    "fallback time share": "share of the time in the fallback",
    "mean m/s": "mean speed (m/s)",
    "sd m/s": "standard deviation of the speed (m/s)",
    "variance": "variance of the speed ((m/s)²)",
}

_UNITS = {
    "m/s2": "m/s²",
    "m/s": "m/s",
    "per m s": "1/(m s)",
    "1/(m s)": "1/(m s)",
    "per s": "persons/s",
    "1/s": "persons/s",
    "per m2": "persons/m²",
    "1/m2": "persons/m²",
    "m2": "m²",
    "deg": "degrees",
    "Hz": "Hz",
    "sigma": "standard deviations",
    "s": "s",
    "m": "m",
}
"""By the end of a name; longer ends first."""

_PARTS = (
    (re.compile(r"\bKS p\b"), "probability in a Kolmogorov-Smirnov test"),
    (re.compile(r"\bv at\b"), "speed at"),
    (re.compile(r"\bv of\b"), "speed of"),
    (re.compile(r"\bJ at\b"), "specific flow at"),
    (re.compile(r"\bJ of\b"), "specific flow of"),
    (re.compile(r"\bT(\d+)/T0\b"), r"time against \1 people over that against none"),
    (re.compile(r"\bT(\d+)\b"), r"time against \1 people"),
    (re.compile(r"\ba = "), "a goal at "),
    (re.compile(r"([\d.]) ?/m2\b"), r"\1 persons/m²"),
    (re.compile(r"([\d.]) ?/m\b"), r"\1 persons/m"),
    (re.compile(r"\bm2\b"), "m²"),
    (re.compile(r"\brms difference\b"), "root mean square difference"),
    (re.compile(r"\bsd\b"), "standard deviation"),
    (re.compile(r"_"), " "),
)


def figure_words(name: str) -> str:
    """What a figure of a test is called in a report.

    Args:
        name: as verdicts have it, such as "travel time s" or "v at 0.5/m2".

    Returns:
        Words, with the unit in brackets where the name ends with one.
    """
    if name in _WHOLE:
        return _WHOLE[name]
    words, unit = name, ""
    for end, said in _UNITS.items():
        if name.endswith(f" {end}") and not name[: -len(end) - 1].endswith((" at", " of", " per")):
            before = name[: -len(end) - 1]
            # "flow at 1.2 m" has no unit: the metre belongs to the width.
            if not (end == "m" and before[-1:].isdigit()):
                words, unit = before, f" ({said})"
            break
    for pattern, said in _PARTS:
        words = pattern.sub(said, words)
    return words + unit
