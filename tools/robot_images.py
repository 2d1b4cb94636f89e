"""Makes the pictures of the robots' room, in light and dark, or says which are out of date.

    .venv/bin/python tools/robot_images.py                  into docs/images
    .venv/bin/python tools/robot_images.py --check          compare, change nothing
    .venv/bin/python tools/robot_images.py --folder FOLDER  into another folder

They are painted without a screen and without OpenGL, so every machine paints the same.
"""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))

from PySide6.QtCore import QSize
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from nep_core.wire.messages import RobotState, Thing
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.view import RobotView, nao_folder
from nep_studio.ui.theme.look import Look, load_fonts

SIZE = QSize(800, 500)
BLUE, GREEN, WARM = 0x30C8FF, 0x50F0A0, 0xFFB040
LIGHTS = ("LeftFace", "RightFace", "LeftEar", "RightEar", "Chest", "LeftFoot", "RightFoot", "Brain")
ARMS_UP = {"RShoulderPitch": -0.9, "RShoulderRoll": -0.3, "RElbowYaw": 1.0, "RElbowRoll": 0.9}
OFFERING = {"LShoulderPitch": 0.7, "LShoulderRoll": 0.35, "LElbowYaw": -1.6, "LElbowRoll": -0.9}
SURROUNDINGS = [
    Thing(id="anna", kind="person", place=(-0.28, -0.5, 0.0), heading=0.9, size=(0.32, 0.2, 0.98)),
    Thing(id="ball", kind="ball", place=(0.42, 0.05, 0.0), size=(0.12, 0.12, 0.12)),
    Thing(id="mark", kind="mark", place=(-0.35, 0.5, 0.0), heading=-0.3, size=(0.16, 0.02, 0.5)),
    Thing(id="wall", kind="wall", place=(-0.75, 0.25, 0.0), size=(0.9, 0.05, 0.42)),
]


def main() -> int:
    """Make or compare the pictures; the exit code is 1 when one is out of date."""
    from tools.image_files import difference

    options = _parsed()
    app = QApplication([])
    load_fonts()
    is_out_of_date = False
    for theme in ("light", "dark"):
        for name, made in (("robots-talking", _talking), ("robot-room", _room)):
            image, path = made(Look(app, theme)), options.folder / f"{name}-{theme}.png"
            reason = difference(image, path) if options.check else _write(image, path)
            is_out_of_date = is_out_of_date or bool(options.check and reason)
            sys.stdout.write(f"{path.stem:24} {reason or 'as it was'}\n")
    return int(is_out_of_date)


def _write(image: QImage, path: Path) -> str:
    """Write a picture with all its colours, for soft shades need them; gives its size in words."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not image.save(str(path), format=b"PNG", quality=0):
        raise OSError(f"{path} cannot be written.")
    return f"{path.stat().st_size / 1000:.0f} kB"


def _talking(look: Look) -> QImage:
    """Two robots that talk to each other."""
    view = _view(look)
    asks = _state("anna", "Stand", (0.0, 0.3, -1.0), BLUE, ARMS_UP | {"HeadYaw": -0.2})
    answers = _state("otto", "StandInit", (0.05, -0.34, 0.9), GREEN, OFFERING | {"HeadYaw": 0.15})
    view.show_robot("anna", _saying(asks, "Hello. Shall we tell the children a story?"))
    view.show_robot("otto", _saying(answers, "Yes, the one with the dragon. I can be the dragon."))
    return _picture(view)


def _room(look: Look) -> QImage:
    """A robot among a person, a ball, a wall and a landmark."""
    view = _view(look)
    for step in range(30):
        base = (-0.25 + 0.01 * step, 0.3 - 0.0003 * step * step, -0.02 * step)
        state = _state("anna", "StandInit", base, WARM, {"HeadYaw": -0.75, "HeadPitch": -0.5})
        view.show_robot("anna", state)
        view.room.step(float("inf"))
    view.show_things(SURROUNDINGS)
    return _picture(view)


def _view(look: Look) -> RobotView:
    view = RobotView(look, drawing="painter")
    view.resize(SIZE)
    return view


def _picture(view: RobotView) -> QImage:
    view.room.step(float("inf"))
    view.look_through(replace(view.camera, yaw=0.32, pitch=0.2))
    view.fit()
    return view.grab_picture(SIZE)


def _state(
    name: str, posture: str, base: tuple[float, float, float], colour: int, joints: dict[str, float]
) -> RobotState:
    body = load_figure(nao_folder()).body
    standing = dict(zip(body.names, body.posture_angles(posture).tolist(), strict=True))
    leds = {f"{light}Leds": colour for light in LIGHTS}
    return RobotState(robot=name, joints=standing | joints, posture=posture, base=base, leds=leds)


def _saying(state: RobotState, words: str) -> RobotState:
    state.saying = words
    return state


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    images = ROOT / "docs" / "images"
    parser.add_argument("--folder", type=Path, default=images, help="where the pictures are")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
