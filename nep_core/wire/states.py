"""How the states of people, and the parts of robots that they touch, are written in messages."""

from __future__ import annotations

import re

# Words that people say, which come as human states: "yes" is heard_yes.

HEARD = "heard_"


def state_of_word(word: str) -> str:
    """The human state of a word or sentence: "Good morning!" is heard_good_morning."""
    return HEARD + plain(word)


def state_of_thing(thing: str, name: object = "") -> str:
    """The human state of something that a robot notices: seen_face, seen_face_anna, heard_sound."""
    verb = "heard" if thing == "sound" else "seen"
    return "_".join(filter(None, (verb, thing, plain(str(name)))))


_SIGN = r"(?<!\w)[-\u2212\u2013]\s*(?=[.,]?\d)"
_MARK = r"(?:(?<=\d)|(?<!\w))[.,](?=\d)"
_BETWEEN_WORDS = re.compile(f"(?P<sign>{_SIGN})|(?P<mark>{_MARK})|(?:(?!{_SIGN}|{_MARK})[\\W_])+")
"""What is not part of a word, but for the minus of a number and its decimal mark."""


def plain(words: str) -> str:
    """Words as part of a human state: "Good morning!" is good_morning, "-2,5" is -2.5."""

    def put(found: re.Match[str]) -> str:
        return {"sign": "-", "mark": "."}.get(found.lastgroup or "", "_")

    return _BETWEEN_WORDS.sub(put, words.casefold()).strip("_")


def word_of_state(state: str) -> str:
    """The word that a human state tells of, "" when it tells of none."""
    return state.removeprefix(HEARD).replace("_", " ") if state.startswith(HEARD) else ""


NOISE = state_of_thing("sound")
"""The human state of a noise: no word, though it begins like one."""
NOT_UNDERSTOOD = "not_understood"
"""The human state of somebody who has said what a robot that listens has not made out."""


TOUCHES = {
    "head": ("head_front", "head_middle", "head_rear"),
    "hand": ("hand_left", "hand_right"),
    "bumper": ("bumper_left", "bumper_right"),
}
"""Parts with several touch sensors."""
