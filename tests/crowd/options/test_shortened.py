"""Shortened copies of the shorter options."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility import Capability
from mesa_mobility.crowd import PRESETS
from mesa_mobility.crowd.options.repertoire import repertoire
from tests.fixtures.maps import (
    STANDING,
    WALKING,
    make_map,
    shipped_map,
    stand,
    straight,
    wanderer,
)
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put, statues

SHARES = ((0.5, 0.0),)


def by_hand():
    """Options 0 to 3 are of a standing person, 4 to 6 of a walking one; 1 and 2 end in one cell."""
    standing = [stand(), straight(0.5, 12), straight(0.53125, 12), straight(1.0, 24)]
    walking = [straight(0.0625, 12), straight(0.0625, 12, turn=0.25), straight(0.5, 12)]
    costs = np.array([0.0, 2.0, 1.0, 0.0, 0.5, 3.0, 0.25], dtype=np.float32)
    return replace(make_map([standing, walking]), costs=costs)


def shortened(parts, share):
    """(row of the map, cluster at the end) of the copies with this share, in order of rows."""
    which = np.flatnonzero(parts.share == share)
    return sorted(zip(parts.rows[which].tolist(), parts.clusters[which].tolist(), strict=True))


def test_the_options_of_the_map_are_all_there_as_they_were():
    capability = Capability(by_hand(), shares=SHARES)
    assert shortened(capability.parts, 1.0) == list(enumerate([0, 1, 1, 1, 1, 1, 1]))
    assert len(capability.table.options) == 7 + 5 + 3


def test_of_those_that_end_alike_the_one_of_least_cost_is_shortened():
    parts = Capability(by_hand(), shares=SHARES).parts
    # 2 is cheaper than 1; the 24 frames of 3 are not the shortest of its cluster.
    assert [row for row, _ in shortened(parts, 0.5)] == [0, 2, 4, 5, 6]
    # Where the ground is nothing only the turn tells them apart: 0 before 1 and 2, 6 before 4.
    assert [row for row, _ in shortened(parts, 0.0)] == [0, 5, 6]


def test_who_is_no_faster_than_somebody_who_stands_ends_up_standing():
    parts = Capability(by_hand(), shares=SHARES).parts
    assert shortened(parts, 0.5) == [
        (0, STANDING),
        (2, WALKING),  # 0.27 m in 0.4 s
        (4, STANDING),  # 0.03 m in 0.4 s: 0.08 m/s
        (5, STANDING),  # as slow, and turning by 0.31 rad/s
        (6, WALKING),
    ]
    # Staying in place is standing, turning or not.
    assert shortened(parts, 0.0) == [(0, STANDING), (5, STANDING), (6, STANDING)]


def test_a_path_is_scaled_and_takes_as_long():
    capability = Capability(by_hand(), shares=SHARES)
    parts, table = capability.parts, capability.table
    [k] = np.flatnonzero((parts.rows == 2) & (parts.share == 0.5))
    steps = [0.0, 0.06640625, 0.1328125, 0.19921875]
    assert table.path[k, 0].tolist() == [*steps, *[0.265625] * 12]
    assert table.options.frames[k] == 12
    assert table.options.speed[k] == pytest.approx(0.265625 / 0.4)
    assert table.options.reach[k] == pytest.approx(0.265625)
    # Half a step turns by half as much, but who stays in place may turn as in the whole step.
    [k] = np.flatnonzero((parts.rows == 5) & (parts.share == 0.5))
    assert table.path[k, 2].tolist() == [0.0, 0.03125, 0.0625, 0.09375, *[0.125] * 12]
    [k] = np.flatnonzero((parts.rows == 5) & (parts.share == 0.0))
    assert not table.path[k, :2].any()
    assert table.path[k, 2].tolist() == [0.0, 0.0625, 0.125, 0.1875, *[0.25] * 12]
    assert table.options.speed[k] == 0.0


def test_the_shortest_are_those_of_each_cluster():
    # Whose fastest step takes 24 frames can take a shorter one of these, and stay in place.
    map_ = make_map([[stand(), straight(0.5, 12)], [straight(1.0, 24), straight(1.5, 45)]])
    parts = Capability(map_, shares=SHARES).parts
    assert shortened(parts, 0.5) == [(0, STANDING), (1, WALKING), (2, WALKING)]
    assert shortened(parts, 0.0) == [(0, STANDING), (2, STANDING)]


def test_each_rank_of_duration_has_its_own_shares():
    # By cluster: 12, 24 and 45 frames; 24 and 45; 45 alone.
    three = [stand(), straight(0.5, 12), straight(1.0, 24), straight(2.0, 45)]
    two = [straight(1.25, 24), straight(1.75, 45)]
    map_ = make_map([three, two, [straight(1.5, 45)]])
    parts = Capability(map_, shares=((0.5,), (0.75, 0.25), ())).parts
    assert shortened(parts, 0.5) == [(0, STANDING), (1, WALKING), (4, WALKING), (6, WALKING)]
    assert shortened(parts, 0.75) == [(2, WALKING), (5, WALKING)]
    assert shortened(parts, 0.25) == [(2, WALKING), (5, WALKING)]
    assert len(parts.rows) == 7 + 4 + 2 + 2
    # Durations that are not in use have no rank: the 24 frames of the first are its shortest now.
    parts = Capability(map_, (24, 45), shares=((0.5,), (0.75,))).parts
    assert shortened(parts, 0.5) == [(2, WALKING), (4, WALKING), (6, WALKING)]
    assert shortened(parts, 0.75) == [(3, WALKING), (5, WALKING)]


def test_a_longer_option_is_as_long_when_shortened_and_stands_below_the_same_speed():
    # 0.28 m in 24 frames: 0.35 m/s; a quarter of it is 0.0875 m/s, three quarters 0.26 m/s.
    map_ = make_map([[stand(), straight(0.5, 12), straight(0.28125, 24)], [stand()]])
    capability = Capability(map_, shares=((), (0.75, 0.25)))
    parts, options = capability.parts, capability.table.options
    assert shortened(parts, 0.75) == [(2, WALKING)]
    assert shortened(parts, 0.25) == [(2, STANDING)]
    [k] = np.flatnonzero(parts.share == 0.75)
    assert options.frames[k] == 24
    assert options.x[k] == 0.2109375
    assert options.speed[k] == pytest.approx(0.2109375 / 0.8)


def test_more_shares_than_durations_are_those_of_options_that_a_cluster_does_not_have():
    map_ = make_map([[stand(), straight(0.5, 12, to=0)]])
    one, many = (Capability(map_, shares=((0.5,), *more)) for more in ((), ((0.25,), (0.75,))))
    assert one.parts.share.tolist() == many.parts.share.tolist()
    assert one.parts.rows.tolist() == many.parts.rows.tolist()


def check(capability, shares):
    """All properties of shortened options, looked up one by one."""
    map_, parts, table = capability.map, capability.parts, capability.table
    cluster = np.repeat(np.arange(map_.n_clusters), np.diff(map_.offsets))
    assert (table.options.frames == map_.durations[parts.rows]).all()
    assert (table.options.cluster == parts.clusters).all()
    mine = np.repeat(np.arange(capability.n_clusters), np.diff(table.offsets))
    assert (mine == cluster[parts.rows]).all()

    x, y = map_.end_points.astype(float).T
    turn, ends_in = map_.end_headings.astype(float), map_.end_clusters
    ends = np.stack([x, y, turn], axis=1)[parts.rows]
    ends[:, :2] *= parts.share[:, None]
    ends[:, 2] *= np.where(parts.share > 0.0, parts.share, 1.0)
    np.testing.assert_allclose(table.path[:, :, -1], ends, atol=1e-6)
    for k in range(0, len(parts.rows), max(len(parts.rows) // 200, 1)):
        row, share = parts.rows[k], parts.share[k]
        path = map_.paths[map_.path_offsets[row] : map_.path_offsets[row + 1]]
        scaled = path * np.array([share, share, share if share > 0.0 else 1.0])
        np.testing.assert_allclose(table.path[k, :, 1 : len(path) + 1].T, scaled, atol=1e-6)

    rising = [sorted(set(map_.durations[cluster == c].tolist())) for c in range(map_.n_clusters)]
    rank = np.array([rising[c].index(d) for c, d in zip(cluster, map_.durations, strict=True)])
    assert {float(s) for s in parts.share} <= {1.0, *(s for own in shares for s in own)}
    for wanted, share in ((n, share) for n, own in enumerate(shares) for share in own):
        short = np.flatnonzero(rank == wanted).tolist()
        cheapest: dict[tuple[int, ...], float] = {}
        for row in short:
            cell = _cell(cluster[row], x[row], y[row], turn[row], share)
            cheapest[cell] = min(cheapest.get(cell, math.inf), map_.costs[row])
        kept = np.flatnonzero((parts.share == share) & (rank[parts.rows] == wanted)).tolist()
        cells = [_cell(cluster[r], x[r], y[r], turn[r], share) for r in parts.rows[kept]]
        assert sorted(cells) == sorted(cheapest)
        assert [map_.costs[r] for r in parts.rows[kept]] == [cheapest[cell] for cell in cells]
        for k, row in zip(kept, parts.rows[kept].tolist(), strict=True):
            seconds = map_.durations[row] / 30.0
            slow = share * math.hypot(x[row], y[row]) / seconds < 0.10
            stands = slow and (share * abs(turn[row]) / seconds < 0.35 or share == 0.0)
            assert parts.clusters[k] == (map_.standing if stands else ends_in[row])

    if shares and 0.0 in shares[0]:
        in_place = (parts.share == 0.0) & (rank[parts.rows] == 0)
        assert not table.path[in_place][:, :2].any()
        assert (parts.clusters[in_place] == map_.standing).all()
        assert set(mine[in_place].tolist()) == set(range(capability.n_clusters))


def _cell(cluster, x, y, turn, share):
    cell = (x / 0.1, y / 0.1, turn / math.radians(15.0)) if share > 0.0 else (turn / np.pi * 12.0,)
    return (int(cluster), *(math.floor(each + 0.5) for each in cell))


@settings(deadline=None, max_examples=50)  # compiled at the first
@given(
    seed=st.integers(0, 2**16),
    shares=st.lists(
        st.lists(st.sampled_from([0.75, 0.5, 0.3, 0.1, 0.0]), unique=True, max_size=3).map(tuple),
        max_size=4,
    ).map(tuple),
)
def test_any_map(seed, shares):
    map_ = wanderer(seed)
    costs = np.random.default_rng(seed).integers(0, 4, map_.n_options).astype(np.float32)
    check(Capability(replace(map_, costs=costs), shares=shares), shares)


@pytest.mark.thorough
def test_the_map_that_ships_with_the_shares_of_the_default_preset():
    rules = PRESETS["default"]
    known = repertoire((shipped_map(),), rules.durations, rules.shares)
    check(known.capabilities[0], rules.shares)


def test_the_paper_has_none():
    rules = PRESETS["paper"]
    capability = Capability(shipped_map(), rules.durations, rules.shares)
    assert (capability.parts.share == 1.0).all()
    assert len(capability.table.options) == (shipped_map().durations == 45).sum()


def test_who_was_never_recorded_to_stop_stands_behind_somebody_who_does():
    # Its map has no option that stays in place but that of a person who stands already.
    restless = make_map([[stand(), straight(0.5, 12)], [straight(0.5, 12)]])
    model = model_of(corridor(12.0, 0.5), [restless, statues()])
    walker = put(model, 1.0, 0.25)
    statue = put(model, 6.0, 0.25, type_index=1)
    advance(model, 300)
    assert model.crowd.fallbacks[walker.row] == 0
    assert walker.cluster == STANDING
    apart = statue.position[0] - walker.position[0]
    # The last step is a whole one, a half or a quarter of one, or none.
    assert 2.0 * core_of(model) <= apart <= 2.0 * core_of(model) + 0.5
