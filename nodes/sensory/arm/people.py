"""Simulated people: how each is built, moves, and wears the watch.

A person is a pure function of a number. Numbers below 100 are for training, so that those from
100 on are people whom no model has seen. Every tenth (9, 19, ...) is left-handed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from nep_core.wire.messages import Wrist
from nodes.recordings import Recording

from .everyday import CALM, EVERYDAY, HANGING, Activity, rest
from .gestures import Gesture, gesture_named
from .motion import LENGTHS, Body, Floats, Joint, Motion, Pose, Sensor, Swing, joint_values

_SEED = 2018
_SCALES = 7  # a source of chance of its own: people stay who they were
_LEFT_HANDED = 9
_STYLE_DEG = 6.0  # how much people differ in each joint of each key pose
_CARE_DEG = 3.0  # how much one person's performances differ


@dataclass(frozen=True)
class Person:
    """Who moves: ``pace`` 1.1 is a tenth faster, ``reach`` 1.1 moves a tenth further."""

    number: int
    body: Body
    sensor: Sensor
    pace: float
    reach: float
    tremor: tuple[Swing, ...]

    def style(self, gesture: str, stroke: int) -> Floats:
        """How this person's key pose differs from the written one: (11,) in rad, m."""
        rng = np.random.default_rng([_SEED, self.number, stroke, *gesture.encode()])
        return _angles(rng, _STYLE_DEG)


def person_numbered(number: int) -> Person:
    """The person of this number, 0 or more: always the same one."""
    rng = np.random.default_rng([_SEED, number])
    size = rng.normal(1.0, 0.05)
    return Person(
        number=number,
        body=_body(rng, size),
        sensor=_sensor(rng, number),
        pace=float(np.clip(rng.normal(1.0, 0.08), 0.85, 1.18)),
        reach=float(np.clip(rng.normal(1.0, 0.06), 0.85, 1.15)),
        tremor=tuple(_tremor(rng)),
    )


def performance_variation(rng: np.random.Generator) -> Floats:
    """How one key pose differs from one performance to the next: (11,) in rad, m."""
    return _angles(rng, _CARE_DEG)


def _body(rng: np.random.Generator, size: float) -> Body:
    upper_arm, forearm, watch = rng.normal(1.0, (0.04, 0.04, 0.25))
    return Body(
        shoulder_height_m=0.48 * size,
        shoulder_width_m=0.18 * size,
        upper_arm_m=0.30 * size * upper_arm,
        forearm_m=0.25 * size * forearm,
        watch_to_wrist_m=0.03 * watch,
    )


def _sensor(rng: np.random.Generator, number: int) -> Sensor:
    """A loose strap lets the watch turn about the forearm (its x axis) more than tilt."""
    about_x, about_y, about_z = np.radians(rng.normal(0.0, (10.0, 3.0, 4.0)))
    return Sensor(
        turned=_turned(about_x, about_y, about_z),
        scale=np.random.default_rng([_SEED, number, _SCALES]).normal(1.0, 0.01, 3),
        acc_bias=rng.normal(0.0, 0.06, 3),
        gyr_bias=rng.normal(0.0, 0.01, 3),
        acc_noise=float(rng.uniform(0.03, 0.08)),
        gyr_noise=float(rng.uniform(0.003, 0.01)),
        left_wrist=number % 10 == _LEFT_HANDED,
    )


def _tremor(rng: np.random.Generator) -> list[Swing]:
    """Never ending small movements: the sway of standing, and the tremor of muscles."""
    kinds = ((0.3, 0.5, 0.6), (0.8, 1.4, 0.1), (7.0, 11.0, 0.002))  # Hz from, Hz to, degrees
    return [
        Swing(
            start_s=-10.0,
            end_s=np.inf,
            frequency_hz=float(rng.uniform(low, high)),
            phase=float(rng.uniform(0, 2 * np.pi)),
            amplitude=_angles(rng, degrees),
        )
        for low, high, degrees in kinds
    ]


def _angles(rng: np.random.Generator, deviation_deg: float) -> Floats:
    angles = rng.normal(0.0, np.radians(deviation_deg), len(Joint))
    angles[list(LENGTHS)] = 0.0
    angles[Joint.HEADING] = 0.0
    return angles


def _turned(about_x: float, about_y: float, about_z: float) -> Floats:
    """A rotation by three small angles, exactly orthogonal."""
    skew = np.array([[0.0, -about_z, about_y], [about_z, 0.0, -about_x], [-about_y, about_x, 0.0]])
    cayley = np.linalg.solve(np.eye(3) - skew / 2, np.eye(3) + skew / 2)
    return np.asarray(cayley, dtype=np.float64)


# A simulated person who moves without a break, sample by sample.

_HASTE_S = 0.03  # how much the parts of a gesture shift in time


@dataclass(frozen=True)
class Samples:
    """n samples: ``t`` (n,) s, ``acc`` (n, 3) m/s² with gravity, ``gyr`` (n, 3) rad/s, n labels."""

    t: Floats
    acc: Floats
    gyr: Floats
    labels: list[str]


class Performer:
    """Plans movements one after the other, and gives out what the watch feels.

    The same person, rate and seed, asked for the same movements, give the same samples.

    ``person`` is who moves, ``rate_hz`` how often it is measured, ``seed`` that of the chance,
    ``start_s`` the time of the first sample.
    """

    def __init__(self, person: Person, rate_hz: float, seed: int, start_s: float = 0.0) -> None:
        self.planned_until_s = start_s
        self._person = person
        self._rate_hz = rate_hz
        self._sent = round(start_s * rate_hz)
        self._moves = np.random.default_rng([1, person.number, seed])
        self._noise = np.random.default_rng([2, person.number, seed])
        self._motion = Motion(joint_values(HANGING))
        for tremor in person.tremor:
            self._motion.swing(tremor)
        self._gestures: list[tuple[float, float, str]] = []

    @property
    def now_s(self) -> float:
        """The time of the next sample."""
        return self._sent / self._rate_hz

    def gesture_at(self, t_s: float) -> str:
        """The gesture being made at a planned time, or ""."""
        return next((name for start, end, name in self._gestures if start <= t_s < end), "")

    def live(self, activity: Activity) -> None:
        """Plan an everyday activity after all that is planned."""
        self.planned_until_s = activity(self._motion, self.planned_until_s, self._moves)

    def interrupt(self) -> None:
        """Give up what is planned but not begun; what is under way flows into the next plan."""
        self._motion.give_up_plans(self.now_s)
        self.planned_until_s = self.now_s

    def make(self, gesture: Gesture) -> None:
        """Plan a gesture after all that is planned: go to its ready pose, wait, make it."""
        pace = self._person.pace * self._moves.normal(1.0, 0.05)
        way_s = self._moves.uniform(0.7, 1.0) / pace
        ready = self._varied(gesture, 0, gesture.ready)
        self._motion.move(ready, self.planned_until_s, way_s)
        begin_s = self.planned_until_s + way_s + self._moves.uniform(0.1, 0.4)
        for number, stroke in enumerate(gesture.strokes, start=1):
            self._motion.move(
                self._varied(gesture, number, stroke.pose),
                begin_s + (stroke.start_s + self._moves.normal(0.0, _HASTE_S)) / pace,
                stroke.duration_s / pace,
            )
        self.planned_until_s = begin_s + gesture.duration_s / pace
        self._gestures.append((begin_s, self.planned_until_s, gesture.name))

    def samples(self, count: int) -> Samples:
        """The next samples; as many must be planned."""
        t = (self._sent + np.arange(count)) / self._rate_hz
        acc, gyr = self._person.sensor.feel(self._motion, self._person.body, t, self._noise)
        labels = [self.gesture_at(at) for at in t.tolist()]
        self._sent += count
        self._motion.forget_before(self.now_s - 1 / self._rate_hz)
        self._gestures = [known for known in self._gestures if known[1] > self.now_s]
        return Samples(t, acc, gyr, labels)

    def has_planned(self, count: int) -> bool:
        """Whether as many samples are planned."""
        return (self._sent + count) / self._rate_hz <= self.planned_until_s

    def planned_samples(self) -> Samples:
        """All samples up to the end of what is planned."""
        return self.samples(int((self.planned_until_s - self.now_s) * self._rate_hz))

    def _varied(self, gesture: Gesture, stroke: int, pose: Pose) -> Pose:
        """A key pose as this person takes it this time."""
        differs = self._person.style(gesture.name, stroke) + performance_variation(self._moves)
        varied: dict[Joint, float] = {}
        for joint, degrees in pose.items():
            start = gesture.ready.get(joint, 0.0)
            reached = start + self._person.reach * (degrees - start)
            varied[joint] = reached + float(np.degrees(differs[joint]))
        if Joint.ELBOW in varied:
            varied[Joint.ELBOW] = float(np.clip(varied[Joint.ELBOW], 0.0, 150.0))
        return varied


# A simulated person who lives in real time: makes gestures on request, else something calm.

MOST_WAITING = 20


class LivePerson:
    """Somebody who wears the watch: gestures wait for each other, everyday movement gives way.

    ``person`` is the number of who wears it, ``rate_hz`` how often it measures, ``seed`` that
    of the chance, ``start_s`` the time of the first sample.
    """

    def __init__(self, person: int, rate_hz: float, seed: int, start_s: float = 0.0) -> None:
        self.number = person
        who = person_numbered(person)
        self.wrist: Wrist = "left" if who.sensor.left_wrist else "right"
        self._performer = Performer(who, rate_hz, seed, start_s)
        self._chance = np.random.default_rng([5, person, seed])
        self._waiting: deque[Gesture] = deque()
        self._gesture_until_s = start_s

    @property
    def now_s(self) -> float:
        """The time of the next sample, by the watch's clock."""
        return self._performer.now_s

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way (or the way to it) or waits."""
        return bool(self._waiting) or self.now_s < self._gesture_until_s

    @property
    def making(self) -> str:
        """The gesture that is being made now, or ""."""
        return self._performer.gesture_at(self.now_s)

    def ask(self, gesture: Gesture) -> bool:
        """Make this gesture at once, or after those under way; False when too many wait."""
        if len(self._waiting) >= MOST_WAITING:
            return False
        self._waiting.append(gesture)
        if self.now_s >= self._gesture_until_s:
            self._performer.interrupt()
        return True

    def samples(self, count: int) -> Samples:
        """The next samples, 1 or more."""
        while not self._performer.has_planned(count):
            if self._waiting:
                self._performer.make(self._waiting.popleft())
                self._gesture_until_s = self._performer.planned_until_s
            else:
                self._performer.live(CALM[self._chance.integers(len(CALM))])
        return self._performer.samples(count)


# Recordings of simulated people: a gesture, a session of several, everyday movement.

_FIDGETING = 0.35  # the part of the pauses of a session in which the hands do something


def perform(gesture: str, person: int, take: int, rate_hz: float = 50.0) -> Recording:
    """One gesture with rest before and after it; each ``take`` is another performance.

    Raises ParameterError for a gesture that the simulated people do not know.

    ``person`` is the number of who makes it, ``rate_hz`` how often it is measured.
    """
    performer = Performer(person_numbered(person), rate_hz, take)
    performer.live(rest)
    performer.make(gesture_named(gesture))
    performer.live(rest)
    return _recording(f"simulated {gesture} {take}", person, [performer.planned_samples()])


def simulate_session(
    person: int, gestures: Sequence[str], repetitions: int, rate_hz: float = 50.0, seed: int = 0
) -> Recording:
    """One labelled stream: every gesture so many times in random order, pauses in between.

    ``person`` is the number of who makes them, ``gestures`` are by name, ``repetitions`` how
    often each; ``rate_hz`` is how often it is measured, ``seed`` that of the chance.
    """
    order = [gesture_named(name) for name in gestures for _ in range(repetitions)]
    chance = np.random.default_rng([3, person, seed])
    performer = Performer(person_numbered(person), rate_hz, seed)

    def parts() -> Iterator[Samples]:
        for index in chance.permutation(len(order)):
            _pause(performer, chance)
            performer.make(order[index])
            yield performer.planned_samples()
        _pause(performer, chance)
        yield performer.planned_samples()

    return _recording(f"simulated session {seed}", person, list(parts()))


def simulate_everyday(
    person: int,
    seconds: float,
    rate_hz: float = 50.0,
    seed: int = 0,
    activities: Sequence[Activity] = EVERYDAY,
) -> Recording:
    """Everyday movement without any gesture: walking, drinking, typing, sitting down, ...

    ``activities``: EVERYDAY, or LIVELY for what is harder to tell from a gesture.

    ``person`` is the number of who moves for so many ``seconds``, ``rate_hz`` how often it is
    measured, ``seed`` that of the chance.
    """
    chance = np.random.default_rng([4, person, seed])
    performer = Performer(person_numbered(person), rate_hz, seed)

    def parts() -> Iterator[Samples]:
        while performer.now_s < seconds:
            performer.live(activities[int(chance.integers(len(activities)))])
            left = max(0, round((seconds - performer.now_s) * rate_hz))
            planned = int((performer.planned_until_s - performer.now_s) * rate_hz)
            if not left:
                return
            yield performer.samples(min(left, planned))

    return _recording(f"simulated everyday movement {seed}", person, list(parts()))


def _pause(performer: Performer, chance: np.random.Generator) -> None:
    performer.live(rest)
    if chance.random() < _FIDGETING:
        performer.live(CALM[chance.integers(len(CALM))])


def _recording(source: str, person: int, parts: list[Samples]) -> Recording:
    return Recording(
        source=source,
        t=np.concatenate([part.t for part in parts]),
        acc=np.concatenate([part.acc for part in parts]),
        gyr=np.concatenate([part.gyr for part in parts]),
        labels=[label for part in parts for label in part.labels],
        gravity_included=True,
        person=str(person),
        simulated=True,
    )
