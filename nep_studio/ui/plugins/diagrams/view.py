"""The widget that shows one diagram: its boxes and arrows are chosen, joined and folded here."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QKeyEvent,
    QKeySequence,
    QMouseEvent,
    QPainter,
    QPainterPathStroker,
)

from nep_studio.blocks.states import ANY
from nep_studio.ui.labels import labelled
from nep_studio.ui.widgets.drawing_board import ARROWS, DrawingBoard, next_to
from nep_studio.ui.words import count_words, is_right_to_left, tr
from nep_studio.ui.workbench.palette.accessible_list import make_list_accessible, tell_current

from .model import Diagram, Item, Key
from .painting import DiagramPainter, Marks
from .shapes import Measures, Shapes, shapes_of

if TYPE_CHECKING:
    from nep_studio.ui.theme.look import Look

EMPTY = Diagram("states", "", "", (), ())
NEAR = 0.6
"""How near to an arrow a click may be, in lines of text."""


class DiagramView(DrawingBoard[Key]):
    """Shows a diagram; the signals say what the person wants with it.

    ``chosen`` gives the block of a box or an arrow, ``fold_wanted`` that of a part;
    ``arrow_wanted`` the states at its ends; ``rename_wanted`` and ``delete_wanted`` give a key,
    and ``menu_wanted`` one, or None, and the place on the screen.
    """

    chosen = Signal(str)
    fold_wanted = Signal(str)
    arrow_wanted = Signal(str, str)
    rename_wanted = Signal(object)
    delete_wanted = Signal(object)
    copy_wanted = Signal()
    menu_wanted = Signal(object, object)

    def __init__(self, look: Look) -> None:
        super().__init__(look)
        self.diagram = EMPTY
        self.shapes = Shapes()
        self._statuses: Mapping[str, str] = {}
        self._from: str | None = None
        """The state from which an arrow is being drawn."""
        self._new_arrow: tuple[QPointF, QPointF] | None = None
        self.accessible: object = None
        make_list_accessible(self, self)
        labelled(
            self,
            name="Diagram",
            description="The arrow keys go from box to box, with Shift from arrow to arrow. "
            "Enter shows the block, Space folds a part of a tree.",
        )
        self.follow_words()

    @property
    def statuses(self) -> Mapping[str, str]:
        """How the boxes are while the program runs, by their keys."""
        return self._statuses

    def show_diagram(self, diagram: Diagram) -> None:
        """Show this; what is chosen stays so while it is there, and what is seen, too."""
        is_other = diagram.id != self.diagram.id
        if diagram == self.diagram and not is_other:
            return
        self.diagram = diagram
        self.lay_out()
        if self.selected not in self.shapes.rects:
            self.selected = None
        self.hovered = None
        if is_other:
            self.fit()
        else:
            self.refit()
        self.update()

    def show_statuses(self, statuses: Mapping[str, str]) -> None:
        """Show how the boxes are."""
        if statuses != self._statuses:
            self._statuses = dict(statuses)
            self.update()

    def show_block(self, block: str) -> None:
        """Choose what stands for a block; nothing where nothing does."""
        key = self.diagram.keys.get(block)
        if key != self.selected:
            self.select(key, is_told=False)

    def item_of(self, key: Key | None) -> Item | None:
        """The box that is meant."""
        if key is None or key[0] != "box":
            return None
        return next((item for item in self.diagram.items if item.key == key[1]), None)

    def block_of(self, key: Key) -> str:
        """The block that a box or an arrow stands for; "" for none."""
        if key[0] == "arrow":
            return key[1]
        item = self.item_of(key)
        return item.block if item is not None else ""

    def sizeHint(self) -> QSize:
        """Room for a small diagram."""
        return QSize(round(self.line * 24), round(self.line * 20))

    # As a drawing board

    def bounds(self) -> QRectF:
        """What holds all of it."""
        return self.shapes.bounds

    def rects(self) -> Mapping[Key, QRectF]:
        """Where boxes and the words of arrows are."""
        return self.shapes.rects

    def item_at(self, place: QPointF) -> Key | None:
        """What is at a place; an arrow also when its line is there."""
        if (found := super().item_at(place)) is not None:
            return found
        stroker, near = QPainterPathStroker(), NEAR * self.line
        stroker.setWidth(2 * near)
        for key, arrow in self.shapes.arrows.items():
            around = arrow.path.boundingRect().adjusted(-near, -near, near, near)
            if not arrow.line.words or not around.contains(place):
                continue
            if stroker.createStroke(arrow.path).contains(place):
                return "arrow", key
        return None

    def beginning(self) -> QRectF | None:
        """Where the program begins, or the top of the tree."""
        first = (self.shapes.boxes.get(key) for key in self.diagram.first)
        return next((box.rect for box in first if box is not None), None)

    def lay_out(self) -> None:
        """Place everything anew."""
        is_mirrored = is_right_to_left()
        self.shapes = shapes_of(self.diagram, Measures(self.font()), is_mirrored=is_mirrored)

    def words_of(self, key: Key) -> str:
        """What a box or an arrow is, with all its words."""
        if key[0] == "arrow":
            line = next(line for line in self.diagram.lines if line.key == key[1])
            start = line.start if line.start != ANY else tr("any rule")
            ends = tr("arrow from {start} to {end}", start=start, end=line.end)
            return f"{ends}\n{line.words}"
        item = self.item_of(key)
        assert item is not None
        return "\n".join(filter(None, (item.title, item.small, *self._remarks(item))))

    def select(self, key: Key | None, *, is_told: bool = True) -> None:
        """Choose something; a screen reader hears which item it is."""
        super().select(key, is_told=False)
        if is_told:
            tell_current(self)

    def draw(self, painter: QPainter, view: QRectF) -> None:
        """Draw the diagram."""
        marks = Marks(
            self._statuses,
            self.selected,
            self.hovered,
            self.hasFocus(),
            self._target() if self._new_arrow is not None else None,
            self._new_arrow,
        )
        theme, measures = self.studio_look.theme, Measures(self.font())
        DiagramPainter(painter, theme, measures).draw(self.shapes, marks, view)

    def open(self, key: Key) -> None:
        """Tell which block it is."""
        if block := self.block_of(key):
            self.chosen.emit(block)

    def _remarks(self, item: Item) -> list[str]:
        """What else is to be seen of a box."""
        found = []
        if item.is_first and item.shape == "state":
            found.append(tr("The program begins here."))
        if not item.is_reached and item.shape == "state":
            found.append(tr("No arrow leads here from where the program begins."))
        if item.shape == "state" and item.is_plain:
            found.append(tr("It has no blocks of its own."))
        if item.shape == "root" and item.hidden:
            hidden = item.hidden
            words = count_words(hidden, "1 part is folded away", "{n} parts are folded away")
            found.append(words)
        status = self._statuses.get(item.key)
        if status == "running":
            found.append(tr("The program is here now.") if item.shape == "state" else tr("running"))
        elif status:
            found.append(tr("succeeded") if status == "succeeded" else tr("failed"))
        return found

    # As a list, for screen readers

    def item_count(self) -> int:
        """How many boxes and arrows there are."""
        return len(self.shapes.rects)

    def item_text(self, number: int) -> str:
        """What a box or an arrow is."""
        return self.words_of(list(self.shapes.rects)[number]).replace("\n", ", ")

    def item_rect(self, number: int) -> QRect:
        """Where it is on the screen."""
        rect = list(self.shapes.rects.values())[number]
        corner = self.in_widget(rect.topLeft())
        inside = QRectF(corner, rect.size() * self.scale).toAlignedRect()
        return QRect(self.mapToGlobal(inside.topLeft()), inside.size())

    def current_item(self) -> int:
        """The one that the keyboard is at, or -1."""
        keys = list(self.shapes.rects)
        return keys.index(self.selected) if self.selected in keys else -1

    # New arrows

    @property
    def _is_of_states(self) -> bool:
        return self.diagram.kind == "states"

    def _target(self) -> str | None:
        """The state over which a new arrow ends."""
        assert self._new_arrow is not None
        key = super().item_at(self._new_arrow[1])
        item = self.item_of(key)
        return item.key if item is not None and item.shape == "state" else None

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin an arrow at a state, else move the diagram."""
        super().mousePressEvent(event)
        item = self.item_of(self.item_at(self.in_drawing(event.position())))
        is_left = event.button() == Qt.MouseButton.LeftButton
        if is_left and item is not None and item.shape == "state":
            self._from = item.key

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Draw an arrow from the state that was pressed."""
        if self._from is None or self._pressed is None:
            super().mouseMoveEvent(event)
            return
        way = event.position() - self._pressed
        if self._new_arrow is None and way.manhattanLength() <= self.line / 3:
            return
        self._has_moved = True
        start = self.shapes.boxes[self._from].rect.center()
        self._new_arrow = (start, self.in_drawing(event.position()))
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End an arrow at a state, or choose what is there."""
        start, target = self._from, self._target() if self._new_arrow is not None else None
        self._from = self._new_arrow = None
        self.update()
        super().mouseReleaseEvent(event)
        if start is not None and target not in (None, start):
            self.arrow_wanted.emit(start, target)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Fold a part of a tree, or unfold it."""
        item = self.item_of(self.item_at(self.in_drawing(event.position())))
        if item is not None and item.can_fold:
            self.fold_wanted.emit(item.key)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of what is there."""
        if event.reason() == QContextMenuEvent.Reason.Mouse:
            key = self.item_at(self.in_drawing(QPointF(event.pos())))
            self.select(key)
            place = event.globalPos()
        else:
            key = self.selected
            middle = self.place_of(key) if key is not None else QPointF(self.rect().center())
            place = self.mapToGlobal(middle.toPoint())
        self.menu_wanted.emit(key, place)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """F2 renames, Delete deletes, Space folds; else as on any board."""
        key, chosen = Qt.Key(event.key()), self.selected
        is_shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        item = self.item_of(chosen)
        if key in ARROWS:
            self._step(*ARROWS[key], "arrow" if is_shift else "box")
        elif event.matches(QKeySequence.StandardKey.Copy):
            self.copy_wanted.emit()
        elif key == Qt.Key.Key_F2 and item is not None and item.shape == "state":
            self.rename_wanted.emit(chosen)
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace) and chosen is not None:
            self.delete_wanted.emit(chosen)
        elif key == Qt.Key.Key_Space and item is not None and item.can_fold:
            self.fold_wanted.emit(item.key)
        elif key == Qt.Key.Key_Escape and self._new_arrow is not None:
            self._from = self._new_arrow = None
            self.update()
        else:
            super().keyPressEvent(event)

    def _step(self, dx: int, dy: int, kind: str) -> None:
        """Go to the next box, or the next arrow, in a direction."""
        rects, chosen = self.shapes.rects, self.selected
        if chosen is None or chosen not in rects:
            self.select(next(iter(self._in_order()), None))
            return
        rects = {key: rect for key, rect in rects.items() if key[0] == kind or key == chosen}
        if (following := next_to(rects, chosen, dx, dy)) is not None:
            self.select(following)

    def _in_order(self) -> list[Key]:
        """The boxes, with where it begins first."""
        first: list[Key] = [("box", key) for key in self.diagram.first]
        return [key for key in (*first, *self.shapes.rects) if key in self.shapes.rects]
