"""What can go wrong with a robot, as one tree.

RobotError
├── ActionFailed      the robot could not do what it was asked
├── FilesUnusable     a file that describes a robot cannot be read
├── WrongAddress      what a person wrote is no address of a robot
├── PortTaken         programs were to reach a robot at a port that another program uses
├── KeyframesUnreadable (robots/body/choregraphe.py)
└── NaoqiError (robots/naoqi/wire/errors.py)
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from faults import FaultError, Text, text_of


class RobotError(FaultError):
    """A robot did not do what it was asked."""

    title = "The robot has a problem"


class ActionFailed(RobotError):
    """The robot could not do what it was asked."""

    title = "The robot could not do it"


class FilesUnusable(RobotError):
    """A file that describes a robot, or how it moves or speaks, cannot be read."""

    title = "A node did not start"


class WrongAddress(RobotError):
    """A text is no address of a robot."""

    title = "A node was started with a wrong setting"


class PortTaken(RobotError):
    """Another program uses the port at which a robot was to be reached."""

    title = "A port is already in use"


def nearest(word: str, known: Iterable[str]) -> tuple[Text, ...]:
    """What to try where a word is not known: the one that is spelt most like it, if there is."""
    near = get_close_matches(word, list(known), 1)
    return tuple(text_of("Did you mean “{near}”?", near=one) for one in near)
