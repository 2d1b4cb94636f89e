"""The list of the palette, out of which blocks are dragged, clicked and chosen by keys."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QEvent, QPoint, QPointF, QRect, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QFontInfo,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
)
from PySide6.QtWidgets import QAbstractScrollArea, QToolTip, QWidget

from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.packs import Pack
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.editing.cargo import Grip
from nep_studio.ui.words import tr

from .accessible_list import make_list_accessible, tell_current
from .entries import Drawer, Entry, Stock, tip
from .shelf_layout import ShelfLayout, ShelfPainter

# A painted list of the palette's entries: one widget, however many blocks it has.

WHEEL_LINES = 3

Anchor = Callable[[ShelfLayout], float]
"""How far a list is scrolled, which its layout tells."""


class ShelfView(QAbstractScrollArea):
    """Shows entries, and which one the keyboard and the mouse are at.

    They come, and get their places, when somebody looks at them: a window that opens is resized,
    filled and refreshed many times before.

    ``drawer_shown`` brings the drawer at the top of the view; ``left_upwards`` says that the
    arrow keys go on to what is above.
    """

    drawer_shown = Signal(object)
    left_upwards = Signal()

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self._filled: tuple[Stock, Sequence[Entry]] = (Stock(canvas.editor), ())
        self._fill: Callable[[], None] | None = None
        self._hovered = self._current = -1
        self._is_delete = False
        self._made: ShelfLayout | None = None
        self._is_settled = False
        self._anchor: Anchor = _top
        self._settle = QTimer(self, singleShot=True, interval=0)
        self._settle.timeout.connect(self._on_settle)
        self.accessible: object = None
        self.setFrameShape(QAbstractScrollArea.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOn)
        self.verticalScrollBar().valueChanged.connect(self._on_scrolled)
        make_list_accessible(self, self)

    # What is shown

    def fill_later(self, fill: Callable[[], None]) -> None:
        """Let ``fill`` show entries as soon as somebody looks."""
        self._fill = fill
        self._settle.start()
        self.viewport().update()

    def show_entries(self, stock: Stock, entries: Sequence[Entry], *, to_top: bool = False) -> None:
        """Show these; the place in the list stays, unless it is to begin at the top."""
        anchor = self._anchor if self._made is None else _drawer_anchor(self._made, self._scrolled)
        current = self.current
        self._filled = stock, entries
        self._hovered = -1
        self._current = list(entries).index(current) if current and current in entries else -1
        self._lay_out(_top if to_top else anchor)

    def refresh(self) -> None:
        """Take the theme, the words and the direction of the canvas."""
        self._lay_out(self._way_from_spot())

    @property
    def entries(self) -> Sequence[Entry]:
        """What is listed."""
        self._catch_up()
        return self._filled[1]

    def show_drawer(self, drawer: str) -> None:
        """Scroll to the beginning of a drawer."""
        spot = self._layout.first_of(drawer)
        if spot is not None:
            self.verticalScrollBar().setValue(round(spot.y))

    def shown_drawer(self) -> Drawer | None:
        """The drawer at the top of the view."""
        line = self._layout.line
        return self._layout.drawer_at(self.verticalScrollBar().value() + line)

    def set_delete(self, is_delete: bool) -> None:
        """Show that blocks let go here are deleted."""
        if is_delete != self._is_delete:
            self._is_delete = is_delete
            self.viewport().update()

    def rect_of(self, number: int) -> QRect:
        """Where an entry is in the viewport."""
        rect = self._layout.block_rect(self._layout.spots[number])
        return rect.translated(0, -self.verticalScrollBar().value()).toAlignedRect()

    def choose_next(self, step: int) -> None:
        """Go to the next entry that can be chosen, or the one before."""
        count, number = len(self.entries), self._current + step
        if self._current < 0:
            number = self._first_in_view() if step > 0 else -1
        while 0 <= number < count and not self.entries[number].is_choosable:
            number += step
        if 0 <= number < count:
            self._go_to(number)
        elif step < 0:
            self.left_upwards.emit()

    def choose_first(self) -> None:
        """Go to the first entry that can be chosen."""
        choosable = (n for n, entry in enumerate(self.entries) if entry.is_choosable)
        self._go_to(next(choosable, -1))

    @property
    def current(self) -> Entry | None:
        """The entry that the keyboard is at."""
        entries = self.entries  # first: with them comes which one it is
        return entries[self._current] if self._current >= 0 else None

    @property
    def _stock(self) -> Stock:
        """What the samples of the entries are in."""
        self._catch_up()
        return self._filled[0]

    @property
    def _layout(self) -> ShelfLayout:
        """Where the entries are now."""
        self._catch_up()
        return self._made if self._made is not None else self._make_layout()

    @property
    def _scrolled(self) -> int:
        return self.verticalScrollBar().value()

    def _way_from_spot(self) -> Anchor:
        """The entry at the top stays there, however high those above it will be."""
        return self._anchor if self._made is None else _spot_anchor(self._made, self._scrolled)

    def _catch_up(self) -> None:
        """Show the entries that are to be shown by now."""
        fill, self._fill = self._fill, None
        if fill is not None:
            fill()

    def _lay_out(self, anchor: Anchor) -> None:
        """Give the entries new places as soon as somebody needs them."""
        self._made, self._is_settled, self._anchor = None, False, anchor
        self._settle.start()
        self.viewport().update()

    def _on_settle(self) -> None:
        if self.isVisible():
            _ = self._layout

    def _make_layout(self) -> ShelfLayout:
        width = max(self.viewport().width(), 120)
        block_font = self._canvas.look.block_font
        size = QFontInfo(self.font()).pixelSize() / QFontInfo(block_font).pixelSize()
        self._made = layout = ShelfLayout(self._canvas, float(width), size)
        layout.fill(*self._filled)
        self._painter = ShelfPainter(self._canvas, layout)
        bar = self.verticalScrollBar()
        bar.setRange(0, layout.lowest_top(self.viewport().height()))
        bar.setEnabled(bar.maximum() > 0)
        bar.setPageStep(self.viewport().height())
        bar.setSingleStep(round(layout.line * WHEEL_LINES))
        bar.setValue(round(self._anchor(layout)))
        self._is_settled = True
        self._on_scrolled()
        return layout

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the entries in view."""
        layout = self._layout
        top = self._scrolled
        exposed = event.rect().translated(0, top)
        with QPainter(self.viewport()) as painter:
            painter.fillRect(event.rect(), self._canvas.look.theme.colour("panel"))
            painter.translate(0, -top)
            spots = layout.between(exposed.top() - 8, exposed.bottom() + 8)
            for number, spot in (
                list(enumerate(spots, start=layout.spots.index(spots[0]))) if spots else []
            ):
                is_current = number == self._current and self.hasFocus()
                if is_current or (number == self._hovered and spot.entry.is_choosable):
                    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                    self._painter.paint_mark(painter, spot, is_current=is_current)
                self._painter.paint(painter, spot)
            painter.translate(0, top)
            if self._is_delete:
                self._painter.paint_delete(painter, QRectF(self.viewport().rect()))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let the blocks be as narrow as the palette; the one at the top stays there."""
        super().resizeEvent(event)
        self._lay_out(self._way_from_spot())

    def scrollContentsBy(self, dx: int, dy: int) -> None:
        """Move what is painted, and paint the rest."""
        if self._is_settled:
            self.viewport().scroll(0, dy)

    def _on_scrolled(self) -> None:
        drawer = self.shown_drawer()
        if drawer is not None:
            self.drawer_shown.emit(drawer)

    def _go_to(self, number: int) -> None:
        self._current = number
        if number >= 0:
            spot = self._layout.spots[number]
            bar = self.verticalScrollBar()
            if spot.y < bar.value():
                bar.setValue(round(spot.y - self._layout.line))
            elif spot.bottom > bar.value() + self.viewport().height():
                bar.setValue(round(spot.bottom + self._layout.line - self.viewport().height()))
            tell_current(self)
        self.viewport().update()

    def _first_in_view(self) -> int:
        top = self.verticalScrollBar().value()
        return next((n for n, spot in enumerate(self._layout.spots) if spot.y >= top), 0)

    # For screen readers

    def item_count(self) -> int:
        """How many entries there are."""
        return len(self.entries)

    def item_text(self, number: int) -> str:
        """What an entry says."""
        entry = self.entries[number]
        if entry.kind == "heading":
            return tr("Category {title}", title=entry.text)
        if entry.kind == "snippet":
            return tr("Snippet {title}", title=entry.text)
        return f"{entry.text}. {entry.note}" if entry.note else entry.text

    def item_rect(self, number: int) -> QRect:
        """Where an entry is on the screen."""
        rect = self.rect_of(number)
        return QRect(self.viewport().mapToGlobal(rect.topLeft()), rect.size())

    def current_item(self) -> int:
        """The entry that the keyboard is at, or -1."""
        self._catch_up()
        return self._current


def _top(_layout: ShelfLayout) -> float:
    return 0.0


def _drawer_anchor(before: ShelfLayout, scrolled: float) -> Anchor:
    """As far from the beginning of its drawer as before."""
    kept = before.drawer_and_way(scrolled)
    return lambda layout: layout.place_of(*kept)


def _spot_anchor(before: ShelfLayout, scrolled: float) -> Anchor:
    """As far from the top of its entry as before."""
    number, way = before.spot_and_way(scrolled)
    return lambda layout: layout.spots[number].y + way if number < len(layout.spots) else 0.0


# Which keys write something.

COMMANDS = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.MetaModifier


def is_letter(event: QKeyEvent) -> bool:
    """Whether a key writes a letter, a digit or a sign, and is no command."""
    letter = event.text()
    is_written = letter.isprintable() and bool(letter.strip())
    return is_written and not event.modifiers() & COMMANDS


class Shelf(ShelfView):
    """A list of entries to take from. A click or Enter chooses one; ``typed`` brings a letter."""

    chosen = Signal(object)
    menu_asked = Signal(object, QPoint)
    typed = Signal(str)

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(canvas, parent)
        self._pressed: QPoint | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.viewport().setMouseTracking(True)

    @property
    def marked_type(self) -> str:
        """The type of the block under the mouse, or else at the keyboard; empty when none."""
        entries = self.entries  # first: with them comes which one it is
        number = self._hovered if self._hovered >= 0 else self._current
        return self.type_of(entries[number]) if number >= 0 else ""

    def type_of(self, entry: Entry) -> str:
        """The type of the block of an entry; empty for what is none."""
        return self._stock.project.blocks[entry.sample].type if entry.sample else ""

    def pack_of(self, entry: Entry) -> Pack | None:
        """The pack of the library that the block of an entry is from, or None."""
        return self._stock.pack_of(entry.sample) if entry.sample else None

    # Mouse

    def clip_of(self, entry: Entry) -> Clip | None:
        """The blocks of an entry."""
        if entry.snippet is not None:
            return entry.snippet.clip
        return self._stock.clip(entry.sample) if entry.sample else None

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a click or a drag."""
        number = self._entry_at(event.position())
        if event.button() != Qt.MouseButton.LeftButton or number < 0:
            return
        self._go_to(number)
        self._pressed = event.position().toPoint()
        clip = self.clip_of(self.entries[number])
        if clip is not None:
            self._canvas.begin_external_drag(
                clip,
                event.globalPosition().toPoint(),
                self.viewport(),
                self._grip(event.position()),
            )

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Choose what was clicked."""
        pressed, self._pressed = self._pressed, None
        number = self._entry_at(event.position())
        is_left = event.button() == Qt.MouseButton.LeftButton
        if is_left and pressed is not None and number == self._current and number >= 0:
            self.chosen.emit(self.entries[number])

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Show what is under the mouse."""
        self._hover(self._entry_at(event.position()))

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse any more."""
        self._hover(-1)
        super().leaveEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of an entry."""
        is_key = event.reason() == QContextMenuEvent.Reason.Keyboard
        number = self.current_item() if is_key else self._entry_at(QPointF(event.pos()))
        if number >= 0:
            place = self.rect_of(number).center() if is_key else event.pos()
            self.menu_asked.emit(self.entries[number], self.viewport().mapToGlobal(place))

    def viewportEvent(self, event: QEvent) -> bool:
        """Tell what a block does."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            number = self._entry_at(QPointF(event.pos()))
            entry = self.entries[number] if number >= 0 else None
            if entry is None or not entry.sample:
                QToolTip.hideText()
                return True
            words = tip(self._stock, entry.sample)
            QToolTip.showText(event.globalPos(), words, self.viewport(), self.rect_of(number))
            return True
        return super().viewportEvent(event)

    def _grip(self, point: QPointF) -> Grip | None:
        """The point of the block under a point of the viewport."""
        y = point.y() + self.verticalScrollBar().value()
        spot = self._layout.spots[self._layout.at(y)]
        if spot.chain is None:
            return None
        box, corner = spot.chain.boxes[0], self._layout.block_rect(spot).topLeft()
        left = corner.x() + (spot.width - box.width * spot.scale if box.is_mirrored else 0.0)
        return Grip(box, (point.x() - left) / spot.scale, (y - corner.y()) / spot.scale)

    def _entry_at(self, point: QPointF) -> int:
        """The entry under a point of the viewport, or -1."""
        place = QPointF(point.x(), point.y() + self.verticalScrollBar().value())
        number = self._layout.at(place.y())
        if number < 0 or not self.entries[number].is_choosable:
            return -1
        rect = self._layout.block_rect(self._layout.spots[number]).adjusted(-6, -2, 6, 2)
        return number if rect.contains(place) else -1

    def _hover(self, number: int) -> None:
        if number != self._hovered:
            self._hovered = number
            self.viewport().update()

    # Keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows choose, Enter inserts, letters go to the search."""
        key = event.key()
        steps = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}
        if key in steps:
            self.choose_next(steps[Qt.Key(key)])
        elif key in (Qt.Key.Key_Home, Qt.Key.Key_End):
            self._current = -1 if key == Qt.Key.Key_Home else len(self.entries)
            self.verticalScrollBar().setValue(0 if key == Qt.Key.Key_Home else 10**6)
            self.choose_next(1 if key == Qt.Key.Key_Home else -1)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.current is not None:
            self.chosen.emit(self.current)
        elif is_letter(event):
            self.typed.emit(event.text())
        else:
            super().keyPressEvent(event)
