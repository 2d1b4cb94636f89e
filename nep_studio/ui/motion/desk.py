"""The motion that is being made: its poses, the moment that is shown, and every step back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from msgspec.structs import replace
from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.own_animations import SHORTEST_STEP_S, OwnAnimation
from nep_studio.ui.motion import editing
from nep_studio.ui.motion.rehearsal import Rehearsal, given_time
from nodes.action.naobody.body import Angles, Body
from nodes.action.naobody.inverse import mirrored_pose
from nodes.action.naobody.limbs import Limb

FIRST_POSE_S = 1.0
"""When the first pose of a new motion is: it takes a moment to go there."""
STANDING = "StandInit"
"""The posture from which a motion starts as soon as it moves the legs."""
MOST_STEPS = 500
POSED_LIMBS = frozenset({Limb.HEAD, Limb.LEFT_ARM, Limb.RIGHT_ARM})
"""What the first pose of a motion takes in when nobody has moved anything yet."""


@dataclass(frozen=True)
class Step:
    """A motion as it was before a step, with the moment and the keys that were chosen."""

    label: str
    motion: OwnAnimation
    cursor_s: float
    chosen: tuple[float, ...]
    merge: str = ""


class MotionDesk(QObject):
    """One motion and its history.

    ``changed`` tells of the motion, ``moved`` of the moment that is shown, ``chosen_changed`` of
    the keys that are chosen. ``is_mirrored``: what one side of the body does, the other does too.
    """

    changed = Signal()
    moved = Signal()
    chosen_changed = Signal()

    def __init__(self, body: Body, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.body = body
        self.name = ""
        self.is_mirrored = False
        self.cursor_s = 0.0
        self.chosen: tuple[float, ...] = ()
        self._undo: list[Step] = []
        self._redo: list[Step] = []
        self._saved: OwnAnimation | None = None
        self.rehearsal = Rehearsal(body, OwnAnimation("", {}))

    @property
    def motion(self) -> OwnAnimation:
        """The motion as it is now."""
        return self.rehearsal.motion

    @property
    def is_modified(self) -> bool:
        """Whether it differs from what was opened or saved last."""
        return self.motion != self._saved

    @property
    def undo_label(self) -> str:
        """What undo would take back, "" for nothing."""
        return self._undo[-1].label if self._undo else ""

    @property
    def redo_label(self) -> str:
        """What redo would do again, "" for nothing."""
        return self._redo[-1].label if self._redo else ""

    def open(self, motion: OwnAnimation, name: str = "", *, is_kept: bool = True) -> None:
        """Begin with a motion; ``name`` is the one under which the project keeps it."""
        self.name = name
        self._undo.clear()
        self._redo.clear()
        self._saved = motion if is_kept else None
        self.cursor_s, self.chosen = 0.0, ()
        self._show(motion)

    def saved(self, name: str) -> None:
        """Say that the project keeps it as it is now."""
        self.name, self._saved = name, self.motion
        self.changed.emit()

    # Changes

    def do(self, label: str, motion: OwnAnimation, *, merge: str = "") -> None:
        """Change the motion, as one step; steps with the same ``merge`` in a row are one."""
        if motion == self.motion:
            return
        if not (merge and self._undo and self._undo[-1].merge == merge):
            self._undo.append(self._step(label, merge))
            del self._undo[:-MOST_STEPS]
        self._redo.clear()
        self._show(motion)

    def seal(self) -> None:
        """What follows is a step of its own: a drag has ended."""
        if self._undo and self._undo[-1].merge:
            last = self._undo[-1]
            self._undo[-1] = Step(last.label, last.motion, last.cursor_s, last.chosen)

    def undo(self) -> None:
        """Take the last step back."""
        self._go(self._undo, self._redo)

    def redo(self) -> None:
        """Do again what was taken back."""
        self._go(self._redo, self._undo)

    def set_joints(self, angles: Mapping[str, float], label: str, *, merge: str = "") -> None:
        """Pose some joints at the moment that is shown: a key of the limbs that they are in."""
        wanted = dict(angles)
        if self.is_mirrored:
            wanted = {**mirrored_pose(wanted), **wanted}
        limbs = self.body.limbs_of(name for name in wanted if name in self.body.index)
        self._key(self.rehearsal.pose(self._posing_time()), limbs, wanted, label, merge)

    def set_key(
        self, joint: str, time: float, angle: float, label: str, *, merge: str = ""
    ) -> None:
        """Set a key of one joint alone."""
        motion = editing.with_pose(self.motion, time, {joint: round(angle, 4)})
        self.do(label, self._standing(motion), merge=merge)
        self.show(time)

    def move_key(
        self, joint: str, time: float, to_s: float, angle: float, label: str, *, merge: str = ""
    ) -> None:
        """Put the key of one joint at a time to another time and angle."""
        motion = editing.with_key_moved(self.motion, joint, time, to_s, round(angle, 4))
        self.do(label, motion, merge=merge)

    def add_key(self, label: str) -> None:
        """Keep the pose that is shown as a key of all that moves."""
        limbs = self.body.limbs_of(self._moving_names()) or POSED_LIMBS
        self._key(self.rehearsal.pose(self.cursor_s), limbs, {}, label, "")

    def set_pose(self, angles: Mapping[str, float], label: str) -> None:
        """Set a key of every joint that is given, such as a robot's."""
        self._key(self.rehearsal.start, frozenset(), angles, label, "")

    def change(self, label: str, *, merge: str = "", **what: str) -> None:
        """Change the title, the kind, the posture it starts from, ..."""
        self.do(label, replace(self.motion, **what), merge=merge)

    def set_start(self, posture: str, label: str) -> None:
        """Begin in a posture, "" in any; legs that move need one."""
        if not posture and Limb.LEGS in self.body.limbs_of(self._moving_names()):
            posture = STANDING
        self.change(label, starts_from=posture)

    def give_time(self, label: str) -> None:
        """Let every joint have the time that it needs."""
        self.do(label, given_time(self.rehearsal))

    # The moment, and the keys

    def show(self, time: float) -> None:
        """Show another moment."""
        time = max(0.0, time)
        if time != self.cursor_s:
            self.cursor_s = time
            self.moved.emit()

    def choose(self, times: Iterable[float]) -> None:
        """Choose the keys at these times."""
        chosen = tuple(sorted(times))
        if chosen != self.chosen:
            self.chosen = chosen
            self.chosen_changed.emit()

    def move_chosen(self, seconds: float, label: str, *, merge: str = "") -> None:
        """Put the chosen keys later, all alike; those that are reached make way."""
        if not self.chosen:
            return
        seconds = max(seconds, SHORTEST_STEP_S - self.chosen[0])
        moves = {time: editing.usable(time + seconds) for time in self.chosen}
        motion = editing.moved(self.motion, moves)
        self.do(label, motion, merge=merge)
        self.choose(set(moves.values()))

    def shift_after(self, time: float, seconds: float, label: str, *, merge: str = "") -> None:
        """Put the key at a time and all later ones later, or earlier as far as there is room."""
        before = [t for t in editing.key_times(self.motion) if t < time - editing.SAME_S]
        motion = editing.shifted_after(self.motion, before[-1] if before else 0.0, seconds)
        self.do(label, motion, merge=merge)

    def delete_chosen(self, label: str) -> None:
        """Take the chosen keys away."""
        motion = editing.without_times(self.motion, self.chosen)
        self.choose(())
        self.do(label, motion)

    def copy_chosen(self, seconds: float, label: str) -> None:
        """Set the chosen keys once more, so much later, and choose the copies."""
        if self.chosen:
            copies = [editing.usable(time + seconds) for time in self.chosen]
            self.do(label, editing.copied(self.motion, self.chosen, seconds))
            self.choose(copies)

    # Within

    def _key(
        self,
        pose: Angles,
        limbs: frozenset[Limb],
        wanted: Mapping[str, float],
        label: str,
        merge: str,
    ) -> None:
        whole = pose.copy()
        known = [name for name in wanted if name in self.body.index]
        for name in known:
            whole[self.body.index[name]] = wanted[name]
        whole = self.body.clamped(whole)[0]
        columns = {*self.body.columns(limbs), *(self.body.index[name] for name in known)}
        angles = {
            self.body.names[column]: round(float(whole[column]), 4) for column in sorted(columns)
        }
        time = editing.usable(self._posing_time())
        motion = editing.with_pose(self.motion, time, angles)
        self.do(label, self._standing(motion), merge=merge)
        self.choose([time])
        self.show(time)

    def _standing(self, motion: OwnAnimation) -> OwnAnimation:
        """A motion that begins in a posture if its legs move."""
        names = [name for name in motion.joints if name in self.body.index]
        if Limb.LEGS in self.body.limbs_of(names) and not motion.starts_from:
            return replace(motion, starts_from=STANDING)
        return motion

    def _posing_time(self) -> float:
        """Where a pose goes: the posture at the beginning is not one of the motion's poses."""
        if self.cursor_s >= SHORTEST_STEP_S:
            near = [t for t in editing.key_times(self.motion) if abs(t - self.cursor_s) < 0.02]
            return near[0] if near else self.cursor_s
        times = editing.key_times(self.motion)
        return times[0] if times else FIRST_POSE_S

    def _moving_names(self) -> list[str]:
        return [name for name in self.motion.joints if name in self.body.index]

    def _step(self, label: str, merge: str = "") -> Step:
        return Step(label, self.motion, self.cursor_s, self.chosen, merge)

    def _go(self, source: list[Step], target: list[Step]) -> None:
        if not source:
            return
        step = source.pop()
        target.append(self._step(step.label))
        self._show(step.motion)
        self.choose(step.chosen)
        self.show(step.cursor_s)

    def _show(self, motion: OwnAnimation) -> None:
        self.rehearsal = self.rehearsal.again(motion)
        self.changed.emit()
