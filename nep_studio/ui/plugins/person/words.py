"""How what can happen is called on a button: "Touch the head", "Say “hello”"."""

from __future__ import annotations

from nep_studio.blocks.program import ALL_ROBOTS
from nep_studio.project.triggers import Happening, Kind
from nep_studio.ui.words import tr

ICONS: dict[Kind, str] = {
    "word": "message-square",
    "face": "user",
    "distance": "ruler",
    "touch": "hand",
    "gesture": "watch",
    "ball": "circle",
    "mark": "target",
    "sound": "volume-2",
    "emotion": "sparkles",
    "state": "eye",
    "sensor": "gauge",
    "joint": "rotate-ccw",
    "posture": "person-standing",
    "doing": "bot",
    "idle": "hourglass",
}
"""The sign of each kind."""


def words_of(happening: Happening) -> str:
    """What one does so that something happens, on a button: "Touch the head"."""
    about = happening.words or happening.value
    words = _words(happening, about)
    is_named = happening.robot not in (ALL_ROBOTS, "")
    return tr("{what} ({robot})", what=words, robot=happening.robot) if is_named else words


def _words(happening: Happening, about: str) -> str:
    match happening.kind:
        case "word":
            return tr("Say “{word}”", word=about or tr("hello"))
        case "face":
            return tr("{name} comes", name=about) if about else tr("Somebody comes")
        case "distance":
            return tr("Stand {distance}", distance=about)
        case "touch":
            return tr("Touch {part}", part=about)
        case "gesture":
            return tr("Make the gesture {gesture}", gesture=about)
        case "ball":
            return tr("Show the red ball")
        case "mark":
            return tr("Show the mark {number}", number=about) if about else tr("Show a mark")
        case "sound":
            return tr("Make a sound")
        case "emotion":
            return tr("Look {emotion}", emotion=about)
    return _measured_words(happening, about)


def _measured_words(happening: Happening, about: str) -> str:
    amount = happening.amount
    match happening.kind:
        case "sensor" if amount is not None:
            return tr("{sensor}: {amount}", sensor=about, amount=f"{amount:g}")
        case "joint":
            return tr("Turn {joint}", joint=about)
        case "posture":
            return tr("Let it take the posture {posture}", posture=about)
        case "doing":
            return tr("Let it be {doing}", doing=about)
        case "idle":
            return tr("Do nothing for {seconds} s", seconds=f"{amount or 0:g}")
        case "state" if not happening.value:
            return tr("Touch the head, or do anything else")
    return about[:1].upper() + about[1:]
