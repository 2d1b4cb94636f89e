"""The part of Robot that lights its lights."""

from __future__ import annotations

from nep_core.robot_requests import RobotRequests


class RobotLights(RobotRequests):
    """What a robot does with its lights; groups are "FaceLeds", "ChestLeds", "AllLeds", ..."""

    def leds(self, group: str, colour: str, seconds: float = 0.0) -> None:
        """Let a group of lights shine in a colour such as "#ff8800", reached in some seconds."""
        fade = {"seconds": seconds} if seconds else {}
        self._perform("leds", group=group, colour=colour, **fade)

    def leds_brightness(self, group: str, percent: float) -> None:
        """Set how bright a group of lights is, 0 to 100."""
        self._perform("intensity", group=group, percent=percent)

    def leds_off(self, group: str) -> None:
        """Switch a group of lights off."""
        self._perform("intensity", group=group, percent=0.0)

    def leds_reset(self, group: str) -> None:
        """Light a group as it was at the start."""
        self._perform("reset_leds", group=group)

    def random_eyes(self, seconds: float) -> None:
        """Let the eyes shine in colours by chance for some seconds."""
        self._perform("random_eyes", seconds=seconds)

    def rotate_eyes(self, seconds: float) -> None:
        """Let green, yellow and red go round the eyes for some seconds."""
        self._perform("rotate_eyes", seconds=seconds)
