"""ALMotion: joints, stiffness, walking, and what there is to know about the body."""

from __future__ import annotations

from nodes.action.naoqi.server import method
from nodes.action.naoqi.services.motion_info import BodyInfo
from nodes.action.naoqi.services.motion_joints import JointControl
from nodes.action.naoqi.services.motion_places import Places
from nodes.action.naoqi.services.motion_reach import Reaching
from nodes.action.naoqi.services.motion_walk import Locomotion


class ALMotion(JointControl, Locomotion, BodyInfo, Places, Reaching):
    """All that moves."""

    @method("getSummary::s()")
    def summary(self) -> str:
        """Return a table of the joints: stiffness, and angle as told and as felt."""
        lines = [f"{'JointName':>16} {'Stiffness':>10} {'Command':>10} {'Sensor':>10}"]
        for joint in self._robot.robot.body.names:
            numbers = self.stiffnesses(joint) + self.angles(joint, False) + self.angles(joint, True)
            lines.append(f"{joint:>16} " + " ".join(f"{number:>10.6f}" for number in numbers))
        return "\n".join(lines)
