"""The arguments of what a robot can be asked to do with its voice, lights, eyes and ears."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

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


SENSE_ACTIONS: dict[str, type[msgspec.Struct]] = {
    "volume": Volume,
    "language": SetLanguage,
    "listen": Listen,
    "intensity": Intensity,
    "reset_leds": ResetLeds,
    "random_eyes": RandomEyes,
    "rotate_eyes": RotateEyes,
    "learn_face": LearnFace,
    "forget_face": ForgetFace,
    "take_picture": TakePicture,
    "record_video": RecordVideo,
    "play_sound": PlaySound,
}
