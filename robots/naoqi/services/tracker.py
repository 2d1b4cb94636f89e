"""ALTracker: looks at things, points at them, and follows them."""

from __future__ import annotations

from typing import Any

from robots.body.inverse import Place, in_torso, to_world
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import number, one_of, within
from .module import Module, kept

FRAMES = ("torso", "world", "robot")
"""By NAOqi's numbers."""
THINGS = {
    "Face": "face",
    "People": "face",
    "RedBall": "ball",
    "LandMark": "mark",
    "LandMarks": "mark",
    "Sound": "sound",
}
"""What can be followed, by NAOqi's names."""
MODES = ("Head", "WholeBody", "Move", "Navigate")
ARMS = {"LArm": "left", "RArm": "right", "Arms": ""}


class ALTracker(Module):
    """Follows with the head, or with the whole body, what the robot sees."""

    mode = kept("getMode::s()", "Head", MODES)
    timeout = kept("getTimeOut::i()", 500)
    distance = kept("getMaximumDistanceDetection::f()", 3.5)
    effector = kept("getEffector::s()", "None", ("None", "Arms", "LArm", "RArm"))
    search = kept("isSearchEnabled::b()", False, setter="toggleSearch::v(b)")
    velocity = kept("getMaximumVelocity::f()", 0.5)
    relative = kept("getRelativePosition::m()", [])
    move = kept("getMoveConfig::m()", [])

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._registered: dict[str, Any] = {}
        self._active = ""

    @method("registerTarget::v(sm)")
    def register_target(self, target: str, parameters: Any) -> None:
        """Say what will be followed, and how large it is."""
        _thing(target)
        self._registered[target] = parameters

    @method("unregisterTarget::v(s)")
    def unregister_target(self, target: str) -> None:
        """Follow something no more."""
        if target == self._active:
            self.stop_tracker()
        self._registered.pop(target, None)

    @method("unregisterTargets::v([s])")
    def unregister_targets(self, targets: list[str]) -> None:
        """Follow some things no more."""
        for target in targets:
            self.unregister_target(target)

    @method("unregisterAllTargets::v()")
    def unregister_all_targets(self) -> None:
        """Follow nothing any more."""
        self.unregister_targets(list(self._registered))

    @method("track::v(s)")
    def track(self, target: str) -> None:
        """Follow something from now on, as soon as it is seen; nobody waits."""
        one_of(target, self._registered, "“{target}” is not registered: call registerTarget first.")
        self._active = target
        using = "body" if self.mode() in ("WholeBody", "Move", "Navigate") else "head"
        # Refused now, when it is not in sight, it is followed all the same once it comes.
        self._robot.ask("track", thing=_thing(target), using=using)

    @method("stopTracker::v()")
    def stop_tracker(self) -> None:
        """Follow nothing any more."""
        thing, self._active = THINGS.get(self._active, "face"), ""
        self._robot.ask("track", thing=thing, using="off")

    active_target = method("getActiveTarget::s()")(lambda self: self._active)
    is_active = method("isActive::b()")(lambda self: bool(self._active))
    is_target_lost = method("isTargetLost::b()")(lambda self: self._place() is None)

    is_new_target_detected = method("isNewTargetDetected::b()")(
        lambda self: self._place() is not None
    )

    @method("getTargetPosition::[f](i)")
    def target_position(self, frame: int) -> list[float]:
        """Return where what it follows is, m, in a frame; empty when it is out of sight."""
        robot, wanted, place = self._robot.robot, _frame(frame), self._place()
        if place is None:
            return []
        with self._robot.lock:
            if wanted == "world":
                return list(to_world(robot, place))
            return list(in_torso(robot, place, "robot") if wanted == "torso" else place)

    # Where the robot is: x m, y m, theta rad
    robot_position = method("getRobotPosition::[f]()")(lambda self: list(self._robot.state().base))
    available_modes = method("getAvailableModes::[s]()")(lambda self: list(MODES))
    supported_targets = method("getSupportedTargets::[s]()")(lambda self: list(THINGS))
    registered_targets = method("getRegisteredTargets::[s]()")(lambda self: list(self._registered))

    @method("lookAt::v([f]ifb)")
    def look_at(self, place: list[float], frame: int, fraction: float, use_body: bool) -> Any:
        """Turn the head to a ``place``, x, y, z m in a ``frame`` (0 torso, 1 world, 2 robot).

        The ``fraction`` of the speed and ``use_body`` change nothing; wait until it is done.
        """
        within(fraction, 0.0, 1.0, "The fraction of the top speed")
        x, y, z = _coordinates(place)
        return self._do("look_at", x_m=x, y_m=y, z_m=z, frame=_frame(frame))

    @method("lookAt::v([f]fb)")
    def look_at_robot(self, place: list[float], fraction: float, use_body: bool) -> Any:
        """Turn the head to a place seen from the torso."""
        return self.look_at(place, FRAMES.index("torso"), fraction, use_body)

    @method("pointAt::v(s[f]if)")
    def point_at(self, effector: str, place: list[float], frame: int, fraction: float) -> Any:
        """Point with ``effector`` (LArm, RArm, Arms) at a ``place`` in a ``frame``, as ``look_at``.

        The ``fraction`` of the speed changes nothing; wait until it is done.
        """
        within(fraction, 0.0, 1.0, "The fraction of the top speed")
        arm = ARMS[one_of(effector, ARMS, "There is no arm “{effector}”. Possible: {arms}.")]
        x, y, z = _coordinates(place)
        return self._do("point_at", x_m=x, y_m=y, z_m=z, frame=_frame(frame), arm=arm)

    @method("pointAt::v(s[f]f)")
    def point_at_robot(self, effector: str, place: list[float], fraction: float) -> Any:
        """Point at a place seen from the torso."""
        return self.point_at(effector, place, FRAMES.index("torso"), fraction)

    @method("initialize::v()")
    def initialize(self) -> None:
        """Follow nothing, and forget all settings."""
        self.stop_tracker()
        self._kept.clear()
        self._registered.clear()

    def _place(self) -> Place | None:
        """Return where what it follows is, m from the robot's feet; None when out of sight."""
        if not self._active:
            return None
        return self._robot.state().sees.get(_thing(self._active))


def _thing(target: str) -> str:
    return THINGS[one_of(target, THINGS, "“{target}” cannot be followed. Possible: {things}.")]


def _frame(number_of: int) -> str:
    if not 0 <= number_of < len(FRAMES):
        raise CallFailed(
            "There is no frame {number_of}: 0 is torso, 1 world, 2 robot.", number_of=number_of
        )
    return FRAMES[number_of]


def _coordinates(place: list[float]) -> tuple[float, float, float]:
    if len(place) != 3:
        raise CallFailed("A place is three numbers: x, y, z m.")
    x, y, z = map(number, place)
    return x, y, z
