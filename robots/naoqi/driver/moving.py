"""What a real robot does for requests that move it: its joints, its walk, its look, its motors."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

from faults import Text
from robots.body import actions as a
from robots.body.body import Angles, Body, part_of, posture_name, single_parts
from robots.body.inverse import arm_for, head_angles, in_torso, pointing
from robots.body.keyframes import Keyframes, Track, control_points
from robots.body.limbs import MOVING, Limb
from robots.body.motion import playable
from robots.body.motor_tasks import HOLDS, SIDES, check_release
from robots.body.schedule import Task, is_over
from robots.body.tasks import DOES_NOT_STAND, check_fit_to_walk
from robots.errors import ActionFailed

from .calls import Calling
from .real import LIFE_OFF, RealRobot
from .stepping import LEG_S, step_on

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
    postures = robot.known.body.postures
    found = postures.get(str((yield from robot.call("ALRobotPosture", "getPosture"))))
    # one of its kind will do: some look the same to NAOqi
    is_alike = found is not None and found.family == postures[name].family
    if not reached or not is_alike:
        raise ActionFailed(
            "{name} did not get into the posture {name_2}. Put it on flat ground with space around "
            "it, and try again.",
            name=robot.name,
            name_2=name,
        )
    robot.known.posture = name
    yield from robot.measure(joints)
    return ""


def wake_up(robot: RealRobot) -> Task:
    """Switch all motors on and stand up; once begun it is finished, also when it is stopped."""
    yield from robot.take_over()
    return (yield from robot.calls.finished(_waken(robot)))


def _waken(robot: RealRobot) -> Task:
    yield from robot.call("ALMotion", "wakeUp", limit_s=WAKING_S)
    awake = yield from robot.call("ALMotion", "robotIsWakeUp")
    if not awake:
        raise ActionFailed("{name} did not wake up. Press its chest button twice.", name=robot.name)
    robot.known.released = frozenset()
    found = yield from robot.call("ALRobotPosture", "getPosture")
    robot.known.posture = str(found)
    yield from robot.measure(robot.names(MOVING))
    return ""


def rest(robot: RealRobot) -> Task:
    """Go down and switch all motors off; once begun it is finished, also when it is stopped."""
    return robot.calls.finished(_go_to_rest(robot))


def _go_to_rest(robot: RealRobot) -> Task:
    robot.life_is_off = True  # NAOqi does not go to rest in the robot's own life
    if robot.calls.has("ALAutonomousLife", "setState"):
        yield from robot.call("ALAutonomousLife", "setState", LIFE_OFF, limit_s=WAKING_S)
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


def move_hands(robot: RealRobot, action: a.Hand) -> Task:
    """Open or close hands, both at once."""
    names = list(SIDES[action.side])
    method = "openHand" if action.open else "closeHand"
    calls = [robot.call("ALMotion", method, name, limit_s=8.0, uses=[name]) for name in names]
    try:
        while calls:
            calls = [call for call in calls if not is_over(call)]
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


def move_joint(robot: RealRobot, action: a.MoveJoint) -> Task:
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


def reach_angles(robot: RealRobot, action: a.ReachAngles) -> Task:
    """Move joints to angles, as far as they go."""
    goal, clamped = robot.goal_of(action.angles)
    yield from robot.go_to(goal, action.speed)
    return f"kept within the limits of {', '.join(clamped)}" if clamped else ""


def approach(robot: RealRobot, action: a.Approach) -> Task:
    """Send joints where the targets say, each time that these change."""
    sent: dict[str, a.Target] = {}
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


def move_through(robot: RealRobot, action: a.MoveThrough) -> Task:
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
    if not on:
        yield from _check_release(robot, names)
    yield from robot.take_over()
    value = 1.0 if on else 0.0
    yield from robot.call(
        "ALMotion", "stiffnessInterpolation", names, value, STIFF_S, limit_s=STIFF_S + 3.0
    )
    yield from _check_motors(robot, parts, on=on)
    return ""


def set_stiffness(robot: RealRobot, action: a.SetStiffness) -> Task:
    """Set how firmly single joints are held."""
    names, seconds = list(action.joints), max(float(action.seconds), STIFF_S)
    yield from _check_release(robot, [n for n in names if action.joints[n] < HOLDS])
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


def set_life(robot: RealRobot, action: a.Awareness | a.Breathing) -> Task:
    """Let the robot look at people by itself, or breathe."""
    if isinstance(action, a.Breathing):
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
    if Limb.LEGS in robot.known.body.limbs_of(joints):  # NAOqi keeps the balance on the way
        return (yield from to_posture(robot, posture))
    goal = robot.picked(robot.known.body.posture_angles(posture), joints)
    yield from robot.go_to(goal, RETURN_SPEED)
    return ""


def posture_task(robot: RealRobot, action: a.Do) -> Task:
    """Take a posture."""
    return take_posture(robot, action.posture, min(POSTURE_SPEED * action.pace, 1.0))


def _check_release(robot: RealRobot, joints: Collection[str]) -> Task:
    """Raise ActionFailed when the robot stands on joints that are to be released."""
    body = robot.known.body
    if not robot.known.stance.skeleton.soles or Limb.LEGS not in body.limbs_of(joints):
        return ""
    found = str((yield from robot.call("ALRobotPosture", "getPosture")))
    yield from robot.measure(robot.names(MOVING))
    check_release(robot.known, body.postures[found].family if found in body.postures else "")
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


# What a real robot does for requests to walk, to turn, to look and to follow.

SLOWEST_M_S = 0.03
SLOWEST_RAD_S = 0.12
LONGEST_TURN_RAD = 2.6
"""NAOqi takes the short way round: it must not be asked for more than half a turn."""
LONGEST_LEG_M = 0.5
"""A longer way is walked in legs: without this driver the robot stands at the end of one."""
STEP_LEG = (0.04, 0.03, 0.2)
"""How far a robot on feet walks freely at once (m, m, rad): one step of each kind."""
WHEEL_LEG = (0.12, 0.12, 0.4)
"""How far one on wheels drives freely at once."""
OFF_M, OFF_PART = 0.08, 0.25
LOOKING_SPEED, POINTING_SPEED = 0.3, 0.3
NOUNS = {"face": "a face", "ball": "the red ball", "mark": "a mark", "sound": "a sound"}
TARGETS: dict[str, tuple[str, object]] = {
    "face": ("Face", 0.15),
    "ball": ("RedBall", 0.06),
    "sound": ("Sound", [1.0, 0.4]),
}
"""What NAOqi can follow: its name, and how large (m) or how sure it is."""


def walk(robot: RealRobot, forward_m: float, left_m: float, turn: float) -> Task:
    """Walk over the floor, turning by ``turn`` rad on the way, and look how far it got.

    ``robot`` walks ``forward_m`` and ``left_m``.
    """
    _check_walk(robot)
    if not (forward_m or left_m or turn):
        return ""
    start = yield from _place(robot)
    for way in legs_of(forward_m, left_m, turn):
        _check_fit(robot)
        limit_s = 15.0 + math.hypot(*way[:2]) / SLOWEST_M_S + abs(way[2]) / SLOWEST_RAD_S
        yield from robot.call("ALMotion", "moveTo", *way, limit_s=limit_s, uses=robot.names(MOVING))
    end = yield from _place(robot)
    _check_way(robot, start, end, (forward_m, left_m, turn))
    posture = yield from robot.call("ALRobotPosture", "getPosture")
    robot.known.posture = str(posture)
    return ""


def legs_of(forward_m: float, left_m: float, turn: float) -> list[tuple[float, float, float]]:
    """Return a way (m, m, rad) as legs that are walked one after the other."""
    turns = max(1, math.ceil(abs(turn) / LONGEST_TURN_RAD))
    # All of the way is in the first of several equal parts of a turn
    first, count = turn / turns, max(1, math.ceil(math.hypot(forward_m, left_m) / LONGEST_LEG_M))
    legs = []
    for number in range(count):  # each is seen from where the robot looks to at its beginning
        gone = first * number / count
        x = forward_m * math.cos(gone) + left_m * math.sin(gone)
        y = left_m * math.cos(gone) - forward_m * math.sin(gone)
        legs.append((x / count, y / count, first / count))
    return legs + [(0.0, 0.0, first)] * (turns - 1)


def walk_freely(robot: RealRobot, action: a.WalkFreely) -> Task:
    """Walk on and on, by short legs: without this driver the robot stands after the last one.

    NAOqi's moveToward would have no end when this process or the network is gone, and nothing that
    a NAO has by itself would end it.
    """
    _check_walk(robot)
    parts = float(action.forward), float(action.left), float(action.turn)
    if not any(parts):
        return ""
    on_feet = bool(robot.known.stance.skeleton.soles)
    longest = STEP_LEG if on_feet else WHEEL_LEG
    leg = [part * most for part, most in zip(parts, longest, strict=True)]
    if on_feet:
        return (yield from step_on(robot, leg))
    while True:
        yield from robot.call("ALMotion", "moveTo", *leg, limit_s=LEG_S, uses=robot.names(MOVING))


def look(robot: RealRobot, yaw: float, pitch: float) -> Task:
    """Turn the head as far as it goes towards a direction (rad)."""
    goal, clamped = robot.goal_of({"HeadYaw": yaw, "HeadPitch": pitch})
    yield from robot.go_to(goal, LOOKING_SPEED)
    if not clamped:
        return ""
    yaw_deg, pitch_deg = math.degrees(goal["HeadYaw"]), math.degrees(goal["HeadPitch"])
    return (
        f"looked as far as its head goes: {yaw_deg:.0f} degrees to the left, {pitch_deg:.0f} down"
    )


def look_at(robot: RealRobot, place: tuple[float, float, float], frame: str) -> Task:
    """Turn the head to a place."""
    yield from _place(robot)
    yaw, pitch = head_angles(in_torso(robot.known, place, frame), robot.known.body)
    return (yield from look(robot, yaw, pitch))


def look_at_seen(robot: RealRobot, thing: str) -> Task:
    """Turn the head to something that the robot notices."""
    if thing not in robot.known.sees:
        raise ActionFailed(
            "{name} does not notice {get} now.", name=robot.name, get=Text(NOUNS.get(thing, thing))
        )
    return (yield from look_at(robot, robot.known.sees[thing], "world"))


def point_at(robot: RealRobot, action: a.PointAt) -> Task:
    """Stretch an arm out towards a place, as far as the shoulder goes."""
    yield from _place(robot)
    place = action.x_m, action.y_m, action.z_m
    side = arm_for(robot.known, place, action.frame, action.arm)
    goal, columns = pointing(robot.known, place, action.frame, side)
    names = [robot.known.body.names[column] for column in columns]
    allowed, clamped = robot.goal_of(robot.picked(goal, names))
    hands = {name: angle for name, angle in allowed.items() if name.endswith("Hand")}
    for hand in hands:
        robot.calls.tell("ALMotion", "setAngles", [hand], [allowed.pop(hand)], 0.5)
    yield from robot.go_to(allowed, POINTING_SPEED)
    return "pointed as far as its arm goes" if clamped else ""


def track(robot: RealRobot, action: a.Track) -> Task:
    """Keep the head or the whole body turned to something, until that is ended."""
    yield from robot.call("ALTracker", "stopTracker")
    yield from robot.call("ALTracker", "unregisterAllTargets")
    robot.known.settings["tracking"] = ""
    if action.using == "off":
        return ""
    if action.thing not in TARGETS:
        known = ", ".join(TARGETS)
        raise ActionFailed(
            '{name} cannot follow "{thing}". Possible: {known}.',
            name=robot.name,
            thing=action.thing,
            known=known,
        )
    name, size = TARGETS[action.thing]
    if action.using == "body":
        _check_walk(robot)
    yield from robot.call("ALTracker", "registerTarget", name, size)
    mode = "Head" if action.using == "head" else "Move"
    yield from robot.call("ALTracker", "setMode", mode)
    yield from robot.call("ALTracker", "track", name)
    active = yield from robot.call("ALTracker", "getActiveTarget")
    if active != name:
        raise ActionFailed("{name} does not follow: it did not take that in.", name=robot.name)
    robot.known.settings["tracking"] = action.thing
    return ""


def _place(robot: RealRobot) -> Calling:
    told = yield from robot.call("ALMotion", "getRobotPosition", True)
    place = robot.be_at(told)
    yield from robot.measure(robot.names(MOVING))
    robot.stand_as_told()
    return place


def while_fit(robot: RealRobot, task: Task) -> Task:
    """Do a task as long as the robot is fit to walk, else raise ActionFailed."""
    try:
        while not is_over(task):
            yield
            _check_fit(robot)
    finally:
        task.close()
    return ""


def _check_walk(robot: RealRobot) -> None:
    _check_fit(robot)
    _check_standing(robot)


def _check_fit(robot: RealRobot) -> None:
    check_fit_to_walk(robot.name, robot.hottest, robot.battery)


def _check_standing(robot: RealRobot) -> None:
    postures = robot.known.body.postures
    family = postures[robot.known.posture].family if robot.known.posture in postures else ""
    if family in DOES_NOT_STAND:
        raise ActionFailed(
            '{name} {family}: it must stand before it can walk. Let it do "posture_stand" first.',
            name=robot.name,
            family=Text(DOES_NOT_STAND[family]),
        )


def _check_way(
    robot: RealRobot,
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    asked: tuple[float, float, float],
) -> None:
    """Raise ActionFailed when the robot is far from where it was to go."""
    east, north = end[0] - start[0], end[1] - start[1]
    cosine, sine = math.cos(start[2]), math.sin(start[2])
    forward, left = east * cosine + north * sine, north * cosine - east * sine
    way = math.hypot(asked[0], asked[1])
    off = math.hypot(forward - asked[0], left - asked[1])
    if off > OFF_M + OFF_PART * way:
        raise ActionFailed(
            "{name} got only {hypot} m of {way} m far. Look whether something is in its way.",
            name=robot.name,
            hypot=f"{math.hypot(forward, left):.2f}",
            way=f"{way:.2f}",
        )
