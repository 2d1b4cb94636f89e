"""A simulated person wearing a watch: gestures on request or by a schedule."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from faults import fault_of
from nep_core.errors import ParameterError
from nep_core.processes.node import Node
from nep_core.wire.messages import GESTURE_REQUEST, IMU, GestureRequest, Imu

from .arm.gestures import MAKES_GESTURE, gesture_named
from .reading import rows
from .wearer import Movement, Repertoire, Wearer, read_repertoire

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


_BATCH_S = 0.03
_MOST_LATE_S = 0.2  # after a longer hold-up (a computer that slept) time is left out, not caught up
_HANDED_OVER_S = 1.0  # by the watch's clock, without samples, when another person puts the watch on


def run(
    node: Node,
    *,
    rate_hz: float,
    person: int,
    gestures: str,
    repeat: bool,
    seed: int,
    speed: float,
    takes: str,
) -> None:
    """Publish ``/imu`` in real time until the node stops; ParameterError for a wrong schedule.

    ``takes``: a folder of recordings whose gestures can be asked for too; RecordingError when it
    cannot be read. ``speed``: how many times faster than real time the person lives and the
    watch's clock goes.
    """
    repertoire = read_repertoire(takes)
    schedule = Schedule(read_schedule(gestures, repertoire.find), repeat=repeat)
    watch = _Watch(node, rate_hz, person, seed, repertoire)
    publisher = node.publisher(IMU)
    requests = node.subscriber(GESTURE_REQUEST, GestureRequest)
    if speed == 1.0:
        node.ready(
            "{rate_hz} samples a second of simulated person {person}",
            rate_hz=f"{rate_hz:g}",
            person=person,
        )
    else:
        node.ready(
            "{rate_hz} samples a second of simulated person {person}, {speed} times as fast as "
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
        self._told = ""

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
        )

    def _ask(self, gesture: Movement) -> None:
        if not self._wearer.ask(gesture):
            self._node.warn("Too many gestures are waiting: {name} is left out.", name=gesture.name)

    def _hand_to(self, person: int) -> None:
        start_s = self._wearer.now_s + _HANDED_OVER_S
        self._wearer = Wearer(person, self._rate_hz, self._seed, start_s)
        self._node.state("running", "simulated person {person} puts the watch on", person=person)

    def _tell(self, gesture: str) -> None:
        if gesture != self._told:
            makes = fault_of(
                "makes the gesture {gesture} (simulated person {number})",
                code=MAKES_GESTURE,
                gesture=gesture,
                number=self._wearer.number,
            )
            self._node.state("running", makes if gesture else "goes on with everyday movement")
        self._told = gesture
