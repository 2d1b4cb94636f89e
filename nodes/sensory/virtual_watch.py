"""A simulated person wearing a watch: gestures on request or by a schedule."""

from __future__ import annotations

import time

from nep_core.errors import ParameterError
from nep_core.messages import GESTURE_REQUEST, IMU, GestureRequest, Imu
from nep_core.node import Node
from nodes.sensory.batches import rows
from nodes.sensory.own_takes import Movement, Repertoire, read_repertoire
from nodes.sensory.schedule import Schedule, read_schedule
from nodes.sensory.wearer import Wearer

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
        node.ready(f"{rate_hz:g} samples a second of simulated person {person}")
    else:
        node.ready(
            f"{rate_hz:g} samples a second of simulated person {person}, "
            f"{speed:g} times as fast as real time"
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
            self._node.warn(" ".join([error.sentence, *error.checklist]))
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
        )

    def _ask(self, gesture: Movement) -> None:
        if not self._wearer.ask(gesture):
            self._node.warn(f"Too many gestures are waiting: {gesture.name} is left out.")

    def _hand_to(self, person: int) -> None:
        start_s = self._wearer.now_s + _HANDED_OVER_S
        self._wearer = Wearer(person, self._rate_hz, self._seed, start_s)
        self._node.state("running", f"simulated person {person} puts the watch on")

    def _tell(self, gesture: str) -> None:
        if gesture != self._told:
            makes = f"makes the gesture {gesture} (simulated person {self._wearer.number})"
            self._node.state("running", makes if gesture else "goes on with everyday movement")
        self._told = gesture
