"""The motion graph against a plain search over all pairs."""

import networkx as nx
import numpy as np
import pytest

from mesa_mobility.errors import MapError
from mesa_mobility.mobility import motion_graph, shortest_paths
from tests.fixtures.poses import make_poses, random_poses


def plain_graph(poses):
    """All transitions by brute force: {i: {successor: cost}} before pruning to a component."""
    f = poses.features.astype(np.float64)
    n = len(f)
    last = set((poses.first[1:] - 1).tolist())
    edges = {i: {} for i in range(n)}
    for i in range(n):
        found = []
        for k in range(len(poses.first) - 1):
            stop = poses.first[k + 1] - 1
            for start in range(poses.first[k], stop, 45):
                stretch = range(start, min(start + 45, stop))
                rows = [j for j in stretch if k != poses.clip[i] or abs(i - j) >= 15]
                distances = [np.linalg.norm(f[i] - f[j]) for j in rows]
                if rows and min(distances) < 0.45:
                    best = int(np.argmin(distances))
                    found.append((distances[best], rows[best]))
        for distance, j in sorted(found)[:10]:
            edges[i][j + 1] = distance / 0.45
        if i not in last:
            edges[i][i + 1] = 1e-4
    return edges


@pytest.mark.parametrize("seed", range(3))
def test_every_transition_is_the_one_a_plain_search_finds(seed):
    poses = random_poses(np.random.default_rng(seed))
    graph = motion_graph(poses)
    edges = plain_graph(poses)
    whole = nx.DiGraph((i, j) for i, row in edges.items() for j in row)
    component = max(nx.strongly_connected_components(whole), key=len)
    assert set(np.flatnonzero(graph.kept)) == component
    for i in component:
        expected = {j: c for j, c in edges[i].items() if j in component}
        found = {j: d["cost"] for j, d in graph.graph[i].items()}
        assert found == pytest.approx(expected, rel=1e-3, abs=1e-5)


def test_a_slow_gait_has_the_transitions_of_a_quick_one():
    """The same cycle recorded four times as slowly: poses change less from frame to frame."""
    found = []
    for frames in (20, 80):
        phase = np.arange(4 * frames) * 2 * np.pi / frames
        cycle = np.column_stack([np.cos(phase + k) for k in range(36)])
        noise = np.random.default_rng(1).normal(0, 0.02, cycle.shape)
        graph = motion_graph(make_poses(cycle + noise, [4 * frames]))
        found.append((graph.share_kept, graph.transitions / len(graph.poses)))
    for kept, transitions in found:
        assert kept > 0.95
        assert transitions >= 1.0


def test_look_alikes_in_another_clip_lead_to_the_frame_after():
    """Clip 0 comes round after 25 frames; frame k of clip 1 looks like its frame 5 + k."""
    rng = np.random.default_rng(5)
    walk = np.cumsum(rng.normal(0, 1, (25, 36)), axis=0)
    walk = np.concatenate([walk, walk[:5]])
    poses = make_poses(np.concatenate([walk, walk[5:25]]), [30, 20])
    graph = motion_graph(poses)
    source = np.repeat(np.arange(50), np.diff(graph.offsets))
    jumps = {
        (int(i), int(j)): float(c)
        for i, j, v, c in zip(source, graph.successors, graph.via, graph.costs, strict=True)
        if v != i
    }
    assert jumps[(12, 38)] == pytest.approx(0.0, abs=1e-6)  # 12 looks like 30 + 7; 38 follows
    assert jumps[(37, 13)] == pytest.approx(0.0, abs=1e-6)


def test_graph_carries_kind_cost_clip_and_frame():
    poses = random_poses(np.random.default_rng(0))
    graph = motion_graph(poses).graph
    node = next(iter(graph.nodes))
    assert set(graph.nodes[node]) == {"clip", "frame"}
    kinds = {data["kind"] for _, _, data in graph.edges(data=True)}
    assert kinds == {"natural", "transition"}
    for i, j, data in graph.edges(data=True):
        assert (data["kind"] == "natural") == (j == i + 1 and data["via"] == i)
        assert data["cost"] == pytest.approx(1e-4) if data["kind"] == "natural" else True
    assert nx.is_strongly_connected(graph)


def test_clips_that_never_resemble_each_other_are_refused():
    features = np.zeros((40, 36))
    features[:, 0] = np.arange(40) * 1.0
    with pytest.raises(MapError, match="no transitions that lead back"):
        motion_graph(make_poses(features, [40]))


def test_literal_shortest_paths_are_those_of_networkx():
    graph = motion_graph(random_poses(np.random.default_rng(1), clips=3, length=40))
    sources = np.flatnonzero(graph.kept)[:3]
    found = shortest_paths(graph, sources)
    for row, source in enumerate(sources):
        lengths = nx.single_source_dijkstra_path_length(graph.graph, int(source), weight="cost")
        for node, frames in enumerate(found.frames[row]):
            if node not in lengths:
                assert frames == -1
        # Frames are those of a path of that cost: no fewer than hops allow.
        hops = nx.single_source_shortest_path_length(graph.graph, int(source))
        assert all(found.frames[row, node] >= hops[node] for node in lengths)
    assert 0.0 <= found.share_of_exactly(45) <= 1.0
    assert found.median_frames > 0
