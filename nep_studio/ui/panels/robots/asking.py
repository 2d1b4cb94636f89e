"""What a person asks robots on the screen for by hand."""

from __future__ import annotations

import uuid

from nep_core import messages as m
from nep_studio.ui.running.runner import Runner


class Asking:
    """Touches robots, and helps them up."""

    def __init__(self, runner: Runner) -> None:
        self._runner = runner

    def touch(self, robot: str, sensor: str, is_pressed: bool) -> None:
        """Touch a sensor, or let go of it."""
        request = m.SenseRequest(robot=robot, sense=sensor, value=float(is_pressed))
        self._runner.send(m.SENSE_REQUEST, request)

    def help_up(self, robot: str) -> None:
        """Let a robot that lies there stand up."""
        request = m.ActionRequest(
            id=uuid.uuid4().hex, robots=[robot], action="do", args={"posture": "posture_stand"}
        )
        self._runner.send(m.ACTION_REQUEST, request)
