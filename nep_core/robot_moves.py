"""The part of Robot that moves the body: hands, joints, walking, gaze, sleep."""

from __future__ import annotations

import math

from nep_core.robot_requests import RobotRequests


class RobotMoves(RobotRequests):
    """What a robot does with its body."""

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

    def open_hand(self, side: str = "both") -> None:
        """Open the "left" hand, the "right" one, or "both"."""
        self._perform("hand", side=side, open=True)

    def close_hand(self, side: str = "both") -> None:
        """Close the "left" hand, the "right" one, or "both"."""
        self._perform("hand", side=side, open=False)

    def move_joint(self, joint: str, degrees: float) -> None:
        """Move a joint, such as "LElbowRoll", to an angle."""
        self._perform("move_joint", joint=joint, degrees=degrees)

    def move_joint_by(self, joint: str, degrees: float) -> None:
        """Move a joint by an angle from where it is."""
        self._perform("move_joint", joint=joint, degrees=degrees, relative=True)

    def angle(self, joint: str) -> float:
        """The angle of a joint in degrees; of a hand ("LHand") how far it is open, 0 to 100."""
        rad = self._state().joints.get(joint, 0.0)
        return round(rad * 100.0 if joint.endswith("Hand") else math.degrees(rad), 1)

    def lock(self, part: str = "body") -> None:
        """Switch the motors of a part on: "head", "left_arm", "legs", "body", ..."""
        self._perform("stiffness", part=part, on=True)

    def release(self, part: str = "body") -> None:
        """Switch the motors of a part off, so that a person can move it."""
        self._perform("stiffness", part=part, on=False)

    def wake_up(self) -> None:
        """Switch all motors on and stand up."""
        self._perform("wake_up")

    def rest(self) -> None:
        """Go down to a safe posture and switch all motors off."""
        self._perform("rest")

    def awareness(self, on: bool) -> None:
        """Look at people by itself, or not."""
        self._perform("awareness", on=_is_on(on))

    def breathing(self, on: bool) -> None:
        """Move a little as if it breathed, or not."""
        self._perform("breathing", on=_is_on(on))

    def walk(self, forward_m: float, left_m: float = 0.0, *, turn_deg: float = 0.0) -> None:
        """Walk so many metres forward (negative: back) and to the left, turning on the way."""
        turn = {"turn_deg": turn_deg} if turn_deg else {}
        self._perform("walk", forward_m=forward_m, left_m=left_m, **turn)

    def turn(self, degrees: float) -> None:
        """Turn on the spot, to the left (negative: to the right)."""
        self._perform("turn", degrees=degrees)

    def start_walking(self, forward: float, left: float = 0.0, turn: float = 0.0) -> None:
        """Walk on and on, each speed in percent of the highest; does not wait.

        It ends with ``stop_moving``, or as soon as the legs are asked for something else.
        """
        speeds = {"forward": forward / 100, "left": left / 100, "turn": turn / 100}
        self._begin("walk_freely", **speeds)

    def stop_moving(self) -> None:
        """Stop what moves joints, at once; what is said goes on. Does not wait."""
        self._send("stop_moving")

    def look(self, yaw_deg: float, pitch_deg: float = 0.0) -> None:
        """Turn the head: yaw to the left, pitch down, in degrees."""
        self._perform("look", yaw_deg=yaw_deg, pitch_deg=pitch_deg)

    def look_at(self, x_m: float, y_m: float, z_m: float, frame: str = "robot") -> None:
        """Turn the head to a place: metres in front of, left of and above its feet.

        ``frame`` "torso": as seen from the torso; "world": from where the robot has started.
        """
        self._perform("look_at", x_m=x_m, y_m=y_m, z_m=z_m, frame=frame)

    def point_at(
        self, x_m: float, y_m: float, z_m: float, frame: str = "robot", arm: str = ""
    ) -> None:
        """Point at a place with the "left" or "right" arm, else the one that is nearer."""
        self._perform("point_at", x_m=x_m, y_m=y_m, z_m=z_m, frame=frame, arm=arm)

    def look_at_seen(self, thing: str = "face") -> None:
        """Turn the head to what it sees or hears: "face", "ball", "sound"."""
        self._perform("look_at_seen", thing=thing)

    def track(self, thing: str, using: str = "head") -> None:
        """Keep the "head" or the whole "body" turned to something it sees; "off" ends it."""
        self._perform("track", thing=thing, using=using)


def _is_on(on: object) -> bool:
    """Whether something is switched on: True, or the word "on"."""
    return on is True or on == "on"
