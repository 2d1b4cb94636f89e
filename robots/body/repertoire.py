"""Which limbs each action needs, and the task by which a virtual robot does it."""

from __future__ import annotations

import math

from faults import Text
from robots.errors import ActionFailed

from . import actions as a
from . import actions as b
from . import actions as s
from . import body, motor_tasks, sense_tasks, tasks
from . import gait as walking
from . import inverse as gaze
from . import tasks as speaking
from .body import PLAIN_NAMES, parts_of_limbs, posture_name, single_parts
from .limbs import MOVING, Limb
from .motor_tasks import at_pace, change_setting, listen, motor_limbs, motor_task
from .pose import VirtualRobot
from .schedule import Task

ARM_OF = {"left": Limb.LEFT_ARM, "right": Limb.RIGHT_ARM}
HANDS = {
    **{side: frozenset({arm}) for side, arm in ARM_OF.items()},
    "both": frozenset(ARM_OF.values()),
}
LOCKS_BY_ITSELF = (a.Do, b.WakeUp, b.Rest, b.Stiffness)


def limbs_of(robot: VirtualRobot, action: a.Action) -> frozenset[Limb]:
    """Return the limbs that an action needs. Raises ActionFailed if it cannot be done."""
    match action:
        case a.Say():
            return speaking.speaking_limbs(robot, action)
        case a.Imitate():
            return robot.animations.get(action.animal, "animal").limbs
        case a.Play(mirror=mirrored):
            limbs = robot.animations.get(action.animation).limbs
            return frozenset(map(_other_side, limbs)) if mirrored else limbs
        case a.Do():
            posture_name(robot.body, action.posture)
            return MOVING
        case a.Leds():
            body.colour_number(action.colour)
            return _lights(action.group)
        case a.Walk() | a.Turn() | b.WalkFreely():
            return frozenset({Limb.LEGS})
        case a.Look() | b.LookAt() | b.LookAtSeen():
            return frozenset({Limb.HEAD})
    return _other_limbs(robot, action)


def _other_limbs(robot: VirtualRobot, action: a.Action) -> frozenset[Limb]:
    match action:
        case b.Hand():
            return HANDS[action.side]
        case b.MoveJoint():
            motor_tasks.check_joint(robot.body, action.joint)
            return robot.body.limbs_of([action.joint])
        case b.Stiffness():
            single_parts(action.part)
        case b.WakeUp() | b.Rest():
            return MOVING
        case b.PointAt():
            place = action.x_m, action.y_m, action.z_m
            return frozenset({ARM_OF[gaze.arm_for(robot, place, action.frame, action.arm)]})
        case b.Track():
            return motor_tasks.tracking_limbs(action)
        case s.Intensity() | s.ResetLeds():
            return _lights(action.group)
        case s.RandomEyes() | s.RotateEyes():
            return frozenset({Limb.LEDS})
        case s.Listen():
            return frozenset({Limb.EARS})
        case s.PlaySound():
            return frozenset({Limb.VOICE})
        case s.LearnFace() | s.ForgetFace() | s.TakePicture() | s.RecordVideo():
            return frozenset()
    return motor_limbs(robot, action)


def task_of(robot: VirtualRobot, action: a.Action) -> Task:
    """Return the task that does an action; parts of the body that it moves must be locked."""
    parts = parts_of_limbs(limbs_of(robot, action))
    if isinstance(action, LOCKS_BY_ITSELF):
        return _task(robot, action)
    if motors := motor_task(robot, action):
        return motors
    return _locked(robot, parts, _task(robot, action))


def _locked(robot: VirtualRobot, parts: frozenset[str], task: Task) -> Task:
    if loose := sorted(parts & robot.released):
        part = Text(PLAIN_NAMES[loose[0]])
        raise ActionFailed(
            "{name}'s {part} is released and cannot move. Lock it first, or let the robot wake up.",
            name=robot.name,
            part=part,
        )
    return (yield from task)


def _task(robot: VirtualRobot, action: a.Action) -> Task:
    match action:
        case a.Say():
            return speaking.say(robot, action)
        case a.Do():
            return at_pace(robot, _posture(robot, action.posture), action.pace)
        case a.Imitate():
            return tasks.play(robot, robot.animations.get(action.animal, "animal"))
        case a.Play():
            animation = robot.animations.get(action.animation)
            return tasks.play(robot, animation, tasks.changed(animation.keyframes, action))
        case a.Walk():
            turn = math.radians(action.turn_deg)
            return walking.walk(robot, action.forward_m, action.left_m, turn)
        case a.Turn():
            return walking.walk(robot, 0.0, 0.0, math.radians(action.degrees))
        case b.WalkFreely():
            return motor_tasks.walk_freely(robot, action)
        case a.Look():
            return tasks.look(robot, math.radians(action.yaw_deg), math.radians(action.pitch_deg))
    return _light_or_gaze_task(robot, action)


def _light_or_gaze_task(robot: VirtualRobot, action: a.Action) -> Task:
    match action:
        case b.LookAt():
            return gaze.look_at(robot, (action.x_m, action.y_m, action.z_m), action.frame)
        case b.LookAtSeen():
            return gaze.look_at_seen(robot, action.thing)
        case b.PointAt():
            place = action.x_m, action.y_m, action.z_m
            side = gaze.arm_for(robot, place, action.frame, action.arm)
            return gaze.point_at(robot, place, action.frame, side)
        case b.Track():
            return motor_tasks.track(robot, action)
        case a.Leds():
            colour = body.colour_number(action.colour)
            return tasks.light(robot, action.group, colour, action.seconds)
        case s.Intensity():
            return sense_tasks.set_intensity(robot, action.group, action.percent)
        case s.ResetLeds():
            return sense_tasks.reset(robot, action.group)
        case s.RandomEyes():
            return sense_tasks.random_eyes(robot, action.seconds)
        case s.RotateEyes():
            return sense_tasks.rotate_eyes(robot, action.seconds)
    return _body_or_setting_task(robot, action)


def _body_or_setting_task(robot: VirtualRobot, action: a.Action) -> Task:
    match action:
        case b.Hand():
            return motor_tasks.move_hands(robot, action.side, is_open=action.open)
        case b.MoveJoint():
            return motor_tasks.move_joint(robot, action)
        case b.Stiffness():
            return motor_tasks.lock(robot, action.part, on=action.on)
        case b.WakeUp():
            return motor_tasks.wake_up(robot)
        case b.Rest():
            return motor_tasks.rest(robot)
        case b.Awareness():
            return change_setting(robot, "awareness", action.on)
        case b.Breathing():
            return change_setting(robot, "breathing", action.on)
        case s.Volume():
            return change_setting(robot, "volume", action.percent)
        case s.SetLanguage():
            return change_setting(robot, "language", action.language)
        case s.Listen():
            return listen(robot, action.words, action.seconds)
        case s.LearnFace():
            return sense_tasks.learn_face(robot, action.name)
        case s.ForgetFace():
            return sense_tasks.forget_face(robot, action.name)
        case s.PlaySound():
            return sense_tasks.play_sound(robot, action)
        case s.TakePicture():
            return sense_tasks.take_picture(robot, action)
        case s.RecordVideo():
            return sense_tasks.record_video(robot, action)
    raise ActionFailed("The virtual {name} cannot do this.", name=robot.name)


def _posture(robot: VirtualRobot, word: str) -> Task:
    """Take a posture with all joints locked: what is released cannot hold one."""
    robot.released = frozenset()
    robot.stiffness = {}
    return (yield from tasks.take_posture(robot, posture_name(robot.body, word)))


def _lights(group: str) -> frozenset[Limb]:
    body.lights(group)
    return frozenset({Limb.LEDS})


def _other_side(limb: Limb) -> Limb:
    return {Limb.LEFT_ARM: Limb.RIGHT_ARM, Limb.RIGHT_ARM: Limb.LEFT_ARM}.get(limb, limb)
