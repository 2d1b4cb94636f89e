"""The motion that is being made: its poses, the moment that is shown, and every step back."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace
from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.animations import (
    Use,
    animation_uses,
    delete_animation,
    keep_animation,
    rename_animation,
)
from nep_studio.blocks.own_animations import (
    SHORTEST_STEP_S,
    AnimationKind,
    JointKeys,
    OwnAnimation,
    own_animations,
)
from nep_studio.ui.labels import follow_words
from nep_studio.ui.words import tr
from robots.body.animations import load_animation
from robots.body.body import Angles, Body, part_of
from robots.body.inverse import mirrored_pose
from robots.body.keyframes import Handle, Keyframes
from robots.body.kinematics import Skeleton
from robots.body.limbs import Limb

from . import editing
from .rehearsal import Fault, Rehearsal, TooFast, falling, given_time, limb_words

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.document_files import Files


def joint_words(language: Language, body: Body, name: str) -> str:
    """What a joint does, such as "elbow, bent"; its own name where nobody has said it."""
    if name.endswith("Hand"):
        return tr("hand, open")
    part = part_of(body, name)
    words = language.choices.get(f"joints.{part}", {}).get(name, name)
    if not name.startswith(("L", "R")):
        return words
    if part.endswith("_leg") and name not in body.same_motor.values():
        side = tr("left") if name.startswith("L") else tr("right")
        return f"{side}: {words}"
    return words


def limb_of_joint_words(body: Body, name: str) -> str:
    """The limb that a joint is in, in words."""
    limb = body.joints[body.index[name]].limb
    return limb_words().get(limb, str(limb))


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


class MotionController(QObject):
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
        self.moved.emit()
        self.chosen_changed.emit()

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
            self._undo.append(Step(label, self.motion, self.cursor_s, self.chosen, merge))
            del self._undo[:-MOST_STEPS]
        self._redo.clear()
        self._show(motion)

    def seal(self) -> None:
        """What follows is a step of its own: a drag has ended."""
        if self._undo and self._undo[-1].merge:
            self._undo[-1] = dataclasses.replace(self._undo[-1], merge="")

    def undo(self) -> None:
        """Take the last step back."""
        self._go(self._undo, self._redo)

    def redo(self) -> None:
        """Do again what was taken back."""
        self._go(self._redo, self._undo)

    def set_joints(self, angles: Mapping[str, float], label: str, *, merge: str = "") -> None:
        """Pose some joints at the moment that is shown: a key of the limbs that they are in."""
        wanted = {**mirrored_pose(dict(angles)), **angles} if self.is_mirrored else angles
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
        self.do(label, editing.moved(self.motion, moves), merge=merge)
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

    def _go(self, source: list[Step], target: list[Step]) -> None:
        if not source:
            return
        step = source.pop()
        target.append(Step(step.label, self.motion, self.cursor_s, self.chosen))
        self._show(step.motion)
        self.choose(step.chosen)
        self.show(step.cursor_s)

    def _show(self, motion: OwnAnimation) -> None:
        self.rehearsal = self.rehearsal.again(motion)
        self.changed.emit()


# The motions of the project that is open, and those that come with the robot.

DIGITS = 5
TABLES: Mapping[AnimationKind, str] = {
    "animation": "animations",
    "animal": "animals",
    "gesture": "say_gestures",
}


class KeptMotions:
    """What can be opened, and where it is saved."""

    def __init__(self, files: Files, folder: Path, body: Body) -> None:
        self._files, self._folder, self._body = files, folder / "animations", body

    @property
    def editor(self) -> Editor | None:
        """The editor of the project that is open, if one is."""
        return self._files.document.editor if self._files.document is not None else None

    def own(self) -> dict[str, OwnAnimation]:
        """The motions that the project keeps, by name."""
        return own_animations(self.editor.project) if self.editor is not None else {}

    def shipped(self, kind: AnimationKind) -> dict[str, str]:
        """The titles of the motions of a kind that come with the robot, by name."""
        if self.editor is None:
            return {}
        own, table = self.own(), self.editor.language.choices.get(TABLES[kind], {})
        return {
            name: words
            for name, words in sorted(table.items(), key=lambda item: item[1].casefold())
            if name not in own and (self._folder / f"{name}.toml").is_file()
        }

    def load(self, name: str) -> OwnAnimation:
        """A motion that comes with the robot; raises FilesUnusable."""
        found = load_animation(self._folder / f"{name}.toml", self._body)
        titles = [self.shipped(kind).get(name) for kind in TABLES]
        title, joints = next(filter(None, titles), found.title), joints_of(found.keyframes)
        about = found.description, found.starts_from, found.says
        return OwnAnimation(title, joints, found.kind, *about)

    def save(self, motion: OwnAnimation, name: str, use: Use | None = None) -> str:
        """Keep a motion in the project; gives its name. Raises EditRefused.

        With another title it gets another name, in the blocks that play it too. The block of
        ``use`` plays it from now on.
        """
        editor = self.editor
        assert editor is not None
        known = self.own().get(name)
        with editor.transaction("keep a motion"):
            if known is not None and known.title != motion.title:
                name = rename_animation(editor, name, motion.title)
            name = keep_animation(editor, motion, name if known is not None else "")
            if use is not None and use.block in editor.project.blocks:
                editor.apply(SetField(use.block, use.slot, name))
        return name

    def uses(self, name: str) -> int:
        """How many blocks of the project play a motion."""
        return len(animation_uses(self.editor, name)) if self.editor is not None else 0

    def delete(self, name: str) -> None:
        """Take a motion out of the project."""
        if self.editor is not None and name in self.own():
            delete_animation(self.editor, name)


def joints_of(keyframes: Keyframes) -> dict[str, JointKeys]:
    """Keyframes as a project keeps them: to a hundredth of a millisecond and of a mrad."""
    return {
        name: JointKeys(
            _rounded(track.times),
            _rounded(track.keys),
            tuple(_handle(handle) for handle in track.handles) if track.handles else None,
        )
        for name, track in keyframes.tracks.items()
    }


def _rounded(numbers: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(number, DIGITS) for number in numbers)


def _handle(handle: Handle) -> Handle:
    a, b, c, d = _rounded(handle)
    return (a, b, c, d)


# Plays the motion of the controller: the moment that is shown goes on with the clock.

FRAME_MS = 16


class Player(QObject):
    """``changed`` tells whether it plays. ``speed``: 1 is real time; ``is_looping``: for ever."""

    changed = Signal(bool)

    def __init__(self, controller: MotionController, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.controller = controller
        self.speed = 1.0
        self.is_looping = False
        self._clock = QElapsedTimer()
        self._timer = QTimer(self, interval=FRAME_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_frame)

    @property
    def is_playing(self) -> bool:
        """Whether the moment goes on by itself."""
        return self._timer.isActive()

    def play(self) -> None:
        """Play on, from the beginning when the end is reached."""
        end_s = self.controller.motion.duration_s
        if self.is_playing or end_s <= 0:
            return
        if self.controller.cursor_s >= end_s:
            self.controller.show(0.0)
        self._clock.start()
        self._timer.start()
        self.changed.emit(True)

    def pause(self) -> None:
        """Stay at the moment that is shown."""
        if self.is_playing:
            self._timer.stop()
            self.changed.emit(False)

    def toggle(self) -> None:
        """Play, or pause."""
        if self.is_playing:
            self.pause()
        else:
            self.play()

    def _on_frame(self) -> None:
        end_s = self.controller.motion.duration_s
        now_s = self.controller.cursor_s + self._clock.restart() / 1000.0 * self.speed
        if now_s < end_s:
            self.controller.show(now_s)
        elif self.is_looping and end_s > 0:
            self.controller.show(now_s % end_s)
        else:
            self.controller.show(end_s)
            self.pause()


# Finds what a robot could not do of the motion of the controller, a little at a time.

SOON_MS = 150
SLICE_S = 0.008


class Faults(QObject):
    """``found`` gives the Faults of the motion, some time after it has changed."""

    found = Signal(list)

    def __init__(
        self, controller: MotionController, skeleton: Skeleton, language: Callable[[], Language]
    ) -> None:
        super().__init__(controller)
        self.controller, self._skeleton, self._language = controller, skeleton, language
        self.now: list[Fault] = []
        self.is_sure = False
        """Whether the motion has been looked at to its end as it is now."""
        self._looking: Iterator[float | None] = iter(())
        self._soon = QTimer(self, singleShot=True, interval=SOON_MS)
        self._soon.timeout.connect(self._begin)
        self._next = QTimer(self, interval=1)
        self._next.timeout.connect(self._on_next)
        controller.changed.connect(self._on_changed)
        follow_words(self, self._on_changed)

    def _on_changed(self) -> None:
        self.is_sure = False
        self._next.stop()
        self._soon.start()

    def _begin(self) -> None:
        worst: dict[tuple[float, float], TooFast] = {}
        for one in self.controller.rehearsal.too_fast():
            gap = one.from_s, one.to_s
            if gap not in worst or worst[gap].ratio < one.ratio:
                worst[gap] = one
        self.now = [self._fast(one) for one in worst.values()]
        self._looking = falling(self._skeleton, self.controller.rehearsal)
        self._next.start()
        self.found.emit(self.now)

    def _on_next(self) -> None:
        end_s = time.perf_counter() + SLICE_S
        while time.perf_counter() < end_s:
            at_s = next(self._looking, -1.0)
            if at_s is None:
                continue
            self._next.stop()
            self.is_sure = True
            if at_s >= 0.0:
                words = tr("The robot would fall at {time} s.", time=f"{at_s:.2f}")
                to_s = max(self.controller.motion.duration_s, at_s + 0.05)
                self.now = [*self.now, Fault("fall", at_s, to_s, words)]
            self.found.emit(self.now)
            return

    def _fast(self, one: TooFast) -> Fault:
        name = one.joint
        limb = limb_of_joint_words(self.controller.body, name)
        words = tr(
            "Too fast at {time} s: {joint} would have to move {ratio} times as fast as it can.",
            time=f"{one.to_s:.2f}",
            joint=f"{limb} ({joint_words(self._language(), self.controller.body, name)})",
            ratio=f"{one.ratio:.1f}",
        )
        return Fault("fast", one.from_s, one.to_s, words)
