"""A simulated person wearing a watch: gestures on request or by a schedule.

The person also makes recorded gestures, led over to and back without a jump.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from faults import fault_of
from nep_core.errors import ParameterError
from nep_core.processes.node import Node
from nep_core.wire.messages import GESTURE_REQUEST, IMU, GestureRequest, Imu, Wrist
from nodes.perceptual.recognition.streams import Take, takes_of, usual_wrist, worn_at
from nodes.recordings import Recording, read_recordings

from .arm.gestures import GESTURES, MAKES_GESTURE, POSTURES, Gesture, gesture_named
from .arm.motion import GRAVITY_M_S2, Floats, minimum_jerk
from .arm.people import MOST_WAITING, LivePerson, Samples
from .reading import rows

# Gestures that a simulated person knows: those of the paper, and recorded takes of any others.

AROUND_S = 1.5
"""So much of a recording is kept before and after a take: the ways there and back."""
_MOST_TAKES = 200  # of each gesture
_LONGEST_GAP_S = 0.5
_SMOOTHED_S = 0.5
_FASTEST_RAD_S = 8.0  # what is taken for gravity is not always gravity


@dataclass(frozen=True)
class RecordedTake:
    """One performance with what was around it; times in s, of which 0 is where the take starts.

    ``up`` (n, 3) is the gravity in the acceleration in m/s², and ``moving`` (n, 3) the rest of it;
    ``up`` is None when the sensor took gravity out. ``gyr`` (n, 3) is rad/s.
    """

    t: Floats
    moving: Floats
    up: Floats | None
    gyr: Floats
    duration_s: float


@dataclass(frozen=True)
class OwnGesture:
    """A gesture that somebody recorded, and its takes."""

    name: str
    takes: tuple[RecordedTake, ...]


Movement = Gesture | OwnGesture


@dataclass(frozen=True)
class Repertoire:
    """The gestures that can be asked for; own ones go before the paper's of the same name."""

    own: dict[str, OwnGesture]

    @property
    def names(self) -> tuple[str, ...]:
        """All of them."""
        return tuple(dict.fromkeys((*self.own, *GESTURES)))

    def find(self, name: str) -> Movement:
        """The gesture, or posture, of this name; ParameterError names the known ones."""
        found = self.own.get(name) or GESTURES.get(name) or POSTURES.get(name)
        if found is None:
            raise ParameterError(
                'The simulated person knows no gesture "{name}".',
                checklist=("Choose one of: {known}.",),
                name=name,
                known=", ".join((*self.names, *POSTURES)),
            )
        return found


def read_repertoire(folder: str) -> Repertoire:
    """The paper's gestures, and those of the recordings in a folder ("" is none).

    What was recorded on the other wrist than most is mirrored, as training does. RecordingError
    says which recording cannot be read.
    """
    takes: dict[str, list[RecordedTake]] = {}
    found = read_recordings(Path(folder)) if folder else []
    wrist = usual_wrist(found)
    for recording in (worn_at(one, wrist) for one in found):
        for take in takes_of(recording):
            made = recorded_take(recording, take)
            if made is not None and len(takes.setdefault(take.gesture, [])) < _MOST_TAKES:
                takes[take.gesture].append(made)
    return Repertoire({name: OwnGesture(name, tuple(each)) for name, each in takes.items() if each})


def recorded_take(recording: Recording, take: Take) -> RecordedTake | None:
    """A take with what is around it and belongs to no other one; None when samples are missing."""
    t = recording.t
    first, last = (int(np.searchsorted(t, at)) for at in (take.start_s, take.end_s))
    begin, end = _free_before(recording, first), _free_after(recording, min(last, len(t) - 1))
    part = slice(begin, end + 1)
    if np.diff(t[first : last + 1]).max(initial=0.0) > _LONGEST_GAP_S or end - begin < 2:
        return None
    rises = np.concatenate([[True], np.diff(t[part]) > 0])
    times, acc = t[part][rises], recording.acc[part][rises]
    gyr = None if recording.gyr is None else recording.gyr[part][rises]
    up = _smoothed(times, acc) if recording.gravity_included else None
    return RecordedTake(
        t=times - take.start_s,
        moving=acc if up is None else acc - up,
        up=up,
        gyr=gyr if gyr is not None else _turning(times, up, len(times)),
        duration_s=take.duration_s,
    )


def _free_before(recording: Recording, first: int) -> int:
    """The first sample of what leads to a take without a gap or a mark."""
    t, labels, at = recording.t, recording.labels or (), first
    while at > 0 and not labels[at - 1] and t[first] - t[at - 1] <= AROUND_S:
        if t[at] - t[at - 1] > _LONGEST_GAP_S:
            break
        at -= 1
    return at


def _free_after(recording: Recording, last: int) -> int:
    """The last sample of what follows a take without a gap or a mark."""
    t, labels, at = recording.t, recording.labels or (), last
    while at + 1 < len(t) and not labels[at + 1] and t[at + 1] - t[last] <= AROUND_S:
        if t[at + 1] - t[at] > _LONGEST_GAP_S:
            break
        at += 1
    return at


def _smoothed(t: Floats, values: Floats) -> Floats:
    """The mean over half a second around each time; (n, 3)."""
    summed = np.vstack([np.zeros(3), np.cumsum(values, axis=0)])
    low = np.searchsorted(t, t - _SMOOTHED_S / 2)
    high = np.searchsorted(t, t + _SMOOTHED_S / 2, side="right")
    mean: Floats = (summed[high] - summed[low]) / (high - low)[:, None]
    return mean


def _turning(t: Floats, up: Floats | None, count: int) -> Floats:
    """The rotation that a turning gravity shows, of a sensor without a gyroscope; (n, 3) rad/s."""
    if up is None:
        return np.zeros((count, 3))
    unit = up / np.maximum(np.linalg.norm(up, axis=1, keepdims=True), 0.1 * GRAVITY_M_S2)
    turning: Floats = np.cross(np.gradient(unit, t, axis=0), unit)
    return np.clip(turning, -_FASTEST_RAD_S, _FASTEST_RAD_S)


LEAD_S = 0.9
"""How long the watch takes from what it felt before to a recorded take, and back."""
_PACE, _REACH = 0.06, 0.08  # how much performances of the same take differ
_WARP = 0.15  # how much faster one half of a take may go, the other slower
_RAMP_S = 0.25  # what the recording lacks before and after a take fades out so quickly
_GRAVITY_S = 0.4


class Wearer:
    """Somebody who wears the watch: makes one gesture after the other, else something calm.

    The same person, rate, seed and requests give the same samples.

    ``person`` is the number of who wears it, ``rate_hz`` how often it measures, ``seed`` that
    of the chance, ``start_s`` the time of the first sample.
    """

    def __init__(self, person: int, rate_hz: float, seed: int, start_s: float = 0.0) -> None:
        self._person = LivePerson(person, rate_hz, seed, start_s)
        self._rate_hz = rate_hz
        self._chance = np.random.default_rng([6, person, seed])
        self._waiting: deque[Movement] = deque()
        self._left: dict[str, list[int]] = {}
        self._up = _Gravity(rate_hz)
        self._playing: _Performance | None = None

    @property
    def number(self) -> int:
        """Which person it is."""
        return self._person.number

    @property
    def wrist(self) -> Wrist:
        """On which wrist the watch is worn."""
        return self._person.wrist

    @property
    def now_s(self) -> float:
        """The time of the next sample, by the watch's clock."""
        return self._person.now_s

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way (or the way to it) or waits."""
        return bool(self._waiting) or self._playing is not None or self._person.is_busy

    def ask(self, gesture: Movement) -> bool:
        """Make this gesture at once, or after those under way; False when too many wait."""
        if isinstance(gesture, Gesture) and not self._waiting and self._playing is None:
            return self._person.ask(gesture)
        if len(self._waiting) >= MOST_WAITING:
            return False
        self._waiting.append(gesture)
        self._begin_next()
        return True

    def samples(self, count: int) -> Samples:
        """The next samples, 1 or more."""
        self._begin_next()
        felt = self._person.samples(count)
        up = self._up.follow(felt.acc)
        if self._playing is None:
            return felt
        made = self._playing.over(felt, up)
        if self._playing.is_over:
            self._playing = None
        return made

    def _begin_next(self) -> None:
        """Begin what waits, when nothing is under way."""
        while self._waiting and self._playing is None and not self._person.is_busy:
            gesture = self._waiting.popleft()
            if isinstance(gesture, Gesture):
                self._person.ask(gesture)
            else:
                take = gesture.takes[self._choose(gesture)]
                self._playing = _Performance(
                    gesture.name, take, self._rate_hz, self._up.now, self._chance
                )

    def _choose(self, gesture: OwnGesture) -> int:
        """A take that was not made since all others were."""
        if not self._left.get(gesture.name):
            self._left[gesture.name] = self._chance.permutation(len(gesture.takes)).tolist()
        return self._left[gesture.name].pop()


class _Gravity:
    """Which part of what the watch feels is gravity, followed sample by sample."""

    def __init__(self, rate_hz: float) -> None:
        self.now = np.array([0.0, 0.0, GRAVITY_M_S2])
        self._is_new = True
        self._part = 1 - np.exp(-1 / (_GRAVITY_S * rate_hz))

    def follow(self, acc: Floats) -> Floats:
        """The gravity in n samples (n, 3); (n, 3)."""
        if self._is_new:
            self.now, self._is_new = acc[0].copy(), False
        up = np.empty_like(acc)
        for at, sample in enumerate(acc):
            self.now = self.now + self._part * (sample - self.now)
            up[at] = self.now
        return up


@dataclass(frozen=True)
class _Made:
    """What a recorded take makes the watch feel, n samples from the lead-in to the lead-out."""

    moving: Floats
    up: Floats
    gyr: Floats
    weight: Floats  # 0 is all simulated, 1 all recorded
    change_hz: Floats  # of the weight


class _Performance:
    """A recorded take as it is made this once: a little faster or slower, larger or smaller."""

    def __init__(
        self, name: str, take: RecordedTake, rate_hz: float, up: Floats, chance: np.random.Generator
    ) -> None:
        self._name = name
        self._at = 0
        pace = float(np.clip(chance.normal(1.0, _PACE), 0.85, 1.18))
        reach = float(np.clip(chance.normal(1.0, _REACH), 0.8, 1.25))
        warp = float(chance.uniform(-_WARP, _WARP))
        lasts_s = take.duration_s / pace
        count = int((lasts_s + 2 * LEAD_S) * rate_hz)
        t = np.arange(count) / rate_hz - LEAD_S
        self._is_made = (t >= 0) & (t < lasts_s)
        # A take at times of its performance (n,), at a pace, with a reach, its middle shifted
        duration_s = take.duration_s
        within = np.clip(t * pace / duration_s, 0.0, 1.0)
        recorded_s = t * pace + warp * duration_s * (1 - np.cos(2 * np.pi * within)) / (2 * np.pi)
        speed = pace * (1 + warp * np.sin(2 * np.pi * within))
        # 1 where there is a recording, and smoothly 0 before and after it; (n,)
        outside_s = np.maximum(np.maximum(take.t[0] - recorded_s, recorded_s - take.t[-1]), 0.0)
        there = 1 - minimum_jerk(outside_s / _RAMP_S)
        moving = _at(recorded_s, take.t, take.moving) * (reach * speed**2 * there)[:, None]
        gyr = _at(recorded_s, take.t, take.gyr) * (speed * there)[:, None]
        if take.up is None:
            gravity = _turned_along(up, gyr, float(t[1] - t[0]))
        else:
            gravity = _at(recorded_s, take.t, take.up)
        weight = minimum_jerk((t + LEAD_S) / LEAD_S) * minimum_jerk((lasts_s + LEAD_S - t) / LEAD_S)
        self._made = _Made(moving, gravity, gyr, weight, np.gradient(weight, 1 / rate_hz))

    @property
    def is_over(self) -> bool:
        """Whether the watch feels only what is simulated again."""
        return self._at >= len(self._made.weight)

    def over(self, felt: Samples, up: Floats) -> Samples:
        """The next samples: what is simulated, and its gravity (n, 3), led over to the take."""
        count = min(len(felt.t), len(self._made.weight) - self._at)
        part, here = slice(self._at, self._at + count), slice(0, count)
        self._at += count
        acc, gyr = felt.acc.copy(), felt.gyr.copy()
        weight, made = self._made.weight[part, None], self._made
        gravity, turn = _led_over(up[here], made.up[part], made.weight[part], made.change_hz[part])
        moving = (felt.acc - up)[here] * (1 - weight) + made.moving[part] * weight
        acc[here] = moving + gravity
        gyr[here] = felt.gyr[here] * (1 - weight) + made.gyr[part] * weight + turn
        is_made = self._is_made[part]
        labels = [self._name if one else "" for one in is_made.tolist()] + felt.labels[count:]
        return Samples(felt.t, acc, gyr, labels)


def _at(times_s: Floats, t: Floats, values: Floats) -> Floats:
    return np.column_stack([np.interp(times_s, t, column) for column in values.T])


def _turned_along(up: Floats, gyr: Floats, step_s: float) -> Floats:
    """Where gravity goes from ``up`` (3,) on while the watch turns at ``gyr`` (n, 3); (n, 3)."""
    size = float(np.linalg.norm(up))
    path = np.empty_like(gyr)
    now = up.copy()
    for at, turning in enumerate(gyr):
        now = now + step_s * np.cross(now, turning)
        now *= size / max(float(np.linalg.norm(now)), 1e-9)
        path[at] = now
    return path


def _led_over(
    start: Floats, goal: Floats, weight: Floats, change_hz: Floats
) -> tuple[Floats, Floats]:
    """Gravity on the way from one (n, 3) to another (n, 3), and the turning that this takes.

    The watch turns about the axis between them; where ``weight`` (n,) is 0 or 1, nothing is added.
    """
    sizes = [np.maximum(np.linalg.norm(one, axis=1), 1e-9) for one in (start, goal)]
    one, other = start / sizes[0][:, None], goal / sizes[1][:, None]
    axis = np.cross(one, other)
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, np.einsum("ni,ni->n", one, other))
    axis = np.where(sine[:, None] > 1e-6, axis / np.maximum(sine, 1e-6)[:, None], _across(one))
    part = (angle * weight)[:, None]
    unit = one * np.cos(part) + np.cross(axis, one) * np.sin(part)
    size = sizes[0] * (1 - weight) + sizes[1] * weight
    turning = -axis * (angle * change_hz)[:, None]
    return unit * size[:, None], turning


def _across(unit: Floats) -> Floats:
    """A direction at a right angle to each (n, 3)."""
    least = np.eye(3)[np.abs(unit).argmin(axis=1)]
    across = np.cross(unit, least)
    normal: Floats = across / np.linalg.norm(across, axis=1, keepdims=True)
    return normal


# When the simulated person makes which gesture: ``karate, hand_up`` or ``3 karate, 8 hand_up``.

PAUSE_S = 3.0


@dataclass(frozen=True)
class Planned:
    """A gesture and when it is begun: at a second, or (None) a pause after the one before."""

    gesture: Movement
    at_s: float | None


def read_schedule(text: str, find: Callable[[str], Movement] = gesture_named) -> list[Planned]:
    """Read a schedule of gestures that can be found; ParameterError names a part that is wrong."""
    parts = [part.split() for part in text.split(",") if part.strip()]
    return [_read_part(words, find) for words in parts]


def _read_part(words: list[str], find: Callable[[str], Movement]) -> Planned:
    if len(words) == 1:
        return Planned(find(words[0]), None)
    try:
        at_s, name = float(words[0]), words[1]
    except ValueError:
        at_s, name = -1.0, ""
    if len(words) > 2 or not 0 <= at_s < 1e6:
        raise ParameterError(
            'The schedule of gestures has "{words}", which is not a gesture.',
            checklist=(
                "Write the gestures with commas between them: karate, hand_up.",
                "Or with the second at which each begins: 3 karate, 8 hand_up.",
            ),
            words=" ".join(words),
        )
    return Planned(find(name), at_s)


class Schedule:
    """Gives out the gestures of a schedule as their time comes."""

    def __init__(self, planned: list[Planned], *, repeat: bool) -> None:
        self._planned = planned
        self._repeat = repeat
        self._next = 0
        self._round_began_s = 0.0
        self._idle_since_s = 0.0

    def due(self, now_s: float, *, is_busy: bool) -> Movement | None:
        """The gesture to begin at ``now_s``, if any; asked again and again as time goes on."""
        if is_busy:
            self._idle_since_s = now_s
        if self._next == len(self._planned):
            if not self._repeat or is_busy or not self._planned:
                return None
            self._next, self._round_began_s = 0, now_s
        planned = self._planned[self._next]
        if planned.at_s is None:
            is_due = not is_busy and now_s >= self._idle_since_s + PAUSE_S
        else:
            is_due = now_s >= self._round_began_s + planned.at_s
        if not is_due:
            return None
        self._next += 1
        self._idle_since_s = now_s
        return planned.gesture


_HOLDS = {
    "arm_raised": "holds the arm up (simulated person {number})",
    "arm_level": "holds the arm level (simulated person {number})",
    "arm_lowered": "lets the arm hang (simulated person {number})",
}
_BATCH_S = 0.03
_MOST_LATE_S = 0.2  # after a longer hold-up (a computer that slept) time is left out, not caught up
_HANDED_OVER_S = 1.0  # by the watch's clock, without samples, when another person puts the watch on


def run(
    node: Node,
    *,
    rate_hz: float,
    person: int,
    gestures: str,
    by_itself: bool,
    repeat: bool,
    seed: int,
    speed: float,
    takes: str,
) -> None:
    """Publish ``/imu`` in real time until the node stops; ParameterError for a wrong schedule.

    ``takes``: a folder of recordings whose gestures can be asked for too; RecordingError when it
    cannot be read. ``speed``: how many times faster than real time the person lives and the
    watch's clock goes.

    ``node`` is this node, ``rate_hz`` how often it measures, ``person`` who wears it,
    ``gestures`` the schedule, ``by_itself`` whether an empty one stands for all gestures,
    ``repeat`` whether it begins anew at its end, ``seed`` that of the chance.
    """
    repertoire = read_repertoire(takes)
    if by_itself and not gestures.strip():
        gestures = ", ".join(repertoire.names)
    schedule = Schedule(read_schedule(gestures, repertoire.find), repeat=repeat)
    watch = _Watch(node, rate_hz, person, seed, repertoire)
    publisher = node.publisher(IMU)
    requests = node.subscriber(GESTURE_REQUEST, GestureRequest)
    node.ready(
        "{rate_hz} samples a second of simulated person {person}"
        if speed == 1.0
        else "{rate_hz} samples a second of simulated person {person}, {speed} times as fast as "
        "real time",
        rate_hz=f"{rate_hz:g}",
        person=person,
        speed=f"{speed:g}",
    )
    pace = _Pace(rate_hz * speed)
    while not node.wait(_BATCH_S):
        for request in requests.pending():
            watch.hear(request)
        watch.follow(schedule)
        if count := pace.samples_due():
            publisher.send(watch.batch(count))


class _Pace:
    """How many samples real time asks for."""

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._sent_until_s = time.monotonic()

    def samples_due(self) -> int:
        now_s = time.monotonic()
        self._sent_until_s = max(self._sent_until_s, now_s - _MOST_LATE_S)
        count = int((now_s - self._sent_until_s) * self._rate_hz)
        self._sent_until_s += count / self._rate_hz
        return count


class _Watch:
    """The watch on somebody's wrist, who may hand it to somebody else."""

    def __init__(
        self, node: Node, rate_hz: float, person: int, seed: int, repertoire: Repertoire
    ) -> None:
        self._repertoire = repertoire
        self._node = node
        self._rate_hz = rate_hz
        self._seed = seed
        self._wearer = Wearer(person, rate_hz, seed)
        self._announced = ""

    def hear(self, request: GestureRequest) -> None:
        """Let the wearer, or the person asked for, make a gesture."""
        try:
            gesture = self._repertoire.find(request.gesture)
        except ParameterError as error:
            self._node.warn(error.fault)
            return
        if request.person >= 0 and request.person != self._wearer.number:
            self._hand_to(request.person)
        self._ask(gesture)

    def follow(self, schedule: Schedule) -> None:
        """Let the wearer make what the schedule has now."""
        if gesture := schedule.due(self._wearer.now_s, is_busy=self._wearer.is_busy):
            self._ask(gesture)

    def batch(self, count: int) -> Imu:
        """The next samples as a message; tells when a gesture begins and ends."""
        samples = self._wearer.samples(count)
        self._tell(samples.labels[-1])
        return Imu(
            source=f"simulated person {self._wearer.number}",
            rate_hz=self._rate_hz,
            t=samples.t.tolist(),
            acc=rows(samples.acc),
            gyr=rows(samples.gyr),
            simulated=True,
            person=self._wearer.number,
            wrist=self._wrist,
        )

    @property
    def _wrist(self) -> Wrist:
        """Where the person wears it; recorded gestures may be those of another wrist."""
        return "" if self._repertoire.own else self._wearer.wrist

    def _ask(self, gesture: Movement) -> None:
        if not self._wearer.ask(gesture):
            self._node.warn("Too many gestures are waiting: {name} is left out.", name=gesture.name)

    def _hand_to(self, person: int) -> None:
        start_s = self._wearer.now_s + _HANDED_OVER_S
        self._wearer = Wearer(person, self._rate_hz, self._seed, start_s)
        self._node.state("running", "simulated person {person} puts the watch on", person=person)

    def _tell(self, gesture: str) -> None:
        if gesture != self._announced:
            makes = fault_of(
                "makes the gesture {gesture} (simulated person {number})"
                if gesture not in POSTURES
                else _HOLDS[gesture],
                code=MAKES_GESTURE,
                gesture=gesture,
                number=self._wearer.number,
            )
            self._node.state("running", makes if gesture else "goes on with everyday movement")
        self._announced = gesture
