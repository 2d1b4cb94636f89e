"""What a real robot does with its voice and its ears, and with movements beside its words."""

from __future__ import annotations

from nep_core.errors import ActionFailed
from nodes.action.naobody import actions as a
from nodes.action.naobody import sense_actions as s
from nodes.action.naobody.animations import NO_GESTURE, Animation
from nodes.action.naobody.body_language import Spoken
from nodes.action.naobody.keyframes import Keyframes
from nodes.action.naobody.running import Task
from nodes.action.naobody.speaking import spoken
from nodes.action.naobody.speech import speaking_time_s
from nodes.action.naobody.tasks import at_once, changed, fitted
from nodes.action.naoqi.driver.calls import waited
from nodes.action.naoqi.driver.moving import play_keyframes, return_to_posture, take_posture
from nodes.action.naoqi.driver.real import RealRobot
from nodes.action.naoqi.driver.watched import LANGUAGES, language_code

SLOWEST_VOICE = 4.0
VOLUME_OFF = 2.0


def say(robot: RealRobot, action: a.Say) -> Task:
    """Speak, moving as the gesture says meanwhile."""
    parts = spoken(robot.known, action)
    tasks = [speak(robot, action)]
    if any(part.gesture != NO_GESTURE for part in parts):
        tasks.append(_gestures(robot, parts, action.speed / 100.0))
    return (yield from beside(tasks))


def speak(robot: RealRobot, action: a.Say) -> Task:
    """Say a text, perhaps in a language of its own, faster or higher."""
    words = action.text.replace("\\", " ")  # begins what NAOqi's voice takes as a command
    if not words.strip():
        return ""
    seconds = speaking_time_s(words) * 100.0 / action.speed
    told = [_voice(action) + words]
    if action.language:
        told.append((yield from _language_name(robot, action.language)))
    robot.known.saying = action.text
    try:
        yield from robot.call(
            "ALTextToSpeech", "say", *told, limit_s=10.0 + SLOWEST_VOICE * seconds
        )
    finally:
        robot.known.saying = ""
    return ""


def imitate(robot: RealRobot, action: a.Imitate) -> Task:
    """Imitate an animal."""
    return play(robot, robot.known.animations.get(action.animal, "animal"))


def play_changed(robot: RealRobot, action: a.Play) -> Task:
    """Play an animation, mirrored, backwards or slower if that is wanted."""
    animation = robot.known.animations.get(action.animation)
    return play(robot, animation, changed(animation.keyframes, action))


def play(robot: RealRobot, animation: Animation, keyframes: Keyframes | None = None) -> Task:
    """Play an animation with its sound, and go back to the posture that it began in."""
    yield from robot.take_over()
    if animation.starts_from and animation.starts_from != robot.known.posture:
        yield from take_posture(robot, animation.starts_from)
    tasks = [_act(robot, keyframes or animation.keyframes)]
    if animation.says:
        tasks.append(speak(robot, a.Say(animation.says)))
    return (yield from beside(tasks))


def set_volume(robot: RealRobot, action: s.Volume) -> Task:
    """Set how loud the robot is, and look that it is."""
    percent = round(action.percent)
    yield from robot.call("ALAudioDevice", "setOutputVolume", percent)
    found = yield from robot.call("ALAudioDevice", "getOutputVolume")
    if abs(float(found) - percent) > VOLUME_OFF:
        raise ActionFailed(f"{robot.name} speaks with volume {found} %, not with {percent} %.")
    robot.known.settings["volume"] = float(action.percent)
    return ""


def set_language(robot: RealRobot, action: s.SetLanguage) -> Task:
    """Set the language that the robot speaks and understands."""
    name = yield from _language_name(robot, action.language)
    yield from robot.call("ALTextToSpeech", "setLanguage", name, limit_s=10.0)
    if robot.calls.has("ALSpeechRecognition", "setLanguage"):
        yield from robot.call("ALSpeechRecognition", "setLanguage", name, limit_s=10.0)
    robot.known.settings["language"] = action.language
    return ""


def beside(tasks: list[Task]) -> Task:
    """Run tasks side by side; when one fails, or this is stopped, the others are ended too."""
    all_of_them = list(tasks)
    try:
        return (yield from at_once(tasks))
    finally:
        for task in all_of_them:
            task.close()


def _act(robot: RealRobot, keyframes: Keyframes) -> Task:
    notes = yield from play_keyframes(robot, keyframes)
    yield from return_to_posture(robot, list(keyframes.tracks))
    return notes


def _gestures(robot: RealRobot, parts: list[Spoken], speed: float) -> Task:
    """Make the gesture of each part of what is said, in about the time that it takes."""
    for part in parts:
        seconds = speaking_time_s(part.text) / speed
        if part.gesture == NO_GESTURE or seconds <= 0.0:
            yield from waited(seconds)
            continue
        animation = robot.known.animations.get(part.gesture, "gesture")
        yield from play(robot, animation, fitted(robot.known, animation.keyframes, seconds))
    return ""


def _voice(action: a.Say) -> str:
    """What NAOqi's voice takes as a wish for another speed and pitch, before the words."""
    wishes = {"rspd": action.speed, "vct": action.pitch}
    return "".join(f"\\{name}={round(to)}\\ " for name, to in wishes.items() if to != 100.0)


def _language_name(robot: RealRobot, code: str) -> Task:
    name = LANGUAGES.get(code, code)
    known = yield from robot.call("ALTextToSpeech", "getAvailableLanguages")
    if name not in known:
        spoken = ", ".join(language_code(one) for one in known)
        raise ActionFailed(f"{robot.name} does not speak {name}. Languages on it: {spoken}.")
    return name
