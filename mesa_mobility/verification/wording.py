"""Names of figures as a reader expects them, with their units."""

from __future__ import annotations

import re
from typing import Any

from mesa_mobility.distributions import Distribution
from mesa_mobility.reports.words import words_of

_WHOLE = {
    "overlaps": "overlaps of bodies",
    "wall_crossings": "steps through walls",
    "left inside": "people left inside",
    "error": "run without an error",
    "all out s": "time until everybody is out (s)",
    "points outside": "positions outside the floor",
    "T_B/T_A": "time with two exits over that with four",
    "T_A s": "time with four exits (s)",
    "T_B s": "time with two exits (s)",
    "flow_in": "flow into the corridor (persons/s)",
    "flow_up": "flow up the stair (persons/s)",
    "fallback time share": "share of the time in the fallback movement",
    "greatest fallback share": "greatest share of the time in the fallback movement",
    "least y m": "least y of the way (m)",
    "greatest y m": "greatest y of the way (m)",
    "mean m/s": "mean speed (m/s)",
    "sd m/s": "standard deviation of the speed (m/s)",
    "variance": "variance of the speed ((m/s)²)",
}

_UNITS = {
    "m/s2": "m/s²",
    "m/s": "m/s",
    "per m s": "persons/(m s)",
    "1/(m s)": "persons/(m s)",
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

_UNITS_AT = (
    (re.compile(r"\bspecific flow (?:at|of)\b"), "persons/(m s)"),
    (re.compile(r"\bflow (?:at|of) [\d.]+ m$"), "persons/s"),
    (re.compile(r"\bdensity in front at\b"), "persons/m²"),
    (re.compile(r"\bspeed at [\d.]+ persons/m"), "m/s"),
)
"""Units of figures whose names end with where they were taken."""

_NUMBERS = {
    "assigned": "assigned to the {} exit",
    "capacity": "a car for {} people",
    "car": "car at level {} at first",
    "density": "density {} persons/m²",
    "door_s": "doors that open in {} s",
    "exits": "{} exits",
    "going": "stairs of {} m in plan",
    "high": "greatest preferred speed {} m/s",
    "length": "length {} m",
    "low": "least preferred speed {} m/s",
    "mean": "mean speed {} m/s",
    "measure_s": "measured for {} s",
    "measured_from": "measured from x = {} m",
    "measured_to": "measured to x = {} m",
    "oldest": "oldest {} years",
    "opposing": "{} people in the other direction",
    "people": "{} people",
    "preferred": "preferred speed on a level floor {} m/s",
    "riser": "risers of {} m",
    "risers": "{} risers",
    "sd": "standard deviation of the speed {} m/s",
    "settle_s": "measured after {} s",
    "speed": "speed {} m/s",
    "start": "from level {}",
    "start_x": "people from x = {} m on",
    "times": "pre-movement times in s: {}",
    "tread": "treads of {} m",
    "trials": "{} trials",
    "width": "width {} m",
    "youngest": "youngest {} years",
}
"""What the numbers of a case are, with their units."""

_EITHER = {
    "closed": ("first stairs open", "first stairs closed"),
    "impaired": ("nobody impaired", "one person slow and larger"),
    "knows": ("without the knowledge", "with the knowledge"),
    "other": ("alone", "with a second person"),
    "screen": ("without a screen", "with a screen before the near exit"),
    "slow": ("nowhere slower", "the last 6 m at half speed"),
    "together": ("as single people", "as a group"),
    "up": ("down", "up"),
}
"""What a case is without and with something."""


def number_words(name: str, value: Any) -> str:
    """One number of a case as a reader expects it, with its unit.

    Args:
        name: of the number.
        value: its value.
    """
    if isinstance(value, bool) and name in _EITHER:
        return _EITHER[name][value]
    if name == "goal":
        # Of lifts it is a level, of necks a distance.
        return f"to level {value}" if isinstance(value, int) else f"goal {value:g} m behind"
    said = f"{value:.4g}" if isinstance(value, float) else str(value)
    if isinstance(value, Distribution):
        kind, _, settings = repr(value).rstrip(")").partition("(")
        said = f"{kind.lower()} ({settings.replace('=', ' ')})"
    return _NUMBERS[name].format(said) if name in _NUMBERS else f"{words_of(name)} {said}"


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
    if not unit:
        unit = next((f" ({said})" for at, said in _UNITS_AT if at.search(words)), "")
    return words + unit
