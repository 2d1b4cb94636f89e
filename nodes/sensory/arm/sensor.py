"""What an accelerometer and a gyroscope feel on a moving wrist."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nodes.sensory.arm.motion import Motion
from nodes.sensory.arm.skeleton import Body, Floats, watch_frames

GRAVITY_M_S2 = 9.81
_STEP_S = 1e-3  # between the poses that are compared; errors of the method are below 1e-3 m/s²
_LEFT_ACC = np.array([-1.0, 1.0, 1.0])  # of a mirrored arm: a watch's x points to the hand there,
_LEFT_GYR = np.array([1.0, -1.0, -1.0])  # and turning directions change with the mirror


@dataclass(frozen=True)
class Sensor:
    """How a watch sits on a wrist, and its errors.

    ``turned`` (3, 3) is the watch's attitude on the wrist; ``scale`` (3,) is what each axis of the
    accelerometer makes of 1 m/s²; biases (3,) and noise (standard deviations) in m/s² and rad/s.
    """

    turned: Floats
    scale: Floats
    acc_bias: Floats
    gyr_bias: Floats
    acc_noise: float
    gyr_noise: float
    left_wrist: bool

    def feel(
        self, motion: Motion, body: Body, t: Floats, rng: np.random.Generator
    ) -> tuple[Floats, Floats]:
        """Acceleration (n, 3) with gravity and rotation rate (n, 3), with the sensor's errors."""
        acc, gyr = felt_exactly(motion, body, t)
        if self.left_wrist:
            acc, gyr = acc * _LEFT_ACC, gyr * _LEFT_GYR
        acc, gyr = acc @ self.turned, gyr @ self.turned
        acc *= self.scale
        acc += self.acc_bias + rng.normal(0.0, self.acc_noise, acc.shape)
        gyr += self.gyr_bias + rng.normal(0.0, self.gyr_noise, gyr.shape)
        return acc, gyr


def felt_exactly(motion: Motion, body: Body, t: Floats) -> tuple[Floats, Floats]:
    """What a perfect sensor feels on the right wrist at n times: (n, 3) m/s², (n, 3) rad/s.

    At rest the acceleration is 9.81 m/s² upward (Android's sign). The poses are smooth functions
    of time, so that differences over a short step have no noise to amplify.
    """
    stencil = (t[:, None] + np.array([-_STEP_S, 0.0, _STEP_S])).ravel()
    positions, rotations = watch_frames(motion.poses(stencil), body)
    positions = positions.reshape(-1, 3, 3)
    before, now, after = rotations.reshape(-1, 3, 3, 3).transpose(1, 0, 2, 3)
    moving = (positions[:, 0] - 2 * positions[:, 1] + positions[:, 2]) / _STEP_S**2
    force = moving + np.array([0.0, 0.0, GRAVITY_M_S2])
    acc = np.einsum("nij,ni->nj", now, force)
    turn = np.einsum("nij,nik->njk", before, after)
    return acc, _rotation_vectors(turn) / (2 * _STEP_S)


def _rotation_vectors(rotations: Floats) -> Floats:
    """Axis times angle (n, 3) of small rotations (n, 3, 3), below a quarter turn."""
    twice_sine = np.stack(
        [
            rotations[:, 2, 1] - rotations[:, 1, 2],
            rotations[:, 0, 2] - rotations[:, 2, 0],
            rotations[:, 1, 0] - rotations[:, 0, 1],
        ],
        axis=1,
    )
    sine = np.linalg.norm(twice_sine, axis=1, keepdims=True) / 2
    angle_by_sine = np.ones_like(sine)
    np.divide(np.arcsin(np.minimum(sine, 1.0)), sine, out=angle_by_sine, where=sine > 1e-12)
    vectors: Floats = twice_sine / 2 * angle_by_sine
    return vectors
