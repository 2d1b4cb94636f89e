"""Robot: what a program can ask a social robot to do, in the words of people."""

from __future__ import annotations

from nep_core.robot_lights import RobotLights
from nep_core.robot_moves import RobotMoves
from nep_core.robot_senses import RobotSenses
from nep_core.robot_voice import RobotVoice


class Robot(RobotMoves, RobotVoice, RobotLights, RobotSenses):
    """One robot by name, or several that act at once.

    Every call returns when all of them are done; it raises RobotNotAnswering or ActionFailed.
    What is measured is measured by the first.
    """

    def stop(self) -> None:
        """Stop all that the robot does, at once; does not wait."""
        self._send("stop")
