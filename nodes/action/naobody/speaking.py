"""What a virtual robot does to say something: it speaks for its time, and makes gestures."""

from __future__ import annotations

from nodes.action.naobody.actions import Say
from nodes.action.naobody.animations import NO_GESTURE
from nodes.action.naobody.body_language import BODY_LANGUAGES, Spoken, spoken_parts
from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task
from nodes.action.naobody.speech import speaking_time_s
from nodes.action.naobody.tasks import at_once, fitted, play, speak


def say(robot: VirtualRobot, action: Say) -> Task:
    """Speak, moving as the gesture says, over and over until the words end."""
    part = action.speed / 100.0
    seconds = speaking_time_s(action.text) / part
    voice = {"voice_speed": action.speed, "voice_pitch": action.pitch}
    spoken_in = action.language or str(robot.settings["language"])
    robot.settings |= voice | {"voice_language": spoken_in}
    tasks = [speak(robot, action.text, seconds)]
    if seconds > 0.0:
        tasks.append(_gestures(robot, spoken(robot, action), part))
    return (yield from at_once(tasks))


def spoken(robot: VirtualRobot, action: Say) -> list[Spoken]:
    """Return the parts of what is said, each with its gesture. Raises ActionFailed."""
    if action.gesture in BODY_LANGUAGES:
        return spoken_parts(action.text, action.gesture, robot.animations, robot.gesture_words)
    if action.gesture != NO_GESTURE:
        robot.animations.get(action.gesture, "gesture")
    return [Spoken(action.text, action.gesture)]


def speaking_limbs(robot: VirtualRobot, action: Say) -> frozenset[Limb]:
    """Return what speaking moves: the voice, and what the gestures need. Raises ActionFailed."""
    limbs = frozenset({Limb.VOICE})
    for part in spoken(robot, action):
        if part.gesture != NO_GESTURE:
            limbs |= robot.animations.get(part.gesture, "gesture").limbs
    return limbs


def _gestures(robot: VirtualRobot, parts: list[Spoken], speed: float) -> Task:
    for part in parts:
        seconds = speaking_time_s(part.text) / speed
        if part.gesture == NO_GESTURE or seconds <= 0.0:
            for _ in range(round(seconds * 100.0)):
                yield
            continue
        animation = robot.animations.get(part.gesture, "gesture")
        yield from play(robot, animation, fitted(robot, animation.keyframes, seconds))
    return ""
