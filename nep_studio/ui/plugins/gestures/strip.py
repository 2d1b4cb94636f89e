"""The graph at the top: what is measured now, or the take that is looked at, large."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QElapsedTimer, QObject, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QFocusEvent,
    QFontMetricsF,
    QHideEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QShowEvent,
)
from PySide6.QtWidgets import QSizePolicy

from nep_studio.blocks.own_gestures import OwnTake
from nep_studio.ui.labels import labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.widgets.curves import line_width
from nep_studio.ui.widgets.layouts import InLines
from nep_studio.ui.words import tr

from . import curves
from .curves import Mark, Window, fault_words
from .gesture_controller import GestureController
from .live import Samples
from .project_gestures import LONGEST_TAKE_S, SHORTEST_TAKE_S, Keeping
from .recording import TakeSession

# The take that is looked at: its stretch of the recording, its ends, and how it is played.

End = Literal["start", "end"]
AROUND_S = 0.8
"""So much of the recording is shown before and after the take."""
STEP_S = 0.02
PLAY_FRAME_MS = 16
REACH_LINES = 0.6
"""So near to an end of the take, in lines of text, it is taken; a little wider than its handle."""


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
        self.shown_s = (0.0, 1.0)
        """What part of the recording is shown."""
        self.samples = Samples.none()
        self._playing = QTimer(self, interval=PLAY_FRAME_MS)
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
    def words(self) -> str:
        """How long it is."""
        start_s, end_s = self._ends
        return tr("{seconds} s long", seconds=f"{end_s - start_s:.2f}")

    @property
    def mark(self) -> Mark:
        """The take, with how long it is."""
        return Mark(*self._ends, self.words)

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
            self.shown_s = max(0.0, take.start_s - AROUND_S), take.end_s + AROUND_S
        self._on_changed()

    def _on_changed(self) -> None:
        take = self._take()
        if take is None:
            self._stop()
            self.samples = Samples.none()
        elif not self.is_dragged:
            self.samples = self._controller.samples(take.recording)
            self._ends = take.start_s, take.end_s
            first_s, last_s = self.shown_s
            self.shown_s = min(first_s, take.start_s), max(last_s, take.end_s)
        self.changed.emit()


# The graph at the top: what is measured now, or one take large, with ends that can be dragged.

SHOWN_S = 10.0
FRAME_MS = 33
_SHRINK = 0.05
"""How quickly the range of values follows a quieter hand, each frame; a wilder one at once."""
_BIG, _SMALLER = 0.6, 0.32
"""How high the countdown is, and the count of takes, as a share of the graph."""


class Strip(InLines):
    """Shows the last ten seconds; a chosen take in their place until nobody looks at it."""

    usual_lines, least_lines = (26, 7), (8, 5)

    def __init__(self, controller: GestureController, session: TakeSession, take: TakeView) -> None:
        super().__init__()
        self._controller, self._session, self.take = controller, session, take
        self._range = curves.value_range(Samples.none())
        self._is_due, self._was_hearing = True, False
        self._frames = QTimer(self, interval=FRAME_MS)
        self._frames.timeout.connect(self._on_frame)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        controller.heard.connect(self._on_heard)
        of_controller = controller.changed, controller.take_chosen, controller.sources_changed
        for signal in (session.changed, take.changed, *of_controller):
            signal.connect(self._on_changed)
        controller.look.theme_changed.connect(self._on_changed)
        controller.take_chosen.connect(self._name_it)
        self._name_it()

    # What is shown

    @property
    def samples(self) -> Samples:
        """What is drawn."""
        if self.take.is_open:
            return self.take.samples
        live = self._controller.live
        return live.last(SHOWN_S + 0.2) if live is not None else Samples.none()

    @property
    def window_shown(self) -> Window:
        """Which part of time is where."""
        line = self.fontMetrics().height()
        rect = QRectF(self.rect()).adjusted(1, 1, -1 - line * 1.2, -1)
        if self.take.is_open:
            low, high = curves.value_range(self.take.samples.between(*self.take.shown_s))
            return Window(rect, *self.take.shown_s, low, high)
        end_s = self._controller.live.last_t if self._controller.live is not None else 0.0
        return Window(rect, end_s - SHOWN_S, end_s, *self._range)

    @property
    def big_words(self) -> str:
        """What is written large over the curves; empty for nothing."""
        session = self._session
        if session.state == "countdown":
            return str(session.count)
        if session.state == "takes":
            if not session.taken and not session.movements:
                return tr("Go")
            return tr("{number} of {count}", number=session.taken, count=session.wanted)
        return ""

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the curves, and what is known of them."""
        theme, window = self._controller.look.theme, self.window_shown
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), theme.colour("field"))
            samples = self.samples
            if self._session.start_s is not None and not self.take.is_open:
                curves.paint_recorded(painter, window, self._session.start_s, theme)
            marks = self._marks()
            for mark in marks:
                curves.paint_mark(painter, window, mark, theme)
            curves.paint_ground(painter, window, theme)
            width = line_width(theme, QFontMetricsF(self.font()))
            curves.paint_lines(painter, window, samples, theme, width)
            shown = samples.between(window.start_s, window.end_s)
            curves.paint_letters(painter, window, shown, theme, self.font())
            for mark in marks:
                curves.paint_label(painter, window, mark, theme, self.font())
            self._paint_over(painter, window)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            colour, width = ("focus", 2) if self.hasFocus() else ("line", 1)
            painter.setPen(QPen(theme.colour(colour), width))
            painter.drawRect(self.rect().adjusted(0, 0, -1, -1))

    def _paint_over(self, painter: QPainter, window: Window) -> None:
        theme, take = self._controller.look.theme, self.take
        if take.is_open:
            line = self.fontMetrics().height()
            for end, time_s in take.ends.items():
                is_held = take.held == end and (take.is_dragged or self.hasFocus())
                curves.paint_handle(painter, window, time_s, theme, line, is_held=is_held)
            if take.cursor_s is not None:
                x = window.x(take.cursor_s)
                painter.setPen(QPen(theme.colour("accent"), 2))
                painter.drawLine(int(x), int(window.rect.top()), int(x), int(window.rect.bottom()))
            if not len(take.samples):
                words = tr("The samples of this take cannot be read.")
                curves.paint_words(painter, window.rect, words, theme, self.font())
        elif self.big_words:
            share = _BIG if self._session.state == "countdown" else _SMALLER
            curves.paint_big(painter, window.rect, self.big_words, theme, self.font(), share)
        elif not self._controller.is_hearing:
            words = tr("No movement is heard. Connect a watch or phone, and move it.")
            curves.paint_words(painter, window.rect, words, theme, self.font())

    def _marks(self) -> list[Mark]:
        if self.take.is_open:
            return [self.take.mark]
        number, marks = 0, []
        for one in self._session.movements if self._session.is_on else []:
            number += not one.fault
            words = fault_words(one.fault) if one.fault else str(number)
            marks.append(Mark(one.start_s, one.end_s, words, bool(one.fault)))
        return marks

    # What happens

    def _on_heard(self, _samples: object) -> None:
        self._is_due = self._is_due or not self.take.is_open

    def _on_changed(self, _what: object = None) -> None:
        self._is_due = True
        self.update()

    def _on_frame(self) -> None:
        if self._controller.is_hearing != self._was_hearing:
            self._was_hearing = not self._was_hearing
            self.update()  # it says that nothing is heard any more, or not any more
        if self.take.is_open or not self._is_due:
            return
        self._is_due = False
        low, high = curves.value_range(self.samples)
        old_low, old_high = self._range
        slow_low, slow_high = (
            old + _SHRINK * (new - old) for old, new in zip(self._range, (low, high), strict=True)
        )
        self._range = min(low, max(old_low, slow_low)), max(high, min(old_high, slow_high))
        self.update()

    def _name_it(self, _take: str = "") -> None:
        is_open = self.take.is_open
        labelled(
            self,
            name="A take, large" if is_open else "What is measured now",
            description="Home and End choose an end, arrow keys move it, Space plays, "
            "Escape goes back."
            if is_open
            else "",
        )

    def showEvent(self, event: QShowEvent) -> None:
        """Draw on."""
        super().showEvent(event)
        self._frames.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Draw nothing that nobody sees."""
        super().hideEvent(event)
        self._frames.stop()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Keep what was moved: the keyboard is elsewhere."""
        super().focusOutEvent(event)
        self.take.let_go()

    # Mouse and keyboard

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take an end of the take."""
        reach = self.fontMetrics().height() * REACH_LINES
        if event.button() == Qt.MouseButton.LeftButton and self.take.is_open:
            self.take.hold_near(event.position().x(), self.window_shown, reach)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the end, or show that it can be dragged."""
        window, x = self.window_shown, event.position().x()
        if self.take.is_dragged:
            self.take.drag(window.time(x))
            return
        reach = self.fontMetrics().height() * REACH_LINES
        is_near = self.take.is_open and self.take.end_near(x, window, reach) is not None
        self.setCursor(Qt.CursorShape.SplitHCursor if is_near else Qt.CursorShape.ArrowCursor)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Keep where the take begins and ends now."""
        self.take.let_go()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the ends of a take by keys; in the live graph keys mean what they do around it."""
        if not self.take.press_key(Qt.Key(event.key())):
            super().keyPressEvent(event)
        elif self.take.is_open and event.key() in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            announce(self, self.take.words)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Keep what a key has moved."""
        super().keyReleaseEvent(event)
        if not event.isAutoRepeat():
            self.take.let_go()
