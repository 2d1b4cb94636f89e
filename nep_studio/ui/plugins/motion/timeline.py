"""The timeline of a motion: its key poses, to be chosen, moved, copied, and the moment shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QLineF, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QBrush,
    QColor,
    QContextMenuEvent,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QWheelEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import count_words, tr

from .editing import SAME_S, key_times
from .motion_controller import MotionController
from .rehearsal import LIMBS, Fault, limb_words

# What keys and clicks on the timeline mean, apart from the widget.


def times_with(chosen: Sequence[float], time: float, *, is_more: bool) -> list[float]:
    """The chosen keys after a click on one; with ``is_more`` it joins or leaves the others."""
    others = [t for t in chosen if abs(t - time) >= SAME_S]
    was_chosen = len(others) < len(chosen)
    if is_more:
        return others if was_chosen else [*others, time]
    return list(chosen) if was_chosen else [time]


def shift_of(key: int, step_s: float) -> float | None:
    """How far an arrow key goes in time, or None when it is another key."""
    return {int(Qt.Key.Key_Left): -step_s, int(Qt.Key.Key_Right): step_s}.get(int(key))


SHORTEST_SHOWN_S = 4.0
MORE_SHOWN = 1.2
"""So many times its own length a motion has room for on its timeline."""
MOST_PER_S = 60.0
"""In heights of a line."""


class Timeline(QWidget):
    """One row for the poses, and one for each limb.

    ``key_asked``: a key pose is wanted at the moment shown; ``menu_asked`` gives a place.
    """

    key_asked = Signal()
    menu_asked = Signal(object)  # QPoint, global

    def __init__(self, controller: MotionController, look: Look) -> None:
        super().__init__()
        self.controller, self.look = controller, look
        self.snap_s = 0.05
        self.zoom = 1.0
        self.faults: list[Fault] = []
        self._drag: _Drag | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        labelled(self, name="Timeline")
        for signal in (controller.changed, controller.moved, controller.chosen_changed):
            signal.connect(self._on_changed)
        follow_words(self, self._on_changed)

    # What is shown

    @property
    def line(self) -> int:
        """The height of a line of text, by which everything is measured."""
        return self.fontMetrics().height()

    @property
    def shown_s(self) -> float:
        """How long the time is that the timeline shows."""
        whole_s = self.controller.motion.duration_s
        return max(SHORTEST_SHOWN_S, whole_s * MORE_SHOWN, self.controller.cursor_s)

    @property
    def scale(self) -> Scale:
        """Where moments are."""
        left, holder = self.names_width + self.line * 0.8, self.parentWidget()
        width = holder.width() if holder is not None and self.zoom > 1.0 else self.width()
        room = max(width - left - self.line, self.line * 4)
        return Scale(left, min(room / self.shown_s * self.zoom, self.line * MOST_PER_S))

    @property
    def names_width(self) -> float:
        """How much room the names of the rows take."""
        words = (tr("Poses"), *limb_words().values())
        return max(map(self.fontMetrics().horizontalAdvance, words)) + self.line

    def row(self, number: int) -> QRectF:
        """Where a row is: 0 the ruler, 1 the poses, from 2 on the limbs."""
        heights = [1.5, 1.6, *(1.05 for _ in LIMBS)]
        top = sum(heights[:number]) * self.line
        return QRectF(0.0, top, self.width(), heights[number] * self.line)

    def place_of(self, time: float) -> QPointF:
        """Where the key pose of a moment is."""
        return QPointF(self.scale.x(time), self.row(1).center().y())

    def show_faults(self, faults: list[Fault]) -> None:
        """Mark where the robot would be too slow, or fall."""
        self.faults = faults
        self.update()

    def sizeHint(self) -> QSize:
        """As wide as what it shows at this zoom."""
        height = int(self.row(len(LIMBS) + 1).bottom()) + 2
        wide = self.scale.x(self.shown_s) + self.line if self.zoom > 1.0 else self.line * 20
        return QSize(int(wide), height)

    def minimumSizeHint(self) -> QSize:
        """Without zoom it takes what room there is."""
        size = self.sizeHint()
        return size if self.zoom > 1.0 else QSize(self.line * 20, size.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint it."""
        painter = QPainter(self)
        TimelinePainter(self, painter).paint()
        painter.end()

    def _on_changed(self) -> None:
        count, now = len(key_times(self.controller.motion)), f"{self.controller.cursor_s:.2f}"
        poses = count_words(count, "1 key pose", "{n} key poses")
        self.setAccessibleDescription(tr("{poses}; {time} s is shown", poses=poses, time=now))
        if self._drag is None:
            self.updateGeometry()
        self.update()

    # The mouse

    def key_at(self, place: QPointF) -> float | None:
        """The time of the key under a place."""
        scale, near = self.scale, self.line * 0.5
        if place.y() < self.row(1).top():
            return None
        away = {t: abs(scale.x(t) - place.x()) for t in key_times(self.controller.motion)}
        return min((t for t in away if away[t] <= near), key=away.__getitem__, default=None)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a key, or show a moment."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        place = event.position()
        key = self.key_at(place)
        if key is None:
            self._drag = _Drag(place, self.scale.time(place.x()), "scrub")
            if place.y() >= self.row(1).top():
                self.controller.choose(())
            self._scrub(place)
            return
        is_more = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        is_after = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        self.controller.choose(times_with(self.controller.chosen, key, is_more=is_more))
        self.controller.show(key)
        self._drag = _Drag(place, key, "after" if is_after else "move")

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag keys, or the moment."""
        if self._drag is None:
            key = self.key_at(event.position())
            shape = Qt.CursorShape.ArrowCursor if key is None else Qt.CursorShape.SizeHorCursor
            self.setCursor(shape)
            return
        if self._drag.kind == "scrub":
            self._scrub(event.position())
        elif self._drag.has_begun(event.position(), self.line):
            is_free = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
            self._move_to(event.position(), 0.0 if is_free else self.snap_s)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """A drag ends."""
        if self._drag is not None:
            self._drag = None
            self.controller.seal()
            self.updateGeometry()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Keep a key pose at that moment."""
        if event.position().y() >= self.row(1).top() and self.key_at(event.position()) is None:
            self._scrub(event.position())
            self.key_asked.emit()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """What can be done with the key, or at the moment."""
        if event.reason() == QContextMenuEvent.Reason.Mouse:
            key = self.key_at(QPointF(event.pos()))
            if key is not None and key not in self.controller.chosen:
                self.controller.choose([key])
                self.controller.show(key)
        self.menu_asked.emit(event.globalPos())

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Ctrl and the wheel zoom."""
        if not event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            event.ignore()
            return
        factor = 1.25 ** (event.angleDelta().y() / 120.0)
        self.zoom = min(max(self.zoom * factor, 1.0), 40.0)  # never less than all of it
        self.setMinimumWidth(self.minimumSizeHint().width())
        self.updateGeometry()
        self.update()

    def _scrub(self, place: QPointF) -> None:
        self.controller.show(snapped(self.scale.time(place.x()), self.snap_s))

    def _move_to(self, place: QPointF, snap_s: float) -> None:
        drag = self._drag
        assert drag is not None
        wanted = snapped(drag.time + (place.x() - drag.place.x()) / self.scale.per_s, snap_s)
        way_s, merge = wanted - drag.at, "move keys"
        if drag.kind == "after":
            self.controller.shift_after(drag.at, way_s, tr("make room"), merge=merge)
        else:
            self.controller.move_chosen(way_s, tr("move key poses"), merge=merge)
        drag.at = max(wanted, 0.01) if drag.kind == "move" else wanted
        self.controller.show(drag.at)

    def event(self, event: QEvent) -> bool:
        """Say what is wrong where something is."""
        if isinstance(event, QHelpEvent):
            time = self.scale.time(event.x())
            found = [one.words for one in self.faults if one.from_s <= time <= one.to_s]
            QToolTip.showText(event.globalPos(), plain_tip("\n".join(found)), self)
            return True
        return super().event(event)

    # The keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows go through time, with Alt they move the chosen keys."""
        is_moving = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
        step_s = shift_of(event.key(), self.snap_s or 0.01)
        if step_s is not None and is_moving:
            self.controller.move_chosen(step_s, tr("move key poses"))
            if self.controller.chosen:
                self.controller.show(self.controller.chosen[0])
        elif step_s is not None:
            self.controller.show(snapped(self.controller.cursor_s + step_s, self.snap_s))
        elif not self._go(event.key()):
            super().keyPressEvent(event)

    def _go(self, key: int) -> bool:
        times, now = key_times(self.controller.motion), self.controller.cursor_s
        match key:
            case Qt.Key.Key_Home:
                self.controller.show(0.0)
            case Qt.Key.Key_End:
                self.controller.show(times[-1] if times else 0.0)
            case Qt.Key.Key_PageUp:
                self._choose(max((t for t in times if t < now - SAME_S), default=None))
            case Qt.Key.Key_PageDown:
                self._choose(min((t for t in times if t > now + SAME_S), default=None))
            case _:
                return False
        return True

    def _choose(self, time: float | None) -> None:
        if time is not None:
            self.controller.choose([time])
            self.controller.show(time)


class _Drag:
    """What the mouse does: where and when it began, and where the keys are by now."""

    def __init__(self, place: QPointF, time: float, kind: str) -> None:
        self.place, self.time, self.kind = place, time, kind
        self.at = time
        self._has_begun = False

    def has_begun(self, place: QPointF, line: float) -> bool:
        """Whether it is more than a click with an unsteady hand."""
        self._has_begun = self._has_begun or abs(place.x() - self.place.x()) > line * 0.25
        return self._has_begun


# Paints the timeline of a motion.


class TimelinePainter:
    """One picture of the timeline as it is now."""

    def __init__(self, timeline: Timeline, painter: QPainter) -> None:
        self.timeline, self.painter = timeline, painter
        self.controller, self.theme = timeline.controller, timeline.look.theme
        self.line, self.scale = timeline.line, timeline.scale

    def paint(self) -> None:
        """Paint everything."""
        self.painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.painter.fillRect(self.timeline.rect(), self.theme.colour("field"))
        self._rows()
        row, text = self.timeline.row(0), self.theme.colour("muted")
        self.painter.fillRect(row, self.theme.colour("panel_alt"))
        for time in self.scale.marks(self.timeline.shown_s, self.line * 3):
            x = self.scale.x(time)
            self.painter.setPen(QPen(text, 1.0))
            self.painter.drawLine(QLineF(x, row.bottom() - self.line * 0.3, x, row.bottom()))
            words = f"{time:g}" if time else tr("0 s")
            place = QRectF(x - self.line * 2, row.top(), self.line * 4, self.line * 1.15)
            self.painter.drawText(place, Qt.AlignmentFlag.AlignCenter, words)
        for fault in self.timeline.faults:
            self._fault(fault)
        self._limb_keys()
        row = self.timeline.row(1)
        for time in key_times(self.controller.motion):
            self._diamond(time, row, self.line * 0.42, self._is_chosen(time))
        names = ["", tr("Poses"), *limb_words().values()]
        width = self.timeline.names_width
        for number, name in enumerate(names):
            row = self.timeline.row(number)
            row.setWidth(width)
            self.painter.fillRect(row.adjusted(0, 0, 0, -1), self.theme.colour("panel_alt"))
            self.painter.setPen(self.theme.colour("text"))
            row.setLeft(self.line * 0.4)
            flags = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
            self.painter.drawText(row, flags, name)
        self._cursor()
        if self.timeline.hasFocus():
            self._focus()

    def _rows(self) -> None:
        pen = QPen(self.theme.colour("line"), max(1.0, self.line / 16))
        self.painter.setPen(pen)
        for number in range(len(LIMBS) + 2):
            row = self.timeline.row(number)
            if number == 1:
                self.painter.fillRect(row, self.theme.colour("panel"))
            self.painter.drawLine(QLineF(row.bottomLeft(), row.bottomRight()))
        end = self.scale.x(self.controller.motion.duration_s)
        beyond = QRectF(end, self.timeline.row(1).top(), self.timeline.width() - end, 1e4)
        shade = self.theme.colour("panel_alt")
        shade.setAlphaF(0.5)
        self.painter.fillRect(beyond, shade)

    def _fault(self, fault: Fault) -> None:
        """Hatched, with a sign: colour does not speak alone."""
        is_fall = fault.kind == "fall"
        colour = self.theme.colour("error" if is_fall else "warning")
        top = self.timeline.row(1).top()
        bottom = self.timeline.row(len(LIMBS) + 1).bottom()
        left, right = self.scale.x(fault.from_s), self.scale.x(fault.to_s)
        style = Qt.BrushStyle.BDiagPattern if is_fall else Qt.BrushStyle.FDiagPattern
        pale = QColor(colour)
        pale.setAlphaF(0.55)
        self.painter.fillRect(QRectF(left, top, right - left, bottom - top), QBrush(pale, style))
        size = self.line * 0.8
        place = QRectF((left + right - size) / 2, top - size * 1.05, size, size)
        paint_icon(self.painter, place, "triangle-alert", colour)

    def _limb_keys(self) -> None:
        body = self.controller.body
        for number, limb in enumerate(LIMBS, start=2):
            row = self.timeline.row(number)
            names = [n for n in self.controller.motion.joints if n in body.index]
            moving = [n for n in names if body.joints[body.index[n]].limb is limb]
            joints = self.controller.motion.joints
            times = sorted({t for name in moving for t in joints[name].times})
            if not times:
                continue
            pale = QColor(self.theme.colour("accent"))
            pale.setAlphaF(0.35)
            self.painter.setPen(QPen(pale, self.line * 0.12))
            middle = row.center().y()
            start, end = self.scale.x(0.0), self.scale.x(times[-1])
            self.painter.drawLine(QLineF(start, middle, end, middle))
            for time in times:
                self._diamond(time, row, self.line * 0.22, self._is_chosen(time))

    def _diamond(self, time: float, row: QRectF, size: float, is_chosen: bool) -> None:
        x, y = self.scale.x(time), row.center().y()
        around = [(0, -size), (size, 0), (0, size), (-size, 0)]
        self.painter.setBrush(self.theme.colour("accent" if is_chosen else "field"))
        self.painter.setPen(QPen(self.theme.colour("accent"), max(1.5, self.line / 9)))
        self.painter.drawPolygon(QPolygonF([QPointF(x + a, y + b) for a, b in around]))
        if is_chosen and size > self.line * 0.3:  # a dot too: not by its filling alone
            self.painter.setBrush(self.theme.colour("accent_text"))
            self.painter.setPen(Qt.PenStyle.NoPen)
            self.painter.drawEllipse(QPointF(x, y), size * 0.25, size * 0.25)

    def _is_chosen(self, time: float) -> bool:
        return any(abs(one - time) < SAME_S for one in self.controller.chosen)

    def _cursor(self) -> None:
        x = self.scale.x(self.controller.cursor_s)
        colour = self.theme.colour("snap")
        ruler = self.timeline.row(0)
        self.painter.setPen(QPen(colour, max(1.5, self.line / 9)))
        bottom = self.timeline.row(len(LIMBS) + 1).bottom()
        self.painter.drawLine(QLineF(x, ruler.bottom() - self.line * 0.3, x, bottom))
        half, low = self.line * 0.36, ruler.bottom()
        self.painter.setBrush(colour)
        self.painter.setPen(Qt.PenStyle.NoPen)
        points = [(x - half, low - self.line * 0.6), (x + half, low - self.line * 0.6), (x, low)]
        self.painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in points]))

    def _focus(self) -> None:
        wide = max(2.0, self.line / 8)
        self.painter.setBrush(Qt.BrushStyle.NoBrush)
        self.painter.setPen(QPen(self.theme.colour("focus"), wide))
        inner = QRectF(self.timeline.rect()).adjusted(wide / 2, wide / 2, -wide / 2, -wide / 2)
        self.painter.drawRect(inner)


# Where the moments of a motion are on its timeline, in pixels.

STEPS_S = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0, 300.0, 600.0)


@dataclass(frozen=True)
class Scale:
    """Pixels for seconds: ``left`` is where 0 s is."""

    left: float
    per_s: float

    def x(self, time: float) -> float:
        """Where a moment is."""
        return self.left + time * self.per_s

    def time(self, x: float) -> float:
        """Which moment is at a place; never before the beginning."""
        return max(0.0, (x - self.left) / self.per_s)

    def marks(self, end_s: float, apart: float) -> list[float]:
        """The moments that get a mark with a number, at least ``apart`` pixels from each other."""
        step = next((s for s in STEPS_S if s * self.per_s >= apart), STEPS_S[-1])
        return [round(number * step, 3) for number in range(int(end_s / step) + 1)]


def snapped(time: float, step: float) -> float:
    """The nearest multiple of a step; with 0 the time itself."""
    return round(round(time / step) * step, 3) if step > 0 else time
