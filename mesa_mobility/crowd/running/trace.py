"""Where everybody has been in the last moments, a few times a second, for those who watch a run."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state.records import Crowd

EVERY = 6
"""Frames from one sample to the next, 0.2 s."""

MOST = 200_000
"""Places that are kept before every second sample is left out: 5,000 people for 8 s."""

MOST_PASSAGES = 10_000
"""People who have come, and people who have left, that are kept; the latest ones."""


class Places(NamedTuple):
    """Places of people, in order of time.

    Attributes:
        frame: (n,) frames.
        person: (n,) rows.
        x: (n,) metres.
        y: (n,) metres.
        heading: (n,) radians.
    """

    frame: NDArray[np.int64]
    person: NDArray[np.int32]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    heading: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.frame)

    @classmethod
    def of(cls, parts: Iterable[Places]) -> Places:
        """Several as one."""
        return cls(*(np.concatenate(each) for each in zip(NOBODY, *parts, strict=True)))


NOBODY = Places(np.empty(0, np.int64), np.empty(0, np.int32), *np.empty((3, 0)))


class Traced(NamedTuple):
    """The places that a trace keeps from some time.

    Attributes:
        frames: of the samples, rising.
        counts: people inside in each of them.
        inside: places of the people inside, sample by sample.
        came: where people were when they came in.
        left: where people were when they left.
    """

    frames: list[int]
    counts: list[int]
    inside: Places
    came: Places
    left: Places


class Trace:
    """Samples of everybody inside, which are kept until somebody has taken them over.

    A model has one in ``model.dynamics.trace``. It keeps places in frames divisible by ``every``,
    and those of people who come or leave in the very frame in which they do. If more than ``most``
    places are kept, every second sample is left out, and of later ones as well, until ``drop``.

    Args:
        every: frames from one sample to the next.
        most: places that are kept.
    """

    def __init__(self, every: int = EVERY, most: int = MOST) -> None:
        self.every = self._least = every
        self._most, self._kept = most, 0
        self._samples: deque[tuple[int, Places]] = deque()
        self._came: deque[Places] = deque(maxlen=MOST_PASSAGES)
        self._left: deque[Places] = deque(maxlen=MOST_PASSAGES)

    def next(self, frame: int) -> int:
        """The first frame after this one that is sampled."""
        return (frame // self.every + 1) * self.every

    def add(self, frame: int, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Keep those in ``rows``, who are inside, if the frame is one to be sampled."""
        if frame % self.every:
            return
        self._samples.append((frame, _at(frame, rows, crowd)))
        self._kept += len(rows)
        while self._kept > self._most and len(self._samples) > 1:
            self.every *= 2
            kept = [each for each in self._samples if each[0] % self.every == 0]
            self._samples = deque(kept)
            self._kept = sum(len(places) for _, places in kept)

    def come(self, frame: int, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Keep where those in ``rows`` have come in."""
        if len(rows):
            self._came.append(_at(frame, rows, crowd))

    def leave(self, frame: int, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Keep where those in ``rows`` have left."""
        if len(rows):
            self._left.append(_at(frame, rows, crowd))

    def drop(self, frame: int) -> None:
        """Forget all until this frame, which has been taken over."""
        while self._samples and self._samples[0][0] <= frame:
            self._kept -= len(self._samples.popleft()[1])
        for passages in (self._came, self._left):
            while passages and passages[0].frame[0] <= frame:
                passages.popleft()
        if len(self._samples) <= 1:
            self.every = self._least

    def until(self, frame: int) -> Traced:
        """The places kept from before a frame, and those of people who came or left up to it."""
        # At once: the run may go on in another thread.
        samples = [each for each in tuple(self._samples) if each[0] < frame]
        return Traced(
            [number for number, _ in samples],
            [len(places) for _, places in samples],
            Places.of(places for _, places in samples),
            Places.of(self._came),
            Places.of(self._left),
        )


def _at(frame: int, rows: NDArray[np.int64], crowd: Crowd) -> Places:
    """Those in ``rows`` as they are now."""
    frames, people = np.full(len(rows), frame, np.int64), rows.astype(np.int32)
    return Places(frames, people, crowd.x[rows], crowd.y[rows], crowd.heading[rows])
