"""A simulated person who moves without a break, sample by sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nodes.sensory.arm.everyday import HANGING
from nodes.sensory.arm.gestures import Gesture
from nodes.sensory.arm.motion import Motion
from nodes.sensory.arm.moving import Activity
from nodes.sensory.arm.people import Person, performance_variation
from nodes.sensory.arm.skeleton import Floats, Joint, Pose, joint_values

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
