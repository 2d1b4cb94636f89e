"""Reads what NAOqi programs give: one name or a list of them, a number or lists of numbers."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from string import Formatter
from typing import Any

from robots.body.body import Body
from robots.naoqi.wire.errors import CallFailed

LEFT_RIGHT = {
    "Arm": ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand"),
    "Leg": ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll"),
}
LEG = ("HipRoll", "HipPitch", "KneePitch")
"""The one leg of Pepper."""
CHAINS: dict[str, tuple[str, ...]] = {"Head": ("HeadYaw", "HeadPitch")} | {
    f"{side}{part}": tuple(f"{side}{joint}" for joint in joints)
    for part, joints in LEFT_RIGHT.items()
    for side in "LR"
}
CHAINS["Leg"] = LEG
CHAINS["Arms"] = CHAINS["LArm"] + CHAINS["RArm"]
CHAINS["Legs"] = CHAINS["LLeg"] + CHAINS["RLeg"]
EVERYTHING = ("Body", "Joints", "JointActuators", "Actuators")


def joint_names(body: Body, name: str) -> list[str]:
    """Return the joints of a chain or group, or the one joint. Raises CallFailed."""
    if name in EVERYTHING:
        return list(body.names)
    known = chains_of(body)
    if name in known:
        return known[name]
    if name in body.index:
        return [name]
    raise CallFailed(
        "There is no joint, chain or group “{name}”. Chains: {known}, Body.",
        name=name,
        known=", ".join(known),
    )


def chains_of(body: Body) -> dict[str, list[str]]:
    """Return the chains and groups that a robot has, with their joints."""
    joints = {name: [one for one in CHAINS[name] if one in body.index] for name in CHAINS}
    return {name: known for name, known in joints.items() if known}


def joints_of(body: Body, names: Any) -> list[str]:
    """Return all joints that a name or a list of names means, in that order."""
    return [joint for name in texts(names) for joint in joint_names(body, name)]


def texts(value: Any) -> list[str]:
    """Return one text, or each of a list of them."""
    values = [value] if isinstance(value, str) else value
    if not isinstance(values, Sequence) or not all(isinstance(one, str) for one in values):
        raise CallFailed("A name or a list of names was expected, not {value}.", value=repr(value))
    return list(values)


def number(value: Any) -> float:
    """Return a number. Raises CallFailed for anything else, infinity too."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value):
        raise CallFailed("A number was expected, not {value}.", value=repr(value))
    return float(value)


def numbers(value: Any, count: int, what: str) -> list[float]:
    """Return so many numbers, one for each joint; a single one stands for all of them."""
    if not isinstance(value, (list, tuple)):
        return [number(value)] * count
    if len(value) == 1:
        return [number(value[0])] * count
    return [number(one) for one in _counted(value, count, what)]


def _counted(found: Sequence[Any], count: int, what: str) -> Sequence[Any]:
    if len(found) != count:
        raise CallFailed(
            "There are {count} {what} for {count_2} joints.",
            count=len(found),
            what=what,
            count_2=count,
        )
    return found


def lists(value: Any, count: int, what: str) -> list[list[float]]:
    """Return for each joint a list of numbers.

    A number or a list of numbers means one each for several joints, all of them for a single one.
    """
    if not isinstance(value, (list, tuple)):
        return [[number(value)] for _ in range(count)]
    if any(isinstance(one, (list, tuple)) for one in value):
        rows = [list(one) if isinstance(one, (list, tuple)) else [one] for one in value]
        if len(rows) == 1 and count > 1:
            rows = rows * count
    elif count == 1:
        rows = [list(value)]
    else:
        rows = [[one] for one in value] if len(value) > 1 else [list(value)] * count
    return [[number(one) for one in row] for row in _counted(rows, count, what)]


def one_of(value: Any, choices: Collection[Any], sentence: str) -> Any:
    """Return a value that is one of the choices. Raises CallFailed with the sentence.

    The sentence has two places, for the value and for all choices, or only the first one.
    """
    if value not in choices:
        places = [place for _, place, _, _ in Formatter().parse(sentence) if place]
        told = (value, ", ".join(map(str, choices)))
        raise CallFailed(sentence, **dict(zip(places, told, strict=False)))
    return value


def rows(value: Any, what: str) -> list[Any]:
    """Return a list of anything. Raises CallFailed for what is none."""
    if not isinstance(value, (list, tuple)):
        raise CallFailed("{what}: a list was expected, not {value}.", what=what, value=repr(value))
    return list(value)


def within(value: float, low: float, high: float, what: str) -> float:
    """Return a ``value`` from ``low`` to ``high``. Raises CallFailed, which calls it ``what``."""
    if not low <= number(value) <= high:
        raise CallFailed(
            "{what} must be from {low} to {high}, not {value}.",
            what=what,
            low=f"{low:g}",
            high=f"{high:g}",
            value=f"{value:g}",
        )
    return float(value)


def words(value: Any, what: str) -> dict[str, Any]:
    """Return what a program gave as a map, or as a list of pairs, as NAOqi's settings are."""
    if isinstance(value, dict):
        return {str(key): one for key, one in value.items()}
    pairs = value if isinstance(value, (list, tuple)) else [value]
    if not all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs):
        raise CallFailed("{what}: a list of pairs of name and value was expected.", what=what)
    return {str(key): one for key, one in pairs}


# The languages that a NAO speaks, by NAOqi's names, and by the codes of this program.

CODES = {
    "Arabic": "ar",
    "Brazilian": "pt_br",
    "Chinese": "zh",
    "Czech": "cs",
    "Danish": "da",
    "Dutch": "nl",
    "English": "en",
    "Finnish": "fi",
    "French": "fr",
    "German": "de",
    "Italian": "it",
    "Japanese": "ja",
    "Korean": "ko",
    "Polish": "pl",
    "Portuguese": "pt",
    "Russian": "ru",
    "Spanish": "es",
    "Swedish": "sv",
    "Turkish": "tr",
}
NAMES = {code: name for name, code in CODES.items()}


def code_of(language: str) -> str:
    """Return the code of a language. Raises CallFailed with those there are."""
    return CODES[one_of(language, CODES, "There is no language “{language}”. Possible: {codes}.")]
