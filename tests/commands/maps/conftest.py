"""What tests of `mesa-mobility map` share."""

import json

import pytest


@pytest.fixture(autouse=True)
def without_walks(monkeypatch):
    """Maps are examined by no test that takes a model, for want of time."""
    monkeypatch.setattr("mesa_mobility.examination.examining.TESTS", ())


def last_line(outcome):
    """The JSON that a command has written last."""
    return json.loads(outcome.out.splitlines()[-1])


def rows_of(recordings):
    """Header, line of the frame time and rows of movement of the slow recording."""
    lines = (recordings / "slow.bvh").read_text().splitlines()
    first = lines.index("MOTION") + 3
    return lines[: first - 2], lines[first - 1], lines[first:]
