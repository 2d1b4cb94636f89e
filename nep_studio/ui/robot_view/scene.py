"""What is in the room: robots, things on the floor, walked paths; plain data for the painters."""

from __future__ import annotations

from dataclasses import dataclass, field

from nep_core.messages import RobotState, Thing

from .figure import RobotFigure
from .placed import Placed

FloorPlace = tuple[float, float]


@dataclass(frozen=True, eq=False)
class SceneRobot:
    """A robot where its state says it is; a pale one is not there really."""

    name: str
    figure: RobotFigure
    state: RobotState
    placed: Placed
    is_pale: bool = False
    path: tuple[FloorPlace, ...] = ()


@dataclass(frozen=True)
class Marked:
    """The parts that stand out: under the pointer or the keyboard, pressed, or felt."""

    robot: str = ""
    sensor: str = ""
    is_pressed: bool = False
    thing: str = ""
    link: str = ""


@dataclass(frozen=True)
class Scene:
    """All that is painted, beside the camera and the theme."""

    robots: tuple[SceneRobot, ...] = ()
    things: tuple[Thing, ...] = ()
    marked: Marked = field(default_factory=Marked)
    has_floor: bool = True
    has_bubbles: bool = True
