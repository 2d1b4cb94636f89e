"""The NAO on the screen: a body in numpy that moves on a clock of its own, and what it measures.

The model of its sensors, where nobody told it what to feel: motors need current to hold the body
and more to move it; the floor carries the body at the points that touch it, and feet feel their
part of that.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from itertools import islice
from typing import Any

import numpy as np

from faults import Text, fault_of

from .actions import Action
from .body import SINGLE_PARTS, Angles, part_of
from .driver import (
    Connection,
    Ended,
    RobotState,
    SenseRequest,
    Thing,
    plain,
    state_of_thing,
    state_of_word,
    states_of_touch,
)
from .gait import SOLE_DOWN_M, come_to_rest
from .inverse import Place, from_world, to_world, twist_of
from .limbs import MOVING, TOUCH_SENSORS, Limb
from .motion import TICK_S
from .pose import TOLD, VirtualRobot
from .reflexes import (
    Idling,
    Sagging,
    fall,
    fallen_sentence,
    gives_way,
    sink,
    steadily,
    sunk_sentence,
)
from .repertoire import limbs_of, task_of
from .schedule import Running, Task, advance, is_over
from .stance import TOUCHING_M, Stance
from .surroundings import Notice, distance_word, sonar_m

GRAVITY_M_S2 = 9.81
HOLDING_A, MOVING_A = 0.05, 0.6
FOOT_SENSORS = {"foot_left": ("L_ankle", 1.0), "foot_right": ("R_ankle", -1.0)}
"""The link of each foot, and the sign of what is outside on it."""
FOOT_CORNERS = {
    "front_left": (0.07025, 0.0299, 0.0231),
    "front_right": (0.07025, -0.0231, -0.0299),
    "rear_left": (-0.03025, 0.0299, 0.0191),
    "rear_right": (-0.02965, -0.0191, -0.0299),
}
"""Where a left and a right foot measure: forward of the ankle, and to the left of it on the left
and on the right foot, m. Source: nao_description V50 URDF."""


def measured(robot: VirtualRobot, joint_speed: Angles, turning: Angles) -> dict[str, float]:
    """Return all sensors by name: m, m/s², rad, rad/s, kg, A; touch sensors 0 or 1.

    ``turning``: how fast the torso turns about its own axes, rad/s.
    """
    sensors = dict.fromkeys(TOUCH_SENSORS, 0.0) | dict.fromkeys(robot.bumped, 1.0)
    sensors |= {name: sonar_m(robot, name) for name in robot.body.sonars}
    down = robot.stance.down
    for axis, part, rate in zip("xyz", down.tolist(), turning.tolist(), strict=True):
        sensors[f"acc_{axis}"] = round(GRAVITY_M_S2 * part, 4)
        sensors[f"gyro_{axis}"] = round(rate, 4)
    _, _, _, roll, pitch, _ = robot.stance.pose
    sensors |= {"angle_x": round(roll, 4), "angle_y": round(pitch, 4)}
    sensors |= weights_kg(robot.stance)
    sensors |= _currents(robot, joint_speed)
    sensors["fallen"] = float(robot.fallen)
    return sensors | {name: value for name, value in robot.felt.items() if name != "battery"}


def turning_rad_s(before: Angles, after: Angles, seconds: float) -> Angles:
    """Return how fast a torso turns about its own axes, from how it was and is turned (3, 3)."""
    return twist_of(before.T @ after) / 2.0 / seconds


def weights_kg(stance: Stance) -> dict[str, float]:
    """Return how much of the weight each corner of each foot feels, and each foot, kg."""
    names, places = _carriers(stance)
    parts = _shares(places, stance.centre_of_mass[:2]) if len(places) else np.zeros(0)
    felt = dict(zip(names, (parts * stance.skeleton.mass_kg).round(3).tolist(), strict=True))
    weights: dict[str, float] = {}
    for foot in FOOT_SENSORS:
        corners = {f"{foot}_{corner}": felt.get(f"{foot}_{corner}", 0.0) for corner in FOOT_CORNERS}
        weights |= corners | {foot: round(sum(corners.values()), 3)}
    return weights


def _carriers(stance: Stance) -> tuple[list[str], Angles]:
    """Return what carries the body, by name, and where (n, 2): corners of feet, other links."""
    skeleton, feet = stance.skeleton, {link for link, _ in FOOT_SENSORS.values()}
    names, places = [], []
    for foot, (link, sign) in FOOT_SENSORS.items():
        for corner, (ahead, on_left, on_right) in FOOT_CORNERS.items():
            if link not in skeleton.soles:
                continue
            left = on_left if sign > 0.0 else on_right
            place = stance.link_place(link, (ahead, left, -SOLE_DOWN_M))
            if place[2] < TOUCHING_M:
                names.append(f"{foot}_{corner}")
                places.append(place[:2])
    links = skeleton.point_links[stance.touching]
    for number in sorted(set(links.tolist())):
        if skeleton.links[number] not in feet:
            names.append(skeleton.links[number])
            touching = stance.places[stance.touching][links == number]
            places.append(touching[:, :2].mean(axis=0))
    return names, np.array(places).reshape(-1, 2)


def _shares(places: Angles, centre: Angles) -> Angles:
    """Return which part of the weight each place carries: the most even one that balances."""
    parts, carrying = np.zeros(len(places)), np.ones(len(places), dtype=bool)
    while True:
        rows = np.vstack([np.ones(int(carrying.sum())), (places[carrying] - centre).T])
        found = np.linalg.pinv(rows) @ np.array([1.0, 0.0, 0.0])
        if (found >= 0.0).all() or carrying.sum() < 2:
            parts[carrying] = np.clip(found, 0.0, 1.0)
            return np.asarray(parts / max(parts.sum(), 1e-9))
        carrying[np.flatnonzero(carrying)[found < 0.0]] = False


def _currents(robot: VirtualRobot, joint_speed: Angles) -> dict[str, float]:
    load = np.abs(joint_speed) / robot.body.max_speed
    return {
        f"current_{name}": 0.0
        if part_of(robot.body, name) in robot.released
        else round(HOLDING_A + MOVING_A * float(part), 3)
        for name, part in zip(robot.body.names, load, strict=True)
    }


# What hands do to a virtual robot: they push it, and put it somewhere else.


def push(robot: VirtualRobot, towards: Place) -> None:
    """Push a robot towards a place (x, y m from its feet) so hard that it tips over."""
    x, y, _ = towards
    if math.isfinite(x) and math.isfinite(y):
        robot.stance.push(float(robot.base[2]) + math.atan2(y, x))


def put(robot: VirtualRobot, place: Place) -> None:
    """Put a robot down at a place (x m, y m, theta rad on the floor), in the posture it is in."""
    if all(math.isfinite(value) for value in place):
        robot.base[:] = place
        robot.stance.put_down(
            robot.angles, np.array(place), robot.body.postures[robot.posture].down
        )


# What a virtual robot is told to feel, see and hear, and what that says about the person.

THINGS = ("face", "ball", "sound", "mark")
MOST_TOLD = 200
"""So many sensors are told what to measure, and things to be in sight, those told last: a stranger
may make up a name each time, and each state of the robot tells them all."""
HANDLED = {"push": push, "place": put}


def sense(robot: VirtualRobot, request: SenseRequest) -> list[str]:
    """Take in what the robot is told to sense; return the human states that follow from it."""
    if not all(map(math.isfinite, (request.value, *request.place))):
        return []  # no sensor measures that, and nobody could read it in the robot's state
    if request.sense == "word":
        return [state_of_word(request.name)] if plain(request.name) else []
    if request.sense in THINGS:
        return _see(robot, request)
    if request.sense == "usual":
        robot.felt.clear()
        return []
    if request.sense in HANDLED:
        HANDLED[request.sense](robot, request.place)
        return []
    was_touched = robot.felt.pop(request.sense, 0.0) > 0.0
    robot.felt[request.sense] = request.value
    _forget_oldest(robot.felt)
    if request.sense in TOUCH_SENSORS and request.value > 0.0 and not was_touched:
        return states_of_touch(request.sense)
    return []


def _forget_oldest(told: dict[str, Any]) -> None:
    while len(told) > MOST_TOLD:
        del told[next(iter(told))]


def _see(robot: VirtualRobot, request: SenseRequest) -> list[str]:
    name = plain(request.name)
    if request.sense == "face":
        name = robot.faces.name_of(TOLD + name, name)
    things = [request.sense, *([f"{request.sense}_{name}"] if name else [])]
    new = [thing for thing in things if thing not in robot.sees]
    if request.value <= 0.0:
        for thing in things:
            robot.sees.pop(thing, None)
        return []
    place = to_world(robot, request.place)
    for thing in things:
        robot.sees.pop(thing, None)
    robot.sees |= dict.fromkeys(things, place)
    _forget_oldest(robot.sees)
    states = [state_of_thing(thing) for thing in reversed(new)]
    if request.sense == "face":
        states.append(f"person_{distance_word(request.place)}")
    return states


LOOKING_S = 0.1
BATTERY_S = 90.0 * 60.0
"""So long a full battery lasts. Source: NAO documentation, in normal use."""
TICKS_IN_TIME, MOST_TICKS_A_LOOK = 4, 8
"""A robot that lives faster looks less often how it stands: so many ticks at once are in time."""
MOST_TICKS = 100
"""In one step: between two of them its node answers, and a slow machine needs long for a tick."""
FELL = "robot_fell"
"""What is told when the robot has lost its balance."""


MOST_THINGS = 500
"""So many things stand around a robot: it looks at each of them ten times a second."""


def _is_somewhere(thing: Thing) -> bool:
    return all(map(math.isfinite, (*thing.place, thing.heading, *thing.size)))


class VirtualDriver:
    """Plays actions on a virtual robot, one tick (TICK_S) after the other.

    ``now_s`` may run faster than real time; nothing here reads a clock.
    """

    def __init__(self, robot: VirtualRobot, now_s: float = 0.0) -> None:
        self.robot = robot
        self.connection = Connection("disconnected")
        self._clock_s = now_s
        self._running: dict[str, Running] = {}
        self._held_up: dict[str, Running] = {}  # until limbs that brake have come to rest
        self._braking: list[Running] = []
        self._joint_speed = np.zeros(len(robot.body.names))
        self._turning = np.zeros(3)
        self._idling = Idling(robot)
        self._sagging = Sagging(robot)
        self._notice = Notice(robot)
        self._noticed: list[str] = []
        self._next_look_s = now_s
        self._ticks_a_look = 1
        self._ticks_since_look = 0

    @property
    def moving(self) -> bool:
        """Whether the robot does something, if only by itself."""
        return self.is_busy or self._idling.is_active or self._sagging.is_active

    @property
    def is_busy(self) -> bool:
        """Whether the robot does something that it was asked for, or falls."""
        is_steady = self.robot.stance.is_steady
        return bool(self._running or self._held_up or self._braking or not is_steady)

    def connect(self) -> None:
        """Be connected at once: the robot is in this process."""
        words = fault_of(
            "virtual {kind}, {family}", kind=self.robot.body.title, family=Text(self.robot.family)
        )
        self.connection = Connection("connected", words)

    def disconnect(self) -> None:
        """Let the robot be."""
        self.stop({*self._running, *self._held_up})
        self.connection = Connection("disconnected")

    def limbs(self, action: Action) -> frozenset[Limb]:
        """Return the limbs that an action needs. Raises ActionFailed if a name is unknown."""
        return limbs_of(self.robot, action)

    def start(self, command_id: str, action: Action) -> None:
        """Begin an action; ``step`` tells when it has ended."""
        limbs = self.limbs(action)
        task = task_of(self.robot, action)
        if limbs & MOVING:
            task = steadily(self.robot, task)
        started = self._held_up if self._braking else self._running
        started[command_id] = Running(task, limbs)

    def stop(self, command_ids: Collection[str]) -> None:
        """End some actions: their joints brake, which holds up later actions for a moment."""
        limbs: set[Limb] = set()
        for command_id in command_ids:
            self._held_up.pop(command_id, None)
            if stopped := self._running.pop(command_id, None):
                stopped.task.close()
                limbs |= stopped.limbs
        if limbs & MOVING:
            rest = come_to_rest(self.robot, limbs, self._joint_speed)
            self._braking.append(Running(rest, frozenset(limbs)))

    def surroundings(self, things: Sequence[Thing]) -> None:
        """Take in what stands around the robot; it notices by itself what is in sight."""
        usable = (thing for thing in things if _is_somewhere(thing))
        self.robot.things = tuple(islice(usable, MOST_THINGS))
        self._next_look_s = self._clock_s

    def step(self, now_s: float) -> list[Ended]:
        """Go on to a time, or to the first tick in which a command ends.

        A time that is too far off is not reached at once: the robot lives slower for a moment.
        """
        self._look_around(now_s)
        hurry = int((now_s - self._clock_s) / TICK_S) // TICKS_IN_TIME
        self._ticks_a_look = min(max(hurry, 1), MOST_TICKS_A_LOOK)
        for _ in range(MOST_TICKS):
            if not self.moving or self._clock_s + TICK_S > now_s:
                break
            self._clock_s += TICK_S
            if ended := self._tick():
                return ended
        if self._ticks_since_look:
            self._follow(must=True)
        if not self.moving:
            self._use_battery(now_s - self._clock_s)
            self._clock_s = now_s
        return []

    def state(self) -> RobotState:
        """Return where the robot's body is."""
        robot = self.robot
        x, y, theta = (float(value) for value in robot.base)
        return RobotState(
            robot=robot.name,
            model=robot.model,
            joints=dict(zip(robot.body.names, robot.angles.round(5).tolist(), strict=True)),
            base=(x, y, theta),
            torso=robot.stance.pose,
            fallen=robot.fallen,
            posture=robot.posture,
            leds=dict(robot.leds),
            saying=robot.saying,
            moving=self.moves_joints,
            battery=round(robot.felt.get("battery", robot.battery), 3),
            sensors=measured(robot, self._joint_speed, self._turning),
            sees={thing: from_world(robot, place) for thing, place in robot.seen.items()},
            settings=robot.settings
            | {"awake": not robot.released and robot.posture != "Rest"}
            | {f"locked_{part}": part not in robot.released for part in SINGLE_PARTS},
            listening=list(robot.listening),
        )

    def sense(self, request: SenseRequest) -> list[str]:
        """Feel, see or hear something; return the human states that follow from it."""
        return sense(self.robot, request)

    def expect(self, words: Sequence[str]) -> None:
        """Do nothing: it hears every word."""

    def noticed(self) -> list[str]:
        """Return the human states that the robot has noticed by itself since the last call."""
        noticed, self._noticed = self._noticed, []
        return noticed

    def halt(self) -> None:
        """Do nothing: ``stop`` has ended all that this robot does."""

    @property
    def moves_joints(self) -> bool:
        """Whether joints move, or are about to."""
        running = [*self._running.values(), *self._held_up.values()]
        return bool(self._braking or any(one.limbs & MOVING for one in running))

    def _tick(self) -> list[Ended]:
        angles = self.robot.angles.copy()
        self._use_battery(TICK_S)
        self._braking = [one for one in self._braking if not is_over(one.task)]
        ended = [end for name in tuple(self._running) if (end := advance(self._running, name))]
        if not self._braking:
            self._running |= self._held_up
            self._held_up.clear()
        acting = [*self._running.values(), *self._held_up.values(), *self._braking]
        self._idling.step(frozenset(limb for one in acting for limb in one.limbs), self._clock_s)
        self._sagging.step()
        self._ticks_since_look += 1
        self._follow(must=bool(ended))
        self._joint_speed = (self.robot.angles - angles) / TICK_S
        if self.robot.stance.has_lost_balance and not self.robot.fallen:
            self._noticed.append(FELL)
            ended += self._instead(fall(self.robot), fallen_sentence(self.robot), MOVING)
        elif gives_way(self.robot):
            sentence = sunk_sentence(self.robot)
            ended += self._instead(sink(self.robot), sentence, frozenset({Limb.LEGS}))
        self._look_around(self._clock_s)
        return ended

    def _follow(self, *, must: bool) -> None:
        """Let the body stand on the floor as its joints are now; not at each tick in a hurry."""
        if must or self._ticks_since_look >= self._ticks_a_look:
            seconds, before = TICK_S * self._ticks_since_look, self.robot.stance.turn
            self.robot.stance.follow(self.robot.angles, seconds)
            self._turning = turning_rad_s(before, self.robot.stance.turn, seconds)
            self._ticks_since_look = 0

    def _look_around(self, now_s: float) -> None:
        """Notice what is in sight, some times a second."""
        if now_s >= self._next_look_s:
            self._next_look_s = now_s + LOOKING_S
            self._noticed += self._notice.look(now_s)

    def _use_battery(self, seconds: float) -> None:
        self.robot.battery = max(0.0, self.robot.battery - seconds / BATTERY_S)

    def _instead(self, task: Task, why: Text, limbs: frozenset[Limb]) -> list[Ended]:
        """Do something instead of all that uses some limbs, which has failed."""
        moving = [name for name, one in self._running.items() if one.limbs & limbs]
        for name in moving:
            self._running.pop(name).task.close()
        self._braking = [Running(task, limbs)]
        return [Ended(name, "failed", fault_of(why)) for name in moving]
