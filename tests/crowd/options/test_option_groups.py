"""Groups of options that are alike hold what they say."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mesa_mobility import MobilityMap
from mesa_mobility.crowd import PRESETS
from mesa_mobility.crowd.options.option_groups import (
    DURATION,
    FASTEST,
    GROUP_SIZE,
    RADIUS,
    SLOWEST,
    TURN,
    UX,
    UY,
    X,
    Y,
    group,
)
from mesa_mobility.crowd.options.repertoire import repertoire
from mesa_mobility.crowd.options.table import LEVELS
from tests.fixtures.maps import make_map, stand, straight, strider


@settings(deadline=None)  # compiled at the first
@given(
    features=arrays(
        np.float64,
        st.tuples(st.integers(1, 60), st.integers(1, 4)),
        elements=st.integers(-3, 3).map(float),
    ),
    cut=st.integers(0, 60),
)
def test_every_row_is_in_one_group_of_its_run(features, cut):
    n = len(features)
    bounds = np.unique([0, min(cut, n), n])
    order, starts = group(features, bounds)
    assert sorted(order.tolist()) == list(range(n))
    sizes = np.diff(np.append(starts, n))
    assert starts[0] == 0
    assert sizes.min() >= 1
    assert sizes.max() <= GROUP_SIZE
    assert set(bounds[:-1]) <= set(starts.tolist())
    for first, last in pairwise(bounds):
        assert sorted(order[first:last].tolist()) == list(range(first, last))


def test_groups_halve_what_is_widest():
    # 16 rows: the first column spans 15, the second 1.
    features = np.column_stack([np.arange(16.0)[::-1], np.arange(16) % 2])
    order, starts = group(features, np.array([0, 16]))
    assert order.tolist() == list(range(15, -1, -1))
    assert starts.tolist() == [0, 8]


def shipped():
    return (MobilityMap.load(None),)


def two_small():
    return (strider(), make_map([[stand(), straight(0.75, 12, to=0)]]))


@pytest.mark.thorough
@pytest.mark.parametrize("maps", [shipped, two_small])
@pytest.mark.parametrize("shares", [(), PRESETS["default"].shares])
def test_groups_span_their_options(maps, shares):
    known = repertoire(maps(), (12, 24, 45), shares)
    table, groups = known.table, known.groups
    n = len(table.options)
    option, spanned = table.options, groups.clusters
    of_group = np.repeat(np.arange(len(table.groups)), np.diff(groups.first))
    cluster = np.repeat(np.arange(len(table.offsets) - 1), np.diff(table.offsets))
    assert len(of_group) == n
    group_cluster = np.repeat(np.arange(len(spanned)), spanned["last"] - spanned["first"])
    assert (group_cluster[of_group] == cluster).all()
    assert groups.ends[DURATION][of_group] == pytest.approx(option.frames / 30.0)
    for k in range(len(spanned)):
        turns = np.where((cluster == k) & (option.speed == 0.0), np.abs(table.heading), np.inf)
        expected = of_group[turns.argmin()] if np.isfinite(turns.min()) else -1
        assert spanned["stay"][k] == expected
    slack = 1e-5
    path = table.path.astype(float)
    away = np.hypot(option.x - groups.ends[X][of_group], option.y - groups.ends[Y][of_group])
    assert (away <= groups.ends[RADIUS][of_group] + slack).all()
    cosine = option.ux * groups.ends[UX][of_group] + option.uy * groups.ends[UY][of_group]
    sine = option.uy * groups.ends[UX][of_group] - option.ux * groups.ends[UY][of_group]
    assert (np.abs(np.arctan2(sine, cosine)) <= groups.ends[TURN][of_group] + slack).all()
    assert (option.speed >= groups.ends[SLOWEST][of_group]).all()
    assert (option.speed <= groups.ends[FASTEST][of_group]).all()
    box = spanned["whole"][cluster]
    assert (path[:, :2].min(axis=2) >= box[:, :2] - slack).all()
    assert (path[:, :2].max(axis=2) <= box[:, 2:] + slack).all()
    for level, sample in enumerate(LEVELS):
        x, y = path[:, 0, sample], path[:, 1, sample]
        dx, dy = x - groups.at[level, X][of_group], y - groups.at[level, Y][of_group]
        assert (np.hypot(dx, dy) <= groups.at[level, RADIUS][of_group] + slack).all()
        span = spanned["spans"][cluster, :, level]
        assert (np.minimum(x - span[:, 0], span[:, 2] - x) >= -slack).all()
        assert (np.minimum(y - span[:, 1], span[:, 3] - y) >= -slack).all()
        farthest = np.hypot(path[:, 0, : sample + 1], path[:, 1, : sample + 1]).max(axis=1)
        for k in np.unique(cluster)[:20]:
            assert spanned["reach"][k, level] == pytest.approx(farthest[cluster == k].max())
