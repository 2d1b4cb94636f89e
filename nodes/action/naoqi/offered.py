"""Offers a virtual robot to NAOqi programs on this computer, while its node lets it live."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from nep_core.messages import ActionResult, SenseRequest
from nodes.action.naobody.actor import Actor
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naoqi.server import Login, Server
from nodes.action.naoqi.services.all import Services
from nodes.action.naoqi.serving import ServedRobot

LOGIN = "NEP_NAOQI_LOGIN"
"""The variable with the user and password that programs must give: ``nao:secret``."""


class Offered:
    """A robot that NAOqi programs ask, at a port of this computer. Raises PortTaken."""

    is_on = True

    def __init__(self, actor: Actor, robot: VirtualRobot, folder: Path, port: int) -> None:
        """``folder``: where the robot's body is described. ``port`` 0 takes any that is free."""
        self.robot = ServedRobot(actor, robot)
        self.lock: contextlib.AbstractContextManager[object] = self.robot.lock
        self._services = Services(self.robot, folder)
        self._server = Server(self._services.by_name, port=port, login=_login())
        self._services.memory.call_module = self._call
        self.port = self._server.start()
        self.description = f"offered to NAOqi programs at tcp://127.0.0.1:{self.port}"

    def hear(
        self, told: Iterable[ActionResult], felt: Sequence[SenseRequest]
    ) -> list[ActionResult]:
        """Tell programs what happened; return the results that others asked for."""
        others = self.robot.hear(told)
        for request in felt:
            self._services.sense(request)
        self._services.notice()
        return others

    def close(self) -> None:
        """End all connections."""
        self._server.stop()

    def _call(self, module: str, name: str, values: list[object]) -> None:
        self._server.tell(module, name, *values)


def _login() -> Login | None:
    user, colon, password = os.environ.get(LOGIN, "").partition(":")
    return Login(user, password) if colon else None
