"""Cost terms: behaviours that rank movement options.

The cost of a movement option is the weighted sum of its terms (equation 1 of the paper).  A
behaviour is one more term.  A term gets all options of all deciding pedestrians and returns one
number for each.  Terms are independent of one another, so their order does not matter.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar, cast

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.errors import ModelError

MOST_WEIGHT = 1e9
"""Largest weight of a term, either way.  Beyond it no other term counts, and sums overflow."""


def is_weight(value: object) -> bool:
    """Whether this can be the weight of a term.

    A negative weight lets people seek what the term makes dear otherwise.
    """
    return is_number(value) and abs(cast("float", value)) <= MOST_WEIGHT


EXPECTED_WEIGHT = f"a finite number, {MOST_WEIGHT:.0e} at most either way"


def _checked_weight(of: str, value: float) -> float:
    """The weight, or one error that names what it is of."""
    if not is_weight(value):
        raise ModelError(f"weight of {of}: got {value!r:.60}, expected {EXPECTED_WEIGHT}")
    return float(value)


class CostTerm(Plugin):
    """One additive term of the cost of a movement option.

    Subclasses set ``name`` and define ``cost``.  The engine multiplies by ``weight``.

    Attributes:
        name: unique name of the term, as it is registered and shown.
        weight: factor of the term in the sum; may be changed while a model runs. A negative one
            turns the term over: people seek what they would avoid.
        weight_by_type: factors for people of some types, as ``{"child": 0.0}``; 0 switches the
            term off for them.
        for_types: names of the types whose people alone have the term, as ``["child"]``; None, by
            default, for everybody. Terms of one name may have different parameters for different
            types.

    Examples:
        >>> import numpy as np
        >>> from mesa_mobility import CostTerm
        >>> class StraightOn(CostTerm):
        ...     name = "straight_on"
        ...
        ...     def cost(self, candidates):
        ...         turn = candidates.headings - candidates.facings[candidates.owner]
        ...         return np.abs(np.angle(np.exp(1j * turn)))
        >>> term = StraightOn(weight=0.5)
        >>> term.name, term.weight
        ('straight_on', 0.5)
    """

    default_weight: ClassVar[float] = 1.0

    _by_type: Mapping[str, float] = MappingProxyType({})
    _for_types: tuple[str, ...] | None = None

    def __init__(self, weight: float | None = None) -> None:
        self.weight = self.default_weight if weight is None else weight

    def _told(self) -> list[str]:
        weight = getattr(self, "_weight", self.default_weight)
        return [f"weight={weight:g}", *super()._told()]

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        # They are checked as when a user sets them; those of the class are none of the object's.
        for name, attribute in (
            ("_weight", "weight"),
            ("_by_type", "weight_by_type"),
            ("_for_types", "for_types"),
        ):
            if name in state:
                setattr(self, attribute, state[name])

    @property
    def weight(self) -> float:
        """Factor of this term in the sum."""
        return self._weight

    @weight.setter
    def weight(self, value: float) -> None:
        self._weight = _checked_weight(repr(self._called), value)

    @property
    def weight_by_type(self) -> Mapping[str, float]:
        """Factors for people of some types, by the types' names, in place of ``weight``."""
        return MappingProxyType(dict(self._by_type))

    @weight_by_type.setter
    def weight_by_type(self, weights: Mapping[str, float]) -> None:
        if not isinstance(weights, Mapping):
            raise ModelError(
                f"weight_by_type of {self._called!r}: got {weights!r:.60}, expected a weight for "
                "each name of a type, such as {'child': 0.0}"
            )
        self._by_type = {
            name: _checked_weight(f"{self._called!r} for {name!r}", value)
            for name, value in weights.items()
        }

    @property
    def for_types(self) -> tuple[str, ...] | None:
        """Names of the types whose people alone have the term; None for everybody."""
        return self._for_types

    @for_types.setter
    def for_types(self, names: Iterable[str] | None) -> None:
        if isinstance(names, str):
            raise ModelError(
                f"for_types of {self._called!r}: got {names!r}, expected a list such as [{names!r}]"
            )
        if names is not None and not isinstance(names, Iterable):
            raise ModelError(
                f"for_types of {self._called!r}: got {names!r:.60}, expected a list of names of "
                "types, or None"
            )
        self._for_types = None if names is None else tuple(dict.fromkeys(names))

    def is_for(self, type_name: str) -> bool:
        """Whether the term applies to people of this type."""
        return self._for_types is None or type_name in self._for_types

    def weights(self, types: Sequence[str]) -> NDArray[np.float64]:
        """(types,) the factor for people of each of a model's types, given by their names.

        It is 0 for types that do not have the term.

        Raises:
            ModelError: a weight for a type that the model does not have, or a term for one.
        """
        for what, names in (("has a weight", self._by_type), ("is", self._for_types or ())):
            unknown = [name for name in names if name not in types]
            if unknown:
                raise ModelError(
                    f"behaviour {self.name!r}: {what} for the type {unknown[0]!r}; the model has "
                    f"{', '.join(types)}"
                )
        return np.array(
            [self._by_type.get(name, self.weight) if self.is_for(name) else 0.0 for name in types]
        )

    @abstractmethod
    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """Cost of each option, without the weight.

        Args:
            candidates: options of any number of pedestrians.

        Returns:
            (n,) one finite number per option.
        """


def without_weight(terms: Sequence[CostTerm], types: Sequence[str]) -> str | None:
    """A warning where none of a model's terms has a weight above 0 for anybody; else None.

    People then take any option, or the worst one.

    Args:
        terms: of the model; one without terms at all is as it should be.
        types: names of the model's types of people.
    """
    if not terms or any((each.weights(types) > 0.0).any() for each in terms):
        return None
    names = ", ".join(each.name for each in terms)
    return f"no behaviour has a weight above 0 (of {names}): people take any option, or the worst"
