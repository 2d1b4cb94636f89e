"""The canvas: a page of blocks that people edit with mouse, finger and keyboard."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from PySide6.QtCore import QEvent, QPoint, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QFocusEvent,
    QFont,
    QKeyEvent,
    QMouseEvent,
    QNativeGestureEvent,
    QTouchEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QMenu, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.program import Changes
from nep_studio.ui.theme.colours import Theme

from .editing.cargo import Bubble, Cargo, DropOverlay, FloatingPicture
from .editing.carrying import KeyboardCarry
from .editing.commands import Commands
from .editing.drag_blocks import ExternalDrag
from .editing.gesture import Gesture
from .editing.keys import Keyboard
from .editing.menu import Section, menu_for
from .editing.notes import NoteEditor, press_key
from .editing.pointing import Pointing
from .editing.snapping import Point
from .editing.view_gestures import native_gesture, wheel
from .fields.editors import FieldEditors
from .view import DropTarget

_FINGERS = {
    QEvent.Type.TouchBegin,
    QEvent.Type.TouchUpdate,
    QEvent.Type.TouchEnd,
    QEvent.Type.TouchCancel,
}


BUSY_MS = 50
"""How long work that can wait is put off while something is dragged."""


class Canvas(DropTarget):
    """A page of blocks to edit. It asks the editor; what the editor did is then shown.

    ``refused`` says in a sentence why something did not fit; ``announced`` is for screen readers;
    ``menu_requested`` gives a place in the viewport, where ``hit`` tells what is there;
    ``blocks_deleted`` brings what was deleted, for the list of deleted blocks;
    ``delete_area`` says whether a place on the screen takes blocks away (the palette, the trash),
    ``delete_area_entered`` whether carried blocks are there now; ``uses_requested`` brings the
    Subject whose uses a person looks for, ``help_requested`` the name of a page of help.
    """

    refused = Signal(object)  # Words
    announced = Signal(str)
    menu_requested = Signal(QPoint)
    problem_opened = Signal(str)
    block_opened = Signal(str)
    blocks_deleted = Signal(object)
    delete_area_entered = Signal(bool)
    uses_requested = Signal(object)
    help_requested = Signal(str)
    picture_requested = Signal()

    def __init__(
        self,
        editor: Editor,
        theme: Theme,
        *,
        font: QFont | None = None,
        is_mirrored: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        self.gesture: Gesture | None = None
        self.note_editor: NoteEditor | None = None
        super().__init__(editor, theme, font=font, is_mirrored=is_mirrored, parent=parent)
        self.pointing = Pointing(self)
        self.fields = FieldEditors(self)
        self.commands = Commands(self)
        self.keyboard = Keyboard(self)
        self.bubble = Bubble(self.viewport())
        self.bubble.dress(theme)
        self.floating = FloatingPicture(self)
        self.drop_overlay = DropOverlay()
        self.overlays.append(self.drop_overlay)
        self.delete_area: Callable[[QPoint], bool] = lambda point: False
        self.menu: QMenu | None = None
        self.menu_sections: list[Section] = []
        self.menu_requested.connect(self._on_menu_requested)
        self.viewport().setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)
        self.viewport().ungrabGesture(Qt.GestureType.PanGesture)  # two fingers are ours

    def lay_out_more(self) -> None:
        """Lay out more of a large page, but later when something is dragged: that comes first."""
        is_busy = self.gesture is not None
        self._rest.setInterval(BUSY_MS if is_busy else 0)
        if not is_busy:
            super().lay_out_more()

    # Changes

    def attempt(self, change: Callable[[], object]) -> bool:
        """Make a change; tell the person why not when the editor refuses it."""
        try:
            change()
        except EditRefused as refusal:
            self.refused.emit(refusal.sentence)
            return False
        return True

    def throw_away(self, cargo: Cargo) -> None:
        """Delete carried blocks that were dropped where blocks are deleted."""
        thrown: list[Clip | None] = []
        if self.attempt(lambda: thrown.append(cargo.throw_away(self))) and thrown[0] is not None:
            self.blocks_deleted.emit(thrown[0])

    def corners(self, ids: Iterable[str]) -> dict[str, Point]:
        """Where chains that begin with these blocks lie on the page."""
        corners = {}
        for block in ids:
            placed = self.page_layout.placed(block)
            if placed is not None:
                right = placed.box.width if placed.box.is_mirrored else 0.0
                corners[block] = placed.x + right, placed.y
        return corners

    def set_look(self, theme: Theme, font: QFont, *, is_mirrored: bool) -> None:
        """Show the blocks with this theme, this font, and from this side."""
        is_made = hasattr(self, "bubble")  # not while the view itself is being made
        if is_made:
            self._leave_page()  # open editors have the old look
        super().set_look(theme, font, is_mirrored=is_mirrored)
        if is_made:
            self.bubble.dress(theme)

    def set_editor(self, editor: Editor) -> None:
        """Show another project; what is under way in this one ends."""
        self._leave_page()
        super().set_editor(editor)

    def show_page(self, page: str) -> None:
        """Show another page, from its beginning; what is under way on this one ends."""
        if page != self.page:
            self._leave_page()
        super().show_page(page)

    def _leave_page(self) -> None:
        self.cancel_gesture()  # while there is what it puts back
        self.fields.close()
        self.fields.comments.close()
        if self.note_editor is not None:
            self.note_editor.finish()

    def _on_changes(self, changes: Changes) -> None:
        self.cancel_gesture()  # what is carried may not be there any more
        super()._on_changes(changes)

    # Gestures

    def begin(self, gesture: Gesture) -> None:
        """Let a gesture have the pointer from now on."""
        self.gesture = gesture

    def cancel_gesture(self) -> None:
        """End what is under way as if it had not begun."""
        gesture, self.gesture = self.gesture, None
        if gesture is not None:
            gesture.cancel(self)

    def begin_external_drag(self, clip: Clip, global_pos: QPoint, source: QWidget) -> None:
        """Carry new blocks once the mouse, pressed on ``source``, has moved 10 pixels.

        Until then the press is the widget's own, as for a click.
        """
        ExternalDrag(self, clip, global_pos, source)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a gesture."""
        self.pointing.press(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Begin a gesture that opens the block if it stays a click."""
        self.pointing.double_click(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with the gesture."""
        self.pointing.move(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the gesture."""
        self.pointing.release(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Scroll or zoom."""
        wheel(self, event)

    def viewportEvent(self, event: QEvent) -> bool:
        """Take fingers, and touch pads that zoom."""
        if event.type() in _FINGERS and isinstance(event, QTouchEvent):
            event.accept()
            return self.pointing.touch(event)
        if isinstance(event, QNativeGestureEvent) and native_gesture(self, event):
            return True
        if event.type() == QEvent.Type.Leave:
            self.pointing.leave()
        return super().viewportEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Cancel what is under way: its end would not be seen."""
        self.pointing.is_space_down = self.keyboard.is_space_pressed = False
        self.cancel_gesture()
        super().focusOutEvent(event)

    # Keys and menus

    def event(self, event: QEvent) -> bool:
        """Keep all keys from the window's shortcuts while a gesture is under way."""
        if event.type() == QEvent.Type.WindowBlocked:  # a dialog takes the mouse
            self.cancel_gesture()
        if event.type() == QEvent.Type.ShortcutOverride and self.gesture is not None:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Let a gesture of the mouse have the key first, then the keyboard's rules."""
        if event.key() == Qt.Key.Key_Space:
            self.pointing.is_space_down = True
        if self.gesture is not None and not isinstance(self.gesture, KeyboardCarry):
            if event.key() == Qt.Key.Key_Escape:
                self.cancel_gesture()
        elif not (press_key(self, event) or self.keyboard.press(event)):
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Remember that the space bar is up again, and pick up if it was only pressed."""
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.pointing.is_space_down = False
            self.keyboard.release_space()
        super().keyReleaseEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Open the menu, unless the right button has just ended a gesture."""
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            self.request_menu(self._cursor_place())
        elif not self.pointing.was_cancelled_by_right:
            self.request_menu(event.pos())

    def request_menu(self, place: QPoint) -> None:
        """Ask for the menu of what is at a place of the view; that becomes the selection."""
        hit = self.hit(place)
        if hit is None:
            note = self.notes.hit(self.to_page(place))
            self.notes.select(note.id if note is not None else "")
        elif hit.block not in self.selection:
            self.selection.set([hit.block])
        self.menu_requested.emit(place)

    def _on_menu_requested(self, place: QPoint) -> None:
        if self.menu is not None:
            self.menu.deleteLater()
        self.menu = menu_for(self, self.hit(place), self.to_page(place))
        self.menu.popup(self.viewport().mapToGlobal(place))

    def _cursor_place(self) -> QPoint:
        """Where the menu of the keyboard's block opens: at its first row, inside the view."""
        rect = self.view_rect_of(self.selection.cursor)
        view = self.viewport().rect()
        if rect is None or not rect.intersects(view):
            return view.center()
        inset = self.measures.row_height * self.camera.scale / 4
        x = rect.right() - inset if self.measures.is_mirrored else rect.left() + inset
        place = QPoint(round(x), round(rect.top() + inset))
        return QPoint(min(max(place.x(), 0), view.right()), min(max(place.y(), 0), view.bottom()))
