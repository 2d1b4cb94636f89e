"""A drawing that is moved about and zoomed, and whose items are chosen with the mouse or keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Generic, TypeVar

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QFontMetricsF,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QToolTip, QWidget

from nep_studio.ui.labels import follow_words, plain_tip
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import is_right_to_left

Key = TypeVar("Key")
"""What an item is known by."""

SMALLEST, LARGEST = 0.25, 2.5
SMALLEST_FIT = 0.6
"""A drawing that fits only smaller than this is not made smaller: it is moved about instead."""
ZOOM_STEP = 1.2
WHEEL_NOTCH = 120
MARGIN = 1.2
"""What is left free around the drawing, in lines of text."""
ARROWS = {
    Qt.Key.Key_Left: (-1, 0),
    Qt.Key.Key_Right: (1, 0),
    Qt.Key.Key_Up: (0, -1),
    Qt.Key.Key_Down: (0, 1),
}


def next_to(rects: Mapping[Key, QRectF], key: Key, dx: int, dy: int) -> Key | None:
    """The nearest item in a direction: what an arrow key goes to."""
    start = rects[key].center()
    best: tuple[float, Key] | None = None
    for other, rect in rects.items():
        way = rect.center() - start
        ahead = way.x() * dx + way.y() * dy
        aside = abs(way.x() * dy) + abs(way.y() * dx)
        far = ahead + 2 * aside
        if other != key and ahead > 1 and (best is None or far < best[0]):
            best = (far, other)
    return best[1] if best else None


class DrawingBoard(QWidget, Generic[Key]):
    """What draws something says where its items are, what they are in words, and opens them."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self.studio_look = look
        self.selected: Key | None = None
        self.hovered: Key | None = None
        self.scale = 1.0
        """How large it is shown."""
        self._corner = QPointF()
        self._is_fitted = True
        self._pressed: QPointF | None = None
        self._has_moved = False
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        look.theme_changed.connect(self._on_theme_changed)

    # What is drawn

    def bounds(self) -> QRectF:
        """What holds all of it, in pixels at scale 1."""
        raise NotImplementedError

    def rects(self) -> Mapping[Key, QRectF]:
        """Where the items are that can be chosen."""
        raise NotImplementedError

    def item_at(self, place: QPointF) -> Key | None:
        """What is at a place of the drawing."""
        return next((key for key, rect in self.rects().items() if rect.contains(place)), None)

    def beginning(self) -> QRectF | None:
        """What is shown of a drawing that is too wide; None: the side where reading begins."""
        return None

    def words_of(self, key: Key) -> str:
        """What an item is: a line or several."""
        raise NotImplementedError

    def draw(self, painter: QPainter, view: QRectF) -> None:
        """Draw what is in ``view``."""
        raise NotImplementedError

    def lay_out(self) -> None:
        """Place everything anew: the font is another one, or the side where reading begins."""
        raise NotImplementedError

    def open(self, key: Key) -> None:
        """Do what a click or Enter on an item is for."""
        raise NotImplementedError

    # What is seen of it

    @property
    def line(self) -> float:
        """The height of a line of text."""
        return QFontMetricsF(self.font()).height()

    def follow_words(self) -> None:
        """Lay it out now, and again in other languages: some are read from the other side."""
        follow_words(self, self.redo)

    def redo(self) -> None:
        """Lay it out anew."""
        self.lay_out()
        self.refit()
        self.update()

    def refit(self) -> None:
        """Show all of what has changed, unless the person has chosen what is seen."""
        if self._is_fitted:
            self.fit()

    def select(self, key: Key | None, *, is_told: bool = True) -> None:
        """Choose something, and bring it into view; a screen reader says what, if it is told."""
        self.selected = key
        if key is not None and key in self.rects():
            self._bring_into_view(self.rects()[key])
            if is_told:
                announce(self, self.words_of(key).replace("\n", ". "))
        self.update()

    def fit(self) -> None:
        """Show all of it."""
        self._is_fitted = True
        bounds = self.bounds()
        if bounds.isEmpty():
            return
        edge = self.line * MARGIN
        bounds = bounds.adjusted(-edge, -edge, edge, edge)
        fitting = min(self.width() / bounds.width(), self.height() / bounds.height(), 1.0)
        self.scale = max(fitting, SMALLEST_FIT)
        self._corner = bounds.center() - QPointF(self.width(), self.height()) / (2 * self.scale)
        if bounds.width() * self.scale > self.width():
            end, first = bounds.right() - self.width() / self.scale, self.beginning()
            x = end if is_right_to_left() else bounds.left()
            if first is not None:
                middle = first.center().x() - self.width() / self.scale / 2
                x = min(max(middle, bounds.left()), end)
            self._corner.setX(x)
        if bounds.height() * self.scale > self.height():
            self._corner.setY(bounds.top())
        self.update()

    def zoom(self, factor: float, at: QPointF | None = None) -> None:
        """Make it larger or smaller; what is ``at`` a place of the widget stays there."""
        place = at or QPointF(self.width() / 2, self.height() / 2)
        scale = min(LARGEST, max(SMALLEST, self.scale * factor))
        self._corner += place / self.scale - place / scale
        self.scale, self._is_fitted = scale, False
        self.update()

    def pan(self, dx: float, dy: float) -> None:
        """Move it by pixels."""
        self._corner -= QPointF(dx, dy) / self.scale
        self._is_fitted = False
        self.update()

    def in_widget(self, place: QPointF) -> QPointF:
        """Where a place of the drawing is in the widget."""
        return (place - self._corner) * self.scale

    def in_drawing(self, place: QPointF) -> QPointF:
        """Which place of the drawing is at one of the widget."""
        return place / self.scale + self._corner

    def place_of(self, key: Key) -> QPointF:
        """Where the middle of an item is in the widget."""
        return self.in_widget(self.rects()[key].center())

    def _view(self) -> QRectF:
        return QRectF(
            self._corner, QPointF(self.width(), self.height()) / self.scale + self._corner
        )

    def _bring_into_view(self, rect: QRectF) -> None:
        view, edge = self._view(), self.line * MARGIN
        wanted = rect.adjusted(-edge, -edge, edge, edge)
        dx = min(0.0, wanted.left() - view.left()) or max(0.0, wanted.right() - view.right())
        dy = min(0.0, wanted.top() - view.top()) or max(0.0, wanted.bottom() - view.bottom())
        if dx or dy:
            self._corner += QPointF(dx, dy)
            self._is_fitted = False

    def _open(self, key: Key | None) -> None:
        self.select(key)
        if key is not None:
            self.open(key)

    def _go(self, dx: int, dy: int) -> None:
        rects = self.rects()
        if self.selected is None or self.selected not in rects:
            self.select(next(iter(rects), None))
        elif (following := next_to(rects, self.selected, dx, dy)) is not None:
            self.select(following)

    # Events

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw it."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), self.studio_look.theme.colour("canvas"))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setLayoutDirection(self.layoutDirection())
        painter.scale(self.scale, self.scale)
        painter.translate(-self._corner)
        self.draw(painter, self._view())
        painter.end()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show all of it still."""
        self.refit()

    def changeEvent(self, event: QEvent) -> None:
        """Lay it out anew in another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.redo()

    def event(self, event: QEvent) -> bool:
        """Tell about what is under the mouse."""
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            key = self.item_at(self.in_drawing(QPointF(event.pos())))
            words = plain_tip(self.words_of(key)) if key is not None else ""
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to move the drawing, or to choose."""
        if event.button() in (Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton):
            self._pressed, self._has_moved = event.position(), False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the drawing, or show what would be chosen."""
        if self._pressed is not None:
            way = event.position() - self._pressed
            if self._has_moved or way.manhattanLength() > self.line / 3:
                self._has_moved = True
                self.setCursor(Qt.CursorShape.ClosedHandCursor)
                self.pan(way.x(), way.y())
                self._pressed = event.position()
            return
        hovered = self.item_at(self.in_drawing(event.position()))
        if hovered != self.hovered:
            self.hovered = hovered
            pointing = Qt.CursorShape.PointingHandCursor
            self.setCursor(Qt.CursorShape.ArrowCursor if hovered is None else pointing)
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Choose what is there."""
        was_click = self._pressed is not None and not self._has_moved
        self._pressed = None
        self.setCursor(Qt.CursorShape.ArrowCursor)
        if was_click and event.button() == Qt.MouseButton.LeftButton:
            self._open(self.item_at(self.in_drawing(event.position())))

    def leaveEvent(self, event: QEvent) -> None:
        """Point at nothing."""
        self.hovered = None
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom where the mouse is; with Shift move sideways."""
        turned = event.angleDelta()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier or turned.x():
            self.pan(turned.x() or turned.y(), turned.y() if turned.x() else 0)
        else:
            self.zoom(ZOOM_STEP ** (turned.y() / WHEEL_NOTCH), event.position())
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows go on, Enter opens, + and - zoom, 0 shows all."""
        key = Qt.Key(event.key())
        if key in ARROWS:
            self._go(*ARROWS[key])
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self._open(self.selected)
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal):
            self.zoom(ZOOM_STEP)
        elif key == Qt.Key.Key_Minus:
            self.zoom(1 / ZOOM_STEP)
        elif key == Qt.Key.Key_0:
            self.fit()
        else:
            super().keyPressEvent(event)

    def _on_theme_changed(self) -> None:
        self.redo()
