"""What a robot can be asked to do: one small struct for the arguments of each action."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from robots.errors import ActionFailed

from . import keyframes
from .keyframes import LARGEST, problem_of
from .limbs import Limb

# The arguments of what programs can ask of single motors, and of a voice that says nothing.

Firmness = Annotated[float, Meta(ge=0.0, le=1.0)]


def _by_word(*kinds: type[msgspec.Struct]) -> dict[str, type[msgspec.Struct]]:
    """Actions by the words for them: WakeUp is wake_up."""
    return {re.sub(r"\B([A-Z])", r"_\1", kind.__name__).lower(): kind for kind in kinds}


class Target(msgspec.Struct, frozen=True):
    """Where a joint is to go (rad, hands 0 to 1), at most at a part of its top speed."""

    angle: float
    speed: float


class SetAngles(msgspec.Struct, frozen=True):
    """Let joints go to angles (rad, hands 0 to 1); nobody waits until they are there.

    Asked again before that, they go to the new angles from where they are, without a halt.
    """

    angles: dict[str, float]
    speed: Speed = 1.0

    def __post_init__(self) -> None:
        """Raise ValueError for what is no angle."""
        _check_angles(self.angles)


class Approach(msgspec.Struct, frozen=True):
    """Go where ``targets`` say, by joint; they may change meanwhile. Only the actor asks this."""

    limb: Limb
    targets: dict[str, Target]


class ReachAngles(msgspec.Struct, frozen=True):
    """Move joints to angles; all arrive together, none faster than a part of its top speed."""

    angles: dict[str, float]
    speed: Speed = 1.0

    def __post_init__(self) -> None:
        """Raise ValueError for what is no angle."""
        _check_angles(self.angles)


class MoveThrough(msgspec.Struct, frozen=True):
    """Move joints through key angles at their times, as far as their speed allows it.

    ``relative``: the keys are added to where each joint is when it begins.
    """

    tracks: dict[str, keyframes.Track]
    relative: bool = False

    def __post_init__(self) -> None:
        """Raise ValueError for keys that no joint can follow; no keys at all are none."""
        for name, track in self.tracks.items():
            if (track.times or track.keys) and (problem := problem_of(track)):
                raise ValueError(f"{name[:40]}: {problem}")


class SetStiffness(msgspec.Struct, frozen=True):
    """Let the motors of joints hold firmly (1), a little, or not at all (0), in some seconds."""

    joints: dict[str, Firmness]
    seconds: Annotated[float, Meta(ge=0.0, le=60.0)] = 0.0


class Silence(msgspec.Struct, frozen=True):
    """Say nothing for some seconds; what else is to be said waits."""

    seconds: Annotated[float, Meta(ge=0.0, le=70.0)]


def _check_angles(angles: dict[str, float]) -> None:
    if not all(abs(angle) <= LARGEST for angle in angles.values()):
        raise ValueError("an angle is infinite or not a number")


# The arguments of what a robot can be asked to do with its body.

Side = Literal["left", "right", "both"]
Frame = Literal["robot", "torso", "world"]
JointAngle = Annotated[float, Meta(ge=-360.0, le=360.0)]
Length = Annotated[float, Meta(ge=-100.0, le=100.0)]
Share = Annotated[float, Meta(ge=-1.0, le=1.0)]
Patience = Annotated[float, Meta(ge=0.0, le=60.0)]
Speed = Annotated[float, Meta(ge=0.001, le=1.0)]


class Hand(msgspec.Struct, frozen=True):
    """Open or close the hand of a side."""

    side: Side
    open: bool


class MoveJoint(msgspec.Struct, frozen=True):
    """Move a joint to an angle, or by one; ``speed`` is a part of its top speed."""

    joint: str
    degrees: JointAngle
    relative: bool = False
    speed: Speed = 0.3


class Stiffness(msgspec.Struct, frozen=True):
    """Lock the joints of a part of the body, or release them, so that a person can move them."""

    part: str
    on: bool


class WakeUp(msgspec.Struct, frozen=True):
    """Lock all joints and stand up."""


class Rest(msgspec.Struct, frozen=True):
    """Go down to the rest posture and release all joints."""


class Awareness(msgspec.Struct, frozen=True):
    """Let the robot look at people by itself, or not."""

    on: bool


class Breathing(msgspec.Struct, frozen=True):
    """Let the robot move a little as if it breathed, or not."""

    on: bool


class WalkFreely(msgspec.Struct, frozen=True):
    """Walk until something else is asked of the legs; each speed is a part of the highest.

    ``unless_asked_s``: stop by itself when the same request has not come again for so long, so
    that a robot whose driver is gone does not walk on; 0 is never. ``was_known``: the robot has
    answered this request already; one that does not know it was started anew, and stays.
    """

    forward: Share = 0.0
    left: Share = 0.0
    turn: Share = 0.0
    unless_asked_s: Patience = 0.0
    was_known: bool = False


class StopMoving(msgspec.Struct, frozen=True):
    """End what moves joints, at once; what is said or lit goes on."""


class LookAt(msgspec.Struct, frozen=True):
    """Turn the head to a place, m: in front of, left of and above the robot's feet or torso."""

    x_m: Length
    y_m: Length
    z_m: Length
    frame: Frame = "robot"


class PointAt(msgspec.Struct, frozen=True):
    """Point at a place with an arm; "" is the arm on the side of the place."""

    x_m: Length
    y_m: Length
    z_m: Length
    frame: Frame = "robot"
    arm: Literal["left", "right", ""] = ""


class LookAtSeen(msgspec.Struct, frozen=True):
    """Turn the head to something that the robot sees or hears."""

    thing: str


class Track(msgspec.Struct, frozen=True):
    """Keep the head, or the whole body, turned to something; "off" ends it."""

    thing: str
    using: Literal["head", "body", "off"] = "head"


BODY_ACTIONS = _by_word(Hand, MoveJoint, Stiffness, WakeUp, Rest, Awareness, Breathing, WalkFreely)
BODY_ACTIONS |= _by_word(LookAt, PointAt, LookAtSeen, Track)


# The arguments of what a robot can be asked to do with its voice, lights, eyes and ears.

Percent = Annotated[float, Meta(ge=0.0, le=100.0)]
Seconds = Annotated[float, Meta(ge=0.0, le=3600.0)]
Name = Annotated[str, Meta(min_length=1, max_length=100)]
Camera = Literal["top", "bottom"]


class Volume(msgspec.Struct, frozen=True):
    """Set how loud the robot speaks."""

    percent: Percent


class SetLanguage(msgspec.Struct, frozen=True):
    """Set the language that the robot speaks and understands, such as "en"."""

    language: Name


class Listen(msgspec.Struct, frozen=True):
    """Listen for words for some seconds."""

    words: list[str]
    seconds: Seconds


class Intensity(msgspec.Struct, frozen=True):
    """Set how bright a group of lights is."""

    group: str
    percent: Percent


class ResetLeds(msgspec.Struct, frozen=True):
    """Light a group as it was when the robot started."""

    group: str


class RandomEyes(msgspec.Struct, frozen=True):
    """Let the eyes shine in colours by chance for some seconds."""

    seconds: Seconds


class RotateEyes(msgspec.Struct, frozen=True):
    """Let green, yellow and red go round the eyes for some seconds."""

    seconds: Seconds


class LearnFace(msgspec.Struct, frozen=True):
    """Learn the face of the person in front, under a name."""

    name: Name


class ForgetFace(msgspec.Struct, frozen=True):
    """Forget a face."""

    name: Name


class TakePicture(msgspec.Struct, frozen=True):
    """Take a picture with a camera, into a file on the robot."""

    file: Name
    camera: Camera = "top"


class RecordVideo(msgspec.Struct, frozen=True):
    """Record a video with a camera for some seconds, into a file on the robot."""

    file: Name
    seconds: Seconds
    camera: Camera = "top"


class PlaySound(msgspec.Struct, frozen=True):
    """Play a sound file of the robot; the one on the screen has those of this computer.

    It begins at ``start_s``; ``again``: it is played again and again until it is stopped.
    """

    file: Name
    start_s: Seconds = 0.0
    again: bool = False


SENSE_ACTIONS = _by_word(Volume) | {"language": SetLanguage}
SENSE_ACTIONS |= _by_word(Listen, Intensity, ResetLeds, RandomEyes, RotateEyes)
SENSE_ACTIONS |= _by_word(LearnFace, ForgetFace, TakePicture, RecordVideo, PlaySound)


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
    """Say a text, with gestures of the arms while speaking.

    ``usual_language``: that of the program, for a text without a ``language`` of its own; a robot
    that does not speak it says the text as it can.
    """

    text: Text
    gesture: str = "no_gesture"
    language: str = ""
    usual_language: str = ""
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

ACTIONS: dict[str, type[Action]] = {
    **_by_word(Say, Do, Imitate, Play, Walk, Turn, Look, Leds),
    **BODY_ACTIONS,
    **SENSE_ACTIONS,
    **_by_word(SetAngles, ReachAngles, MoveThrough, SetStiffness, Silence, Stop, StopMoving),
}


def read_action(name: str, args: dict[str, Any]) -> Action:
    """Return a named action with its arguments checked; arguments it does not know are ignored.

    Raises ActionFailed with a sentence that names what is possible.
    """
    if name not in ACTIONS:
        raise ActionFailed(
            'There is no action "{name}". Possible actions: {actions}.',
            name=name,
            actions=", ".join(ACTIONS),
        )
    kind = ACTIONS[name]
    try:
        return msgspec.convert(args, kind)
    except msgspec.ValidationError as error:
        # Msgspec's "Expected `float`, got `str` - at `$.degrees`" as people say it
        what, _, place = str(error).partition(" - at `$.")
        for word, plain in PLAIN_WORDS.items():
            what = what.replace(word, plain)
        told = f"{place.rstrip('`')} {what}.".strip().replace("`", "")
        fields = ", ".join(
            field.name if field.required else f"{field.name} (may be left out)"
            for field in msgspec.structs.fields(kind)
        )
        raise ActionFailed(
            '"{name}" cannot be done: {told} It takes {fields}.',
            name=name,
            told=told,
            fields=fields,
        ) from error
