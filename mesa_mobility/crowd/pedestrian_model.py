"""The Mesa model of pedestrians on a floor plan."""

from __future__ import annotations

import os
from collections.abc import Iterable
from copy import deepcopy
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility import _mesa  # noqa: F401 - early, as in precompile.py
from mesa_mobility.crowd.checkpoint.snapshot import load_model, save_model
from mesa_mobility.crowd.hooks import Plugin, check_behaviours
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.model import adding, filling
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.crowd.model.parameters import parameters, rules_used, set_parameters
from mesa_mobility.crowd.model.questions import blocked_by, decided, explain, under_way
from mesa_mobility.crowd.model.replaying import replay
from mesa_mobility.crowd.model.reporters import add_agent_reporter, add_reporter
from mesa_mobility.crowd.model.summary import summary
from mesa_mobility.crowd.people.pedestrian import last_number, number_from
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.occupants import add_occupants


class PedestrianModel(CrowdModel):
    """Pedestrians on a floor plan, driven by recorded movement.

    Concrete models build a floor plan, call this constructor and then
    ``add_pedestrians``.

    Args:
        floor_plan: where people walk, a ``FloorPlan`` or a ``Building``. A building is drawn as
            several sheets side by side in one plane, and positions are coordinates in that plane:
            see its ``places`` and ``true_places``.
        preset: "default", "paper", a TOML file, or rules of one's own.
        mobility_map: a mobility map or its file; by default the able-bodied map that ships.
            Everybody then has the same type, with the map's preferred speeds.
        pedestrian_types: the types of pedestrians, instead of ``mobility_map``.
        population: the shares of types that people are drawn from, instead of ``mobility_map`` and
            ``pedestrian_types``: a ``Population``, shares by type, or a text such as "mixed" (see
            ``Population.of``).
        behaviors: cost terms instead of the preset's.
        target_choice: where people go; by default everybody leaves by the nearest exit.
        pedestrian_class: class of the agents, ``Pedestrian`` or one derived from it.
        fields: further numbers that each person has: the type (bool, int or float) of each, by
            name. Agents, behaviours and results see them.
        frames_per_step: frames that one ``step()`` advances; 3 are 0.1 s.
        record: keep every frame in ``recorder``; "decisions" also keeps in ``decisions`` who has
            taken which option. The animation needs these to show bodies.
        rng: seed, also as text, or NumPy generator.

    Attributes:
        preset: name of the preset.
        rules: the preset, with the numbers that were given to the model.
        numbers: where the numbers of its behaviours come from; see ``parameters``.
        floor_plan: the floor plan; for a building, one plan with all of its sheets.
        building: the building, if it has several levels, otherwise None.
        space: Mesa's continuous space with everybody inside.
        crowd: the crowd's arrays; see ``Crowd``.
        population: who has come and who is inside; see ``Population``.
        statistics: the figures of the run so far; see ``Statistics``.
        dynamics: what happens in each frame; see ``Dynamics``.
        sources: an ``Inflow`` for each ``add_source``.
        doors: a ``DoorControl`` for each ``add_door``.
        journeys: the routes of people who cross gates and visit places in order.
        speed_rules: behaviours that change preferred speeds; the preset's rule for groups is added
            with the first group. May be changed at run time.
        tactics: the steps from a target to what people want of their next movement, in order; may
            be removed, replaced and added to at run time.
        terms: the cost terms; may be added to, removed and re-weighted at run time.
        frame: frames since the start.
        elapsed: simulated seconds since the start.
        inside: number of people inside.
        time: Mesa's clock, seconds. After a step it equals ``elapsed``; while an event of Mesa runs
            between two steps, it is the event's time.
        blocked: people who have stood for a minute although they want to move, without a reason: a
            ``person``, ``since`` when, and the ``ring`` of people that they belong to.
        stalled: whether the run has stalled. It stalls if for a minute nobody has left and people
            have come no nearer to an exit (on average), or if everybody who wants to move is in
            ``blocked``. ``stall_reason`` says why. ``go_on`` and ``run`` wait another minute.
        watch: set to a ``Watch`` to keep the decisions of one pedestrian as they are taken.
        events_at_first: events that Mesa itself has scheduled.
        framework_attributes: names of the attributes that this class has made.
        datacollector: time, people inside, mean speed and fallback share after each step.

    Raises:
        ModelError: an unknown preset or a parameter out of range.
        MapError: an unusable map file.

    Examples:
        >>> from mesa_mobility import Exit, FloorPlan, PedestrianModel
        >>> plan = FloorPlan(
        ...     "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))", exits=[Exit("door", (6, 1.5), (6, 2.5))]
        ... )
        >>> model = PedestrianModel(plan, rng=1)
        >>> people = model.add_pedestrians([(1.0, 2.0), (2.0, 1.0)], preferred_speeds=1.2)
        >>> model.step()
        >>> model.inside, round(model.elapsed, 3)
        (2, 0.1)
        >>> model.run(max_seconds=30)
        >>> model.inside
        0
    """

    # Functions of a model are methods as they are.
    add_pedestrians = adding.add_pedestrians
    add_source = adding.add_source
    add_door = adding.add_door
    fill = filling.fill
    fill_as = filling.fill_as
    replay = replay
    add_reporter = add_reporter
    add_agent_reporter = add_agent_reporter
    blocked_by = blocked_by
    decided = decided
    explain = explain
    parameters = parameters
    rules_used = rules_used
    set_parameters = set_parameters
    under_way = under_way
    save = save_model
    summary = summary

    def person_data(self) -> dict[str, ArrayLike]:
        """Further data of each person for trajectories, by name; models may add to them.

        Returns:
            (n,) ``type`` and ``group``, names, of everybody who has ever been in the model, by row.
            The group is an empty text for people without one. Where a type's core radii are drawn
            from a distribution, ``core_radius``, metres, as well.
        """
        crowd, count = self.crowd, self.population.count
        types = np.array([kind.name for kind in self.pedestrian_types])
        groups = np.array(["", *map(str, self.population.groups)])
        data: dict[str, ArrayLike] = {
            "type": types[crowd.type_index[:count]],
            "group": groups[crowd.agenda["group"][:count]],
        }
        if any(isinstance(kind.core_radius, Distribution) for kind in self.pedestrian_types):
            data["core_radius"] = self.core_radii
        return data

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """An independent copy that continues exactly as the model would.

        Both share the mobility map and compiled code, which neither changes.

        Args:
            memo: copies made so far, as for ``copy.deepcopy``.
        """
        copied = type(self).__new__(type(self))
        memo[id(self)] = copied
        # Its agents go into registers that use their model's number.
        number_from(copied, last_number(self))
        for name, value in vars(self).items():
            copied.__dict__[name] = value if name == "made_with" else deepcopy(value, memo)
        add_occupants(copied.floor_plan, copied.population)
        return copied

    def __reduce_ex__(self, protocol: Any) -> Any:
        """Raise ModelError: a model holds what no pickle can, such as compiled code."""
        raise ModelError(
            f"{type(self).__name__}: a model can be copied by copy.deepcopy, neither by copy.copy "
            "nor by pickle; expected its parameters and seed, which make it anew"
        )

    def draw_types(self, n: int) -> NDArray[np.int64]:
        """(n,) indices of types, drawn from the model's population; 0 where it has none.

        For models that place people by type; ``add_pedestrians`` draws by itself.
        """
        return Newcomers(population=self._scene.shares).draw_types(
            n, self.pedestrian_types, self.rng
        )

    def add_tactic(self, tactic: Tactic) -> None:
        """Add a tactic behind the one that it names in ``after``, or else at the end.

        Raises:
            ModelError: ``tactic`` is no tactic, for instance a class and not an object.
        """
        check_behaviours("add_tactic", [tactic], Tactic)
        names = [each.name for each in self.tactics]
        at = names.index(tactic.after) + 1 if tactic.after in names else len(names)
        self.tactics.insert(at, tactic)

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], *, plugins: Iterable[Plugin] = (), **arguments: Any
    ) -> Self:
        """The model of a checkpoint, in this process or another.

        Args:
            path: the file.
            plugins: behaviours that the model had, and that are neither installed nor made by its
                constructor.
            arguments: arguments for the constructor that the file cannot hold, such as a mobility
                map.

        Raises:
            ModelError: a file that cannot be read or is another model's, other mobility maps, or
                missing arguments or behaviours.
        """
        return load_model(cls, path, plugins, arguments)
