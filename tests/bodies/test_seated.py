import numpy as np

from mesa_mobility.bodies.seated import SEATED_PELVIS, seated_motion
from mesa_mobility.bodies.skeleton import JOINT


def test_somebody_who_sits_faces_where_the_chair_does():
    track = np.array([[0.0, 0.0, 0.0], [2.0, 3.0, np.pi / 2]])
    motion = seated_motion(np.array([4, 5]), track)
    assert motion.frames.tolist() == [4.0, 5.0]
    place = {name: motion.positions[1, j] for name, j in JOINT.items()}
    np.testing.assert_allclose(place["pelvis"], [2.0, 3.0, SEATED_PELVIS])
    # Facing +y, left is -x: hips 8.75 cm aside, a level thigh of 42.9 cm, an upright shank of 43.1.
    np.testing.assert_allclose(place["left_knee"], [1.9125, 3.429, 0.55], atol=1e-12)
    np.testing.assert_allclose(place["right_ankle"], [2.0875, 3.429, 0.119], atol=1e-12)
    # Shoulders 46 cm up; upper arms 35 degrees forward, then a level forearm.
    sine, cosine = np.sin(np.deg2rad(35)), np.cos(np.deg2rad(35))
    elbow = [2.0 - 0.185, 3.0 + 0.3 * sine, 1.01 - 0.3 * cosine]
    np.testing.assert_allclose(place["left_elbow"], elbow, atol=1e-12)
    np.testing.assert_allclose(place["left_wrist"] - elbow, [0.0, 0.255, 0.0], atol=1e-12)
