"""What is painted: bodies, lights, shadows, paths, in every theme and at every size."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QImage

from nep_core.wire.messages import RobotState, Thing
from nep_studio.ui.robot_view.camera import Camera, Lens
from nep_studio.ui.robot_view.figure import RobotFigure
from nep_studio.ui.robot_view.scene import KIND_SIZES, placed_thing
from nep_studio.ui.robot_view.shading import cast_shadow
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.theme.colours import Theme

StateMaker = Callable[..., RobotState]
SIZE = QSize(320, 240)


def pixels(image: QImage) -> np.ndarray:
    image = image.convertToFormat(QImage.Format.Format_RGB32)
    rows = np.frombuffer(image.constBits(), np.uint8)
    return rows.reshape(image.height(), -1, 4)[..., 2::-1].astype(int)


def colour_at(view: RobotView, place: np.ndarray, image: QImage) -> QColor:
    x, y = Lens(view.camera, image.width(), image.height()).project(place).round().astype(int)
    return image.pixelColor(int(x), int(y))


def shown_eye(view: RobotView, state: StateMaker, colour: int) -> tuple[QImage, QColor]:
    """A picture of the face, and the colour of a light of its left eye."""
    view.show_robot("nao", state(leds={"LeftFaceLeds": colour}))
    view.room.step(float("inf"))
    view.look_from("face")
    robot = view.room.scene().robots[0]
    number = next(i for i, part in enumerate(robot.placed.parts) if part.light == "FaceLedLeft0")
    image = view.grab_picture(SIZE)
    return image, colour_at(view, robot.placed.middles()[number], image)


def test_eyes_have_the_colour_of_their_lights(view: RobotView, state: StateMaker) -> None:
    _, red = shown_eye(view, state, 0xFF0000)
    _, green = shown_eye(view, state, 0x00FF00)

    assert red.red() > 200 > 150 > red.green()
    assert green.green() > 200 > 150 > green.red()


def test_one_light_of_an_eye_can_have_a_colour_of_its_own(
    view: RobotView, state: StateMaker
) -> None:
    view.show_robot("nao", state(leds={"LeftFaceLeds": 0x0000FF, "FaceLedLeft0": 0xFF0000}))
    view.look_from("face")
    robot = view.room.scene().robots[0]
    lights = {part.light: i for i, part in enumerate(robot.placed.parts) if part.light}
    image = view.grab_picture(SIZE)

    own, other = (
        colour_at(view, robot.placed.middles()[lights[f"FaceLedLeft{i}"]], image) for i in (0, 4)
    )

    assert own.red() > own.blue()
    assert other.blue() > other.red()


def test_a_light_glows_on_what_is_around_it(view: RobotView, state: StateMaker) -> None:
    dark, _ = shown_eye(view, state, 0x000000)
    lit, _ = shown_eye(view, state, 0xFF0000)

    changed = np.abs(pixels(dark) - pixels(lit)).max(axis=2) > 3
    eye_alone = np.abs(pixels(dark) - pixels(lit)).max(axis=2) > 100
    assert changed.sum() > 2 * eye_alone.sum() > 0


def test_the_shadow_is_under_the_feet(view: RobotView, state: StateMaker) -> None:
    view.show_robot("nao", state())
    view.room.step(float("inf"))
    robot = view.room.scene().robots[0]

    shadow = cast_shadow(robot.placed, view.camera)

    assert shadow is not None
    foot = robot.placed.links["L_ankle"][:2, 3]
    at = ((foot - shadow.low) / shadow.side * shadow.image.width()).astype(int)
    assert shadow.image.pixelColor(int(at[0]), int(at[1])).alpha() > 90
    assert shadow.image.pixelColor(1, 1).alpha() < 10


@pytest.mark.parametrize("posture", ["Stand", "Crouch", "Sit", "SitRelax", "LyingBack"])
def test_a_robot_lies_or_stands_on_the_floor(
    figure: RobotFigure, state: StateMaker, posture: str
) -> None:
    placed = figure.pose(state(posture))

    lowest = placed.farthest(np.array([[0.0, 0.0, -1.0]]))[:, 0, 2].min()
    assert lowest == pytest.approx(0.0, abs=1e-6)


def test_a_told_torso_is_where_it_is_told(figure: RobotFigure, state: StateMaker) -> None:
    placed = figure.pose(state(torso=(0.5, 0.2, 0.4, 0.0, 0.0, 1.0)))

    assert np.allclose(placed.links["torso"][:3, 3], (0.5, 0.2, 0.4))
    assert placed.links["torso"][0, 0] == pytest.approx(np.cos(1.0))


def test_a_closed_hand_is_shorter_than_an_open_one(figure: RobotFigure, state: StateMaker) -> None:
    def reach(opened: float) -> float:
        told = state("StandZero")
        placed = figure.pose(RobotState(robot="n", joints=told.joints | {"LHand": opened}))
        tips = [i for i, part in enumerate(placed.parts) if part.name == "finger_one_tip_left"]
        return float(placed.origins[tips[0], 0])

    assert reach(0.0) < reach(1.0) - 0.01


@pytest.mark.parametrize("size", [(160, 160), (60, 400), (1600, 900)])
def test_a_robot_is_seen_in_every_theme_and_size(
    view: RobotView, state: StateMaker, theme: Theme, size: tuple[int, int]
) -> None:
    view.look.choose(theme.name)
    view.resize(*size)
    view.show_robot("nao", state())
    view.fit()

    image = view.grab_picture(QSize(*size))

    canvas = np.array(theme.colour("canvas").getRgb()[:3])
    far = np.abs(pixels(image) - canvas).max(axis=2) > 40
    assert far.mean() > 0.02


def test_a_robot_of_which_nothing_is_known_is_paler(view: RobotView, state: StateMaker) -> None:
    view.show_robot("nao", state())
    known = pixels(view.grab_picture(SIZE))
    view.show_robot("nao", None)

    unknown = pixels(view.grab_picture(SIZE))

    assert unknown.std() < known.std() * 0.7


def test_a_robot_that_is_gone_is_shown_where_it_was_last(
    view: RobotView, state: StateMaker
) -> None:
    view.show_robot("nao", state(base=(0.4, 0.2, 1.0), saying="Ouch"))
    view.show_robot("nao", None)
    view.room.step(math.inf)

    (robot,) = view.room.scene().robots

    assert robot.state.base == (0.4, 0.2, 1.0)
    assert robot.state.saying == ""


@pytest.mark.parametrize("kind", list(KIND_SIZES))
def test_things_have_their_size_and_stand_on_the_floor(kind: str) -> None:
    thing = Thing(id="1", kind=kind, place=(1.0, 2.0, 0.0), size=KIND_SIZES[kind])

    corners = placed_thing(thing).corners()

    low, high = corners.min(axis=0), corners.max(axis=0)
    assert low[2] == pytest.approx(0.0, abs=0.01)
    assert high[2] == pytest.approx(KIND_SIZES[kind][2], rel=0.03)
    assert np.allclose((low + high)[:2] / 2, (1.0, 2.0), atol=0.06)


def test_what_is_in_front_covers_what_is_behind(view: RobotView, state: StateMaker) -> None:
    view.show_robot("nao", state())
    ball = Thing(id="b", kind="ball", place=(0.3, 0.0, 0.0), size=(0.1, 0.1, 0.1))
    view.show_things([ball])
    view.look_through(Camera(yaw=0.0, pitch=0.05, target=(0.0, 0.0, 0.05), distance=1.2))

    image = view.grab_picture(SIZE)

    colour = colour_at(view, np.array([0.3, 0.0, 0.05]), image)
    assert colour.red() > 1.5 * colour.blue()
