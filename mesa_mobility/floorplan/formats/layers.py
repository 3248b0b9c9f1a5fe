"""Kinds of the layers of a drawing, guessed from their names."""

import re
from collections.abc import Sequence

_WORDS = {
    "exit": r"exit|ausgang|notausg|egress|sortie|salida",
    "obstacle": r"obstacle|hindernis|column|pillar|furniture|stuetze|stütze|a-furn|a-cols",
    "wall": r"wall|wand|mauer|w[aä]nde|muro|\bmur\b",
    "walkable": r"walkable|walk_?able|floor|a-flor|boden|grundfl|outline",
}
"""Words in the names of layers, by what is drawn there; exits come first, as in floor-exits."""


def guessed(drawn: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Kind and name of the parts on each layer whose name says something.

    ``wall`` is a kind besides those that a layer can be given: lines or areas of walls.
    """
    kinds = {}
    for layer in drawn:
        for kind, words in _WORDS.items():
            if re.search(words, layer, re.IGNORECASE):
                kinds[layer] = (kind, "")
                break
    return kinds
