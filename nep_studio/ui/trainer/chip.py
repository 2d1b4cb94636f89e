"""The block "when this gesture is made", to be dragged onto the canvas or put there by a click."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QMouseEvent, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy, QWidget

from nep_studio.blocks.operations.copying import Clip, clip_of
from nep_studio.blocks.program import PAGES
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.insert_bar_places import insert_clip
from nep_studio.ui.theme import paint_icon
from nep_studio.ui.words import tr

BLOCK = "event.gesture"
_WIDEST_LINES = 11


class GestureChip(QAbstractButton):
    """Looks like the beginning of the block. Only a press that stays a click adds it."""

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self.gesture = ""
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        self.clicked.connect(self.add_block)

    def show_gesture(self, gesture: str, title: str) -> None:
        """Be the block of this gesture."""
        self.gesture = gesture
        words = tr("when {gesture}", gesture=title)
        if words != self.text():
            self.setText(words)
            self.setToolTip(tr("Drag it onto the page, or click to add it: {words}", words=words))
            self.setAccessibleName(tr("Add the block “{words}”", words=words))
            self.updateGeometry()

    def clip(self) -> Clip:
        """The block."""
        return clip_of(self._canvas.editor.language, BLOCK, gesture=self.gesture)

    def add_block(self) -> None:
        """Put the block on the page of behaviour, where one looks."""
        self._show_behaviour()
        insert_clip(self._canvas, self.clip())

    def _show_behaviour(self) -> None:
        canvas = self._canvas
        if canvas.editor.project.kind_of_page(canvas.page) != PAGES[0]:
            canvas.show_page(PAGES[0])

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a click or a drag."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._show_behaviour()
            place = event.globalPosition().toPoint()
            self._canvas.begin_external_drag(self.clip(), place, self)
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """A click adds the block."""
        super().mouseReleaseEvent(event)

    def sizeHint(self) -> QSize:
        """Room for its words; long names are cut."""
        metrics = self.fontMetrics()
        line = metrics.height()
        words = min(metrics.horizontalAdvance(self.text()), line * _WIDEST_LINES)
        return QSize(round(words + line * 2.2), round(line * 1.75))

    def minimumSizeHint(self) -> QSize:
        """A few letters."""
        line = self.fontMetrics().height()
        return QSize(line * 5, round(line * 1.75))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint a hat of the colour of events."""
        theme, line = self._canvas.theme, self.fontMetrics().height()
        colours = theme.block("events")
        rect = QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            is_marked = self.hasFocus()
            painter.setPen(QPen(theme.colour("focus") if is_marked else colours.line, 2))
            painter.setBrush(colours.fill)
            painter.drawPath(_hat(rect, line))
            is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
            side = line * 0.95
            x = rect.right() - side - line * 0.4 if is_mirrored else rect.left() + line * 0.4
            middle = rect.center().y() + line * 0.1
            paint_icon(painter, QRectF(x, middle - side / 2, side, side), "hand", colours.text)
            room = rect.adjusted(line * 1.6, line * 0.2, -line * 0.4, 0)
            if is_mirrored:
                room = rect.adjusted(line * 0.4, line * 0.2, -line * 1.6, 0)
            mode = Qt.TextElideMode.ElideRight
            shown = self.fontMetrics().elidedText(self.text(), mode, round(room.width()))
            painter.setPen(colours.text)
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter, shown)


def _hat(rect: QRectF, line: float) -> QPainterPath:
    """A rounded rectangle with the low hump that blocks have which begin a stack."""
    hump, corner = line * 0.22, line * 0.25
    body = rect.adjusted(0, hump, 0, 0)
    path = QPainterPath()
    path.addRoundedRect(body, corner, corner)
    crest = QPainterPath(QPointF(body.left() + corner, body.top() + corner))
    wide = min(line * 4, body.width() / 2)
    crest.lineTo(body.left() + corner / 2, body.top() + 1)
    crest.cubicTo(
        body.left() + wide * 0.3,
        rect.top() - hump,
        body.left() + wide * 0.7,
        rect.top() - hump / 2,
        body.left() + wide,
        body.top() + 1,
    )
    crest.closeSubpath()
    return path.united(crest)
