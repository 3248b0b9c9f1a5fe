"""Recorded stretches of options, from the poses in which these start and their transitions."""

import numpy as np

from mesa_mobility.bodies.retracing import chains_of
from mesa_mobility.mobility import cluster_poses, motion_graph, reachable_options
from tests.fixtures.poses import random_poses


def test_stretches_lead_along_the_recorded_motion():
    poses = random_poses(np.random.default_rng(3), clips=3, length=40, wobble=0.05)
    graph = motion_graph(poses)
    clusters = cluster_poses(graph, 6)
    options = reachable_options(graph, clusters)
    chains = chains_of(options, len(poses))
    assert chains.shape == (len(options.durations), 4, 2)
    several = 0
    for row in range(0, len(chains), 37):
        stretches = [(int(frame), int(pose)) for frame, pose in chains[row] if frame >= 0]
        assert stretches[0] == (0, options.sources[row])
        frames = [frame for frame, _ in stretches]
        assert frames == sorted(set(frames))
        several += len(stretches) > 1
        # Each sample's pose, counted on from the stretch that it lies in.
        for sample in range(int(options.durations[row]) // 3):
            at = 3 * (sample + 1)
            start, pose = max(each for each in stretches if each[0] <= at)
            assert clusters.labels[pose + at - start] == options.path_clusters[row, sample]
    assert several
