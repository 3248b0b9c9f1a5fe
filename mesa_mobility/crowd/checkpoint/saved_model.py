"""Copying, saving and loading a model."""

from __future__ import annotations

import os
from collections.abc import Iterable
from copy import deepcopy
from typing import TYPE_CHECKING, Any, Self, cast

import mesa

from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.people.pedestrian import last_number, number_from
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.occupants import add_occupants

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel
    from mesa_mobility.crowd.population import Population


class SavedModel(mesa.Model):
    """A model that can be copied, saved and loaded."""

    floor_plan: FloorPlan
    population: Population

    made_with: tuple[tuple[Any, ...], dict[str, Any]]
    """The arguments that the constructor was called with."""

    _framework: frozenset[str]
    """Names of the attributes that the framework has made."""

    def __new__(cls, *args: Any, **keywords: Any) -> Self:
        """A model that knows what it was made with."""
        model = super().__new__(cls)
        model.made_with = args, keywords
        return model

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """An independent copy that continues exactly as this model would.

        Both share the mobility map and compiled code, which neither changes.
        """
        copied = type(self).__new__(type(self))
        memo[id(self)] = copied
        # Its agents go into registers that use their model's number.
        number_from(copied, self.last_id)
        for name, value in self.__dict__.items():
            copied.__dict__[name] = value if name == "made_with" else deepcopy(value, memo)
        add_occupants(copied.floor_plan, copied.population)
        return copied

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise ModelError(
            f"{type(self).__name__}: a model can be copied by copy.deepcopy, neither by copy.copy "
            "nor by pickle; expected its parameters and seed, which make it anew"
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a checkpoint, from which ``load`` goes on to the same trajectories.

        It holds the constructor's arguments and all that has changed since: people, behaviours,
        generators, records, and attributes of the model and its people. Maps are not in it but
        their digest is.

        Args:
            path: the file, a zip of arrays and JSON.

        Raises:
            ModelError: an attribute or a behaviour's state that cannot be saved, people who wait
                for a function, or a file that cannot be written.
        """
        from mesa_mobility.crowd.checkpoint.snapshot import save_model

        save_model(cast("PedestrianModel", self), path)

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], *, plugins: Iterable[Plugin] = (), **arguments: Any
    ) -> Self:
        """The model of a checkpoint, in this process or another.

        Args:
            path: the file.
            plugins: behaviours that the model had, and that are neither installed nor made by its
                constructor.
            arguments: constructor's arguments that the file cannot hold, such as a mobility map.

        Raises:
            ModelError: a file that cannot be read or is another model's, other mobility maps, or
                missing arguments or behaviours.
        """
        from mesa_mobility.crowd.checkpoint.snapshot import load_model

        loaded = load_model(cast("type[PedestrianModel]", cls), path, plugins, arguments)
        assert isinstance(loaded, cls)
        return loaded

    @property
    def last_id(self) -> int:
        """``unique_id`` of the last agent that came."""
        return last_number(self)

    def own_attributes(self) -> list[str]:
        """Names of the attributes that subclasses and users have added."""
        return sorted(vars(self).keys() - self._framework - {"_framework"})
