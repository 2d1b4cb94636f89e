"""What people do with the notes of a page: by mouse and finger, by key, and writing in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent

from nep_studio.blocks.program import Note
from nep_studio.ui.canvas.fields.comments import NoteText
from nep_studio.ui.canvas.fields.field_edit import editor_font
from nep_studio.ui.canvas.fields.popup import give_back_focus
from nep_studio.ui.canvas.painting.notes import SMALLEST_HEIGHT, SMALLEST_WIDTH
from nep_studio.ui.labels import labelled
from nep_studio.ui.words import tr

from .gesture import Gesture, Pointer

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

_STEP = 10.0
_ARROWS = {
    Qt.Key.Key_Left: (-_STEP, 0.0),
    Qt.Key.Key_Right: (_STEP, 0.0),
    Qt.Key.Key_Up: (0.0, -_STEP),
    Qt.Key.Key_Down: (0.0, _STEP),
}


def note_gesture(canvas: CanvasHost, pointer: Pointer) -> Gesture | None:
    """The gesture that a press on a note begins, or None where there is no note."""
    note = canvas.notes.hit(pointer.page)
    if note is None:
        return None
    return NotePress(note, pointer, is_corner=canvas.notes.is_corner(note, pointer.page))


def press_key(canvas: CanvasHost, event: QKeyEvent) -> bool:
    """Do what a key means for the selected note; False when it means nothing there."""
    notes, note_id = canvas.notes, canvas.notes.selected
    note = canvas.editor.project.notes.get(note_id)
    if note is None:
        return False
    key = Qt.Key(event.key())
    if key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
        canvas.attempt(lambda: notes.delete(note_id))
        canvas.news.announced.emit(tr("Note deleted"))
    elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_F2):
        edit_note(canvas, note_id)
    elif key == Qt.Key.Key_Escape:
        notes.select("")
    elif key in _ARROWS:
        x, y = _ARROWS[key]
        moved = msgspec.structs.replace(note, x=note.x + x, y=note.y + y)
        canvas.attempt(lambda: notes.set(moved))
    else:
        return False
    return True


def edit_note(canvas: CanvasHost, note_id: str) -> NoteEditor | None:
    """Write in a note."""
    if note_id not in canvas.editor.project.notes:
        return None
    canvas.notes.select(note_id)
    canvas.notes.writing = NoteEditor(canvas, note_id)
    return canvas.notes.writing


class NotePress(Gesture):
    """A press on a note: a click selects it, a double click opens it, a drag moves it."""

    def __init__(self, note: Note, pointer: Pointer, *, is_corner: bool) -> None:
        self.is_double = False
        self._note, self._start, self._is_corner = note, pointer, is_corner

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Become a drag when the pointer has moved far enough."""
        if pointer.is_far(self._start.view):
            canvas.notes.select(self._note.id)
            kind = NoteResize if self._is_corner else NoteDrag
            drag = kind(self._note, self._start.page)
            canvas.pointing.begin(drag)
            drag.move(canvas, pointer)

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """It was a click."""
        canvas.notes.select(self._note.id)
        if self.is_double:
            edit_note(canvas, self._note.id)


class NoteDrag(Gesture):
    """Moves a note."""

    def __init__(self, note: Note, start: QPointF) -> None:
        self._note, self._start = note, start

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Show the note where it would be."""
        canvas.notes.carry(self._changed(canvas, pointer.page - self._start))

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Leave it there."""
        changed = self._changed(canvas, pointer.page - self._start)
        canvas.notes.carry(None)
        canvas.editor.history.seal()
        canvas.attempt(lambda: canvas.notes.set(changed))

    def cancel(self, canvas: CanvasHost) -> None:
        """Leave it where it was."""
        canvas.notes.carry(None)

    def _changed(self, canvas: CanvasHost, by: QPointF) -> Note:
        note = self._note
        return msgspec.structs.replace(note, x=note.x + by.x(), y=note.y + by.y())


class NoteResize(NoteDrag):
    """Makes a note larger or smaller by its corner."""

    def _changed(self, canvas: CanvasHost, by: QPointF) -> Note:
        note, sign = self._note, -1 if canvas.look.measures.is_mirrored else 1
        return msgspec.structs.replace(
            note,
            width=max(SMALLEST_WIDTH, note.width + sign * by.x()),
            height=max(SMALLEST_HEIGHT, note.height + by.y()),
        )


class NoteEditor(NoteText):
    """The text of a note, over the note; what is written is in the project at once."""

    def __init__(self, canvas: CanvasHost, note_id: str) -> None:
        super().__init__(canvas.area.viewport(), self.finish)
        self._canvas, self._note = canvas, note_id
        self._is_over = False
        theme = canvas.look.theme
        self.setStyleSheet(
            f"QPlainTextEdit {{ background: {theme.colour('note').name()};"
            f" color: {theme.colour('note_text').name()}; border-radius: 3px; padding: 2px;"
            f" border: 2px solid {theme.colour('focus').name()}; }}"
        )
        labelled(self, name="Note")
        self.setPlainText(canvas.editor.project.notes[note_id].text)
        self.textChanged.connect(self._on_written)
        canvas.editor.history.seal()
        for signal in (canvas.news.view_changed, canvas.news.layout_changed):
            signal.connect(self._follow)
        canvas.notes.edited = note_id
        self._repaint()
        self._follow()
        self.show()
        self.setFocus(Qt.FocusReason.OtherFocusReason)

    def finish(self) -> None:
        """Keep what was written, and go away."""
        if self._is_over:
            return
        self._is_over = True
        self._canvas.notes.writing = None
        for signal in (self._canvas.news.view_changed, self._canvas.news.layout_changed):
            signal.disconnect(self._follow)
        self._canvas.notes.edited = ""
        self._canvas.editor.history.seal()
        self._repaint()
        give_back_focus(self._canvas.area, self)
        self.hide()
        self.deleteLater()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """A press elsewhere ends the writing."""
        super().focusOutEvent(event)
        if event.reason() not in (
            Qt.FocusReason.PopupFocusReason,
            Qt.FocusReason.ActiveWindowFocusReason,
        ):
            self.finish()

    def _follow(self) -> None:
        note = self._canvas.editor.project.notes.get(self._note)
        if note is None or note.page != self._canvas.page_layout.page:
            self.finish()
            return
        rect: QRectF = self._canvas.sight.camera.view_rect(self._canvas.notes.rect_of(note))
        self.setFont(editor_font(self._canvas))
        self.setGeometry(rect.toAlignedRect())

    def _on_written(self) -> None:
        text = self.toPlainText()
        self._canvas.attempt(lambda: self._canvas.notes.set_text(self._note, text))

    def _repaint(self) -> None:
        note = self._canvas.editor.project.notes.get(self._note)
        if note is not None:
            self._canvas.layers.repaint_page([self._canvas.notes.rect_of(note)])
