"""The poses that people of a running model go through, for the three-dimensional view."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import PedestrianModel
from mesa_mobility.animation.bundle import bank_arrays, bundled, figure_parts
from mesa_mobility.animation.figures.aids import aid_of
from mesa_mobility.bodies import Movements, PoseBank, bank_of_maps
from mesa_mobility.bodies.sequence import stretch_of_each
from mesa_mobility.errors import MapError

NUMBERS = 5
"""Numbers of each person: type, frames since the present stretch of a recording began, number of
the pose then, whether the person moves, factor of the recorded strides. Only the type counts where
poses are not known."""


class Bodies:
    """Poses of the people of one model.

    Args:
        model: the model.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self._model = model
        self._banks: list[PoseBank] = []
        self._bank_of: list[int] = []
        for maps in model.mobility_maps:
            try:
                bank = bank_of_maps([(each.digest, each.lengths) for each in maps])
            except MapError:  # drawn without limbs
                self._bank_of.append(-1)
                continue
            if bank not in self._banks:
                self._banks.append(bank)
            self._bank_of.append(self._banks.index(bank))

    def bundle(self) -> str:
        """Figures and poses as ``viewer/bundle.js`` opens them.

        For each pedestrian type, the header has the number of its bank of poses (-1 where they are
        not known), and what people of the type hold or sit in.
        """
        header, arrays = figure_parts()
        header["types"] = [
            {"bank": bank, "aid": aid_of(kind.name)}
            for bank, kind in zip(self._bank_of, self._model.pedestrian_types, strict=True)
        ]
        header["scales"] = [bank.scale for bank in self._banks]
        for number, bank in enumerate(self._banks):
            arrays |= bank_arrays(bank, f"bank{number}")
        return bundled(header, arrays)

    def now(self) -> NDArray[np.float32]:
        """(n, NUMBERS) of everybody inside, in the order of the model's rows."""
        model = self._model
        doing = model.under_way()
        found = np.zeros((len(doing["person"]), NUMBERS), dtype=np.float32)
        found[:, 0] = doing["type_index"]
        of_bank = np.array(self._bank_of)[doing["type_index"]]
        for number, bank in enumerate(self._banks):
            own = of_bank == number
            movements = Movements(
                doing["frame"][own].astype(np.int64),
                doing["option"][own].astype(np.int64),
                doing["share"][own].astype(np.float64),
            )
            phases = np.maximum(model.frame - movements.starts, 0)
            found[own, 1:] = np.column_stack(stretch_of_each(bank, movements, phases))
        return found
