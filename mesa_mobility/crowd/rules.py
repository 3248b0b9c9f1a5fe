"""What holds for everybody in a model."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Rules(NamedTuple):
    """What holds for everybody.

    Fields: ``search_radius`` for neighbours (m); ``cores``, whether bodies are hard; by pedestrian
    type: ``standing``, its standing cluster, and ``first_option``, its first row in the table.
    """

    search_radius: float
    cores: bool
    standing: NDArray[np.int32]
    first_option: NDArray[np.int64]
