"""Makes the moving pictures of the examples: what the robots do in each, as an animated WebP.

    .venv/bin/python tools/example_loops.py                 into resources/examples/pictures
    .venv/bin/python tools/example_loops.py NAME...         these examples only
    .venv/bin/python tools/example_loops.py --folder FOLDER into another folder

The virtual robots play on a clock of their own, and our own painter draws them, without a floor: a
picture lies on the colours of each theme. The first frame is the one that stands still.
"""

from __future__ import annotations

import argparse
import os
import struct
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))

import msgspec
import numpy as np
from PySide6.QtCore import QBuffer, QByteArray, QIODevice, QSize, Qt
from PySide6.QtGui import QColor, QFont, QGuiApplication, QImage, QImageWriter, QPainter

from nep_core.wire import messages as m
from nep_studio.project.examples import examples
from nep_studio.ui.robot_view.camera import Camera, Frame, Lens, fitted
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.painter import ScenePainter
from nep_studio.ui.robot_view.scene import Scene, SceneRobot, placed_thing
from nep_studio.ui.theme.colours import load_theme
from robots.body.actor import FINAL, Actor
from robots.body.animations import load_animations
from robots.body.body import load_body
from robots.body.driver import ActionRequest
from robots.body.motion import TICK_S
from robots.body.pose import VirtualRobot
from robots.body.virtual import VirtualDriver

NAO = ROOT / "resources" / "robots" / "nao"
WIDE, HIGH = 400, 240
FRAMES_A_SECOND = 7
MOST_SECONDS = 3.8
QUALITY = 48
ALPHA_STEP = 17
"""How finely it is told how transparent a pixel is: soft shadows would make large files."""
CLOSE = 0.05
"""The share of a picture that stays free around all that moves in it."""

Step = tuple[str, dict[str, object]]


@dataclass(frozen=True)
class Act:
    """What happens in a picture.

    ``parts``: the steps of each robot, which stand beside each other. ``still_s``: when it looks
    as it does while it stands still. ``skip_s`` is left out at the beginning. ``light``: the
    colour of the eyes. ``yaw``: from which side it is seen (rad).
    ``scale``: how much larger than the others it is.
    """

    parts: tuple[tuple[Step, ...], ...]
    still_s: float = 1.5
    skip_s: float = 0.0
    light: str = "#30c8ff"
    things: tuple[m.Thing, ...] = ()
    yaw: float = 0.42
    scale: float = 1.0


def _play(*names: str) -> tuple[Step, ...]:
    return tuple(("play", {"animation": name}) for name in names)


def _person(x: float, y: float) -> m.Thing:
    return m.Thing(
        id="person", kind="person", place=(x, y, 0.0), heading=-1.6, size=(0.26, 0.17, 0.8)
    )


ACTS = {
    "karate_greeting": Act((_play("karate", "bow"),), still_s=1.3, scale=1.6),
    "two_robots_talk": Act((_play("explain", "bow"), _play("dance")), still_s=1.4, yaw=0.0),
    "theatre_sequence": Act((_play("welcome", "bow"),), still_s=1.2, light="#ffd060"),
    "emotions": Act((_play("happy", "love"),), still_s=1.4, light="#ffcc20"),
    "dance": Act((_play("disco"),), still_s=2.0, light="#ff40c0"),
    "five_gestures": Act((_play("batting", "katana"),), still_s=1.4),
    "imitate_animals": Act((_play("elephant"),), still_s=1.6),
    "animal_story": Act((_play("mouse", "crow"),), still_s=1.4),
    "theatre_cues": Act((_play("scared", "bow"),), still_s=1.2, light="#9060ff"),
    "quiz": Act((_play("thinking", "clap"),), still_s=1.4, light="#60ff90"),
    "quiz_table": Act((_play("question", "cheer"),), still_s=1.4, light="#ffd060"),
    "touch_game": Act((_play("point_side", "cheer"),), still_s=1.2, light="#60ff90"),
    "follow_me": Act(
        ((("walk", {"forward_m": 0.16}), ("walk", {"forward_m": -0.16})),),
        things=(_person(0.55, 0.0),),
        yaw=1.2,
    ),
    "museum_coach": Act((_play("strech_up", "clap"),), still_s=1.4, things=(_person(0.1, -0.5),)),
    "morning_greeter": Act((_play("wave"),), still_s=1.3, things=(_person(0.1, -0.5),)),
    "reception": Act((_play("greet", "explain"),), still_s=1.3, things=(_person(0.1, -0.5),)),
    "interrupted_guide": Act((_play("point_side", "welcome"),), still_s=1.3),
    "count_visitors": Act((_play("count"),), still_s=1.3, things=(_person(0.1, -0.5),)),
    "own_blocks": Act((_play("wave"),), still_s=1.3, light="#ffa040"),
    "own_gestures": Act((_play("big", "here"),), still_s=1.3, light="#c080ff"),
}


def main() -> int:
    """Make the pictures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these examples")
    usual = ROOT / "resources" / "examples" / "pictures"
    parser.add_argument("--folder", type=Path, default=usual, help="where the pictures go")
    options = parser.parse_args()
    app = QGuiApplication([])
    options.folder.mkdir(parents=True, exist_ok=True)
    names = options.names or [example.path.stem for example in examples()]
    total = 0
    for name in names:
        frames = list(pictures(ACTS[name]))
        data = animated([webp(frame) for frame in frames], frames[0].size())
        (options.folder / f"{name}.webp").write_bytes(data)
        total += len(data)
        sys.stdout.write(f"{name:20} {len(frames):3} frames {len(data) / 1000:6.0f} kB\n")
    sys.stdout.write(f"{'':20} {total / 1000:17.0f} kB\n")
    del app
    return 0


# What is seen in a picture, frame by frame.


def pictures(act: Act) -> Iterator[QImage]:
    """The frames of an act, first the one that is seen while it stands still."""
    moments = scenes(act)
    camera = _camera(moments, act.yaw)
    painter = ScenePainter(load_theme("light"))
    painter.shades.canvas = QColor(0, 0, 0, 0)
    frames = []
    for scene in moments:
        wide, high = round(WIDE * act.scale), round(HIGH * act.scale)
        image = QImage(2 * wide, 2 * high, QImage.Format.Format_ARGB32_Premultiplied)
        image.fill(0)
        with QPainter(image) as drawn:
            drawn.scale(2, 2)
            painter.paint(drawn, scene, Lens(camera, wide, high), QFont())
        frames.append(_smaller(image, wide, high))
    first = min(round((act.still_s - act.skip_s) * FRAMES_A_SECOND), len(frames) - 1)
    yield from (*frames[first:], *frames[:first])


def scenes(act: Act) -> list[Scene]:
    """What there is at each moment."""
    robots = [list(states(steps, act.light)) for steps in act.parts]
    count = max(map(len, robots))
    figure = load_figure(NAO)
    found = []
    for number in range(count):
        placed = []
        for place, told in enumerate(robots):
            state = _moved(told[min(number, len(told) - 1)], place, len(robots))
            placed.append(SceneRobot(state.robot, figure, state, figure.pose(state)))
        found.append(Scene(tuple(placed), act.things, has_floor=False, has_bubbles=False))
    skipped = round(act.skip_s * FRAMES_A_SECOND)
    return found[skipped : skipped + round(MOST_SECONDS * FRAMES_A_SECOND)]


def states(steps: Sequence[Step], light: str) -> Iterator[m.RobotState]:
    """A robot's states, as often as there are frames, until it has done all steps."""
    body = load_body(NAO)
    animations = load_animations(NAO / "animations", body)
    first = steps[0][1].get("animation")
    posture = animations.get(str(first)).starts_from if first else ""
    driver = VirtualDriver(VirtualRobot("NAO", body, animations, posture or "Stand"))
    actor = Actor("NAO", driver)
    lit: dict[str, object] = {"group": "FaceLeds", "colour": light}
    actor.request(ActionRequest(id="light", robots=["NAO"], action="leds", args=lit))
    now_s, next_s = 0.0, 0.0
    for number, (action, args) in enumerate(steps):
        actor.request(ActionRequest(id=str(number), robots=["NAO"], action=action, args=args))
        is_over = False
        while not is_over:
            now_s += TICK_S
            told = actor.step(now_s)
            is_over = any(one.state in FINAL and one.id == str(number) for one in told)
            if now_s >= next_s:
                next_s += 1 / FRAMES_A_SECOND
                yield msgspec.convert(msgspec.to_builtins(driver.state()), m.RobotState)


def _moved(state: m.RobotState, place: int, count: int) -> m.RobotState:
    """A robot beside the others."""
    if count == 1:
        return state
    aside = 0.24 if place == 0 else -0.24
    x, y, turn = state.base
    torso = state.torso
    if torso is not None:
        torso = (torso[0], torso[1] + aside, *torso[2:])
    return msgspec.structs.replace(
        state, robot=f"NAO{place}", base=(x, y + aside, turn), torso=torso
    )


def _camera(moments: Sequence[Scene], yaw: float) -> Camera:
    """One that sees all that is ever there."""
    corners = [robot.placed.corners() for scene in moments for robot in scene.robots]
    corners += [placed_thing(thing).corners() for thing in moments[0].things]
    return fitted(Camera(yaw=yaw, pitch=0.14), np.concatenate(corners), Frame(WIDE, HIGH), CLOSE)


def _smaller(image: QImage, wide: int, high: int) -> QImage:
    small = image.scaled(
        wide, high, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation
    )
    small = small.convertToFormat(QImage.Format.Format_ARGB32)
    pixels = np.frombuffer(small.bits(), np.uint8).reshape(high, wide, 4)
    alpha = pixels[..., 3]
    alpha[:] = (alpha.astype(int) + ALPHA_STEP // 2) // ALPHA_STEP * ALPHA_STEP
    pixels[alpha == 0] = 0
    return small


# A WebP that moves: Qt writes single ones, whose chunks are put into one file here. Its form is
# told in https://developers.google.com/speed/webp/docs/riff_container

_ANIMATION_AND_ALPHA = 0x12
_NOT_BLENDED = 0x02


def webp(image: QImage) -> bytes:
    """One picture."""
    data = QByteArray()
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    writer = QImageWriter(buffer, b"webp")
    writer.setQuality(QUALITY)
    if not writer.write(image):
        raise OSError(writer.errorString())
    return bytes(data.data())


def animated(frames: Sequence[bytes], of_size: QSize) -> bytes:
    """Pictures of the same size, one after the other for ever."""
    ends = of_size.width() - 1, of_size.height() - 1
    size = b"".join(struct.pack("<I", end)[:3] for end in ends)
    head = _chunk(b"VP8X", bytes([_ANIMATION_AND_ALPHA, 0, 0, 0]) + size)
    head += _chunk(b"ANIM", struct.pack("<IH", 0, 0))
    lasts = struct.pack("<I", round(1000 / FRAMES_A_SECOND))[:3]
    body = b"".join(
        _chunk(b"ANMF", bytes(6) + size + lasts + bytes([_NOT_BLENDED]) + b"".join(_inner(one)))
        for one in frames
    )
    inside = b"WEBP" + head + body
    return b"RIFF" + struct.pack("<I", len(inside)) + inside


def _chunk(name: bytes, data: bytes) -> bytes:
    return name + struct.pack("<I", len(data)) + data + bytes(len(data) % 2)


def _inner(picture: bytes) -> Iterator[bytes]:
    """The chunks of a single picture that have its colours and how transparent they are."""
    at = 12
    while at < len(picture):
        name, (length,) = picture[at : at + 4], struct.unpack("<I", picture[at + 4 : at + 8])
        if name in (b"VP8 ", b"VP8L", b"ALPH"):
            yield _chunk(name, picture[at + 8 : at + 8 + length])
        at += 8 + length + length % 2


if __name__ == "__main__":
    sys.exit(main())
