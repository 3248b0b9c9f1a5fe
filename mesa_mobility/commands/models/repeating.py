"""Running a saved run again, as far as one decision, and making sure that it is the same run."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.commands.models.making import ModelOptions, create_model, origin_of
from mesa_mobility.crowd import Explanation, PedestrianModel, Watch
from mesa_mobility.crowd.model_files import find_model
from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.plugins.parameters import parameters
from mesa_mobility.results import Trajectories
from mesa_mobility.results.run import Run

if TYPE_CHECKING:
    from mesa_mobility.results.decisions import Decisions

_NEEDED = ("model", "preset", "seed", "parameters", "maps")
"""Entries that a run's summary must have to repeat the run."""


@dataclass(eq=False)
class _WatchOne(Watch):
    """Keeps the decision of one frame, even if others follow in the same step.

    Attributes:
        frame: of the decision.
        kept: the decision, once it has been taken.
    """

    frame: int
    kept: Explanation | None = None

    def commits(self, crowd: Any, first_option: Any) -> None:
        """Keep the decision if it is the one."""
        super().commits(crowd, first_option)
        if self.decision is not None and self.decision.frame == self.frame:
            self.kept = self.decision


def decision_frame(trajectories: Trajectories, person: int, seconds: float) -> int:
    """Frame of the decision that a person follows ``seconds`` after the start of the run.

    Raises:
        ResultsError: decisions were not recorded, the person has taken none, or the time is before
            their first decision or after their last frame.
    """
    decisions = _recorded(trajectories)
    rows = decisions.rows_of(person)
    if not len(rows):
        people = np.unique(decisions.person)
        raise ResultsError(
            f"person {person}: has taken no decision, expected one of the {len(people)} who have"
        )
    frames = decisions.frame[rows]
    first = int(frames[0])
    last = int(trajectories.frame[trajectories.person == person].max())
    frame, rate = seconds * trajectories.frame_rate, trajectories.frame_rate
    if not first - 1e-6 <= frame <= last + 1e-6:
        raise ResultsError(
            f"person {person}: moves from {first / rate:.2f} to {last / rate:.2f} s, got a time of "
            f"{seconds:g} s"
        )
    # A time as it is printed counts for its frame.
    return int(frames[frames <= frame + 0.2][-1])


def repeat_decision(
    found: Run,
    name: Path,
    person: int,
    frame: int,
    *,
    map_file: Path | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> tuple[PedestrianModel, Explanation]:
    """The decision that somebody took in a frame of a saved run, which is run again up to it.

    Args:
        found: the run, with its decisions.
        name: folder of the run, for errors.
        person: number of the person.
        frame: of the decision.
        map_file: the mobility map that the run used, if it was not the model's own.
        progress: called with the share of the frames that have been run.

    Returns:
        The model, just after that decision, and the decision with all its options.

    Raises:
        ResultsError: the summary lacks an entry that is needed, or the run does not repeat itself:
            other maps, other decisions or other positions up to this frame.
        ModelError: there is no such model or behaviour any more.
    """
    from mesa_mobility.results.decisions import Decisions

    model = _make(found.summary, name, map_file)
    decisions = _recorded(found.trajectories)
    here = Decisions.of(model)
    if (here.maps, here.stairs) != (decisions.maps, decisions.stairs):
        raise ResultsError(
            f"{name}: its decisions were taken with other mobility maps, expected those of the run"
        )
    watch = model.watch = _WatchOne(person, frame)
    model.running = True
    while model.running and model.frame <= frame:
        model.step()
        progress(min(model.frame / max(frame, 1), 1.0))
    _compare(found, name, Trajectories.of(model), frame)
    if watch.kept is None:
        raise ResultsError(f"{name}: {_other(found.summary)}: person {person} decides elsewhen")
    return model, watch.kept


def _make(summary: Mapping[str, Any], name: Path, map_file: Path | None) -> PedestrianModel:
    """The model of a summary, as it was at the start."""
    missing = [key for key in _NEEDED if key not in summary]
    if missing:
        raise ResultsError(
            f"{name / 'summary.json'}: lacks {', '.join(missing)}, expected a run of this version"
        )
    kind = find_model(str(summary["model"]))
    options = ModelOptions(
        seed=summary["seed"],
        settings=[f"{key}={value}" for key, value in summary.get("set", {}).items()],
        behaviors=summary.get("behaviors"),
        preset=summary["preset"] if "preset" in parameters(kind) else None,
        map_file=map_file,
    )
    model, given = create_model(
        kind,
        str(summary["model"]),
        options,
        record="decisions",
        **_parameters(kind, summary["parameters"]),
    )
    if not isinstance(model, PedestrianModel):
        raise ModelError(f"model {summary['model']}: expected a subclass of PedestrianModel")
    now = origin_of(given, model)
    if now["preset_sha256"] != summary.get("preset_sha256", now["preset_sha256"]):
        raise ResultsError(
            f"{name}: the run used the preset {summary['preset']} with sha256 "
            f"{str(summary['preset_sha256'])[:12]}..., here it is {now['preset_sha256'][:12]}..."
        )
    here = now["maps"]
    for kind_name, was in summary["maps"].items():
        there = here.get(kind_name, {})
        if there.get("sha256") != was["sha256"]:
            raise ResultsError(
                f"{name}: people of type {kind_name!r} used {was['file']} (sha256 "
                f"{str(was['sha256'])[:12]}...), here it is {there.get('file')} "
                f"({str(there.get('sha256'))[:12]}...); --map gives another"
            )
    return model


def _parameters(kind: type, values: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of a constructor, of which a summary has numbers as they are and all else as
    texts; those that are as by default are left out."""
    taken, arguments = parameters(kind), {}
    for key, value in values.items():
        known = taken.get(key)
        if known is not None and (known.default == value or str(known.default) == value):
            continue
        if known is not None and isinstance(value, str):
            try:
                value = known.convert(value)
            except ModelError:
                # Distributions name their numbers where they are printed.
                value = known.convert(re.sub(r"\b\w+=", "", value))
        arguments[key] = value
    return arguments


def _compare(found: Run, name: Path, again: Trajectories, frame: int) -> None:
    """Raise ResultsError unless two runs are the same up to a frame, to the last bit."""
    was, now = _recorded(found.trajectories), _recorded(again)
    earlier, later = was.frame <= frame, now.frame <= frame
    for column in ("frame", "person", "type_index", "option", "share"):
        one, other = getattr(was, column)[earlier], getattr(now, column)[later]
        if one.tobytes() != other.tobytes():
            raise ResultsError(f"{name}: {_other(found.summary)}: other decisions were taken")
    rows = found.trajectories.frame <= frame, again.frame <= frame
    for column in ("frame", "person", "x", "y", "heading"):
        one, other = (
            getattr(each, column)[own]
            for each, own in zip((found.trajectories, again), rows, strict=True)
        )
        if one.tobytes() != other.tobytes():
            raise ResultsError(f"{name}: {_other(found.summary)}: people are elsewhere")


def _other(summary: Mapping[str, Any]) -> str:
    """Text that says that a run does not repeat itself, and which versions differ."""
    here = origin_of({}, None)
    was = {"mesa_mobility": summary.get("mesa_mobility"), **summary.get("versions", {})}
    now = {"mesa_mobility": here["mesa_mobility"], **here["versions"]}
    differ = [f"{key} {was[key]}, here {now[key]}" for key in was if was[key] != now.get(key)]
    return "the run does not repeat itself" + (f" ({'; '.join(differ)})" if differ else "")


def _recorded(trajectories: Trajectories) -> Decisions:
    """The decisions.

    Raises:
        ResultsError: they were not recorded.
    """
    if trajectories.decisions is None:
        raise ResultsError(
            "the run has no decisions, expected one of `mesa-mobility run --record decisions`"
        )
    return trajectories.decisions
