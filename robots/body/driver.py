"""What every robot driver offers, and what goes into a robot and comes out of it.

A driver's robot is on the screen or in the room. Requests, results and states have the keys of the
messages of a NEP network, so that a node that plays a robot hands them over as they are. They are
the robot's own all the same: it needs no network.
"""

from __future__ import annotations

import re
import time
from collections.abc import Collection, Sequence
from typing import Any, Literal, NamedTuple, Protocol

import msgspec

from faults import Fault, fault_of

from .actions import Action
from .limbs import Limb

NOTHING = fault_of("")
"""Nothing to say."""

ActionState = Literal["accepted", "started", "done", "failed", "cancelled"]
ThingKind = Literal["person", "ball", "wall", "mark"]


class ActionRequest(msgspec.Struct, kw_only=True, omit_defaults=True):
    """What robots are asked to do.

    The same ``id`` sent again asks how the action is doing: it is never played twice. What has a
    higher ``priority`` takes the limbs that it needs from what has a lower one; ``by`` is what the
    rule or goal that asks is called.
    """

    id: str
    robots: list[str]
    action: str
    args: dict[str, Any] = {}
    priority: int = 0
    by: str = ""


class ActionResult(msgspec.Struct, kw_only=True):
    """How a requested action is going on one robot, and what there is to say about it."""

    id: str
    robot: str
    state: ActionState
    fault: Fault = NOTHING

    @property
    def description(self) -> str:
        """What there is to say, in English."""
        return str(self.fault)


class RobotState(msgspec.Struct, kw_only=True, omit_defaults=True):
    """Where a robot's body is, and how it is.

    ``joints`` are rad by joint name (hands 0 to 1); ``base`` is x m, y m, theta rad on the floor;
    ``leds`` are 0xRRGGBB by group; ``battery`` is 0 to 1. ``sensors`` are numbers by name, in m,
    m/s², rad/s, kg and A, touch sensors 0 or 1. ``sees`` is where things are that it sees or hears
    ("face", "face_anna", "ball", "sound", "mark_64"): x, y, z m in front of, left of, above its
    feet. ``settings`` are how it is set: volume, language, awake, ... ``listening`` are the words
    that it waits for. ``torso`` is where the torso is above the floor: x, y, z m, and roll, pitch,
    yaw rad, turned about z, then y, then x; None when that is not known. ``fallen``: it lies there
    because it lost its balance. ``model`` is which robot it is: the name of its folder, or a path
    to one's own; "" is a NAO.
    """

    robot: str
    joints: dict[str, float]
    model: str = ""
    base: tuple[float, float, float] = (0.0, 0.0, 0.0)
    posture: str = ""
    leds: dict[str, int] = {}
    saying: str = ""
    moving: bool = False
    battery: float = 1.0
    sensors: dict[str, float] = {}
    sees: dict[str, tuple[float, float, float]] = {}
    settings: dict[str, bool | float | str] = {}
    listening: list[str] = []
    torso: tuple[float, float, float, float, float, float] | None = None
    fallen: bool = False
    time: float = msgspec.field(default_factory=time.time)


class SenseRequest(msgspec.Struct, kw_only=True, omit_defaults=True):
    """Lets a virtual robot feel, see or hear something.

    ``sense`` is a sensor ("head_front", "sonar_left", "battery"), which gets the ``value``; or
    "face", "ball", "sound" or "mark", there while ``value`` is above 0, at ``place`` (x, y, z m
    from its feet), a face or mark with a ``name``; or "word", with the ``name`` that was said. Or
    hands: "push" towards a ``place``; "place" puts it down there (x, y m, theta rad on the floor).
    "usual": all sensors measure by themselves again.
    """

    robot: str
    sense: str
    value: float = 1.0
    name: str = ""
    place: tuple[float, float, float] = (1.0, 0.0, 0.5)


class Thing(msgspec.Struct, kw_only=True, omit_defaults=True, frozen=True):
    """Something that stands on the floor near virtual robots.

    ``place`` is x, y m on the floor and z m, how high it is above it (a ball on a table);
    ``heading`` rad is where a person or a mark faces, and a wall's front. ``size`` is how wide,
    deep and high it is, m. ``name`` is a person's, or a mark's number.
    """

    id: str
    kind: ThingKind
    place: tuple[float, float, float]
    heading: float = 0.0
    size: tuple[float, float, float] = (0.4, 0.3, 1.7)
    name: str = ""


class Surroundings(msgspec.Struct, kw_only=True):
    """All that stands around virtual robots."""

    things: list[Thing]


# The words for what a robot notices of people and things: human states.


def state_of_word(word: str) -> str:
    """The human state of a word or sentence: "Good morning!" is heard_good_morning."""
    return "heard_" + plain(word)


def state_of_thing(thing: str) -> str:
    """The human state of something that a robot notices: seen_face, seen_face_anna, heard_sound."""
    return f"heard_{thing}" if thing == "sound" else f"seen_{thing}"


NOT_UNDERSTOOD = "not_understood"
"""The human state of somebody who has said what a robot that listens has not made out."""


def states_of_touch(sensor: str) -> list[str]:
    """The human states of a touch: of the sensor by itself, then of the part that it is on."""
    return [f"touched_{sensor}", f"touched_{sensor.partition('_')[0]}"]


_SIGN = r"(?<!\w)[-\u2212\u2013]\s*(?=[.,]?\d)"
_MARK = r"(?:(?<=\d)|(?<!\w))[.,](?=\d)"
_BETWEEN_WORDS = re.compile(f"(?P<sign>{_SIGN})|(?P<mark>{_MARK})|(?:(?!{_SIGN}|{_MARK})[\\W_])+")
"""What is not part of a word, but for the minus of a number and its decimal mark."""


def plain(words: str) -> str:
    """Words as part of a human state: "Good morning!" is good_morning, "-2,5" is -2.5."""

    def put(found: re.Match[str]) -> str:
        return {"sign": "-", "mark": "."}.get(found.lastgroup or "", "_")

    return _BETWEEN_WORDS.sub(put, words.casefold()).strip("_")


# What every robot driver offers to the action node, be its robot on the screen or in the room.


class Connection(NamedTuple):
    """How the link to the robot is, and what there is to say about it."""

    event: Literal["connecting", "connected", "connection_failed", "disconnected", "warning"]
    fault: Fault = NOTHING


class Ended(NamedTuple):
    """A command that the robot has ended, and what there is to say about it."""

    id: str
    state: Literal["done", "failed"]
    fault: Fault = NOTHING


class Driver(Protocol):
    """One robot. Nothing here waits: ``step`` is called often, and moves on what goes on."""

    @property
    def connection(self) -> Connection:
        """How the link to the robot is."""

    @property
    def moving(self) -> bool:
        """Whether the robot does something."""

    def connect(self) -> None:
        """Begin to connect, and keep trying until ``disconnect``."""

    def disconnect(self) -> None:
        """Give the robot up."""

    def limbs(self, action: Action) -> frozenset[Limb]:
        """Return the limbs that an action needs. Raises ActionFailed if it cannot be done."""

    def start(self, command_id: str, action: Action) -> None:
        """Begin an action; ``step`` tells when it has ended."""

    def stop(self, command_ids: Collection[str]) -> None:
        """End some actions at once; ``step`` does not tell of them any more."""

    def step(self, now_s: float) -> list[Ended]:
        """Go on to a time. Returns early, as soon as a command ends: call until it is empty."""

    def state(self) -> RobotState | None:
        """Return where the robot's body is, or None when that is not known."""

    def sense(self, request: SenseRequest) -> list[str]:
        """Let a virtual robot feel, see or hear something; return the human states that follow."""

    def surroundings(self, things: Sequence[Thing]) -> None:
        """Let a virtual robot know what stands around it; a real one sees for itself."""

    def expect(self, words: Sequence[str]) -> None:
        """Let a real robot listen for the words that rules wait for; a virtual one hears all."""

    def noticed(self) -> list[str]:
        """Return the human states that the robot has noticed by itself since the last call."""

    def halt(self) -> None:
        """Let the robot stop whatever it does, also what this driver does not know of."""
