"""Makes film strips of animations and a sheet of the postures, in light and dark.

    .venv/bin/python tools/animation_strips.py                  into docs/images
    .venv/bin/python tools/animation_strips.py --check          compare, change nothing
    .venv/bin/python tools/animation_strips.py --folder FOLDER bow wave    strips of these

The virtual robot plays each animation on a clock of its own; the pictures are what its view shows.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
ANIMATIONS = ("wave", "karate", "elephant", "gorilla", "disco", "laugh")
THEMES = ("light", "dark")

os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))

import msgspec
import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QImage, QPainter
from PySide6.QtWidgets import QApplication

from nep_core.wire import messages as m
from nep_studio.ui.robot_view.camera import Camera, Lens
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.painter import ScenePainter
from nep_studio.ui.robot_view.scene import Scene, SceneRobot
from nep_studio.ui.theme.colours import load_theme
from robots.body.actor import FINAL, Actor
from robots.body.animations import Animation, load_animations
from robots.body.body import load_body
from robots.body.driver import ActionRequest, RobotState
from robots.body.motion import TICK_S
from robots.body.pose import VirtualRobot
from robots.body.virtual import VirtualDriver


def main() -> int:
    """Make or compare the pictures; the exit code is 1 when one is out of date."""
    options = _parsed()
    from tools.image_files import difference, write_small

    app = QApplication([])
    out_of_date = False
    for theme in THEMES:
        strips = Strips(ROOT / "resources" / "robots" / options.robot, theme)
        pictures = {"animations": strips.animations(options.names or ANIMATIONS)}
        if not options.names:
            pictures["postures"] = strips.postures()
        for name, image in pictures.items():
            path = options.folder / f"{name}-{theme}.png"
            reason = difference(image, path) if options.check else write_small(image, path)
            out_of_date = out_of_date or bool(options.check and reason)
            sys.stdout.write(f"{path.stem:24} {reason or 'as it was'}\n")
    app.quit()
    return int(out_of_date)


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these animations")
    parser.add_argument("--robot", default="nao", help="the folder of the robot")
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    parser.add_argument("--folder", type=Path, default=IMAGES, help="where the pictures are")
    return parser.parse_args()


FRAMES = 8
WIDE, HIGH = 156, 196
TITLE = 22
CAMERA = Camera(yaw=0.5, pitch=0.16, distance=1.62, target=(0.02, 0.0, 0.29))
LYING_CAMERA = Camera(yaw=0.9, pitch=0.35, distance=1.62, target=(0.0, 0.0, 0.2))
NAO_HIGH_M = 0.58
"""The cameras are placed for a robot of this height."""
BEFORE_S = 20.0
"""No posture takes longer to be reached."""


def _seen(state: RobotState) -> m.RobotState:
    """The state as the window gets it, by a message."""
    return msgspec.convert(msgspec.to_builtins(state), m.RobotState)


class Strips:
    """Sheets of one robot in one theme."""

    def __init__(self, folder: Path, theme: str) -> None:
        self._folder = folder
        self._body = load_body(folder)
        self._known = load_animations(folder / "animations", self._body)
        self._figure = load_figure(folder)
        self._theme = load_theme(theme)
        self._painter = ScenePainter(self._theme)
        standing = self._figure.pose(_seen(self._actor("Stand")[0].state()))
        self._times_nao = float(standing.corners()[:, 2].max()) / NAO_HIGH_M

    def animations(self, names: Sequence[str]) -> QImage:
        """One row for each animation: its title, and the robot at moments of it."""
        rows = {self._known.get(name).title: list(self._moments(name)) for name in names}
        return self._sheet(rows, FRAMES, self._placed(CAMERA))

    def postures(self) -> QImage:
        """All postures but the one with the motors off, each with its name, four in a row."""
        names = [name for name in self._body.postures if name != "Rest"]
        image = self._empty(4 * WIDE, -(-len(names) // 4) * (HIGH + TITLE))
        painter = QPainter(image)
        for number, name in enumerate(names):
            at = QPointF(number % 4 * WIDE, number // 4 * (HIGH + TITLE))
            self._write(painter, at, name)
            state = self._in_posture(name)
            x, y = (state.torso or (0.0, 0.0))[:2]
            camera = self._placed(LYING_CAMERA)
            camera = replace(camera, target=(x, y, camera.target[2]))
            self._draw(painter, at + QPointF(0, TITLE), state, camera)
        painter.end()
        return image

    def _placed(self, camera: Camera) -> Camera:
        """A camera as far away as the robot is large."""
        x, y, z = (part * self._times_nao for part in camera.target)
        return replace(camera, distance=camera.distance * self._times_nao, target=(x, y, z))

    def _sheet(self, rows: dict[str, list[RobotState]], columns: int, camera: Camera) -> QImage:
        image = self._empty(columns * WIDE, len(rows) * (HIGH + TITLE))
        painter = QPainter(image)
        for row, (title, states) in enumerate(rows.items()):
            at = QPointF(0, row * (HIGH + TITLE))
            self._write(painter, at, title)
            for column, state in enumerate(states):
                self._draw(painter, at + QPointF(column * WIDE, TITLE), state, camera)
        painter.end()
        return image

    def _empty(self, width: int, height: int) -> QImage:
        image = QImage(width, height, QImage.Format.Format_RGB32)
        image.fill(self._theme.colour("canvas"))
        return image

    def _write(self, painter: QPainter, at: QPointF, words: str) -> None:
        painter.setPen(self._theme.colour("text"))
        box = QRectF(at.x() + 8, at.y(), WIDE * 4, TITLE)
        painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, words)

    def _draw(self, painter: QPainter, at: QPointF, state: RobotState, camera: Camera) -> None:
        told = _seen(state)
        robot = SceneRobot(state.robot, self._figure, told, self._figure.pose(told))
        frame = QImage(WIDE, HIGH, QImage.Format.Format_RGB32)
        on_frame = QPainter(frame)
        scene = Scene((robot,), has_floor=False, has_bubbles=False)
        self._painter.paint(on_frame, scene, Lens(camera, WIDE, HIGH), QFont())
        on_frame.end()
        painter.drawImage(at, frame)

    def _moments(self, name: str) -> Iterator[RobotState]:
        """The robot at evenly chosen poses of an animation, the first and the last with them."""
        animation = self._known.get(name)
        driver, actor = self._actor(animation.starts_from or "Stand")
        actor.request(_asked("play", {"animation": name}))
        now_s = 0.0
        for moment_s in _chosen(animation):
            while now_s < moment_s:
                now_s += TICK_S
                actor.step(now_s)
            yield driver.state()

    def _in_posture(self, name: str) -> RobotState:
        driver, actor = self._actor("Stand")
        actor.request(_asked("do", {"posture": name}))
        now_s = 0.0
        while now_s < BEFORE_S and not any(told.state in FINAL for told in actor.step(now_s)):
            now_s += TICK_S
        return driver.state()

    def _actor(self, posture: str) -> tuple[VirtualDriver, Actor]:
        driver = VirtualDriver(VirtualRobot("NAO", self._body, self._known, posture))
        return driver, Actor("NAO", driver)


def _asked(action: str, args: dict[str, object]) -> ActionRequest:
    return ActionRequest(id="1", robots=["NAO"], action=action, args=args)


def _chosen(animation: Animation) -> list[float]:
    """When the FRAMES poses are reached that differ the most from each other, in order."""
    tracks = animation.keyframes.tracks.values()
    times = np.array(sorted({time for track in tracks for time in track.times}))
    poses = np.array([np.interp(times, track.times, track.keys) for track in tracks]).T
    chosen = [0]
    while len(chosen) < min(FRAMES, len(times)):
        gaps = np.linalg.norm(poses[:, None] - poses[chosen], axis=2).min(axis=1)
        gaps[chosen] = -1.0
        chosen.append(int(gaps.argmax()))
    return [float(times[number]) for number in sorted(chosen)]


if __name__ == "__main__":
    sys.exit(main())
