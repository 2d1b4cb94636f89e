"""The paper's five gestures as key poses and the strokes between them, for a right arm.

Made after the gravity directions and the times of the mean curves that the paper's authors
published (NEP, 2018); benchmarks/virtual_watch.py compares. As there, a gesture starts in its
ready pose and ends held: the ways there and back belong to it no more than to any other movement.
"""

from __future__ import annotations

from dataclasses import dataclass

from nep_core.errors import ParameterError
from nodes.sensory.arm.skeleton import Joint, Pose


@dataclass(frozen=True)
class KeyStroke:
    """A stroke towards a pose, in s from the gesture's start."""

    start_s: float
    duration_s: float
    pose: Pose


@dataclass(frozen=True)
class Gesture:
    """A gesture: where it starts, its strokes, and how long it lasts with the last pose held."""

    name: str
    ready: Pose
    strokes: tuple[KeyStroke, ...]
    duration_s: float


def arm(flexion: float, abduction: float, rotation: float, elbow: float, pronation: float) -> Pose:
    """A pose of the five joints of the arm, in degrees."""
    return {
        Joint.FLEXION: flexion,
        Joint.ABDUCTION: abduction,
        Joint.ROTATION: rotation,
        Joint.ELBOW: elbow,
        Joint.PRONATION: pronation,
    }


def trunk(twist: float, lean: float = 0.0) -> Pose:
    """A pose of the trunk, in degrees."""
    return {Joint.TWIST: twist, Joint.LEAN: lean}


_KARATE = Gesture(  # from the hip up beside the head, then a chop forward; the hand turns over
    "karate",
    ready={**arm(-31, 9, 3, 110, -70), **trunk(-10)},
    strokes=(
        KeyStroke(0.08, 0.66, arm(-13, 13, 11, 134, -42)),
        KeyStroke(
            0.45,
            0.58,
            {Joint.FLEXION: 78, Joint.ABDUCTION: -11, Joint.ROTATION: 29, **trunk(13)},
        ),
        KeyStroke(0.59, 0.36, {Joint.PRONATION: 80}),
        KeyStroke(0.71, 0.45, {Joint.ELBOW: 3}),
    ),
    duration_s=1.75,
)
_KATANA = Gesture(  # a sword, held with both hands, cut down from overhead and raised again
    "katana",
    ready={**arm(153, 6, 30, 105, 22), **trunk(0)},
    strokes=(
        KeyStroke(0.07, 0.92, {**arm(43, -5, 90, 7, -80), **trunk(0, 15)}),
        KeyStroke(0.83, 1.15, {**arm(147, 7, 32, 94, 7), **trunk(0)}),
    ),
    duration_s=2.31,
)
_BATTING = Gesture(  # a baseball bat swung from the right shoulder round to the left one
    "batting",
    ready={**arm(-9, 49, -82, 140, -8), **trunk(-50)},
    strokes=(
        KeyStroke(0.37, 1.16, trunk(33, 3)),
        KeyStroke(0.48, 1.00, arm(54, -10, 42, 14, -85)),
        KeyStroke(1.00, 0.96, {**arm(98, -53, 36, 41, -87), **trunk(56)}),
    ),
    duration_s=2.06,
)
_HAND_UP = Gesture(  # the hand raised high in front of the body, and kept there
    "hand_up",
    ready={**arm(2, 6, 10, 8, 60), **trunk(0)},
    strokes=(
        KeyStroke(0.34, 1.08, arm(84, -3, 12, 8, 63)),
        KeyStroke(0.80, 1.78, arm(175, -6, 12, 6, 62)),
    ),
    duration_s=3.66,
)
_STRECH_UP = Gesture(  # the hands, fingers laced and palms outward, stretched up slowly
    "strech_up",
    ready={**arm(74, 24, 91, 87, 96), **trunk(0)},
    strokes=(
        KeyStroke(0.60, 2.0, {**arm(122, 13, 87, 72, 93), **trunk(0, -3)}),
        KeyStroke(1.50, 2.1, arm(174, 6, 86, 28, 50)),
    ),
    duration_s=4.28,
)

GESTURES = {gesture.name: gesture for gesture in (_BATTING, _HAND_UP, _KARATE, _KATANA, _STRECH_UP)}


def gesture_named(name: str) -> Gesture:
    """The gesture of this name; ParameterError names the known ones."""
    if name not in GESTURES:
        raise ParameterError(
            f'The simulated person knows no gesture "{name}".',
            checklist=(f"Choose one of: {', '.join(GESTURES)}.",),
        )
    return GESTURES[name]
