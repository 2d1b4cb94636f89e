"""The takes of one gesture as little pictures, painted by one widget."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from statistics import median

import numpy as np
from PySide6.QtCore import QEvent, QMimeData, QPoint, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QDrag,
    QFocusEvent,
    QFontMetricsF,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QResizeEvent,
)
from PySide6.QtWidgets import QApplication, QSizePolicy, QToolTip, QWidget

from nep_studio.blocks.own_gestures import OwnTake
from nep_studio.ui.labels import labelled, plain_tip
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.widgets.curves import line_width
from nep_studio.ui.words import tr
from nep_studio.ui.workbench.palette.accessible_list import make_list_accessible, tell_current

from .curves import Window, paint_lines, value_range
from .gesture_controller import GestureController
from .results.findings import METHODS, findings_of, id_of_take

# Where the takes of one gesture are: their places in rows, and the way of the arrow keys.

WIDE_LINES, HIGH_LINES, GAP_LINES = 4.6, 3.4, 0.35


@dataclass(frozen=True)
class Grid:
    """Cells for ``count`` takes in a room so many pixels wide."""

    count: int
    width: int
    line: int
    is_mirrored: bool = False

    @property
    def gap(self) -> int:
        """The room between two cells."""
        return max(2, round(self.line * GAP_LINES))

    @property
    def cell(self) -> tuple[int, int]:
        """How large a cell is; a narrow room has narrow cells."""
        wide = min(round(self.line * WIDE_LINES), max(1, self.width - 2 * self.gap))
        return wide, round(self.line * HIGH_LINES)

    @property
    def columns(self) -> int:
        """How many are beside each other."""
        return max(1, (self.width - self.gap) // (self.cell[0] + self.gap))

    @property
    def height(self) -> int:
        """How high all rows are."""
        rows = -(-self.count // self.columns)
        return rows * (self.cell[1] + self.gap) + self.gap if rows else 0

    def rect(self, number: int) -> QRect:
        """Where a take is."""
        wide, high = self.cell
        column, row = number % self.columns, number // self.columns
        x = self.gap + column * (wide + self.gap)
        if self.is_mirrored:
            x = self.width - x - wide
        return QRect(x, self.gap + row * (high + self.gap), wide, high)

    def at(self, place: QPoint) -> int:
        """The take at a place, or -1."""
        return next((n for n in range(self.count) if self.rect(n).contains(place)), -1)

    def beside(self, number: int, key: Qt.Key) -> int:
        """The take that an arrow key leads to from another; -1 where there is none."""
        forth = -1 if self.is_mirrored else 1
        steps = {
            Qt.Key.Key_Right: forth,
            Qt.Key.Key_Left: -forth,
            Qt.Key.Key_Down: self.columns,
            Qt.Key.Key_Up: -self.columns,
        }
        if key not in steps or not self.count:
            return -1
        if number < 0:
            return 0
        reached = number + steps[key]
        return reached if 0 <= reached < self.count else -1


# Little pictures of takes, painted when they are first seen and kept.

MOST_KEPT = 1500


class TakePictures:
    """The curves of takes as pixmaps; all takes of all cards share one store.

    ``picture`` gives the curves of a take, so large in logical pixels.
    """

    def __init__(self, controller: GestureController) -> None:
        self._controller = controller
        self.picture = lru_cache(MOST_KEPT)(self._paint)

    def _paint(
        self, take: OwnTake, size: QSize, ratio: float, theme: Theme, width: float
    ) -> QPixmap:
        pixmap = QPixmap(size * ratio)
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        samples = self._controller.take_samples(take)
        if not len(samples):
            return pixmap
        low, high = value_range(samples)
        rect = QRectF(0, 0, size.width(), size.height())
        window = Window(rect, float(samples.t[0]), float(samples.t[-1]), low, high)
        with QPainter(pixmap) as painter:
            paint_lines(painter, window, samples, theme, width)
        return pixmap


TAKES_MIME = "application/x-nep-takes"
_PALE = 0.35


class TakesList(QWidget):
    """Shows takes; a click or Enter looks at one, Delete deletes, dragging carries them.

    ``opened`` gives the id of a take, ``menu_asked`` a place of the screen, ``delete_asked`` ids.
    """

    opened = Signal(str)
    menu_asked = Signal(QPoint)
    delete_asked = Signal(list)
    current_changed = Signal()

    def __init__(self, controller: GestureController, pictures: TakePictures) -> None:
        super().__init__()
        self._controller, self._pictures = controller, pictures
        self.takes: tuple[OwnTake, ...] = ()
        self._badges: Mapping[str, str] = {}
        self.current = -1
        self._pressed: QPoint | None = None
        self.accessible: object = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        policy = QSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)
        labelled(
            self, description="Arrow keys choose a take, Enter looks at it, Delete deletes it."
        )
        make_list_accessible(self, self)
        controller.take_chosen.connect(self.update)
        controller.look.theme_changed.connect(self.update)

    # What is shown

    def show_takes(self, takes: tuple[OwnTake, ...], badges: Mapping[str, str]) -> None:
        """Show these."""
        here = {take.id: badges[take.id] for take in takes if take.id in badges}
        if (takes, here) == (self.takes, self._badges):
            return
        has_other_height = len(takes) != len(self.takes)
        self.takes, self._badges = takes, here
        self.current = min(self.current, len(takes) - 1)
        if has_other_height:
            self._fit()
        self.update()

    @property
    def grid(self) -> Grid:
        """Where each take is."""
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        return Grid(len(self.takes), self.width(), self.fontMetrics().height(), is_mirrored)

    @property
    def chosen(self) -> list[str]:
        """The id of the take at the keyboard; nothing when there is none."""
        return [self.takes[self.current].id] if 0 <= self.current < len(self.takes) else []

    def hasHeightForWidth(self) -> bool:
        """Narrower is higher."""
        return True

    def heightForWidth(self, width: int) -> int:
        """As high as its rows."""
        return Grid(len(self.takes), width, self.fontMetrics().height()).height

    def sizeHint(self) -> QSize:
        """Five beside each other."""
        line = self.fontMetrics().height()
        return QSize(line * 12, self.heightForWidth(max(self.width(), line * 6)))

    def minimumSizeHint(self) -> QSize:
        """One column."""
        return QSize(self.fontMetrics().height() * 3, self.sizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the height of the rows."""
        super().resizeEvent(event)
        if event.oldSize().width() != event.size().width():
            self._fit()

    def _fit(self) -> None:
        height = self.heightForWidth(self.width())
        if height != self.height():
            self.setFixedHeight(height)
        self.updateGeometry()

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the takes that are in view."""
        grid = self.grid
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            for number, take in enumerate(self.takes):
                rect = grid.rect(number)
                if rect.intersects(event.rect()):
                    self._paint(painter, rect, number, take)

    def _paint(self, painter: QPainter, rect: QRect, number: int, take: OwnTake) -> None:
        theme, line = self._controller.look.theme, self.fontMetrics().height()
        remark = self._badges.get(take.id, "")
        is_open = take.id == self._controller.chosen_take
        has_keys = number == self.current and self.hasFocus()
        edge = "focus" if has_keys else "accent" if is_open else "warning" if remark else "line"
        painter.setPen(QPen(theme.colour(edge), 2 if has_keys or is_open else 1))
        painter.setBrush(theme.colour("selection" if is_open else "field"))
        painter.drawRoundedRect(QRectF(rect).adjusted(1, 1, -1, -1), 4, 4)
        below = line if remark or take.left_out else 0
        room = rect.adjusted(5, 4, -5, -4 - below)
        ratio, width = self.devicePixelRatioF(), line_width(theme, QFontMetricsF(self.font()))
        picture = self._pictures.picture(take, room.size(), ratio, theme, width)
        painter.setOpacity(_PALE if take.left_out else 1.0)
        painter.drawPixmap(room.topLeft(), picture)
        painter.setOpacity(1.0)
        if below:
            self._paint_remark(painter, rect, tr("left out") if take.left_out else remark, take)

    def _paint_remark(self, painter: QPainter, rect: QRect, words: str, take: OwnTake) -> None:
        theme, line = self._controller.look.theme, self.fontMetrics().height()
        name, colour = ("eye-off", "muted") if take.left_out else ("triangle-alert", "warning")
        side = line * 0.72
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        x = rect.right() - 5 - side if is_mirrored else rect.left() + 5
        y = rect.bottom() - line - 1 + (line - side) / 2
        paint_icon(painter, QRectF(x, y, side, side), name, theme.colour(colour))
        font = self.font()
        font.setPointSizeF(font.pointSizeF() * 0.85)
        painter.setFont(font)
        start, end = (5, 7 + side) if is_mirrored else (7 + side, 5)
        top, width = rect.bottom() - line - 2, rect.width() - start - end
        room = QRectF(rect.left() + start, top, width, line)
        shown = QFontMetricsF(font).elidedText(words, Qt.TextElideMode.ElideRight, width)
        painter.setPen(theme.colour(colour))
        sides = Qt.AlignmentFlag.AlignRight if is_mirrored else Qt.AlignmentFlag.AlignLeft
        painter.drawText(room, int(sides | Qt.AlignmentFlag.AlignVCenter), shown)

    # Mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a take, or begin to drag it."""
        number = self.grid.at(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and number >= 0:
            self._pressed = event.position().toPoint()
            self._go_to(number)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Carry the take once the mouse has gone far enough."""
        place = event.position().toPoint()
        if self._pressed is None or not self.chosen:
            return
        if (place - self._pressed).manhattanLength() >= QApplication.startDragDistance():
            self._pressed = None
            drag, data = QDrag(self), QMimeData()
            data.setData(TAKES_MIME, "\n".join(self.chosen).encode())
            drag.setMimeData(data)
            drag.setPixmap(self.grab(self.grid.rect(self.current)))
            drag.exec(Qt.DropAction.MoveAction)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Look at what was clicked."""
        pressed, self._pressed = self._pressed, None
        is_here = self.grid.at(event.position().toPoint()) == self.current
        if pressed is not None and is_here and self.chosen:
            self.opened.emit(self.chosen[0])

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of a take."""
        if event.reason() != QContextMenuEvent.Reason.Keyboard:
            self._go_to(self.grid.at(event.pos()))
            place = event.globalPos()
        else:
            place = self.mapToGlobal(self.grid.rect(self.current).center())
        if self.chosen:
            self.menu_asked.emit(place)

    def event(self, event: QEvent) -> bool:
        """Tell of a take in a tool tip."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            number = self.grid.at(event.pos())
            if number < 0:
                QToolTip.hideText()
            else:
                words = plain_tip(self.item_text(number))
                QToolTip.showText(event.globalPos(), words, self, self.grid.rect(number))
            return True
        return super().event(event)

    # Keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows choose, Enter looks, Delete deletes."""
        key = Qt.Key(event.key())
        reached = self.grid.beside(self.current, key)
        if reached >= 0:
            self._go_to(reached)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.chosen:
            self.opened.emit(self.chosen[0])
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace) and self.chosen:
            self.delete_asked.emit(self.chosen)
        else:
            super().keyPressEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Begin at the first take."""
        super().focusInEvent(event)
        if self.current < 0 and self.takes:
            self.current = 0
        tell_current(self)

    def _go_to(self, number: int) -> None:
        if 0 <= number < len(self.takes):
            self.current = number
            tell_current(self)
            self.current_changed.emit()
            self.update()

    # For screen readers

    def item_count(self) -> int:
        """How many takes there are."""
        return len(self.takes)

    def item_text(self, number: int) -> str:
        """What is known of a take."""
        take = self.takes[number]
        seconds = f"{take.end_s - take.start_s:.1f}"
        said = [tr("Take {number}, {seconds} s", number=number + 1, seconds=seconds)]
        recording = self._controller.recordings.get(take.recording)
        said += [recording.person] if recording is not None and recording.person else []
        said += [self._badges[take.id]] if take.id in self._badges else []
        said += [tr("left out")] if take.left_out else []
        return ", ".join(said)

    def item_rect(self, number: int) -> QRect:
        """Where a take is on the screen."""
        rect = self.grid.rect(number)
        return QRect(self.mapToGlobal(rect.topLeft()), rect.size())

    def current_item(self) -> int:
        """The take that the keyboard is at, or -1."""
        return self.current


def takes_in(data: QMimeData) -> Collection[str]:
    """The ids of the takes that are carried; none when it is something else."""
    text = bytes(data.data(TAKES_MIME).data()).decode(errors="replace")
    return [one for one in text.split("\n") if one]


# What is remarkable about a take: too short, too still, or taken for another gesture.

FEW_TAKES = 3
"""With fewer it is not known what is usual."""
_SHORT, _LONG, _STILL = 0.5, 2.0, 0.4


class Badges:
    """The remarks on takes by id; measured once for each stretch."""

    def __init__(self, controller: GestureController) -> None:
        self._controller = controller
        self._strengths: dict[OwnTake, float] = {}

    def all(self) -> dict[str, str]:
        """The remark on each take that has one."""
        found: dict[str, str] = {}
        for gesture in self._controller.gestures.values():
            found |= self._measured(gesture.takes)
        return {**self._learned(), **found}

    def _measured(self, takes: Sequence[OwnTake]) -> dict[str, str]:
        """What its own length and strength say, beside those of the others."""
        if len(takes) < FEW_TAKES:
            return {}
        usual_s = median(take.end_s - take.start_s for take in takes)
        usual = median(map(self._strength, takes))
        found = {}
        for take in takes:
            length = (take.end_s - take.start_s) / usual_s if usual_s else 1.0
            if length < _SHORT:
                found[take.id] = tr("too short")
            elif length > _LONG:
                found[take.id] = tr("too long")
            elif self._strength(take) < _STILL * usual:
                found[take.id] = tr("too still")
        return found

    def _strength(self, take: OwnTake) -> float:
        """How much the acceleration changes during a take, in m/s²."""
        if take not in self._strengths:
            acc = self._controller.take_samples(take).acc
            spread = acc.std(axis=0) if len(acc) else np.zeros(3)
            self._strengths[take] = float(np.sqrt((spread**2).sum()))
        return self._strengths[take]

    def _learned(self) -> dict[str, str]:
        """What the recogniser took a take for when it had not learned from it."""
        controller = self._controller
        if controller.recogniser is None or not controller.is_up_to_date:
            return {}
        by_method, gestures = findings_of(controller.recogniser.report), controller.gestures
        findings = next((by_method[name] for name in METHODS if name in by_method), None)
        found = {}
        for one in findings.left_out if findings is not None else ():
            take, other = id_of_take(one, gestures), gestures.get(one.recognised)
            if take and one.recognised != one.gesture:
                words = tr("looks like {gesture}", gesture=other.title) if other else ""
                found[take] = words or tr("not recognised")
        return found
