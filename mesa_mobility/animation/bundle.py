"""Arrays and texts in one string for the browser, and the parts of its three-dimensional view."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.animation.figures.clothes import looks
from mesa_mobility.animation.figures.figure import Figure, rest_positions
from mesa_mobility.animation.figures.levels import jointed_figures, rigid_figures, seated_head
from mesa_mobility.bodies import PoseBank
from mesa_mobility.bodies.bank_data import OTHER_SIDE
from mesa_mobility.bodies.feet import LEGS
from mesa_mobility.bodies.skeleton import ANKLE_HEIGHT, HEEL_BACK, JOINT, OFFSETS, PARENTS, TURNING

_LETTERS = {"float32": "f4", "int32": "i4", "int16": "i2", "uint16": "u2", "uint8": "u1"}


def bundled(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> str:
    """Base64 of a compressed bundle, which ``unbundle`` in ``viewer/bundle.js`` opens.

    It is the length of a JSON object as a 32-bit integer, that object, and the arrays one after
    the other, each from a multiple of 4 bytes on; all little-endian, compressed by zlib.

    Args:
        header: what JSON takes.
        arrays: float32, int32, int16, uint16 or uint8, flat or not; they arrive flat.
    """
    parts, places, length = [], {}, 0
    for name, array in arrays.items():
        kind = array.dtype.name
        data = np.ascontiguousarray(array, dtype=f"<{_LETTERS[kind]}").tobytes()
        places[name] = {"kind": kind, "from": length, "count": int(array.size)}
        data += bytes(-len(data) % 4)
        parts.append(data)
        length += len(data)
    text = json.dumps({**header, "arrays": places}).encode("utf-8")
    text += b" " * (-len(text) % 4)
    content = b"".join([len(text).to_bytes(4, "little"), text, *parts])
    return base64.b64encode(zlib.compress(content, 6)).decode("ascii")


def figure_parts() -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header and arrays of the neutral skeleton and of the figures round it."""
    parents = np.asarray(PARENTS, dtype=np.int32)
    jointed, rigid = jointed_figures(), rigid_figures()
    header = {
        "figures": [*jointed, *rigid],
        "looks": looks(),
        "skeleton": {
            "parents": parents.tolist(),
            "offsets": OFFSETS.reshape(-1).tolist(),
            "rest": rest_positions().reshape(-1).tolist(),
            "turning": TURNING.tolist(),
            "otherSide": OTHER_SIDE.tolist(),
            "legs": [list(leg) for leg in LEGS],
            "ankleHeight": ANKLE_HEIGHT,
            "heel": [-HEEL_BACK, 0.0, -ANKLE_HEIGHT],
            "ball": [float(OFFSETS[JOINT["left_toe"], 0]), 0.0, -ANKLE_HEIGHT],
            "seatedHead": seated_head(),
        },
    }
    parts = {name: _mesh(figure) | _moved(figure) for name, figure in jointed.items()}
    parts |= {name: _mesh(figure) for name, figure in rigid.items()}
    arrays = {f"{name}.{key}": each for name, own in parts.items() for key, each in own.items()}
    return header, arrays


def _mesh(figure: Figure) -> dict[str, NDArray[Any]]:
    return {
        "vertices": figure.vertices,
        "normals": figure.normals,
        "triangles": figure.triangles,
        "parts": figure.parts,
    }


def _moved(figure: Figure) -> dict[str, NDArray[Any]]:
    # No vertex is moved by more than two joints.
    return {"joints": figure.joints[:, :2].astype(np.float32), "weights": figure.weights[:, 0]}


def bank_arrays(bank: PoseBank, name: str) -> dict[str, NDArray[Any]]:
    """Arrays of a bank of poses under a name."""
    return {
        f"{name}.rotations": bank.rotations,
        f"{name}.heights": bank.heights,
        f"{name}.contacts": bank.contacts,
        f"{name}.clips": bank.clips.astype(np.int32),
    }
