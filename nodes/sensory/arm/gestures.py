"""The paper's five gestures as key poses and the strokes between them, for a right arm.

Made after the gravity directions and the times of the mean curves that the paper's authors
published (NEP, 2018); benchmarks/virtual_watch.py compares. As there, a gesture starts in its
ready pose and ends held: the ways there and back belong to it no more than to any other movement.
"""

from __future__ import annotations

from dataclasses import dataclass

from nep_core.errors import ParameterError

from .motion import Joint, Pose


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
    """A pose of the five joints of the arm, in degrees.

    ``flexion``, ``abduction`` and ``rotation`` are the shoulder's, ``elbow`` and ``pronation``
    the forearm's.
    """
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
    ready={**arm(-39, 10, 16, 111, -63), **trunk(-16, -12)},
    strokes=(
        KeyStroke(0.18, 0.76, arm(-16, 14, 17, 125, -35)),
        KeyStroke(
            0.43, 0.70, {Joint.FLEXION: 83, Joint.ABDUCTION: 1, Joint.ROTATION: 28, **trunk(19, 8)}
        ),
        KeyStroke(0.65, 0.30, {Joint.PRONATION: 81}),
        KeyStroke(0.69, 0.46, {Joint.ELBOW: 2}),
    ),
    duration_s=1.75,
)
_KATANA = Gesture(  # a sword, held with both hands, cut down from overhead and raised again
    "katana",
    ready={**arm(157, 4, 31, 108, 20), **trunk(3)},
    strokes=(
        KeyStroke(0.02, 1.00, {**arm(39, -2, 93, 4, -82), **trunk(-4, 21)}),
        KeyStroke(0.76, 1.25, {**arm(150, 7, 34, 93, 7), **trunk(1)}),
    ),
    duration_s=2.31,
)
_BATTING = Gesture(  # a baseball bat swung from the right shoulder round to the left one
    "batting",
    ready={**arm(3, 41, -89, 146, -46), **trunk(-55, -9)},
    strokes=(
        KeyStroke(0.32, 1.45, arm(64, -20, 59, 7, -85)),
        KeyStroke(0.41, 1.18, trunk(51, 7)),
        KeyStroke(1.42, 0.72, {**arm(99, -25, 35, 26, -82), **trunk(44, 6)}),
    ),
    duration_s=2.06,
)
_HAND_UP = Gesture(  # the hand raised high in front of the body, and kept there
    "hand_up",
    ready={**arm(4, 1, 9, 12, 58), **trunk(0)},
    strokes=(
        KeyStroke(0.46, 1.19, arm(80, -6, 21, 2, 71)),
        KeyStroke(0.90, 1.84, arm(176, -8, 17, 7, 67)),
    ),
    duration_s=3.66,
)
_STRECH_UP = Gesture(  # the hands, fingers laced and palms outward, stretched up slowly
    "strech_up",
    ready={**arm(78, 23, 94, 87, 98), **trunk(0, -5)},
    strokes=(
        KeyStroke(0.54, 2.0, {**arm(127, 12, 89, 73, 96), **trunk(0, -4)}),
        KeyStroke(1.50, 2.11, arm(171, 3, 86, 31, 50)),
    ),
    duration_s=4.28,
)

_HELD_S = 3.0


def _held(name: str, pose: Pose) -> Gesture:
    """A pose that is taken and held for a while, which makes it a posture and no gesture."""
    return Gesture(name, ready=pose, strokes=(), duration_s=_HELD_S)


POSTURES = {
    posture.name: posture
    for posture in (
        _held("arm_raised", {**arm(168, 6, 10, 8, 30), **trunk(0)}),
        _held("arm_level", {**arm(88, 8, 10, 4, 40), **trunk(0)}),
        _held("arm_lowered", {**arm(3, 8, 5, 10, 25), **trunk(0)}),
    )
}
"""How a simulated person holds the arm when asked; by the human states that tell of it."""

MAKES_GESTURE = "makes_gesture"
"""The code of what the virtual watch tells while it makes one, whose name is a value."""

GESTURES = {gesture.name: gesture for gesture in (_BATTING, _HAND_UP, _KARATE, _KATANA, _STRECH_UP)}


def gesture_named(name: str) -> Gesture:
    """The gesture of this name; ParameterError names the known ones."""
    if name not in GESTURES:
        raise ParameterError(
            'The simulated person knows no gesture "{name}".',
            checklist=("Choose one of: {gestures}.",),
            name=name,
            gestures=", ".join(GESTURES),
        )
    return GESTURES[name]
