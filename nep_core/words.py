"""Words that people say, which come as human states: "yes" is heard_yes."""

from __future__ import annotations

import re
import time

from nep_core.tasks import POLL_S, current_task

HEARD = "heard_"
LONGEST_WAIT_S = 3600.0


def state_of_word(word: str) -> str:
    """The human state of a word or sentence: "Good morning!" is heard_good_morning."""
    return HEARD + plain(word)


def state_of_thing(thing: str, name: object = "") -> str:
    """The human state of something that a robot notices: seen_face, seen_face_anna, heard_sound."""
    verb = "heard" if thing == "sound" else "seen"
    return "_".join(filter(None, (verb, thing, plain(str(name)))))


def plain(words: str) -> str:
    """Words as part of a human state: "Good morning!" is good_morning."""
    return re.sub(r"[\W_]+", "_", words.casefold()).strip("_")


def word_of_state(state: str) -> str:
    """The word that a human state tells of, "" when it tells of none."""
    return state.removeprefix(HEARD).replace("_", " ") if state.startswith(HEARD) else ""


def next_word(heard: list[str], wanted: dict[str, str], seconds: float) -> str:
    """Wait for the first state of ``heard`` that is a wanted word, or any word; "" when too late.

    ``heard`` grows while this waits; ``wanted`` is the word of each state.
    """
    task, end_s, looked_at = current_task(), time.monotonic() + seconds, 0
    while True:
        while looked_at < len(heard):
            state = heard[looked_at]
            looked_at += 1
            if state in wanted or (not wanted and word_of_state(state)):
                return wanted.get(state) or word_of_state(state)
        left_s = end_s - time.monotonic()
        if left_s <= 0:
            return ""
        task.sleep(min(POLL_S, left_s))
