"""What a virtual robot does for requests about how it is set, and what it listens for."""

from __future__ import annotations

from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task


def change_setting(robot: VirtualRobot, name: str, value: bool | float | str) -> Task:
    """Set a setting of the robot."""
    robot.settings[name] = value
    yield
    return ""


def listen(robot: VirtualRobot, words: list[str], seconds: float) -> Task:
    """Listen for words for some seconds; no words: for anything."""
    robot.listening = tuple(words) or ("",)
    try:
        for _ in range(max(1, round(seconds / TICK_S))):
            yield
    finally:
        robot.listening = ()
    return ""
