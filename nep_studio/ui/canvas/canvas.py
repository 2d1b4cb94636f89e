"""The canvas: a page of blocks that people edit with mouse, finger and keyboard."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QPoint, Qt, QTimer
from PySide6.QtGui import (
    QContextMenuEvent,
    QDragEnterEvent,
    QDragLeaveEvent,
    QDragMoveEvent,
    QDropEvent,
    QFocusEvent,
    QFont,
    QKeyEvent,
    QMouseEvent,
    QNativeGestureEvent,
    QPaintEvent,
    QResizeEvent,
    QTouchEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QAbstractScrollArea, QMenu, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.program import Changes
from nep_studio.ui.theme.colours import Theme

from .editing.cargo import Grip
from .editing.carrying import KeyboardCarry
from .editing.commands import Commands
from .editing.drag_blocks import ExternalDrag, carry_in, clip_in
from .editing.keys import Keyboard
from .editing.making_way import MakingWay
from .editing.marks import DragMarks
from .editing.menu import Section, menu_for
from .editing.notes import press_key
from .editing.pointing import Pointing
from .editing.view_gestures import native_gesture, wheel
from .fields.editors import FieldEditors
from .following import Following
from .host import CanvasNews
from .layout.page import PageLayout
from .painting.layers import Layers
from .painting.notes import Notes
from .painting.overlay import ProblemOverlay, SelectionOverlay
from .painting.painter import Look
from .selection import Selection
from .sight import Sight

_FINGERS = {
    QEvent.Type.TouchBegin,
    QEvent.Type.TouchUpdate,
    QEvent.Type.TouchEnd,
    QEvent.Type.TouchCancel,
}

_FOR_FIELDS = {
    QEvent.Type.MouseButtonPress,
    QEvent.Type.ToolTip,
    QEvent.Type.Hide,
    QEvent.Type.Resize,
}

SLICE_S = 0.006
"""How long stacks out of view are laid out at a time."""

BUSY_MS = 50
"""How long work that can wait is put off while something is dragged."""


class Canvas(QAbstractScrollArea):
    """A page of blocks to edit. It asks the editor; what the editor did is then shown.

    What has a state of its own is an object that the canvas owns; each of them sees the canvas as
    a `CanvasHost`. What happens on it is told by ``news``.
    """

    def __init__(
        self,
        editor: Editor,
        theme: Theme,
        *,
        font: QFont | None = None,
        is_mirrored: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.area: QAbstractScrollArea = self
        self.editor = editor
        self.accessible: object = None
        self.news = CanvasNews(self)
        self.look = Look(theme, font or self.font(), editor.language, is_mirrored=is_mirrored)
        self.page_layout = PageLayout(editor.project, editor.language, self.look.measures)
        self.selection = Selection(self)
        self.sight = Sight(self)
        self.notes = Notes(self)
        self.problems = ProblemOverlay()
        self.layers = Layers(self, [self.notes, SelectionOverlay(), self.problems])
        self.pointing = Pointing(self)
        self.fields = FieldEditors(self)
        self.commands = Commands(self)
        self.keyboard = Keyboard(self)
        self.marks = DragMarks(self)
        self._making_way = MakingWay(self)
        self.following = Following(self)
        self.menu: QMenu | None = None
        self.menu_sections: list[Section] = []
        self.later_layout = QTimer(self, interval=0)
        self.later_layout.timeout.connect(self.lay_out_more)
        self._listen()
        self.repaint_all()

    def _listen(self) -> None:
        self.editor.history.listen(self._on_changes)
        self.editor.history.finish_with(self._making_way)
        self.selection.changed.connect(self.viewport().update)
        self.news.menu_requested.connect(self._on_menu_requested)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setFrameShape(QAbstractScrollArea.Shape.NoFrame)
        viewport = self.viewport()
        viewport.setMouseTracking(True)
        viewport.setAcceptDrops(True)
        viewport.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)
        viewport.ungrabGesture(Qt.GestureType.PanGesture)  # two fingers are ours

    @property
    def page(self) -> str:
        """The page that is shown."""
        return self.page_layout.page

    # What is shown

    def set_look(self, theme: Theme, font: QFont, *, is_mirrored: bool) -> None:
        """Show the blocks with this theme, this font, and from this side."""
        self._leave_page()  # open editors have the old look
        self._take_look(theme, font, is_mirrored, self.page)

    def use_words(self, *, is_mirrored: bool) -> None:
        """Show the blocks in the words that the editor has now; what is typed stays open."""
        self.pointing.cancel()
        look, was_mirrored = self.look, self.look.measures.is_mirrored
        self._take_look(look.theme, look.block_font, is_mirrored, self.page)
        if is_mirrored != was_mirrored:  # the page is read from its other side now
            self.sight.show_beginning()
            self.show_block(self.selection.cursor)
        self.fields.use_words()

    def set_editor(self, editor: Editor) -> None:
        """Show another project; what is under way in this one ends."""
        self._leave_page()
        self.editor.history.unlisten(self._on_changes)
        self.editor.history.finish_with(self._making_way, is_on=False)
        self.editor = editor
        editor.history.listen(self._on_changes)
        editor.history.finish_with(self._making_way)
        self.selection.clear()
        look = self.look
        self._take_look(look.theme, look.block_font, look.measures.is_mirrored, "behaviour")
        self.news.page_changed.emit(self.page)

    def show_page(self, page: str) -> None:
        """Show another page, from its beginning; what is under way on this one ends."""
        self.news.page_asked.emit()
        if page == self.page:
            return
        self._leave_page()
        self.selection.clear()
        self.page_layout.show(page)
        self.repaint_all()
        self.news.page_changed.emit(page)
        self.sight.show_beginning()

    def show_block(self, block_id: str) -> None:
        """Scroll, and change the page, so that a block can be seen."""
        project = self.editor.project
        if block_id not in project.blocks:
            return
        self.show_page(project.page_of(block_id))
        placed = self.page_layout.placed(block_id)
        if placed is not None:
            self.sight.show_head(placed)

    def repaint_all(self) -> None:
        """Paint everything anew; the page may be larger now."""
        self.later_layout.start()
        self.notes.refresh()
        self.layers.repaint_all()
        self.sight.update_scroll_bars()
        self.news.layout_changed.emit()

    def lay_out_more(self) -> None:
        """Lay out, while nobody waits, some of the stacks of a large page that are out of view.

        What is dragged comes first.
        """
        is_busy = self.pointing.gesture is not None
        self.later_layout.setInterval(BUSY_MS if is_busy else 0)
        if is_busy:
            return
        chains = self.page_layout.chains
        if not chains.lay_out_some(SLICE_S):
            self.later_layout.stop()
        outgrown, chains.outgrown = chains.outgrown, []
        self.layers.repaint_page(outgrown)
        self.sight.update_scroll_bars()

    def _take_look(self, theme: Theme, font: QFont, is_mirrored: bool, page: str) -> None:
        editor = self.editor
        self.look = Look(theme, font, editor.language, is_mirrored=is_mirrored)
        self.page_layout = PageLayout(editor.project, editor.language, self.look.measures)
        if page != self.page:
            self.page_layout.show(page)
        self.marks.bubble.dress(theme)
        self.repaint_all()

    def _leave_page(self) -> None:
        self.pointing.cancel()  # while there is what it puts back
        self.fields.close()
        self.fields.comments.close()
        if self.notes.writing is not None:
            self.notes.writing.finish()

    # Changes

    def attempt(self, change: Callable[[], object]) -> bool:
        """Make a change; tell the person why not when the editor refuses it."""
        try:
            change()
        except EditRefused as refusal:
            self.news.refused.emit(refusal.sentence)
            return False
        return True

    def _on_changes(self, changes: Changes) -> None:
        if self.pointing.gesture is not None:
            self.pointing.cancel()  # what is carried may not be there any more
        self.layers.repaint_page(self.page_layout.change(changes))
        if self.page_layout.chains.waiting:
            self.later_layout.start()
        if changes.notes or changes.whole:
            self.layers.repaint_page(self.notes.change(changes))
        self.selection.keep(self.editor.project.blocks)
        self.sight.update_scroll_bars()
        self.news.layout_changed.emit()

    # The view

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the layers."""
        self.layers.paint(event.region())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the new size."""
        self.layers.resize()
        super().resizeEvent(event)
        self.sight.take_width(event.size().width())
        self.news.resized.emit()

    def scrollContentsBy(self, dx: int, dy: int) -> None:
        """Follow a scroll bar."""
        self.sight.follow_scroll_bars()

    def viewportEvent(self, event: QEvent) -> bool:
        """Take fingers, touch pads that zoom, and the resolution of another screen."""
        kind = event.type()
        if kind in _FOR_FIELDS and self.fields.take(event):
            return True
        if kind in _FINGERS and isinstance(event, QTouchEvent):
            event.accept()
            return self.pointing.touch(event)
        if isinstance(event, QNativeGestureEvent) and native_gesture(self, event):
            return True
        if kind == QEvent.Type.Leave:
            self.pointing.leave()
        elif kind == QEvent.Type.DevicePixelRatioChange:
            self.layers.resize()
        return super().viewportEvent(event)

    # Mouse

    def begin_external_drag(
        self, clip: Clip, global_pos: QPoint, source: QWidget, grip: Grip | None = None
    ) -> None:
        """Carry new blocks once the mouse, pressed on ``source``, has moved 10 pixels.

        Until then the press is the widget's own, as for a click. ``grip`` is the point of the
        first block that the mouse holds.
        """
        ExternalDrag(self, clip, global_pos, source, grip)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a gesture."""
        self.keyboard.is_space_pressed = False
        self.pointing.press(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Begin a gesture that opens the block if it stays a click."""
        self.keyboard.is_space_pressed = False
        self.pointing.double_click(event)
        is_plain = event.button() == Qt.MouseButton.LeftButton and not event.modifiers()
        if is_plain and self.sight.hit(event.position()) is None:
            self.news.page_double_clicked.emit(self.sight.to_page(event.position()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with the gesture."""
        self.pointing.move(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the gesture."""
        self.pointing.release_at(event.position(), event.button())

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Scroll or zoom."""
        wheel(self, event)

    # Blocks from other windows

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take the text of blocks; files are for the window."""
        clip = clip_in(self, event.mimeData())
        if clip is not None:
            carry_in(self, clip, self.viewport().mapToGlobal(event.position().toPoint()))
            event.setDropAction(Qt.DropAction.CopyAction)
            event.accept()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Bring the blocks along."""
        self.pointing.move_to(event.position())
        event.accept()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """The blocks have left again."""
        self.pointing.cancel()

    def dropEvent(self, event: QDropEvent) -> None:
        """Put the blocks where they are."""
        self.pointing.release_at(event.position())
        event.setDropAction(Qt.DropAction.CopyAction)
        event.accept()

    # Keys and menus

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Cancel what is under way: its end would not be seen."""
        self.pointing.is_space_down = self.keyboard.is_space_pressed = False
        self.pointing.cancel()
        super().focusOutEvent(event)

    def event(self, event: QEvent) -> bool:
        """Keep all keys from the window's shortcuts while a gesture is under way."""
        if event.type() == QEvent.Type.WindowBlocked:  # a dialog takes the mouse
            self.pointing.cancel()
        if event.type() == QEvent.Type.ShortcutOverride and self.pointing.gesture is not None:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Let a gesture of the mouse have the key first, then the keyboard's rules."""
        if event.key() == Qt.Key.Key_Space:
            self.pointing.is_space_down = True
        gesture = self.pointing.gesture
        if gesture is not None and not isinstance(gesture, KeyboardCarry):
            if event.key() == Qt.Key.Key_Escape:
                self.pointing.cancel()
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
            self.pointing.request_menu(self._cursor_place())
        elif not self.pointing.was_cancelled_by_right:
            self.pointing.request_menu(event.pos())

    def _on_menu_requested(self, place: QPoint) -> None:
        if self.menu is not None:
            self.menu.deleteLater()
        at = self.sight.to_page(place)
        self.menu = menu_for(self, self.sight.hit(place), at, self.menu_sections)
        self.menu.popup(self.viewport().mapToGlobal(place))

    def _cursor_place(self) -> QPoint:
        """Where the menu of the keyboard's block opens: at its first row, inside the view."""
        rect = self.sight.view_rect_of(self.selection.cursor)
        view, measures = self.viewport().rect(), self.look.measures
        if rect is None or not rect.intersects(view):
            return view.center()
        inset = measures.row_height * self.sight.camera.scale / 4
        x = rect.right() - inset if measures.is_mirrored else rect.left() + inset
        place = QPoint(round(x), round(rect.top() + inset))
        return QPoint(min(max(place.x(), 0), view.right()), min(max(place.y(), 0), view.bottom()))
