"""How a virtual robot walks: a movement of its legs and a path of its torso over the floor.

Standing feet stay where they are. The centre of mass sways so that the zero moment point, where
the floor carries the robot, is under a standing foot while the other one swings.
Source: S. Kajita et al., Biped walking pattern generation by using preview control of zero-moment
point, ICRA 2003: the mass at a constant height; its exact solution is a filter (see _swayed).
"""

from __future__ import annotations

import functools
import math
from collections.abc import Collection, Generator
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass

import numpy as np

from faults import Text, text_of
from robots.errors import ActionFailed

from .body import Angles, Body
from .keyframes import MINIMUM_JERK_PEAK, minimum_jerk, ticks
from .kinematics import Frames, Points, Skeleton, leg_sizes, turned, write_legs
from .limbs import Limb
from .motion import TICK_S, Motion, braking
from .pose import VirtualRobot
from .schedule import Task
from .stance import Carried, Leaning
from .surroundings import bump
from .tasks import DOES_NOT_STAND, at_once, go, moved_base, play_motion

STEP_S = 0.42
"""Time of a step at NAO's highest step frequency. With the step lengths below: 0.095 m/s forward,
0.071 m/s sideways, 0.48 rad/s turning. Source: NAO documentation, ALMotion walk parameters."""
STEP_FORWARD_M = 0.04
STEP_LEFT_M = 0.03
STEP_TURN_RAD = 0.2
_LONGEST_STEP = np.array([STEP_FORWARD_M, STEP_LEFT_M, STEP_TURN_RAD])

FOOT_LIFT_M = 0.02
BOTH_FEET_PART = 0.3
"""Part of a step in which both feet stand and the weight goes over to the other one."""
LEAVING_S = 0.45
"""Before the first step the weight goes to one foot, after the last one back between both."""
SOLE_MIDDLE_M = 0.02
"""So far in front of the ankle is the middle of the sole."""
INWARD_M = 0.012
"""So far from the middle of a sole towards the other foot the weight is carried."""
GRAVITY_M_S2 = 9.81
FASTEST_PART = 0.93
"""Steps for which a joint would have to be faster than this part of its top speed take longer."""
ROUNDED_STEPS = 1e-6
"""By so much numbers of NAOqi, which have 24 bits, make a way longer than whole steps."""
MORE_STEPS = 1.25
"""So many times as many are taken where slower ones do not help."""
TRIES = 15
CORRECTIONS = 3
FILTER_S = 1.5
SETTLING_S = 0.3


@dataclass(frozen=True)
class Walk:
    """A walk: for each tick the legs' movement, and x m, y m, theta rad of feet and torso.

    ``base`` (ticks, 3) is the middle between the feet, ``torso`` (ticks, 3) where the torso is;
    both are relative to where the walk starts, x pointing forward. ``lean`` (3, 3) is how the
    torso leans while it walks. ``weight`` (ticks, 2) is where the floor is to carry the robot.
    ``stops`` (steps + 1, 3) is where the base is after each step, and ``step_s`` how long each is.
    """

    legs: Motion
    base: Angles
    torso: Angles
    lean: Frames
    weight: Angles
    stops: Angles
    step_s: float

    @property
    def landed_s(self) -> float:
        """When the last foot is down: from then on both stay where they are."""
        return LEAVING_S + self.step_s * (len(self.stops) - BOTH_FEET_PART)


@dataclass(frozen=True)
class _Feet:
    """Where the ankles are at every tick (ticks, 3), m, and how they are turned (ticks,), rad."""

    places: dict[str, Points]
    yaws: dict[str, Angles]
    weight: Points

    @property
    def yaw(self) -> Angles:
        """How the base is turned: as the feet are, on the mean."""
        return (self.yaws["L"] + self.yaws["R"]) / 2.0


def plan_walk(
    body: Body,
    standing: Angles,
    forward_m: float,
    left_m: float,
    turn: float,
    *,
    at_least_steps: int = 1,
) -> Walk:
    """Return the walk by so many m forward and left, turning ``turn`` rad evenly on the way.

    ``standing``: the angles of every joint in the posture that it starts and ends in, feet flat.

    ``body`` is whose legs they are, ``forward_m`` and ``left_m`` how far, ``at_least_steps``
    the fewest steps.
    """
    way = np.array([forward_m, left_m, turn])
    stops, step_s, last_part = _even_stops(way, at_least_steps), STEP_S, math.inf
    for _ in range(TRIES):
        angles, walk = _walk(body, standing, stops, step_s)
        part = _fastest_part(body, standing, angles)
        if part <= FASTEST_PART:
            break
        if part < last_part:
            # whole ticks, so that a walk can be followed by another one in the middle
            step_s = math.ceil(step_s * part / FASTEST_PART / TICK_S - 1e-9) * TICK_S
            last_part = part
        else:  # in slower steps it sways farther: a leg is stretched, and its knee has to hurry
            steps = math.ceil(MORE_STEPS * (len(stops) - 1))
            stops, step_s, last_part = _even_stops(way, steps), STEP_S, math.inf
    return walk


def _even_stops(way: Angles, at_least_steps: int = 1) -> Angles:
    """Return where the base is after each of the steps that go a way evenly."""
    steps = max(at_least_steps, math.ceil(_steps(way) - ROUNDED_STEPS))
    return np.linspace(0.0, 1.0, steps + 1)[:, None] * way


def _walk(body: Body, standing: Angles, stops: Angles, step_s: float) -> tuple[Angles, Walk]:
    """Return a walk with the base at ``stops``, and the angles of every joint in it."""
    skeleton = Skeleton(body)
    lean = skeleton.resting_turn(standing)
    feet = _feet(stops, step_s, leg_sizes(body).hip_left)
    frames = skeleton.transforms(standing)
    middle = lean @ skeleton.feet_middle(frames)
    offset = lean @ skeleton.mass_centre(frames)
    base = np.column_stack([(feet.places["L"] + feet.places["R"])[:, :2] / 2.0, feet.yaw])
    base[-1] = stops[-1]
    ends = base[[0, -1], :2] + _turned(base[[0, -1], 2], np.tile((offset - middle)[:2], (2, 1)))
    wanted = _swayed(feet.weight, float(offset[2] - middle[2]), ends)
    angles = np.repeat(standing[None, :], len(base), axis=0)
    path = _Path(dict(feet.yaws), wanted - _turned(feet.yaw, np.tile(offset[:2], (len(base), 1))))
    for _ in range(CORRECTIONS):
        _pose_legs(body, angles, feet, path, lean, -float(middle[2]))
        path.correct(skeleton.transforms(angles), skeleton, lean, feet, wanted)
    _pose_legs(body, angles, feet, path, lean, -float(middle[2]))
    columns = tuple(body.columns({Limb.LEGS}))
    angles, _ = body.clamped(angles)
    torso = np.column_stack([path.torso, path.yaw])
    legs = Motion(columns, angles[:, columns])
    return angles, Walk(legs, base, torso, lean, feet.weight, stops, step_s)


@dataclass
class _Path:
    """Where the torso is (ticks, 2), m, and how its feet are asked to be turned (ticks,), rad."""

    yaws: dict[str, Angles]
    torso: Points

    @property
    def yaw(self) -> Angles:
        """How the torso is turned: as the feet, on the mean."""
        return (self.yaws["L"] + self.yaws["R"]) / 2.0

    def correct(
        self, frames: Frames, skeleton: Skeleton, lean: Frames, feet: _Feet, wanted: Points
    ) -> None:
        """Come nearer to where mass and feet are wanted: legs weigh, and turn as they bend."""
        masses = skeleton.mass_centre(frames) @ lean.T
        there = self.torso + _turned(self.yaw, masses[:, :2])
        yaw = self.yaw
        for link in skeleton.soles:
            heading = frames[:, skeleton.index[link], :3, 0] @ lean.T
            turned = yaw + np.arctan2(heading[:, 1], heading[:, 0])
            self.yaws[link[0]] = self.yaws[link[0]] - (turned - feet.yaws[link[0]])
        moving = 1.0 - _fading(len(there))
        # nothing is corrected at the beginning and at the end
        self.torso = self.torso - (there - wanted) * np.minimum(moving, moving[::-1])


def _fastest_part(body: Body, standing: Angles, angles: Angles) -> float:
    """Return how fast the fastest joint moves, as a part of its top speed."""
    steps = np.abs(np.diff(angles, axis=0, prepend=standing[None]))
    return float((steps / TICK_S / body.max_speed).max())


def _feet(stops: Angles, step_s: float, hip_left_m: float) -> _Feet:
    steps = len(stops) - 1
    swings = steps + 1
    times_s = ticks(2.0 * LEAVING_S + swings * step_s, TICK_S)
    swing_s = step_s * (1.0 - BOTH_FEET_PART)
    begins_s = LEAVING_S + step_s * np.arange(float(swings))
    places, yaws, stands = {}, {}, {}
    for side, sign, first in (("L", 1.0, 0), ("R", -1.0, 1)):
        own = np.arange(first, swings, 2)
        landings = np.array([0.0, *np.minimum(own + 1.0, steps)])
        gone, part = _in_turn(times_s, begins_s[own], swing_s, landings)
        height = np.sin(np.pi * part) ** 2 * FOOT_LIFT_M
        base = _base_after(gone, stops)
        places[side], yaws[side] = _foot(base, sign * hip_left_m, height), base[:, 2]
        middle = _foot(base, sign * (hip_left_m - INWARD_M), height)
        heading = np.column_stack([np.cos(yaws[side]), np.sin(yaws[side])])
        stands[side] = middle[:, :2] + SOLE_MIDDLE_M * heading
    # The weight is carried between the feet, then on each standing one in turn
    changing_s = np.full(swings + 1, step_s * BOTH_FEET_PART)
    ends_s = LEAVING_S + step_s * np.arange(swings + 1.0)
    ends_s[-1] += changing_s[-1]
    changing_s[[0, -1]] *= 2.0  # the first and the last change have more time than others
    feet = np.array([0.5, *(np.arange(swings) % 2.0), 0.5])
    on_left, _ = _in_turn(times_s, ends_s - changing_s, changing_s, feet)
    share = on_left[:, None]
    weight: Points = share * stands["L"] + (1.0 - share) * stands["R"]
    return _Feet(places, yaws, weight)


def _base_after(gone: Angles, stops: Angles) -> Angles:
    """Return where the base is after so many steps, also within one."""
    numbers = np.arange(len(stops))
    return np.column_stack([np.interp(gone, numbers, stops[:, axis]) for axis in range(3)])


def _foot(base: Angles, left_m: float, height: Angles) -> Points:
    """Return where a foot is ``left_m`` beside the base."""
    x, y, yaw = base.T
    return np.column_stack([x - left_m * np.sin(yaw), y + left_m * np.cos(yaw), height])


def _in_turn(
    times_s: Angles, begins_s: Angles, lasting_s: Angles | float, stops: Angles
) -> tuple[Angles, Angles]:
    """Return how far something is that moves on from stop to stop, and how far on its last way.

    ``begins_s`` and ``lasting_s``: of each way, one fewer than ``stops``.
    """
    way = np.maximum(np.searchsorted(begins_s, times_s, "right") - 1, 0)
    lasting_s = np.broadcast_to(lasting_s, begins_s.shape)
    part = np.clip((times_s - begins_s[way]) / lasting_s[way], 0.0, 1.0)
    return stops[way] + (stops[way + 1] - stops[way]) * minimum_jerk(part), part


def _swayed(weight: Points, height_m: float, ends: Points) -> Points:
    """Return how the centre of mass moves (ticks, 2) so that the floor carries it at ``weight``.

    The mass m at the height h obeys weight = x - h/g x''. Of its solutions, this is the one that
    does not run away: the weight's path filtered by k/2 exp(-k |t|), k = sqrt(g/h).
    ``ends`` (2, 2): where it rests before and after.
    """
    k = math.sqrt(GRAVITY_M_S2 / height_m)
    count = round(FILTER_S / TICK_S)
    kernel = np.exp(-k * TICK_S * np.abs(np.arange(-count, count + 1)))
    kernel /= kernel.sum()
    padded = np.vstack([np.repeat(weight[:1], count, 0), weight, np.repeat(weight[-1:], count, 0)])
    swayed = np.column_stack(
        [np.convolve(padded[:, axis], kernel, mode="valid") for axis in (0, 1)]
    )
    before = _fading(len(swayed))
    missing = ends - swayed[[0, -1]]
    rested: Points = swayed + before * missing[0] + before[::-1] * missing[1]
    return rested


def _fading(count: int) -> Points:
    """Return rows (count, 1) that begin with 1 and soon become 0."""
    part: Points = 1.0 - minimum_jerk(np.clip(np.arange(count) * TICK_S / SETTLING_S, 0.0, 1.0))
    return part[:, None]


def _pose_legs(
    body: Body, angles: Angles, feet: _Feet, path: _Path, lean: Frames, height_m: float
) -> None:
    ankles = {}
    for side, places in feet.places.items():
        level = _turned(-path.yaw, places[:, :2] - path.torso)
        seen = np.column_stack([level, places[:, 2] - height_m])
        ankles[side] = seen @ lean
    write_legs(body, angles, ankles, lean[2], path.yaws["L"] - path.yaws["R"])


def _turned(yaw: Angles, vectors: Points) -> Points:
    cosine, sine = np.cos(yaw), np.sin(yaw)
    x, y = vectors[:, 0], vectors[:, 1]
    return np.column_stack([x * cosine - y * sine, x * sine + y * cosine])


# How NAO ends a walk in the middle of a step: it puts its feet side by side.

JOINING_S = 0.5
JOINING_FASTEST_PART = 0.9
JOINING_TRIES = 4
SIDES = {"L": 1.0, "R": -1.0}
SOLE_DOWN_M = 0.04511
BESIDE_M = 0.005
"""Feet that are so near to where they belong need not be lifted."""
LIFTED_M = 0.003
"""A foot that is higher above the floor does not carry the robot."""


@dataclass(frozen=True)
class Joining:
    """The legs' movement, where the torso is meanwhile, and the base at the end."""

    legs: Motion
    guides: list[Carried]
    base: Angles


@dataclass(frozen=True)
class _Foot:
    place: Points
    heading: float


def plan_joining(robot: VirtualRobot, standing: Angles) -> Joining:
    """Return how a walking robot comes to stand. ``standing``: every joint when it stands still."""
    feet = {side: _foot_at(robot, side) for side in SIDES}
    firm = min(feet, key=lambda side: _looseness(robot, feet[side]))
    there, aside_m = feet[firm], -SIDES[firm] * leg_sizes(robot.body).hip_left
    middle = there.place + turned(there.heading) @ [0.0, aside_m, 0.0]
    base = np.array([middle[0], middle[1], there.heading])
    seconds = JOINING_S
    for _ in range(JOINING_TRIES):
        angles, guides = _planned(robot, standing, feet, firm, base, seconds)
        part = _fastest_part(robot.body, robot.angles, angles)
        if part <= JOINING_FASTEST_PART:
            break
        seconds *= part / JOINING_FASTEST_PART
    columns = robot.body.columns({Limb.LEGS})
    return Joining(Motion(tuple(columns), angles[:, columns]), guides, base)


def _planned(
    robot: VirtualRobot,
    standing: Angles,
    feet: dict[str, _Foot],
    firm: str,
    base: Angles,
    seconds: float,
) -> tuple[Angles, list[Carried]]:
    skeleton, stance = robot.stance.skeleton, robot.stance
    part = minimum_jerk(ticks(seconds, TICK_S) / seconds)
    lean = skeleton.resting_turn(standing)
    heading = math.atan2(stance.turn[1, 0], stance.turn[0, 0])
    yaw = heading + part * math.remainder(base[2] - heading, 2.0 * math.pi)
    feet_middle = lean @ skeleton.feet_middle(skeleton.transforms(standing))
    goal = np.array([*base[:2], SOLE_DOWN_M]) - turned(float(base[2])) @ feet_middle
    torso = stance.place + part[:, None] * (goal - stance.place)
    ankles, yaws, highest_m = {}, {}, 0.0
    for side, sign in SIDES.items():
        aside_m = sign * leg_sizes(robot.body).hip_left
        places, yaws[side] = _way(feet[side], base, aside_m, part)
        highest_m = max(highest_m, float(places[:, 2].max()) - SOLE_DOWN_M)
        level = _turned(-yaw, (places - torso)[:, :2])
        ankles[side] = np.column_stack([level, (places - torso)[:, 2]]) @ lean
    angles = np.repeat(standing[None, :], len(part), axis=0)
    write_legs(robot.body, angles, ankles, lean[2], yaws["L"] - yaws["R"])
    angles += (1.0 - part)[:, None] * (robot.angles - angles[0])
    guides = [
        Carried(turned(float(turn)) @ lean, float(x), float(y), stands=highest_m < LIFTED_M)
        for turn, (x, y, _) in zip(yaw, torso, strict=True)
    ]
    return robot.body.clamped(angles)[0], guides


def _foot_at(robot: VirtualRobot, side: str) -> _Foot:
    link = f"{side}_ankle"
    turn = robot.stance.link_turn(link)
    return _Foot(robot.stance.link_place(link), math.atan2(turn[1, 0], turn[0, 0]))


def _looseness(robot: VirtualRobot, foot: _Foot) -> float:
    """Return how little a foot carries: the higher it is, or the farther from below the mass."""
    away_m = float(np.linalg.norm(foot.place[:2] - robot.stance.centre_of_mass[:2]))
    return float(foot.place[2]) + 0.01 * away_m


def _way(foot: _Foot, base: Angles, aside_m: float, part: Angles) -> tuple[Points, Angles]:
    """Return where a foot is while it comes to its side of the base, and how it is turned."""
    goal = np.array([*base[:2], SOLE_DOWN_M])
    goal += turned(float(base[2])) @ [0.0, aside_m, 0.0]
    way = goal - foot.place
    places = foot.place + part[:, None] * way
    if float(np.hypot(*way[:2])) > BESIDE_M:
        places[:, 2] += np.sin(np.pi * part) ** 2 * FOOT_LIFT_M
    turn = math.remainder(base[2] - foot.heading, 2.0 * math.pi)
    return places, foot.heading + part * turn


# How a robot on wheels drives: all at once, speeding up and slowing down evenly.

FASTEST = np.array([0.35, 0.35, 1.0])
"""Forward and to the left, m/s, and turning, rad/s: what looks calm."""


def plan_roll(way: Angles) -> Angles:
    """Return the base (ticks, 3) on a way of m, m and rad, relative to where it starts."""
    duration_s = float(np.max(MINIMUM_JERK_PEAK * np.abs(way) / FASTEST))
    times_s = ticks(duration_s, TICK_S)
    return minimum_jerk(times_s / times_s[-1])[:, None] * way


# How a virtual robot walks over the floor, and comes to rest when it is told to stop.

WALKING_POSTURE = "StandInit"
QUICKLY_PLANNED_STEPS = 100
"""More are planned in a thread: 500 steps that turn take seconds, too long to say nothing."""
PLANNING_LOOK_S = 0.001
MERGING_S = 0.3
"""In this time a robot that stands a little beside where it should comes to stand there."""


def walk(
    robot: VirtualRobot, forward_m: float, left_m: float, turn: float, *, at_least_steps: int = 1
) -> Task:
    """Walk over the floor with steps, turning by ``turn`` rad on the way.

    Raises ActionFailed when the robot does not stand, and when it walks into something.

    ``robot`` walks ``forward_m`` and ``left_m``, in ``at_least_steps`` steps or more.
    """
    if robot.family in DOES_NOT_STAND:
        raise ActionFailed(
            '{name} {family}: it must stand before it can walk. Let it do "posture_stand" first.',
            name=robot.name,
            family=Text(DOES_NOT_STAND[robot.family]),
        )
    way = np.array([forward_m, left_m, turn])
    if not way.any():
        return ""
    if not robot.stance.skeleton.soles:
        return (yield from _roll(robot, way))
    robot.going = going = _Going(robot, way)
    try:
        yield from go(robot, WALKING_POSTURE, {Limb.LEGS})
        robot.posture = WALKING_POSTURE
        first = robot.base
        yield from going.begin(at_least_steps)
        while going.step():
            if what := bump(robot, going.way):
                yield from _end_step(robot)
                raise ActionFailed(_bumped(robot, what, first))
            yield
    finally:
        robot.going = None
    return ""


class _Going:
    """A walk under way: its plan, where that starts on the floor, and the tick that is next.

    ``way`` is what was asked for last.
    """

    def __init__(self, robot: VirtualRobot, way: Angles) -> None:
        self.way = way
        self._robot = robot
        self._plan: Walk | None = None

    def begin(self, at_least_steps: int) -> Task:
        """Plan it, for what was asked for last."""
        planned = None
        while planned is not self.way:
            planned = self.way
            plan = yield from _planned_walk(self._robot, planned, at_least_steps)
        self._follow(plan, self._robot.base, 0)
        return ""

    def step(self) -> bool:
        """Go on by a tick; whether the walk was not over yet."""
        plan, tick, robot = self._plan, self._tick, self._robot
        if plan is None or tick == len(plan.base):
            return False
        share = min((tick - self._since) * TICK_S / MERGING_S, 1.0)
        missing = 1.0 - float(minimum_jerk(np.array([share]))[0])
        robot.angles[list(plan.legs.columns)] = plan.legs.angles[tick] + missing * self._bent
        x, y, yaw = moved_base(self._start, plan.torso[tick])
        x, y = (x, y) + missing * self._beside
        turn = turned(float(yaw)) @ plan.lean
        stands = tick * TICK_S >= plan.landed_s
        robot.stance.guide = Carried(turn, float(x), float(y), stands=stands)
        robot.base = moved_base(self._start, plan.base[tick])
        self._tick += 1
        return True

    @property
    def next_base(self) -> Angles:
        """Where the base is after the step under way, from which another way would be gone."""
        plan = self._plan
        if plan is None:
            return self._robot.base
        return moved_base(self._start, plan.stops[min(self._begun(plan) + 1, len(plan.stops) - 1)])

    def _begun(self, plan: Walk) -> int:
        """Return which step is under way, -1 before the first."""
        return max(math.floor((self._tick * TICK_S - LEAVING_S) / plan.step_s), -1)

    def replace(self, way: Angles) -> bool:
        """Go ``way`` from where the step under way ends, instead of what was left to go.

        False when that cannot be: it has no step left but the one that puts its feet side by
        side, or it would have to be too fast.
        """
        plan, robot = self._plan, self._robot
        if plan is None:
            self.way = way
            return True
        begun = self._begun(plan)
        if begun >= len(plan.stops) - 1 or _steps(way) > QUICKLY_PLANNED_STEPS:
            return False
        # Steps that are over are left out, a left and a right one, but for those still felt
        over = max(0, (begun - 2) // 2 * 2)
        fixed = np.array([_seen_from(plan.stops[over], one) for one in plan.stops[over:]])
        fixed = fixed[: begun + 2 - over]
        more = [moved_base(fixed[-1], one) for one in _even_stops(way)[1:]]
        standing = _standing(robot)
        angles, new = _walk(robot.body, standing, np.array([*fixed, *more]), plan.step_s)
        if _fastest_part(robot.body, standing, angles) > 1.0:
            return False
        tick = self._tick - round(over * plan.step_s / TICK_S)
        self._follow(new, moved_base(self._start, plan.stops[over]), tick)
        self.way = way
        return True

    def _follow(self, plan: Walk, start: Angles, tick: int) -> None:
        """Follow a plan from a tick on, coming softly from where the robot is."""
        robot, last = self._robot, max(tick - 1, 0)
        self._plan, self._start, self._tick, self._since = plan, start, tick, tick
        self._beside = robot.stance.place[:2] - moved_base(start, plan.torso[last])[:2]
        here = robot.angles[list(plan.legs.columns)]
        self._bent = here - plan.legs.angles[last] if tick else np.zeros_like(here)


def _steps(way: Angles) -> float:
    return float(np.max(np.abs(way) / _LONGEST_STEP))


def _seen_from(base: Angles, other: Angles) -> Angles:
    """Return a base as a way from another one, what moved_base undoes."""
    x, y, turn = other - base
    cosine, sine = math.cos(base[2]), math.sin(base[2])
    return np.array([x * cosine + y * sine, y * cosine - x * sine, turn])


def is_stepping(robot: VirtualRobot) -> bool:
    """Whether a walk carries the torso, and a foot is in the air, or will be."""
    guide = robot.stance.last_guide
    return isinstance(guide, Carried) and not guide.stands


def comes_to_rest(robot: VirtualRobot) -> bool:
    """Whether a walk still carries the torso, but both feet stand where they stay."""
    guide = robot.stance.last_guide
    return isinstance(guide, Carried) and guide.stands


def _planned_walk(
    robot: VirtualRobot, way: Angles, at_least_steps: int
) -> Generator[None, None, Walk]:
    """Return the plan of a walk; a long one is made while the robot stands and can be asked."""
    plan = functools.partial(plan_walk, robot.body, _standing(robot), *way.tolist())
    if _steps(way) <= QUICKLY_PLANNED_STEPS:
        return plan(at_least_steps=at_least_steps)
    worker = ThreadPoolExecutor(1)
    try:
        planning = worker.submit(plan)
        while not wait((planning,), PLANNING_LOOK_S).done:
            yield
        return planning.result()
    finally:
        worker.shutdown(wait=False)


def come_to_rest(robot: VirtualRobot, limbs: Collection[Limb], joint_speed: Angles) -> Task:
    """Brake some limbs from the speeds that they have: every joint's, rad/s.

    A robot that walks ends its step; what leans from posture to posture leans no further.
    """
    guide = robot.stance.last_guide
    tasks = [_end_step(robot)] if isinstance(guide, Carried) and Limb.LEGS in limbs else []
    others = set(limbs) - {Limb.LEGS} if tasks else set(limbs)
    tasks.append(_brake(robot, others, joint_speed, is_led=isinstance(guide, Leaning)))
    yield from at_once(tasks)
    if Limb.LEGS in limbs and robot.family == "standing" and robot.stance.skeleton.soles:
        yield from go(robot, robot.posture, {Limb.LEGS})
    return ""


def _brake(
    robot: VirtualRobot, limbs: Collection[Limb], joint_speed: Angles, *, is_led: bool
) -> Task:
    motion = braking(robot.body, robot.angles, joint_speed, robot.body.columns(limbs))
    for _ in play_motion(robot, motion):
        if is_led:
            robot.stance.guide = Leaning(robot.stance.down)
        yield
    return ""


def _end_step(robot: VirtualRobot) -> Task:
    """Put the feet side by side in the middle of a walk."""
    standing = _standing(robot)
    plan = plan_joining(robot, standing)
    for guide, _ in zip(plan.guides, play_motion(robot, plan.legs), strict=True):
        robot.stance.guide = guide
        robot.base = robot.stance.feet_base()
        yield
    robot.base = plan.base
    return ""


def _standing(robot: VirtualRobot) -> Angles:
    """Return the angles of every joint when the legs stand ready to walk."""
    columns = robot.body.columns({Limb.LEGS})
    standing = robot.angles.copy()
    standing[columns] = robot.body.posture_angles(WALKING_POSTURE)[columns]
    return standing


def _roll(robot: VirtualRobot, way: Angles) -> Task:
    """Drive a way on wheels."""
    start = robot.base
    for place in plan_roll(way):
        robot.base = moved_base(start, place)
        robot.stance.roll_to(robot.base)
        if what := bump(robot, way):
            raise ActionFailed(_bumped(robot, what, start))
        yield
    return ""


def _bumped(robot: VirtualRobot, what: str, start: Angles) -> Text:
    way_m = float(np.hypot(*(robot.base - start)[:2]))
    return text_of(
        "{name} walked into {what} after {way_m} m and stopped.",
        name=robot.name,
        what=Text(what),
        way_m=f"{way_m:.2f}",
    )
