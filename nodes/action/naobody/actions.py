"""What a robot can be asked to do: one small struct for the arguments of each action."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from msgspec import Meta

from nep_core.errors import ActionFailed
from nodes.action.naobody.body_actions import BODY_ACTIONS, StopMoving
from nodes.action.naobody.motor_actions import MOTOR_ACTIONS
from nodes.action.naobody.sense_actions import SENSE_ACTIONS

LONGEST_TEXT = 5000

PLAIN_WORDS = {
    "Object missing required field": "there is no",
    "Expected": "should be",
    "got": "not",
    "`str`": "text",
    "`float`": "a number",
    "`int`": "a whole number",
    "`bool`": "true or false",
    "`null`": "nothing",
    "`array`": "a list",
    "`object`": "a group of values",
    "<=": "at most",
    ">=": "at least",
}

Text = Annotated[str, Meta(max_length=LONGEST_TEXT)]
WalkLength = Annotated[float, Meta(ge=-20.0, le=20.0)]
TurnAngle = Annotated[float, Meta(ge=-3600.0, le=3600.0)]
LookAngle = Annotated[float, Meta(ge=-180.0, le=180.0)]
Stretch = Annotated[float, Meta(ge=0.1, le=10.0)]
VoicePercent = Annotated[float, Meta(ge=50.0, le=200.0)]
FadeTime = Annotated[float, Meta(ge=0.0, le=60.0)]


class Say(msgspec.Struct, frozen=True):
    """Say a text, with gestures of the arms while speaking."""

    text: Text
    gesture: str = "no_gesture"
    language: str = ""
    speed: VoicePercent = 100.0
    pitch: VoicePercent = 100.0


class Do(msgspec.Struct, frozen=True):
    """Take a posture, such as ``posture_stand``, ``pace`` times as fast as it likes to."""

    posture: str
    pace: Annotated[float, Meta(ge=0.1, le=2.0)] = 1.0


class Imitate(msgspec.Struct, frozen=True):
    """Imitate an animal."""

    animal: str


class Play(msgspec.Struct, frozen=True):
    """Play an animation: as seen in a mirror, backwards, or ``stretch`` times as long."""

    animation: str
    mirror: bool = False
    reverse: bool = False
    stretch: Stretch = 1.0


class Walk(msgspec.Struct, frozen=True):
    """Walk so many metres forward and to the left (below 0: back, to the right).

    ``turn_deg``: how far it turns on the way, above 0 to the left.
    """

    forward_m: WalkLength = 0.0
    left_m: WalkLength = 0.0
    turn_deg: TurnAngle = 0.0


class Turn(msgspec.Struct, frozen=True):
    """Turn on the spot: above 0 to the left."""

    degrees: TurnAngle


class Look(msgspec.Struct, frozen=True):
    """Turn the head: yaw above 0 to the left, pitch above 0 down, as NAO counts."""

    yaw_deg: LookAngle = 0.0
    pitch_deg: LookAngle = 0.0


class Leds(msgspec.Struct, frozen=True):
    """Light a group of lights in a colour (``#rrggbb``), fading over some seconds."""

    group: str
    colour: str
    seconds: FadeTime = 0.0


class Stop(msgspec.Struct, frozen=True):
    """End the action with this request id, or all of them: at once, nothing can delay it."""

    request: str = ""


Action = msgspec.Struct
"""What takes its time, and limbs: one of those in ACTIONS."""

AT_ONCE = (Stop, StopMoving)
"""What is done before anything else, and never waits."""

ACTIONS: dict[str, type[Action]] = {
    "say": Say,
    "do": Do,
    "imitate": Imitate,
    "play": Play,
    "walk": Walk,
    "turn": Turn,
    "look": Look,
    "leds": Leds,
    **BODY_ACTIONS,
    **SENSE_ACTIONS,
    **MOTOR_ACTIONS,
    "stop": Stop,
    "stop_moving": StopMoving,
}


def read_action(name: str, args: dict[str, Any]) -> Action:
    """Return a named action with its arguments checked; arguments it does not know are ignored.

    Raises ActionFailed with a sentence that names what is possible.
    """
    if name not in ACTIONS:
        raise ActionFailed(f'There is no action "{name}". Possible actions: {", ".join(ACTIONS)}.')
    kind = ACTIONS[name]
    try:
        return msgspec.convert(args, kind)
    except msgspec.ValidationError as error:
        told, fields = _plain(error), _fields(kind)
        raise ActionFailed(f'"{name}" cannot be done: {told} It takes {fields}.') from error


def _plain(error: msgspec.ValidationError) -> str:
    """Return msgspec's "Expected `float`, got `str` - at `$.degrees`" as people say it."""
    what, _, place = str(error).partition(" - at `$.")
    for word, plain in PLAIN_WORDS.items():
        what = what.replace(word, plain)
    return f"{place.rstrip('`')} {what}.".strip().replace("`", "")


def _fields(kind: type[Action]) -> str:
    fields = [
        field.name if field.required else f"{field.name} (may be left out)"
        for field in msgspec.structs.fields(kind)
    ]
    return ", ".join(fields)
