"""Mouse and finger: what the system reports becomes the moves of one gesture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QTouchEvent

from ..keyboard.carrying import KeyboardCarry
from ..note_editing import NotePress
from .choose import choose, problem_at
from .gesture import Pointer
from .pinch_zoom import PinchZoom
from .press import Press

if TYPE_CHECKING:
    from ..canvas import Canvas


class Pointing:
    """The pointer over one canvas."""

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self._last: Pointer | None = None
        self.is_space_down = False
        self.was_cancelled_by_right = False
        """Whether the right button ended a gesture: then it opens no menu."""

    def press(self, event: QMouseEvent) -> None:
        """A mouse button went down."""
        canvas = self._canvas
        self.was_cancelled_by_right = canvas.keyboard.is_space_pressed = False
        if isinstance(canvas.gesture, KeyboardCarry):  # the mouse begins something of its own
            canvas.cancel_gesture()
        if canvas.gesture is not None:
            if event.button() == Qt.MouseButton.RightButton:
                self.was_cancelled_by_right = True
                canvas.cancel_gesture()
            return
        self._begin(self._pointer(event.position(), event.button(), event.modifiers()))

    def double_click(self, event: QMouseEvent) -> None:
        """A second press soon after the first: a click of it opens the block."""
        self.press(event)
        if isinstance(self._canvas.gesture, Press | NotePress):
            self._canvas.gesture.is_double = True

    def move(self, event: QMouseEvent) -> None:
        """The mouse moved: with a gesture, or over the page."""
        canvas, last = self._canvas, self._last
        if canvas.gesture is None or last is None or isinstance(canvas.gesture, KeyboardCarry):
            self._hover(event.position())
        elif not event.buttons() & last.button:  # the release went elsewhere
            canvas.cancel_gesture()
        else:
            self.move_to(event.position())

    def release(self, event: QMouseEvent) -> None:
        """A mouse button came up."""
        if self._last is not None and event.button() == self._last.button:
            self.release_at(event.position())

    def move_to(self, view: QPointF) -> None:
        """Bring the gesture to a point of the view."""
        if self._canvas.gesture is not None:
            self._last = self._moved(view)
            self._canvas.gesture.move(self._canvas, self._last)

    def release_at(self, view: QPointF) -> None:
        """End the gesture at a point of the view."""
        gesture, self._canvas.gesture = self._canvas.gesture, None
        if gesture is not None:
            self._last = self._moved(view)
            gesture.release(self._canvas, self._last)

    def take_over(self, view: QPointF) -> None:
        """Follow a pointer that was pressed elsewhere, such as in the palette."""
        self._last = self._pointer(view)

    def repeat(self) -> None:
        """Tell the gesture again where the pointer is: the page has moved under it."""
        if self._last is not None:
            self.move_to(self._last.view)

    def touch(self, event: QTouchEvent) -> bool:
        """Fingers went down, moved or came up; gives whether the canvas takes them."""
        canvas, kind = self._canvas, event.type()
        points = [point.position() for point in event.points()]
        if kind == QEvent.Type.TouchCancel:
            canvas.cancel_gesture()
        elif kind == QEvent.Type.TouchBegin and len(points) == 1:
            self._begin(self._pointer(points[0], is_touch=True))
        elif kind == QEvent.Type.TouchEnd:
            self.release_at(points[0])
        elif len(points) >= 2:
            self._pinch(points[0], points[1])
        else:
            self.move_to(points[0])
        return True

    def leave(self) -> None:
        """The pointer left the view."""
        if self._canvas.gesture is None:
            self._canvas.viewport().unsetCursor()

    def _begin(self, pointer: Pointer) -> None:
        canvas = self._canvas
        self._last = pointer
        canvas.fields.close()
        gesture = choose(canvas, pointer, canvas.hit(pointer.view))
        if gesture is not None:
            canvas.begin(gesture)

    def _pinch(self, first: QPointF, second: QPointF) -> None:
        canvas = self._canvas
        if not isinstance(canvas.gesture, PinchZoom):
            canvas.cancel_gesture()
            canvas.begin(PinchZoom(canvas, first, second))
        elif isinstance(canvas.gesture, PinchZoom):
            canvas.gesture.pinch(canvas, first, second)

    def _hover(self, view: QPointF) -> None:
        """Show by the cursor what a press would do."""
        shape = self._cursor(view)
        if self._canvas.viewport().cursor().shape() != shape:
            self._canvas.viewport().setCursor(shape)

    def _cursor(self, view: QPointF) -> Qt.CursorShape:
        canvas = self._canvas
        if self.is_space_down:
            return Qt.CursorShape.OpenHandCursor
        if problem_at(canvas, canvas.to_page(view)):
            return Qt.CursorShape.PointingHandCursor
        hit = canvas.hit(view)
        if hit is None:
            return Qt.CursorShape.ArrowCursor
        is_pressed = hit.piece is not None and hit.piece.piece in ("field", "button")
        return Qt.CursorShape.PointingHandCursor if is_pressed else Qt.CursorShape.OpenHandCursor

    def _moved(self, view: QPointF) -> Pointer:
        last = self._last or self._pointer(view)
        return self._pointer(view, last.button, last.modifiers, is_touch=last.is_touch)

    def _pointer(
        self,
        view: QPointF,
        button: Qt.MouseButton = Qt.MouseButton.LeftButton,
        modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
        *,
        is_touch: bool = False,
    ) -> Pointer:
        page = self._canvas.to_page(view)
        return Pointer(QPointF(view), page, button, modifiers, is_touch)
