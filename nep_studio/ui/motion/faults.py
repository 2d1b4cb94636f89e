"""Finds what a robot could not do of the motion on the desk, a little at a time."""

from __future__ import annotations

import time
from collections.abc import Iterator

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.language import Language
from nep_studio.ui.motion.balance import falling
from nep_studio.ui.motion.desk import MotionDesk
from nep_studio.ui.motion.joint_words import joint_words, limb_of_joint_words
from nep_studio.ui.motion.rehearsal import TooFast
from nep_studio.ui.motion.timeline_painter import Fault
from nep_studio.ui.words import tr
from nodes.action.naobody.skeleton import Skeleton

SOON_MS = 150
SLICE_S = 0.008


class Faults(QObject):
    """``found`` gives the Faults of the motion, some time after it has changed."""

    found = Signal(list)

    def __init__(self, desk: MotionDesk, skeleton: Skeleton, language: Language) -> None:
        super().__init__(desk)
        self.desk, self._skeleton, self._language = desk, skeleton, language
        self.now: list[Fault] = []
        self.is_sure = False
        """Whether the motion has been looked at to its end as it is now."""
        self._looking: Iterator[float | None] = iter(())
        self._soon = QTimer(self, singleShot=True, interval=SOON_MS)
        self._soon.timeout.connect(self._begin)
        self._next = QTimer(self, interval=1)
        self._next.timeout.connect(self._on_next)
        desk.changed.connect(self._on_changed)
        self._on_changed()

    @property
    def has_too_fast(self) -> bool:
        """Whether a joint would have to move faster than it can."""
        return any(fault.kind == "fast" for fault in self.now)

    def _on_changed(self) -> None:
        self.is_sure = False
        self._next.stop()
        self._soon.start()

    def _begin(self) -> None:
        worst: dict[tuple[float, float], TooFast] = {}
        for one in self.desk.rehearsal.too_fast():
            gap = one.from_s, one.to_s
            if gap not in worst or worst[gap].ratio < one.ratio:
                worst[gap] = one
        self.now = [self._fast(one) for one in worst.values()]
        self._looking = falling(self._skeleton, self.desk.rehearsal)
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
                self.now = [*self.now, self._fall(at_s)]
            self.found.emit(self.now)
            return

    def _fast(self, one: TooFast) -> Fault:
        words = tr(
            "Too fast at {time} s: {joint} would have to move {ratio} times as fast as it can.",
            time=f"{one.to_s:.2f}",
            joint=self._joint(one.joint),
            ratio=f"{one.ratio:.1f}",
        )
        return Fault("fast", one.from_s, one.to_s, words)

    def _fall(self, at_s: float) -> Fault:
        words = tr("The robot would fall at {time} s.", time=f"{at_s:.2f}")
        return Fault("fall", at_s, max(self.desk.motion.duration_s, at_s + 0.05), words)

    def _joint(self, name: str) -> str:
        limb = limb_of_joint_words(self.desk.body, name)
        return f"{limb} ({joint_words(self._language, self.desk.body, name)})"
