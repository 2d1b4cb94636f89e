"""The take that is looked at: its stretch of the recording, its ends, and how it is played."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

from nep_studio.blocks.own_gestures import OwnTake
from nep_studio.ui.words import tr

from .curves import Mark, Window
from .gesture_controller import GestureController
from .live import Samples
from .project_gestures import LONGEST_TAKE_S, SHORTEST_TAKE_S, Keeping

End = Literal["start", "end"]
AROUND_S = 0.8
"""So much of the recording is shown before and after the take."""
STEP_S = 0.02
FRAME_MS = 16


class TakeView(QObject):
    """The chosen take, while it is looked at. ``changed``: something of it looks different."""

    changed = Signal()

    def __init__(
        self, controller: GestureController, keeping: Keeping, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._controller, self._keeping = controller, keeping
        self.held: End = "start"
        self.is_dragged = False
        self.cursor_s: float | None = None
        """Where it is being played; None while it is not."""
        self._ends = (0.0, 0.0)
        self._shown = (0.0, 1.0)
        self.samples = Samples.none()
        self._playing = QTimer(self, interval=FRAME_MS)
        self._playing.timeout.connect(self._on_played)
        self._clock = QElapsedTimer()
        controller.take_chosen.connect(self._on_chosen)
        controller.changed.connect(self._on_changed)

    # What it is

    @property
    def is_open(self) -> bool:
        """Whether a take is looked at."""
        return bool(self._controller.chosen_take)

    @property
    def ends(self) -> dict[End, float]:
        """Where it begins and ends, on the clock of its recording."""
        return {"start": self._ends[0], "end": self._ends[1]}

    @property
    def shown_s(self) -> tuple[float, float]:
        """What part of the recording is shown."""
        return self._shown

    @property
    def words(self) -> str:
        """Where it begins and how long it is."""
        start_s, end_s = self._ends
        return tr("{seconds} s long", seconds=f"{end_s - start_s:.2f}")

    def marks(self) -> list[Mark]:
        """The take, with how long it is."""
        return [Mark(*self._ends, self.words)] if self.is_open else []

    # Played

    def play(self) -> None:
        """Let a line go through the take as fast as the hand did, or stop it."""
        if self.cursor_s is not None:
            self._stop()
        elif self.is_open:
            self.cursor_s = self._ends[0]
            self._clock.start()
            self._playing.start()
        self.changed.emit()

    def _on_played(self) -> None:
        self.cursor_s = self._ends[0] + self._clock.elapsed() / 1000
        if self.cursor_s > self._ends[1]:
            self._stop()
        self.changed.emit()

    def _stop(self) -> None:
        self._playing.stop()
        self.cursor_s = None

    # Its ends

    def end_near(self, x: float, window: Window, reach: float) -> End | None:
        """The end that is near enough to be taken."""
        ways: dict[End, float] = {end: abs(window.x(at) - x) for end, at in self.ends.items()}
        nearest = min(ways, key=lambda end: ways[end])
        return nearest if ways[nearest] <= reach else None

    def hold_near(self, x: float, window: Window, reach: float) -> None:
        """Take the end that is near, to drag it."""
        near = self.end_near(x, window, reach)
        if near is not None:
            self.held, self.is_dragged = near, True
            self.changed.emit()

    def drag(self, time_s: float) -> None:
        """Move the end that is held, as far as there is room."""
        take = self._take()
        if take is None:
            return
        start_s, end_s = self._ends
        first_s, last_s = self._keeping.room_of(take)
        if self.held == "start":
            earliest_s = max(first_s, end_s - LONGEST_TAKE_S)
            start_s = min(max(time_s, earliest_s), end_s - SHORTEST_TAKE_S)
        else:
            latest_s = min(last_s, start_s + LONGEST_TAKE_S)
            end_s = max(min(time_s, latest_s), start_s + SHORTEST_TAKE_S)
        self._ends = start_s, end_s
        self.changed.emit()

    def let_go(self) -> None:
        """Keep the ends as they are now, as one step."""
        if self.is_dragged:
            self.is_dragged = False
            self._keeping.trim_take(self._controller.chosen_take, *self._ends)
            self.changed.emit()

    def press_key(self, key: Qt.Key) -> bool:
        """Do what a key means for a take; False when it means nothing.

        An end that a key moves is kept once the key is up: a key held down is one step.
        """
        if not self.is_open:
            return False
        steps = {Qt.Key.Key_Left: -STEP_S, Qt.Key.Key_Right: STEP_S}
        held: dict[Qt.Key, End] = {Qt.Key.Key_Home: "start", Qt.Key.Key_End: "end"}
        if key in steps:
            self.is_dragged = True
            self.drag(self.ends[self.held] + steps[key])
        elif key in held:
            self.held = held[key]
            self.changed.emit()
        elif key == Qt.Key.Key_Space:
            self.play()
        elif key == Qt.Key.Key_Escape:
            self._controller.choose_take("")
        else:
            return False
        return True

    # Within

    def _take(self) -> OwnTake | None:
        found = self._controller.find_take(self._controller.chosen_take)
        return found[1] if found is not None else None

    def _on_chosen(self, _take_id: str) -> None:
        self._stop()
        self.is_dragged, self.held = False, "start"
        take = self._take()
        if take is not None:
            self._shown = max(0.0, take.start_s - AROUND_S), take.end_s + AROUND_S
        self._on_changed()

    def _on_changed(self) -> None:
        take = self._take()
        if take is None:
            self._stop()
            self.samples = Samples.none()
        elif not self.is_dragged:
            self.samples = self._controller.samples(take.recording)
            self._ends = take.start_s, take.end_s
            first_s, last_s = self._shown
            self._shown = min(first_s, take.start_s), max(last_s, take.end_s)
        self.changed.emit()
