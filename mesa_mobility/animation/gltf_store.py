"""Arrays and nodes of a glTF file."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


class Store:
    """Arrays of a glTF file in one buffer."""

    def __init__(self, gltf: Any, file: Any) -> None:
        self._gltf, self._file = gltf, file
        self._parts: list[bytes] = []
        self._length = 0
        self._together: dict[int, list[bytes]] = {}
        self._lengths: dict[int, int] = {}

    def node(self, node: Any) -> int:
        """Add a node; its number."""
        self._file.nodes.append(node)
        return len(self._file.nodes) - 1

    def accessor(
        self,
        array: NDArray[Any],
        kind: str,
        component: int,
        *,
        target: int | None = None,
        **more: Any,
    ) -> int:
        """Add an array and its accessor; the number of the accessor."""
        return self._accessor(self._view(_bytes_of(array), target), array, kind, component, **more)

    def keys(self, array: NDArray[Any], kind: str, component: int, **more: Any) -> int:
        """The same of an array of an animation; those of one type of numbers share a view."""
        data, number = _bytes_of(array), -component  # until the view is there
        start = self._lengths.get(component, 0)
        self._together.setdefault(component, []).append(data)
        self._lengths[component] = start + len(data)
        return self._accessor(number, array, kind, component, byteOffset=start, **more)

    def finish(self) -> None:
        """Put all arrays into the file."""
        views = {-each: self._view(b"".join(own)) for each, own in self._together.items()}
        for accessor in self._file.accessors:
            accessor.bufferView = views.get(accessor.bufferView, accessor.bufferView)
        self._file.buffers.append(self._gltf.Buffer(byteLength=self._length))
        self._file.set_binary_blob(b"".join(self._parts))

    def _view(self, data: bytes, target: int | None = None) -> int:
        self._file.bufferViews.append(
            self._gltf.BufferView(
                buffer=0, byteOffset=self._length, byteLength=len(data), target=target
            )
        )
        self._parts.append(data)
        self._length += len(data)
        return len(self._file.bufferViews) - 1

    def _accessor(
        self, view: int, array: NDArray[Any], kind: str, component: int, **more: Any
    ) -> int:
        self._file.accessors.append(
            self._gltf.Accessor(
                bufferView=view, componentType=component, count=len(array), type=kind, **more
            )
        )
        return len(self._file.accessors) - 1


def _bytes_of(array: NDArray[Any]) -> bytes:
    data = np.ascontiguousarray(array).tobytes()
    return data + bytes(-len(data) % 4)
