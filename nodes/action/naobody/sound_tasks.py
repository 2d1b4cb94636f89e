"""What a virtual robot does to play a sound: it is busy with it for as long as it lasts."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from nep_core.errors import ActionFailed
from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task
from nodes.action.naobody.sense_actions import PlaySound
from nodes.action.naobody.sound_files import KINDS, found, length_s

PLAYING = "playing"
"""The setting that says which file is played, "" for none."""


def play_sound(robot: VirtualRobot, action: PlaySound) -> Task:
    """Play a sound file of this computer to its end, or until it is stopped."""
    path = _file(robot, action.file)
    seconds = _seconds(robot, path)
    robot.settings[PLAYING] = str(path)
    try:
        yield from _pass(seconds - action.start_s)
        while action.again:
            yield from _pass(seconds)
    finally:
        robot.settings[PLAYING] = ""
    return ""


def _pass(seconds: float) -> Iterator[None]:
    for _ in range(max(1, round(seconds / TICK_S))):
        yield


def _file(robot: VirtualRobot, file: str) -> Path:
    path = found(file)
    if path is None:
        raise ActionFailed(
            f"{robot.name} finds no sound file “{file}”. Put it into your home folder or its "
            "folder Music, or write the whole path."
        )
    return path


def _seconds(robot: VirtualRobot, path: Path) -> float:
    try:
        return length_s(path)
    except (ValueError, OSError) as error:
        kinds = ", ".join(KINDS)
        raise ActionFailed(
            f"{robot.name} cannot play “{path.name}”: it is not a sound that it knows. "
            f"Possible: {kinds}."
        ) from error
