"""The reference for the canvas: a plain QGraphicsScene with an item for each block.

It is what most block editors made with Qt do. It shares with ours the program, the layout and the
painter of a block, so that only the way of showing them differs: here each block is an item that
paints itself, a stack is an item that carries them, and what a dragged stack would snap to is
asked of the scene. The items of a stack are not inside each other, since that would be slower.
"""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QMouseEvent, QPainter
from PySide6.QtWidgets import (
    QGraphicsItem,
    QGraphicsRectItem,
    QGraphicsScene,
    QGraphicsView,
    QStyleOptionGraphicsItem,
    QWidget,
)

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Changes
from nep_studio.ui.canvas.layout.boxes import Chain, Measures, TextWidths
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.canvas.layout.page import Placed, boxes_of
from nep_studio.ui.canvas.painting.painter import BlockPainter
from nep_studio.ui.theme.colours import Theme

SNAP_RADIUS = 28.0
EVERYWHERE = Rect(-1e7, -1e7, 2e7, 2e7)


class BlockItem(QGraphicsItem):
    """A block with its words and fields."""

    def __init__(self, placed: Placed, block_painter: BlockPainter, stack: StackItem) -> None:
        super().__init__(stack)
        self.stack = stack
        self._boxes = (Placed(placed.box, 0.0, 0.0),)
        self._painter = block_painter
        self._rect = QRectF(-1, -1, placed.box.width + 2, placed.box.height + 8)
        self.is_statement = placed.box.outline in ("statement", "hat", "cap")
        self.foot = QPointF(placed.x, placed.y + placed.box.height)
        self.setPos(placed.x, placed.y)

    def boundingRect(self) -> QRectF:
        """The block with its line and tab."""
        return self._rect

    def paint(
        self, painter: QPainter, option: QStyleOptionGraphicsItem, widget: QWidget | None = None
    ) -> None:
        """Paint the block alone: those inside it are items too."""
        self._painter.paint(painter, self._boxes, 1.0)


class StackItem(QGraphicsItem):
    """What carries the blocks of a stack."""

    def __init__(self, chain: Chain, block_painter: BlockPainter) -> None:
        super().__init__()
        self.setFlag(QGraphicsItem.GraphicsItemFlag.ItemHasNoContents)
        self.height = chain.height
        for placed in boxes_of(chain, EVERYWHERE):
            BlockItem(placed, block_painter, self)

    def boundingRect(self) -> QRectF:
        """Nothing: it is not seen itself."""
        return QRectF()


class ReferenceView(QGraphicsView):
    """Shows the behaviour page of a project; a stack can be dragged by its first block."""

    def __init__(self, editor: Editor, theme: Theme) -> None:
        super().__init__()
        self.editor = editor
        widths = TextWidths(self.font())
        measures = Measures(widths.line, widths.__getitem__)
        self._layout = Layout(editor.project, editor.language, measures)
        self._block_painter = BlockPainter(theme, editor.language, measures, self.font())
        self._scene = QGraphicsScene(self)
        self._stacks: dict[str, StackItem] = {}
        self._dragged: StackItem | None = None
        self._grip = QPointF()
        self._marker = self._new_marker()
        for stack in editor.project.pages["behaviour"]:
            self._add(stack.id)
        room = 200
        self._scene.setSceneRect(
            self._scene.itemsBoundingRect().adjusted(-room, -room, 10 * room, room)
        )
        self._scene.setBackgroundBrush(QBrush(theme.colour("canvas")))
        self.setScene(self._scene)
        self.setFrameShape(QGraphicsView.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        editor.history.listen(self._on_changes)

    def look_at(self, corner: QPointF) -> None:
        """Show the page from a place on."""
        self.horizontalScrollBar().setValue(round(corner.x()))
        self.verticalScrollBar().setValue(round(corner.y()))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the stack under the pointer."""
        item = self.itemAt(event.position().toPoint())
        if isinstance(item, BlockItem):
            self._dragged = item.stack
            self._dragged.setZValue(1)
            self._grip = self.mapToScene(event.position().toPoint()) - item.stack.pos()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Carry the stack, and mark what it would snap to."""
        if self._dragged is not None:
            self._dragged.setPos(self.mapToScene(event.position().toPoint()) - self._grip)
            self._show_snap(self._dragged)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Leave the stack where it is."""
        self._dragged = None
        self._marker.hide()

    @property
    def is_carrying(self) -> bool:
        """Whether a stack is being dragged."""
        return self._dragged is not None

    def place_of(self, stack: str) -> QPointF:
        """Where a stack is, to see that it has been dragged."""
        return self._stacks[stack].pos()

    def _show_snap(self, dragged: StackItem) -> None:
        """Look for the nearest foot of a statement at the head and at the foot of the stack."""
        nearest, least = None, SNAP_RADIUS
        for end in (dragged.pos(), dragged.pos() + QPointF(0, dragged.height)):
            area = QRectF(end.x() - SNAP_RADIUS, end.y() - SNAP_RADIUS, 56, 56)
            for item in self._scene.items(area):
                if isinstance(item, BlockItem) and item.is_statement and item.stack is not dragged:
                    place = item.stack.pos() + item.foot
                    distance = (place - end).manhattanLength()
                    if distance < least:
                        nearest, least = place, distance
        self._marker.setVisible(nearest is not None)
        if nearest is not None:
            self._marker.setPos(nearest)

    def _on_changes(self, changes: Changes) -> None:
        self._layout.forget(changes.owners)
        for stack_id in changes.stacks:
            if (old := self._stacks.pop(stack_id, None)) is not None:
                self._scene.removeItem(old)
            if stack_id in self.editor.project.stacks:
                self._add(stack_id)

    def _add(self, stack_id: str) -> None:
        stack = self.editor.project.stacks[stack_id]
        item = StackItem(self._layout.chain(stack.body, owner=stack_id), self._block_painter)
        item.setPos(stack.x, stack.y)
        self._scene.addItem(item)
        self._stacks[stack_id] = item

    def _new_marker(self) -> QGraphicsRectItem:
        marker = QGraphicsRectItem(0, 0, 160, 4)
        marker.setBrush(QBrush(Qt.GlobalColor.black))
        marker.setZValue(2)
        marker.hide()
        self._scene.addItem(marker)
        return marker
