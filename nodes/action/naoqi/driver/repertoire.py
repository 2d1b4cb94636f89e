"""Which limbs each action needs, and the task by which a real robot does it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from nodes.action.naobody import actions as a
from nodes.action.naobody import body_actions as b
from nodes.action.naobody import motor_actions as m
from nodes.action.naobody import repertoire as virtual
from nodes.action.naobody import sense_actions as s
from nodes.action.naobody.limbs import MOVING, Limb
from nodes.action.naobody.running import Task
from nodes.action.naoqi.driver import lighting, moving, recording, speaking, walking
from nodes.action.naoqi.driver.calls import waited
from nodes.action.naoqi.driver.real import RealRobot

LIMBS: dict[type[a.Action], frozenset[Limb]] = {
    s.TakePicture: frozenset(),
    s.RecordVideo: frozenset(),
}
"""What the virtual robot cannot do needs these; all else needs what it needs there."""
ANY_MOTORS = (
    a.Do,
    b.WakeUp,
    b.Rest,
    b.Stiffness,
    m.SetStiffness,
    m.Approach,
)
"""What is done with motors that are off as well."""

TASKS: dict[type[a.Action], Callable[[RealRobot, Any], Task]] = {
    a.Say: speaking.say,
    a.Do: moving.posture_task,
    a.Imitate: speaking.imitate,
    a.Play: speaking.play_changed,
    a.Walk: lambda robot, it: walking.walk(
        robot, it.forward_m, it.left_m, math.radians(it.turn_deg)
    ),
    a.Turn: lambda robot, it: walking.walk(robot, 0.0, 0.0, math.radians(it.degrees)),
    a.Look: lambda robot, it: walking.look(
        robot, math.radians(it.yaw_deg), math.radians(it.pitch_deg)
    ),
    a.Leds: lighting.light,
    b.Hand: moving.move_hands,
    b.MoveJoint: moving.move_joint,
    b.Stiffness: lambda robot, it: moving.lock(robot, it.part, on=it.on),
    b.WakeUp: lambda robot, _: moving.wake_up(robot),
    b.Rest: lambda robot, _: moving.rest(robot),
    b.Awareness: moving.set_life,
    b.Breathing: moving.set_life,
    b.WalkFreely: walking.walk_freely,
    b.LookAt: lambda robot, it: walking.look_at(robot, (it.x_m, it.y_m, it.z_m), it.frame),
    b.LookAtSeen: lambda robot, it: walking.look_at_seen(robot, it.thing),
    b.PointAt: walking.point_at,
    b.Track: walking.track,
    m.Approach: moving.approach,
    m.ReachAngles: moving.reach_angles,
    m.MoveThrough: moving.move_through,
    m.SetStiffness: moving.set_stiffness,
    m.Silence: lambda _, it: waited(it.seconds),
    s.Volume: speaking.set_volume,
    s.SetLanguage: speaking.set_language,
    s.Intensity: lighting.set_intensity,
    s.ResetLeds: lighting.reset,
    s.RandomEyes: lighting.play_of_colours,
    s.RotateEyes: lighting.play_of_colours,
    s.LearnFace: recording.learn_face,
    s.ForgetFace: recording.forget_face,
    s.TakePicture: recording.take_picture,
    s.RecordVideo: recording.record_video,
    s.PlaySound: recording.play_sound,
}
"""How a real robot does each action; a test sees that none is missing."""


def limbs_of(robot: RealRobot, action: a.Action) -> frozenset[Limb]:
    """Return the limbs that an action needs. Raises ActionFailed if it cannot be done."""
    known = LIMBS.get(type(action))
    return virtual.limbs_of(robot.known, action) if known is None else known


def task_of(robot: RealRobot, action: a.Action) -> Task:
    """Return the task that does an action; what it moves must be locked."""
    task = TASKS[type(action)](robot, action)
    limbs = limbs_of(robot, action)
    if isinstance(action, ANY_MOTORS) or not limbs & MOVING:
        return task
    return _moving(robot, limbs, task)


def _moving(robot: RealRobot, limbs: frozenset[Limb], task: Task) -> Task:
    yield from robot.take_over()
    robot.check_locked(limbs)
    return (yield from task)
