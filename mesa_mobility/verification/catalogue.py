"""The catalogue of tests: criteria and their sources."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import did_you_mean
from mesa_mobility.verification.suite import VerificationTest


@dataclass(frozen=True)
class Entry:
    """One test of the catalogue.

    Attributes:
        id: its name.
        what: its subject, in one line.
        source: the standards and the numbers of the test in them.
        read: where its numbers were read, by the names of `readings`.
        applies: "flat", "stairs", "lifts", or "flat*" for a stand-in on a level floor.
        geometry: floor, start and exits, in words.
        population: people.
        criterion: the requirement, as text.
        criterion_strict: its limit as a number, if there is one.
        chosen: choices where the source leaves something open, and why.
        cap: why a figure of the criterion is a design limit that need not be met.
    """

    id: str
    what: str
    source: str
    applies: str
    geometry: str
    population: str
    criterion: str
    criterion_strict: str = ""
    chosen: str = ""
    cap: str = ""
    read: tuple[str, ...] = ()

    @property
    def asked(self) -> str:
        """Criterion and its number."""
        return "; strictly: ".join(text for text in (self.criterion, self.criterion_strict) if text)


@cache
def catalogue() -> dict[str, Entry]:
    """All tests by id, in the order of the standards."""
    tests = _content()["test"]
    return {each["id"]: Entry(**{**each, "read": tuple(each.get("read", ()))}) for each in tests}


def standards() -> dict[str, str]:
    """Title of each standard, by its short name."""
    return dict(_content()["standards"])


def readings() -> dict[str, str]:
    """Where numbers of tests were read, by the names that entries have."""
    return dict(_content()["readings"])


@cache
def _content() -> dict[str, Any]:
    text = files("mesa_mobility.verification").joinpath("data/catalogue.toml").read_text("utf-8")
    return tomllib.loads(text)


def suite(ids: Sequence[str] = ()) -> dict[str, VerificationTest]:
    """Tests by id, in the catalogue's order; all of them where none is named.

    Raises:
        ModelError: an unknown id.
    """
    from mesa_mobility.verification import imo, iso, nist, rimea, storeys

    known = {**rimea.TESTS, **storeys.TESTS, **imo.TESTS, **nist.TESTS, **iso.TESTS}
    for name in ids:
        if name not in known:
            raise ModelError(
                f"unknown test {name!r}{did_you_mean(name, known)}; "
                f"there are {', '.join(n for n in catalogue() if n in known)}"
            )
    wanted = set(ids) or set(known)
    return {name: known[name] for name in catalogue() if name in wanted}
