"""Which limbs each action needs, and the task by which a virtual robot does it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from faults import Text
from robots.errors import ActionFailed

from . import actions as a
from . import body, motor_tasks, sense_tasks, tasks
from . import inverse as gaze
from .body import PLAIN_NAMES, parts_of_limbs, posture_name, single_parts
from .gait import walk
from .limbs import MOVING, Limb
from .pose import VirtualRobot
from .reflexes import fallen_sentence
from .schedule import Task
from .tasks import speaking_limbs

ARM_OF = {"left": Limb.LEFT_ARM, "right": Limb.RIGHT_ARM}
OTHER_ARM = {Limb.LEFT_ARM: Limb.RIGHT_ARM, Limb.RIGHT_ARM: Limb.LEFT_ARM}
LOCKS_BY_ITSELF = (a.Do, a.WakeUp, a.Rest, a.Stiffness)
WALKS = (a.Walk, a.Turn, a.WalkFreely)
MOTOR_ACTIONS = (a.Approach, a.ReachAngles, a.MoveThrough, a.SetStiffness, a.Silence)
"""What a joint whose motor is off does not follow, without telling."""


def limbs_of(robot: VirtualRobot, action: a.Action) -> frozenset[Limb]:
    """Return the limbs that an action needs. Raises ActionFailed if it cannot be done."""
    match action:
        case a.Say():
            return speaking_limbs(robot, action)
        case a.Imitate():
            return robot.animations.get(action.animal, "animal").limbs
        case a.Play(mirror=mirrored):
            limbs = robot.animations.get(action.animation).limbs
            return frozenset(OTHER_ARM.get(one, one) for one in limbs) if mirrored else limbs
        case a.Do():
            posture_name(robot.body, action.posture)
        case a.Leds():
            body.colour_number(action.colour)
            body.lights(action.group)
        case a.Hand():
            return frozenset(ARM_OF[side] for side in ARM_OF if action.side in (side, "both"))
        case a.Stiffness():
            single_parts(action.part)
        case a.PointAt():
            place = action.x_m, action.y_m, action.z_m
            return frozenset({ARM_OF[gaze.arm_for(robot, place, action.frame, action.arm)]})
        case a.Track():
            return motor_tasks.tracking_limbs(action)
        case a.Intensity() | a.ResetLeds():
            body.lights(action.group)
        case a.Approach(limb=limb):
            return frozenset({limb})
        case a.MoveJoint(joint=joint):
            return motor_tasks.limbs_of_joints(robot.body, [joint])
        case a.SetAngles(angles=joints) | a.ReachAngles(angles=joints):
            return motor_tasks.limbs_of_joints(robot.body, joints)
        case a.MoveThrough(tracks=joints):
            return motor_tasks.limbs_of_joints(robot.body, joints)
        case a.SetStiffness(joints=joints):
            motor_tasks.limbs_of_joints(robot.body, joints)
    return LIMBS.get(type(action), frozenset())


LIMBS: dict[type[a.Action], frozenset[Limb]] = {
    **dict.fromkeys((a.Do, a.WakeUp, a.Rest), MOVING),
    **dict.fromkeys((a.Walk, a.Turn, a.WalkFreely), frozenset({Limb.LEGS})),
    **dict.fromkeys((a.Look, a.LookAt, a.LookAtSeen), frozenset({Limb.HEAD})),
    **dict.fromkeys(
        (a.Leds, a.Intensity, a.ResetLeds, a.RandomEyes, a.RotateEyes), frozenset({Limb.LEDS})
    ),
    **dict.fromkeys((a.PlaySound, a.Silence), frozenset({Limb.VOICE})),
    a.Listen: frozenset({Limb.EARS}),
}
"""What an action needs whatever its arguments are; all others need none."""


def task_of(robot: VirtualRobot, action: a.Action) -> Task:
    """Return the task that does an action; parts of the body that it moves must be locked."""
    parts = parts_of_limbs(limbs_of(robot, action))
    if type(action) not in TASKS:
        raise ActionFailed("The virtual {name} cannot do this.", name=robot.name)
    task = TASKS[type(action)](robot, action)
    if isinstance(action, (*LOCKS_BY_ITSELF, *MOTOR_ACTIONS)):
        return task
    if robot.fallen and isinstance(action, WALKS):
        return task  # it says that a robot which lies does not walk
    return _locked(robot, parts, task)


def _locked(robot: VirtualRobot, parts: frozenset[str], task: Task) -> Task:
    if loose := sorted(parts & robot.released):
        if robot.fallen:
            raise ActionFailed(fallen_sentence(robot))
        part = Text(PLAIN_NAMES[loose[0]])
        raise ActionFailed(
            "{name}'s {part} is released and cannot move. Lock it first, or let the robot wake up.",
            name=robot.name,
            part=part,
        )
    return (yield from task)


def _fit(robot: VirtualRobot, task: Task) -> Task:
    """Walk, unless the robot should rest."""
    motor_tasks.check_walk(robot)
    return (yield from task)


def _do(robot: VirtualRobot, action: a.Do) -> Task:
    """Take a posture with all joints locked: what is released cannot hold one."""
    robot.released = frozenset()
    robot.stiffness = {}
    return (yield from tasks.take_posture(robot, posture_name(robot.body, action.posture)))


def _play(robot: VirtualRobot, action: a.Play) -> Task:
    animation = robot.animations.get(action.animation)
    return tasks.play(robot, animation, tasks.changed(animation.keyframes, action))


def _point_at(robot: VirtualRobot, action: a.PointAt) -> Task:
    place = action.x_m, action.y_m, action.z_m
    side = gaze.arm_for(robot, place, action.frame, action.arm)
    return gaze.point_at(robot, place, action.frame, side)


def _sets(name: str, value: str) -> Callable[[VirtualRobot, Any], Task]:
    """What sets a setting to a value of the action."""
    return lambda robot, it: motor_tasks.change_setting(robot, name, getattr(it, value))


TASKS: dict[type[a.Action], Callable[[VirtualRobot, Any], Task]] = {
    a.Say: tasks.say,
    a.Do: lambda robot, it: motor_tasks.at_pace(robot, _do(robot, it), it.pace),
    a.Imitate: lambda robot, it: tasks.play(robot, robot.animations.get(it.animal, "animal")),
    a.Play: _play,
    a.Walk: lambda robot, it: _fit(
        robot, walk(robot, it.forward_m, it.left_m, math.radians(it.turn_deg))
    ),
    a.Turn: lambda robot, it: _fit(robot, walk(robot, 0.0, 0.0, math.radians(it.degrees))),
    a.WalkFreely: lambda robot, it: _fit(robot, motor_tasks.walk_freely(robot, it)),
    a.Look: lambda robot, it: tasks.look(
        robot, math.radians(it.yaw_deg), math.radians(it.pitch_deg)
    ),
    a.LookAt: lambda robot, it: gaze.look_at(robot, (it.x_m, it.y_m, it.z_m), it.frame),
    a.LookAtSeen: lambda robot, it: gaze.look_at_seen(robot, it.thing),
    a.PointAt: _point_at,
    a.Track: motor_tasks.track,
    a.Leds: lambda robot, it: tasks.light(
        robot, it.group, body.colour_number(it.colour), it.seconds
    ),
    a.Intensity: lambda robot, it: sense_tasks.set_intensity(robot, it.group, it.percent),
    a.ResetLeds: lambda robot, it: sense_tasks.reset(robot, it.group),
    a.RandomEyes: lambda robot, it: sense_tasks.random_eyes(robot, it.seconds),
    a.RotateEyes: lambda robot, it: sense_tasks.rotate_eyes(robot, it.seconds),
    a.Hand: lambda robot, it: motor_tasks.move_hands(robot, it.side, is_open=it.open),
    a.MoveJoint: motor_tasks.move_joint,
    a.Stiffness: lambda robot, it: motor_tasks.lock(robot, it.part, on=it.on),
    a.WakeUp: lambda robot, _: motor_tasks.wake_up(robot),
    a.Rest: lambda robot, _: motor_tasks.rest(robot),
    a.Awareness: _sets("awareness", "on"),
    a.Breathing: _sets("breathing", "on"),
    a.Volume: _sets("volume", "percent"),
    a.SetLanguage: _sets("language", "language"),
    a.Listen: lambda robot, it: motor_tasks.listen(robot, it.words, it.seconds),
    a.LearnFace: lambda robot, it: sense_tasks.learn_face(robot, it.name),
    a.ForgetFace: lambda robot, it: sense_tasks.forget_face(robot, it.name),
    a.PlaySound: sense_tasks.play_sound,
    a.TakePicture: sense_tasks.take_picture,
    a.RecordVideo: sense_tasks.record_video,
    a.Approach: motor_tasks.approach,
    a.ReachAngles: motor_tasks.reach,
    a.MoveThrough: motor_tasks.move_through,
    a.SetStiffness: motor_tasks.set_stiffness,
    a.Silence: lambda _, it: motor_tasks.wait(it.seconds),
}
"""How a virtual robot does each action."""
