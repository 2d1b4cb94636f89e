"""What a real robot does for requests that move joints, or switch their motors on and off."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

from faults import Text
from robots.body import actions as a
from robots.body import actions as b
from robots.body import actions as m
from robots.body.body import Angles, Body, part_of, posture_name, single_parts
from robots.body.keyframes import Keyframes, Track, control_points
from robots.body.limbs import MOVING
from robots.body.motion import playable
from robots.body.motor_tasks import SIDES
from robots.body.schedule import Task
from robots.errors import ActionFailed

from .real import RealRobot

# Keyframes as ALMotion.angleInterpolationBezier takes them, within limits and speeds.

BEZIER = 3
"""NAOqi's number for a handle of a curve, as Choregraphe writes it."""

Handle = list[float | int]
Key = list[float | Handle]


@dataclass(frozen=True)
class BezierCall:
    """The arguments of the call, how long it takes, where joints are at its end."""

    names: list[str]
    times: list[list[float]]
    keys: list[list[Key]]
    duration_s: float
    end: dict[str, float]
    notes: tuple[str, ...] = ()


def bezier_call(body: Body, pose: Angles, keyframes: Keyframes) -> BezierCall:
    """Return keyframes as a call that begins at a pose (every joint).

    What is too fast is stretched, angles that joints cannot have are clamped; the notes say so.
    """
    fitted, notes = playable(body, pose, keyframes)
    names, clamped = list(fitted.tracks), []
    keys = []
    for name, track in fitted.tracks.items():
        allowed = _allowed(body, name, track)
        if allowed != track:
            clamped.append(name)
        keys.append(_keys(body, float(pose[body.index[name]]), name, allowed))
    if clamped:
        notes = [*notes, f"kept within the limits of {', '.join(clamped)}"]
    return BezierCall(
        names,
        [[float(time) for time in fitted.tracks[name].times] for name in names],
        keys,
        fitted.duration_s,
        {name: float(one[-1][0]) for name, one in zip(names, keys, strict=True)},  # type: ignore[arg-type]
        tuple(notes),
    )


def _allowed(body: Body, name: str, track: Track) -> Track:
    low, high = float(body.min[body.index[name]]), float(body.max[body.index[name]])
    keys = tuple(min(max(key, low), high) for key in track.keys)
    return track if keys == track.keys else Track(track.times, keys, track.handles)


def _keys(body: Body, start: float, name: str, track: Track) -> list[Key]:
    """Each key: its angle, the handle before it and the one after it, both relative to it."""
    x, y = control_points(track, start, float(body.max_speed[body.index[name]]))
    count = len(track.keys)
    keys: list[Key] = []
    for i in range(count):
        before: Handle = [BEZIER, float(x[2, i] - x[3, i]), float(y[2, i] - y[3, i])]
        after: Handle = [BEZIER, 0.0, 0.0]
        if i + 1 < count:
            after = [BEZIER, float(x[1, i + 1] - x[0, i + 1]), float(y[1, i + 1] - y[0, i + 1])]
        keys.append([float(track.keys[i]), before, after])
    return keys


POSTURE_S = 60.0
WAKING_S = 25.0
POSTURE_SPEED = 0.6
RETURN_SPEED = 0.3
STIFF_S = 0.3
OPEN, CLOSED = 1.0, 0.0
RESTING = "Rest"
"""Our word for what NAOqi calls to rest: crouched, with its motors off."""


def take_posture(robot: RealRobot, word: str, speed: float = POSTURE_SPEED) -> Task:
    """Take a posture with all motors on, and look that it is there."""
    name = posture_name(robot.known.body, word)
    if name == RESTING:
        return (yield from rest(robot))
    yield from robot.take_over()
    if robot.known.released:
        yield from wake_up(robot)
    return (yield from to_posture(robot, name, speed))


def to_posture(robot: RealRobot, name: str, speed: float = POSTURE_SPEED) -> Task:
    """Go to a posture of NAOqi's."""
    joints = robot.names(MOVING)
    reached = yield from robot.call(
        "ALRobotPosture", "goToPosture", name, speed, limit_s=POSTURE_S, uses=joints
    )
    found = yield from robot.call("ALRobotPosture", "getPosture")
    if not reached or not _is_alike(robot, str(found), name):
        raise ActionFailed(
            "{name} did not get into the posture {name_2}. Put it on flat ground with space around "
            "it, and try again.",
            name=robot.name,
            name_2=name,
        )
    robot.known.posture = name
    yield from robot.measure(joints)
    return ""


def _is_alike(robot: RealRobot, found: str, name: str) -> bool:
    """Whether a posture is the wanted one, or one of its kind: some look the same to NAOqi."""
    postures = robot.known.body.postures
    return found in postures and postures[found].family == postures[name].family


def wake_up(robot: RealRobot) -> Task:
    """Switch all motors on and stand up."""
    yield from robot.take_over()
    yield from robot.call("ALMotion", "wakeUp", limit_s=WAKING_S)
    awake = yield from robot.call("ALMotion", "robotIsWakeUp")
    if not awake:
        raise ActionFailed("{name} did not wake up. Press its chest button twice.", name=robot.name)
    robot.known.released = frozenset()
    yield from _look_at_posture(robot)
    return ""


def rest(robot: RealRobot) -> Task:
    """Go down and switch all motors off."""
    robot.life_is_off = True  # NAOqi does not go to rest in the robot's own life
    if robot.calls.has("ALAutonomousLife", "setState"):
        yield from robot.call("ALAutonomousLife", "setState", "disabled", limit_s=WAKING_S)
    yield from robot.call("ALMotion", "rest", limit_s=WAKING_S)
    awake = yield from robot.call("ALMotion", "robotIsWakeUp")
    if awake:
        raise ActionFailed(
            "{name} did not go to rest. Look whether something holds it.", name=robot.name
        )
    robot.known.released = frozenset(robot.parts)
    robot.known.posture = RESTING
    yield from robot.measure(robot.names(MOVING))
    return ""


def move_hands(robot: RealRobot, action: b.Hand) -> Task:
    """Open or close hands, both at once."""
    names = list(SIDES[action.side])
    method = "openHand" if action.open else "closeHand"
    calls = [robot.call("ALMotion", method, name, limit_s=8.0, uses=[name]) for name in names]
    try:
        while calls:
            calls = [call for call in calls if not _is_over(call)]
            if calls:
                yield
    finally:
        for call in calls:
            call.close()
    measured = yield from robot.measure(names)
    if action.open and any(angle < OPEN / 2 for angle in measured.values()):
        raise ActionFailed(
            "{name}'s hand did not open. Look whether something holds it.", name=robot.name
        )
    held = [name for name, angle in measured.items() if angle > CLOSED + 0.4]
    return "it holds something" if held and not action.open else ""


def move_joint(robot: RealRobot, action: b.MoveJoint) -> Task:
    """Move a joint as far as it goes."""
    start = 0.0
    if action.relative:
        measured = yield from robot.measure([action.joint])
        start = measured[action.joint]
    goal, clamped = robot.goal_of({action.joint: start + math.radians(action.degrees)})
    yield from robot.go_to(goal, action.speed)
    if not clamped:
        return ""
    return f"moved as far as it goes: {math.degrees(goal[action.joint]):.0f} degrees"


def reach_angles(robot: RealRobot, action: m.ReachAngles) -> Task:
    """Move joints to angles, as far as they go."""
    goal, clamped = robot.goal_of(action.angles)
    yield from robot.go_to(goal, action.speed)
    return f"kept within the limits of {', '.join(clamped)}" if clamped else ""


def approach(robot: RealRobot, action: m.Approach) -> Task:
    """Send joints where the targets say, each time that these change."""
    sent: dict[str, m.Target] = {}
    while action.targets:
        new = {name: one for name, one in action.targets.items() if sent.get(name) != one}
        for name, target in new.items():
            goal, _ = robot.goal_of({name: target.angle})
            robot.calls.tell(
                "ALMotion", "setAngles", [name], [goal[name]], min(float(target.speed), 1.0)
            )
        sent |= new
        away = robot.known.body.columns({action.limb})
        goal, _ = robot.goal_of({name: one.angle for name, one in action.targets.items()})
        index = robot.known.body.index
        near = all(abs(robot.known.angles[index[name]] - at) < 0.05 for name, at in goal.items())
        if near or not away:
            action.targets.clear()
        yield
    return ""


def move_through(robot: RealRobot, action: m.MoveThrough) -> Task:
    """Move joints through keys."""
    tracks = {name: track for name, track in action.tracks.items() if track.times}
    if not tracks:
        return ""
    measured = yield from robot.measure(list(tracks))
    if action.relative:
        tracks = {
            name: Track(one.times, tuple(key + measured[name] for key in one.keys), one.handles)
            for name, one in tracks.items()
        }
    return (yield from play_keyframes(robot, Keyframes(tracks)))


def play_keyframes(robot: RealRobot, keyframes: Keyframes) -> Task:
    """Play keyframes from where the joints are, and look that they got to the last keys."""
    yield from robot.measure(list(keyframes.tracks))
    call = bezier_call(robot.known.body, robot.known.angles, keyframes)
    yield from robot.call(
        "ALMotion",
        "angleInterpolationBezier",
        call.names,
        call.times,
        call.keys,
        limit_s=1.5 * call.duration_s + 4.0,
        uses=call.names,
    )
    yield from robot.check_reached(call.end)
    return "; ".join(call.notes)


def lock(robot: RealRobot, part: str, *, on: bool) -> Task:
    """Switch the motors of a part on or off, softly."""
    parts = {one: them for one, them in robot.parts.items() if one in single_parts(part)}
    names = [name for them in parts.values() for name in them]
    if not names:
        raise ActionFailed("{name} has no such part of the body.", name=robot.name)
    yield from robot.take_over()
    value = 1.0 if on else 0.0
    yield from robot.call(
        "ALMotion", "stiffnessInterpolation", names, value, STIFF_S, limit_s=STIFF_S + 3.0
    )
    yield from _check_motors(robot, parts, on=on)
    return ""


def set_stiffness(robot: RealRobot, action: m.SetStiffness) -> Task:
    """Set how firmly single joints are held."""
    names, seconds = list(action.joints), max(float(action.seconds), STIFF_S)
    values = [[float(value)] for value in action.joints.values()]
    yield from robot.call(
        "ALMotion",
        "stiffnessInterpolation",
        names,
        values,
        [[seconds]] * len(names),
        limit_s=seconds + 3.0,
    )
    parts = {part_of(robot.known.body, name) for name in names}
    for part in parts:
        stiff = yield from robot.call("ALMotion", "getStiffnesses", robot.parts[part])
        _set_released(robot, part, loose=not any(float(value) > 0.0 for value in stiff))
    return ""


def set_life(robot: RealRobot, action: b.Awareness | b.Breathing) -> Task:
    """Let the robot look at people by itself, or breathe."""
    if isinstance(action, b.Breathing):
        yield from robot.take_over()
        yield from robot.call("ALMotion", "setBreathEnabled", "Body", action.on, limit_s=8.0)
        robot.known.settings["breathing"] = action.on
        return ""
    if robot.calls.has("ALBasicAwareness", "setEnabled"):
        yield from robot.call("ALBasicAwareness", "setEnabled", action.on, limit_s=8.0)
    else:  # before NAOqi 2.5
        method = "startAwareness" if action.on else "stopAwareness"
        yield from robot.call("ALBasicAwareness", method, limit_s=8.0)
    robot.known.settings["awareness"] = action.on
    return ""


def return_to_posture(robot: RealRobot, joints: Collection[str]) -> Task:
    """Move joints back to where they are in the posture that the robot is in."""
    posture = robot.known.posture
    if posture not in robot.known.body.postures:
        return ""
    goal = robot.picked(robot.known.body.posture_angles(posture), joints)
    legs = any("Hip" in name or "Knee" in name or "Ankle" in name for name in joints)
    if legs:  # NAOqi keeps the balance on the way
        return (yield from to_posture(robot, posture))
    yield from robot.go_to(goal, RETURN_SPEED)
    return ""


def posture_task(robot: RealRobot, action: a.Do) -> Task:
    """Take a posture."""
    return take_posture(robot, action.posture, min(POSTURE_SPEED * action.pace, 1.0))


def _look_at_posture(robot: RealRobot) -> Task:
    found = yield from robot.call("ALRobotPosture", "getPosture")
    robot.known.posture = str(found)
    yield from robot.measure(robot.names(MOVING))
    return ""


def _check_motors(robot: RealRobot, parts: dict[str, list[str]], *, on: bool) -> Task:
    for part, joints in parts.items():
        stiff = yield from robot.call("ALMotion", "getStiffnesses", joints)
        is_loose = not any(float(value) > 0.0 for value in stiff)
        if is_loose is on:
            state = Text("locked" if on else "released")
            raise ActionFailed(
                "{name}'s {replace} could not be {state}.",
                name=robot.name,
                replace=Text(part.replace("_", " ")),
                state=state,
            )
        _set_released(robot, part, loose=is_loose)
    return ""


def _set_released(robot: RealRobot, part: str, *, loose: bool) -> None:
    released = robot.known.released
    robot.known.released = released | {part} if loose else released - {part}


def _is_over(task: Task) -> bool:
    try:
        next(task)
    except StopIteration:
        return True
    return False
