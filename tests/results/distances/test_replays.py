"""How far replayed people are from where they were measured."""

from types import SimpleNamespace

import numpy as np

from mesa_mobility.results import Trajectories
from mesa_mobility.results.distances import position_errors


def tracks(walks, rate: float) -> Trajectories:
    """Tracks ``{person: (first frame, [x, ...])}``."""
    rows = [
        (first + k, person, x, 0.0)
        for person, (first, places) in walks.items()
        for k, x in enumerate(places)
    ]
    frame, person, x, y = (np.array(column) for column in zip(*rows, strict=True))
    return Trajectories(frame, person, x, y, np.zeros(len(rows)), frame_rate=rate)


def test_errors_are_those_of_the_model_and_of_constant_velocity():
    # Measured at 10 Hz: at 1 m/s until frame 20, then at 2 m/s. The second begins at frame 20.
    x = [0.1 * min(f, 20) + 0.2 * max(f - 20, 0) for f in range(61)]
    measured = tracks({4: (0, x), 7: (20, x[20:]), 9: (0, x[:45])}, 10.0)
    # Simulated at 30 Hz, from frame 5 of the model on: at 1.5 m/s. The third leaves after 1 s.
    walk = [2.0 + 1.5 * k / 30 for k in range(121)]
    run = tracks({0: (5, walk), 1: (5, walk), 2: (5, walk[:31])}, 30.0)
    replay = SimpleNamespace(
        frame=5, from_frame=20, persons=np.array([4, 7, 9]), rows=np.array([0, 1, 2])
    )
    found = position_errors(run, measured, replay, seconds=(1.0, 1.55, 3.0))
    # After t seconds 2 t, 1.5 t and 1 t have been walked.
    np.testing.assert_allclose(found.simulated[0], [0.5, 0.775, 1.5])
    np.testing.assert_allclose(found.constant_velocity[0], [1.0, 1.55, 3.0])
    # Without earlier frames there is no velocity.
    assert np.isnan(found.simulated[1]).all()
    np.testing.assert_allclose(found.simulated[2], [0.5, np.nan, np.nan])
    np.testing.assert_allclose(found.constant_velocity[2], [1.0, np.nan, np.nan])
    np.testing.assert_allclose(found.means(), [[0.5, 0.775, 1.5], [1.0, 1.55, 3.0]])
