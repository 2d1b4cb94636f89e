"""Robot: what a program can ask a social robot to do, in the words of people."""

from __future__ import annotations

from typing import Any

from nep_core.actions import action_client
from nep_core.errors import RobotError
from nep_core.network import Network


class Robot:
    """One robot by name, or several that act at once.

    Every call returns when all of them are done; it raises RobotNotAnswering or ActionFailed.
    """

    def __init__(self, robots: str | list[str], *, network: Network | None = None) -> None:
        self.robots = [robots] if isinstance(robots, str) else list(robots)
        if not self.robots or not all(isinstance(name, str) and name for name in self.robots):
            raise RobotError(
                "A robot needs a name.",
                checklist=('Write Robot("NAO") or Robot(["NAO", "NAO2"]).',),
            )
        self._network = network

    def say(self, text: object, gesture: str = "no_gesture", language: str = "") -> None:
        """Say a text aloud, perhaps with a gesture, in a language such as "en"."""
        self._perform("say", text=str(text), gesture=gesture, language=language)

    def do(self, posture: str) -> None:
        """Take a posture: "posture_stand", "posture_sit", ..."""
        self._perform("do", posture=posture)

    def imitate(self, animal: str) -> None:
        """Imitate an animal: "cat", "elephant", ..."""
        self._perform("imitate", animal=animal)

    def play(
        self, animation: str, *, mirror: bool = False, reverse: bool = False, stretch: float = 1.0
    ) -> None:
        """Play an animation: left for right, backwards, or ``stretch`` times as long."""
        self._perform("play", animation=animation, mirror=mirror, reverse=reverse, stretch=stretch)

    def walk(self, forward_m: float, left_m: float = 0.0) -> None:
        """Walk so many metres forward (negative: back) and to the left."""
        self._perform("walk", forward_m=forward_m, left_m=left_m)

    def turn(self, degrees: float) -> None:
        """Turn on the spot, to the left (negative: to the right)."""
        self._perform("turn", degrees=degrees)

    def look(self, yaw_deg: float, pitch_deg: float = 0.0) -> None:
        """Turn the head: yaw to the left, pitch down, in degrees."""
        self._perform("look", yaw_deg=yaw_deg, pitch_deg=pitch_deg)

    def leds(self, group: str, colour: str) -> None:
        """Let a group of lights shine in a colour such as "#ff8800"."""
        self._perform("leds", group=group, colour=colour)

    def stop(self) -> None:
        """Stop all that the robot does, at once; does not wait."""
        action_client(self._network).send(self.robots, "stop", {})

    def _perform(self, action: str, **args: Any) -> None:
        action_client(self._network).perform(self.robots, action, args)
