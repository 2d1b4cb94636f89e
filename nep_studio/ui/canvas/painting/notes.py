"""The notes of a page: sticky notes that lie below the blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import msgspec
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen, QTextOption

from nep_studio.blocks.edits.content import AddNote, ChangeNote, RemoveNote
from nep_studio.blocks.program import Changes, Note
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

NEW_WIDTH, NEW_HEIGHT = 200.0, 120.0
SMALLEST_WIDTH, SMALLEST_HEIGHT = 80.0, 48.0
CORNER = 18.0
"""The side of the square at a note's corner by which it is resized; all in canvas units."""

_SMALLEST_TEXT_SCALE = 0.3


class Writing(Protocol):
    """An editor in which a note is written."""

    def finish(self) -> None:
        """Keep what was written, and go away."""


class Notes:
    """Draws the notes of the page that is shown, and says what is where.

    One note at most is selected; ``carried`` is how a note looks while it is dragged or resized.
    """

    def __init__(self, view: CanvasHost) -> None:
        self._view = view
        self.selected = ""
        self.edited = ""
        self.carried: Note | None = None
        self.writing: Writing | None = None
        self._rects: dict[str, Rect] = {}
        view.selection.changed.connect(self._on_blocks_selected)

    # What is where

    def refresh(self) -> None:
        """Take the notes of the page as they are now."""
        notes, page = self._view.editor.project.notes.values(), self._view.page_layout.page
        self._rects = {note.id: self.rect_of(note) for note in notes if note.page == page}
        if self.selected not in self._rects:
            self.selected = ""

    def change(self, changes: Changes) -> list[Rect]:
        """Take in what a step changed; gives the places to paint again."""
        before = self._rects
        self.refresh()
        ids = changes.notes or {*before, *self._rects}
        found = [rects[i] for i in ids for rects in (before, self._rects) if i in rects]
        return [rect.grown(CORNER) for rect in found]

    def rect_of(self, note: Note) -> Rect:
        """Where a note is: its place is the corner where lines of text begin."""
        is_mirrored = self._view.look.measures.is_mirrored
        return Rect(note.x - note.width if is_mirrored else note.x, note.y, note.width, note.height)

    def hit(self, point: QPointF) -> Note | None:
        """The note under a point of the page; later ones lie over earlier ones."""
        at = (point.x(), point.y())
        found = [i for i, rect in self._rects.items() if rect.holds(*at)]
        return self._view.editor.project.notes[found[-1]] if found else None

    def is_corner(self, note: Note, point: QPointF) -> bool:
        """Whether a point of the page is on the corner by which a note is resized."""
        rect, is_mirrored = self.rect_of(note), self._view.look.measures.is_mirrored
        side = point.x() - rect.x if is_mirrored else rect.right - point.x()
        return 0 <= side <= CORNER and 0 <= rect.bottom - point.y() <= CORNER

    # Changes

    def add(self, x: float, y: float, text: str = "") -> str:
        """Put a new note on the page; gives its id."""
        editor = self._view.editor
        note_id = editor.project.new_id("n")
        editor.apply(
            AddNote(Note(note_id, self._view.page_layout.page, x, y, NEW_WIDTH, NEW_HEIGHT, text))
        )
        self.select(note_id)
        return note_id

    def set(self, note: Note) -> None:
        """Change a note, when anything of it is new."""
        editor = self._view.editor
        if editor.project.notes.get(note.id) != note:
            editor.apply(ChangeNote(note))

    def set_text(self, note_id: str, text: str) -> None:
        """Write in a note; typing is one step of undo."""
        note = self._view.editor.project.notes.get(note_id)
        if note is not None:
            self.set(msgspec.structs.replace(note, text=text))

    def delete(self, note_id: str) -> None:
        """Delete a note."""
        self._view.editor.apply(RemoveNote(note_id))

    def select(self, note_id: str) -> None:
        """Select a note, and then no block; an empty id selects none."""
        if note_id:
            self._view.selection.clear()
        old, self.selected = self.selected, note_id
        for changed in (old, note_id):
            if changed in self._rects:
                self._view.layers.update_page(self._rects[changed].grown(CORNER))

    def carry(self, note: Note | None) -> None:
        """Show a note as it will be when it is let go; None ends it."""
        old, self.carried = self.carried, note
        starts = (old is None) != (note is None)
        rects = [self.rect_of(each).grown(CORNER) for each in (old, note) if each is not None]
        carried = note or old
        if starts and carried is not None and carried.id in self._rects:
            self._view.layers.repaint_page([self._rects[carried.id].grown(CORNER)])
        for rect in rects:
            self._view.layers.update_page(rect)

    # Painting

    def paint_resting(self, painter: QPainter, rect: Rect, scale: float) -> None:
        """Draw the notes that touch a part of the page, but not the one that is carried."""
        carried = self.carried.id if self.carried is not None else ""
        notes = self._view.editor.project.notes
        for note_id, place in self._rects.items():
            if note_id != carried and place.grown(CORNER).touches(rect):
                self._paint(painter, notes[note_id], place, scale)

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw what changes often: the note that is carried, and the line of the selected one."""
        if self.carried is not None:
            place = self.rect_of(self.carried)
            self._paint(painter, self.carried, place, view.sight.camera.scale)
        note = self.carried or view.editor.project.notes.get(self.selected)
        if note is None or not self.selected:
            return
        pixel = 1 / view.sight.camera.scale
        rect = self.rect_of(note)
        painter.setPen(QPen(view.look.theme.colour("focus"), 2.5 * pixel))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(QRectF(*rect), 4, 4)
        # The lines at which the note is made larger
        is_mirrored = self._view.look.measures.is_mirrored
        painter.setPen(QPen(self._view.look.theme.colour("note_text"), 1.5))
        for inset in (5.0, 10.0):
            bottom = rect.bottom - 4
            side = rect.x + 4 if is_mirrored else rect.right - 4
            inner = side + inset if is_mirrored else side - inset
            painter.drawLine(QPointF(inner, bottom), QPointF(side, bottom - inset))

    def _paint(self, painter: QPainter, note: Note, place: Rect, scale: float) -> None:
        theme, unit = self._view.look.theme, self._view.look.measures.unit
        rect = QRectF(*place)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.colour("shadow"))
        painter.drawRoundedRect(rect.translated(unit, 3 * unit), 4 * unit, 4 * unit)
        painter.setPen(QPen(theme.colour("note_text"), unit * 0.8))
        painter.setBrush(theme.colour("note"))
        painter.drawRoundedRect(rect, 4 * unit, 4 * unit)
        if scale < _SMALLEST_TEXT_SCALE or note.id == self.edited:
            return
        colour = theme.colour("note_text")
        if not note.text:
            colour.setAlphaF(0.7)
        painter.setPen(colour)
        painter.setFont(self._view.look.block_font)
        option = QTextOption()
        option.setWrapMode(QTextOption.WrapMode.WrapAtWordBoundaryOrAnywhere)
        if self._view.look.measures.is_mirrored:
            option.setTextDirection(Qt.LayoutDirection.RightToLeft)
        pad = 8 * unit
        painter.save()
        painter.setClipRect(rect, Qt.ClipOperation.IntersectClip)
        shown = note.text or tr("Write a note")
        painter.drawText(rect.adjusted(pad, pad * 0.75, -pad, -pad / 2), shown, option)
        painter.restore()

    def _on_blocks_selected(self) -> None:
        if self.selected and self._view.selection.ids:
            self.select("")
