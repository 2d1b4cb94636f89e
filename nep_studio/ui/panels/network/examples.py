"""Messages to begin with when one is sent by hand, and the check of what was written."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec

from nep_core import messages as m

from .graph_words import pretty

EXAMPLES: Mapping[str, Mapping[str, Any]] = {
    m.NODE_STATE: {"node": "my_node", "type": "sensory", "event": "ready", "description": ""},
    m.IMU: {
        "source": "by_hand",
        "rate_hz": 50.0,
        "t": [0.0, 0.02],
        "acc": [[0.0, 0.0, 9.81], [0.1, 0.0, 9.8]],
        "gyr": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    },
    m.HUMAN_BEHAVIOR: {"human_state": "gesture_karate", "certainty": 0.95, "source": "by_hand"},
    m.ACTION_REQUEST: {
        "id": "by_hand_1",
        "robots": ["NAO"],
        "action": "say",
        "args": {"text": "Hello"},
        "priority": 0,
    },
    m.ACTION_RESULT: {"id": "by_hand_1", "robot": "NAO", "state": "done", "description": ""},
    m.ROBOT_STATE: {"robot": "NAO", "joints": {"HeadYaw": 0.0}, "posture": "posture_stand"},
    m.PROGRAM_STATE: {"program": "program", "event": "value", "values": {"score": "1"}},
    m.PROGRAM_CONTROL: {"command": "pause", "program": "program"},
    m.GESTURE_REQUEST: {"gesture": "karate", "person": -1},
    m.SENSE_REQUEST: {"robot": "NAO", "sense": "head_front", "value": 1.0},
    m.SURROUNDINGS: {"things": [{"id": "ball1", "kind": "ball", "place": [0.5, 0.0, 0.05]}]},
    m.EXPECTED_WORDS: {"words": ["hello", "goodbye"]},
}
"""One for each topic that has a struct; what the struct adds by itself is left out."""


class NotAMessage(Exception):
    """What was written cannot be sent; the text says why, ``line`` where (0: not known)."""

    def __init__(self, reason: str, line: int = 0) -> None:
        super().__init__(reason)
        self.line = line


def example_of(topic: str, last: Any = None) -> str:
    """A message of a topic to begin with: its example, else the last one heard."""
    if topic in EXAMPLES:
        return pretty(dict(EXAMPLES[topic]))
    return pretty(last) if last is not None and not isinstance(last, bytes) else "{\n  \n}"


def read_message(topic: str, text: str) -> msgspec.Struct | dict[str, Any]:
    """What was written, as the struct of its topic or as a dictionary; raises NotAMessage."""
    try:
        data = msgspec.json.decode(text.encode())
    except msgspec.DecodeError as error:
        raise _not_json(text, str(error)) from error
    if not isinstance(data, dict):
        raise NotAMessage("A message begins and ends with a curly bracket.")
    kind = m.BY_TOPIC.get(topic)
    if kind is None:
        return data
    unknown = [key for key in data if key not in kind.__struct_fields__]
    if unknown:
        known = ", ".join(kind.__struct_fields__)
        raise NotAMessage(f"{topic} has no “{unknown[0]}”. It has: {known}.")
    try:
        return msgspec.convert(data, kind)
    except msgspec.ValidationError as error:
        raise NotAMessage(f"{error}.".replace("`", "“", 1).replace("`", "”", 1)) from error


def _not_json(text: str, reason: str) -> NotAMessage:
    """Say where JSON is broken: msgspec names the byte."""
    _, _, tail = reason.partition("(byte ")
    place = int(tail.rstrip(")")) if tail.rstrip(")").isdigit() else -1
    if place < 0:
        return NotAMessage("This is not complete JSON: a bracket or a quote is missing.")
    line = text.encode()[:place].count(b"\n") + 1
    return NotAMessage(f"This is not JSON: look at line {line}.", line)
