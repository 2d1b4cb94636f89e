"""Mouse and finger: what the system reports becomes the moves of one gesture."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QMouseEvent, QTouchEvent

from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import Hit
from nep_studio.ui.canvas.painting.overlay import badge_rect

from .cargo import lift
from .carrying import KeyboardCarry
from .drag_blocks import DragBlocks, copy_of, pulled_out
from .gesture import Gesture, Pointer
from .notes import NotePress, note_gesture
from .reorder_parts import ReorderParts, can_reorder
from .view_gestures import Pan, PinchZoom, RubberBand

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


# A finger that rests opens the menu of what is under it.

LONG_PRESS_MS = 500
"""How long a finger rests until it means the menu."""


class LongPress(Gesture):
    """The menu is open; what the finger does means nothing more, also that it is lifted."""

    def __init__(self, canvas: CanvasHost, pointer: Pointer) -> None:
        canvas.pointing.request_menu(pointer.view.toPoint())


# A press that is not yet a click or a drag: how far it moves, and how long it lasts, decides.

ADDS = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier
ALONE = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier


class Press(Gesture):
    """A click selects, opens a field or presses a button; a drag carries, selects or scrolls."""

    def __init__(
        self, canvas: CanvasHost, pointer: Pointer, hit: Hit | None, *, problem: str = ""
    ) -> None:
        self.is_double = False
        self._start = pointer
        self._hit = hit
        self._problem = problem
        self._timer = QTimer(canvas.area, singleShot=True, interval=LONG_PRESS_MS)
        if pointer.is_touch:
            self._timer.timeout.connect(lambda: canvas.pointing.begin(LongPress(canvas, pointer)))
            self._timer.start()

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Become a drag when the pointer has moved far enough."""
        if pointer.is_far(self._start.view):
            self.cancel(canvas)
            drag = self._drag(canvas)
            canvas.pointing.begin(drag)
            drag.move(canvas, pointer)

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """It was a click."""
        self.cancel(canvas)
        is_adding = bool(self._start.modifiers & ADDS)
        if self._problem:
            canvas.news.problem_opened.emit(self._problem)
        elif self._hit is None:
            if not is_adding:
                canvas.selection.clear()
        elif is_adding:
            canvas.selection.toggle(self._hit.block)
        else:
            self._click(canvas, self._hit)

    def cancel(self, canvas: CanvasHost) -> None:
        """Nothing has happened yet."""
        self._timer.stop()
        self._timer.deleteLater()

    def _click(self, canvas: CanvasHost, hit: Hit) -> None:
        canvas.selection.set([hit.block])
        piece = hit.piece
        if piece is not None and piece.piece == "button":
            canvas.fields.press_button(hit.block, piece.kind, piece.key, piece.number)
        elif piece is not None and canvas.fields.open(hit.block, piece.key, at_pointer=True):
            return
        elif self.is_double:
            canvas.news.block_opened.emit(hit.block)

    def _drag(self, canvas: CanvasHost) -> Gesture:
        start = self._start
        if self._hit is None:
            return Pan(canvas, start) if start.is_touch else RubberBand(canvas, start)
        if can_reorder(canvas, self._hit):
            return ReorderParts(canvas, self._hit)
        held = start.modifiers & ALONE
        pulled = copy_of(canvas, self._hit) if held == ALONE else pulled_out(canvas, self._hit)
        cargo = pulled or lift(canvas, self._hit.block, alone=bool(held))
        return DragBlocks(canvas, cargo, start.page)


# Which gesture a press begins, by the button, the keys held, and what is under the pointer.


def choose(canvas: CanvasHost, pointer: Pointer, hit: Hit | None) -> Gesture | None:
    """The gesture that begins with a press; None when the button begins none."""
    is_left = pointer.button == Qt.MouseButton.LeftButton
    if pointer.button == Qt.MouseButton.MiddleButton or (is_left and canvas.pointing.is_space_down):
        return Pan(canvas, pointer)
    if not is_left:
        return None
    if hit is None and (gesture := note_gesture(canvas, pointer)) is not None:
        return gesture
    return Press(canvas, pointer, hit, problem=problem_at(canvas, pointer.page))


def problem_at(canvas: CanvasHost, at: QPointF) -> str:
    """The block whose problem badge is at a point of the page; empty when there is none."""
    if not canvas.problems.problems:
        return ""
    margin = 20 * canvas.look.measures.unit
    around = Rect(at.x() - margin, at.y() - margin, 2 * margin, 2 * margin)
    for placed in canvas.page_layout.boxes(around):
        block = placed.box.block
        if block in canvas.problems.problems and badge_rect(placed, canvas).contains(at):
            return block
    return ""


def _as_it_is_now(canvas: CanvasHost, hit: Hit | None) -> Hit | None:
    """What was under the pointer, where it is laid out now; a press means what was seen."""
    placed = canvas.page_layout.placed(hit.block) if hit is not None else None
    if hit is None or placed is None:
        return None
    if placed == hit.placed or hit.piece is None:
        return Hit(hit.block, placed, hit.piece)
    was = hit.piece
    same = (p for p in placed.box.pieces if (p.piece, p.key) == (was.piece, was.key))
    return Hit(hit.block, placed, next(same, None))


class Pointing:
    """The pointer over one canvas."""

    def __init__(self, canvas: CanvasHost) -> None:
        self.gesture: Gesture | None = None
        self._canvas = canvas
        self._last: Pointer | None = None
        self.is_space_down = False
        self.was_cancelled_by_right = False
        """Whether the right button ended a gesture: then it opens no menu."""

    def begin(self, gesture: Gesture) -> None:
        """Let a gesture have the pointer from now on."""
        self.gesture = gesture

    def cancel(self) -> None:
        """End what is under way as if it had not begun."""
        gesture, self.gesture = self.gesture, None
        if gesture is not None:
            gesture.cancel(self._canvas)

    def request_menu(self, place: QPoint) -> None:
        """Ask for the menu of what is at a place of the view; that becomes the selection."""
        canvas = self._canvas
        hit = canvas.sight.hit(place)
        if hit is None:
            note = canvas.notes.hit(canvas.sight.to_page(place))
            canvas.notes.select(note.id if note is not None else "")
        elif hit.block not in canvas.selection:
            canvas.selection.set([hit.block])
        canvas.news.menu_requested.emit(place)

    def press(self, event: QMouseEvent) -> None:
        """A mouse button went down."""
        self.was_cancelled_by_right = False
        if isinstance(self.gesture, KeyboardCarry):  # the mouse begins something of its own
            self.cancel()
        if self.gesture is not None:
            if event.button() == Qt.MouseButton.RightButton:
                self.was_cancelled_by_right = True
                self.cancel()
            return
        self._begin(self._pointer(event.position(), event.button(), event.modifiers()))

    def double_click(self, event: QMouseEvent) -> None:
        """A second press soon after the first: a click of it opens the block."""
        self.press(event)
        if isinstance(self.gesture, Press | NotePress):
            self.gesture.is_double = True

    def move(self, event: QMouseEvent) -> None:
        """The mouse moved: with a gesture, or over the page."""
        last = self._last
        if self.gesture is None or last is None or isinstance(self.gesture, KeyboardCarry):
            # Show by the cursor what a press would do
            shape = self._cursor(event.position())
            if self._canvas.area.viewport().cursor().shape() != shape:
                self._canvas.area.viewport().setCursor(shape)
        elif not event.buttons() & last.button:  # the release went elsewhere
            self.cancel()
        else:
            self.move_to(event.position())

    def move_to(self, view: QPointF) -> None:
        """Bring the gesture to a point of the view."""
        if self.gesture is not None:
            self._last = self._moved(view)
            self.gesture.move(self._canvas, self._last)

    def release_at(self, view: QPointF, button: Qt.MouseButton | None = None) -> None:
        """End the gesture at a point of the view; not if another button than its came up."""
        if button is not None and (self._last is None or button != self._last.button):
            return
        gesture, self.gesture = self.gesture, None
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
        kind = event.type()
        points = [point.position() for point in event.points()]
        if kind == QEvent.Type.TouchCancel:
            self.cancel()
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
        if self.gesture is None:
            self._canvas.area.viewport().unsetCursor()

    def _begin(self, pointer: Pointer) -> None:
        canvas = self._canvas
        self._last = pointer
        hit = canvas.sight.hit(pointer.view)
        canvas.fields.close()  # blocks may have other names, and be wider, from now on
        gesture = choose(canvas, pointer, _as_it_is_now(canvas, hit))
        if gesture is not None:
            self.begin(gesture)

    def _pinch(self, first: QPointF, second: QPointF) -> None:
        canvas = self._canvas
        if isinstance(self.gesture, PinchZoom):
            self.gesture.pinch(canvas, first, second)
        else:
            self.cancel()
            self.begin(PinchZoom(canvas, first, second))

    def _cursor(self, view: QPointF) -> Qt.CursorShape:
        canvas = self._canvas
        if self.is_space_down:
            return Qt.CursorShape.OpenHandCursor
        if problem_at(canvas, canvas.sight.to_page(view)):
            return Qt.CursorShape.PointingHandCursor
        hit = canvas.sight.hit(view)
        if hit is None:
            return Qt.CursorShape.ArrowCursor
        is_pressed = hit.piece is not None and hit.piece.piece in ("field", "button")
        return Qt.CursorShape.PointingHandCursor if is_pressed else Qt.CursorShape.OpenHandCursor

    def _moved(self, view: QPointF) -> Pointer:
        last = self._last or self._pointer(view)
        return replace(last, view=QPointF(view), page=self._canvas.sight.camera.to_page(view))

    def _pointer(
        self,
        view: QPointF,
        button: Qt.MouseButton = Qt.MouseButton.LeftButton,
        modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
        *,
        is_touch: bool = False,
    ) -> Pointer:
        page = self._canvas.sight.to_page(view)
        return Pointer(QPointF(view), page, button, modifiers, is_touch)
