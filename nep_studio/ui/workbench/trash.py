"""The list of deleted blocks, and the trash in the corner of the canvas that opens it."""

from __future__ import annotations

from collections import deque
from itertools import count
from pathlib import Path

from PySide6.QtCore import QObject, QPoint, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QFrame, QLabel, QPushButton, QWidget

from nep_studio.blocks.operations.copying import Clip, paste
from nep_studio.blocks.program import PAGES
from nep_studio.blocks.text import sentence
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

from .palette.categories import add_delete_area, is_taking
from .palette.entries import Drawer, Entry, Stock
from .palette.shelf import Shelf
from .placing import free_place
from .snippets import Snippet

# What was deleted in this session, to be brought back; undo does not empty it.

MOST_KEPT = 50


class Trash(QObject):
    """Keeps the last deleted blocks of one canvas, the newest first."""

    changed = Signal()

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.canvas = canvas
        self.clips: deque[tuple[int, Clip]] = deque(maxlen=MOST_KEPT)
        self._numbers = count(1)
        canvas.news.blocks_deleted.connect(self.add)

    def add(self, clip: Clip) -> None:
        """Keep deleted blocks."""
        if clip.stacks:
            self.clips.appendleft((next(self._numbers), clip))
            self.changed.emit()

    def empty(self) -> None:
        """Keep nothing any more."""
        self.clips.clear()
        self.changed.emit()

    def take_out(self, number: int) -> None:
        """Forget deleted blocks: they are in the program again."""
        kept = [pair for pair in self.clips if pair[0] != number]
        self.clips = deque(kept, maxlen=MOST_KEPT)
        self.changed.emit()

    def restore(self, number: int) -> bool:
        """Put deleted blocks into the program again, as stacks where one looks."""
        clip = next((clip for known, clip in self.clips if known == number), None)
        if clip is None:
            return False
        canvas = self.canvas
        canvas.show_page(self._page_for(clip))
        where = free_place(canvas, clip)
        made: list[str] = []
        if not canvas.attempt(
            lambda: made.extend(paste(canvas.editor, clip, canvas.page, where.x(), where.y()))
        ):
            return False
        self.take_out(number)
        canvas.selection.set(made)
        canvas.show_block(made[0])
        canvas.news.announced.emit(tr("brought back"))
        return True

    def title(self, clip: Clip) -> str:
        """What deleted blocks are called: the sentence of the first, and how many there are."""
        language = self.canvas.editor.language.of(clip.project)
        first = sentence(clip.project, language, clip.roots[0][0])
        more = len(clip) - 1
        if not more:
            return first
        return f"{first} " + count_words(more, "and 1 more", "and {n} more")

    def _page_for(self, clip: Clip) -> str:
        """The page that is shown, when the blocks belong on one of its kind."""
        project = self.canvas.editor.project
        kind = next((page for page in PAGES if clip.project.pages.get(page)), PAGES[0])
        return self.canvas.page if project.kind_of_page(self.canvas.page) == kind else kind


MARGIN = 10
SIDE_LINES = 2.6


class TrashPanel(QFrame):
    """Shows what was deleted. Blocks can be dragged out; a click, Enter or Restore bring back."""

    def __init__(self, trash: Trash, parent: QWidget | None = None) -> None:
        super().__init__(parent or trash.canvas)
        self.trash = trash
        self.setObjectName("trash_panel")
        self.title = labelled(QLabel(self), text="Deleted blocks")
        self.title.setProperty("role", "heading")
        self.shelf = labelled(Shelf(trash.canvas, self), name="Deleted blocks")
        self.restore = labelled(QPushButton(self), text="Restore")
        self.empty = labelled(QPushButton(self), text="Forget all")
        labelled(self, name="Deleted blocks")
        self.restore.clicked.connect(self._on_restore)
        self.empty.clicked.connect(trash.empty)
        self.shelf.chosen.connect(self._on_chosen)
        in_column(self.title, (self.shelf, 1), in_row(self.restore, 1, self.empty), of=self)
        trash.changed.connect(self._fill)
        self.refresh()

    def refresh(self) -> None:
        """Take the theme and the words."""
        theme = self.trash.canvas.look.theme
        self.setStyleSheet(
            f"#trash_panel {{ background: {theme.colour('panel').name()};"
            f" border: 1px solid {theme.colour('field_line').name()}; border-radius: 8px; }}"
        )
        self.shelf.refresh()
        self._fill()

    def sizeHint(self) -> QSize:
        """Room for a few stacks."""
        line = self.fontMetrics().height()
        return QSize(20 * line, 22 * line)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc closes."""
        if event.key() == Qt.Key.Key_Escape:
            self.hide()
            self.trash.canvas.setFocus(Qt.FocusReason.OtherFocusReason)
        else:
            super().keyPressEvent(event)

    def _fill(self) -> None:
        drawer = Drawer("trash", tr("Deleted blocks"), "trash-2")
        entries = [
            Entry(
                "snippet",
                drawer,
                title := self.trash.title(clip),
                action=str(number),
                snippet=Snippet(Path(), title, clip),
            )
            for number, clip in self.trash.clips
        ]
        if not entries:
            words = tr("Nothing was deleted yet. What you delete can be brought back from here.")
            entries = [Entry("words", drawer, words)]
        self.shelf.show_entries(Stock(self.trash.canvas.editor), entries, to_top=True)
        for button in (self.restore, self.empty):
            button.setEnabled(bool(self.trash.clips))

    def _on_chosen(self, entry: Entry) -> None:
        if entry.action:
            self.trash.restore(int(entry.action))

    def _on_restore(self) -> None:
        """Bring back what the keyboard is at, or what was deleted last."""
        entry = self.shelf.current
        if entry is not None:
            self._on_chosen(entry)
        elif self.trash.clips:
            self.trash.restore(self.trash.clips[0][0])


class TrashButton(QAbstractButton):
    """The trash in the corner of a canvas: takes blocks, and opens the list of deleted ones."""

    def __init__(self, canvas: Canvas, trash: Trash | None = None) -> None:
        super().__init__(canvas)
        self.canvas = canvas
        self.trash = trash or Trash(canvas)
        self.panel = TrashPanel(self.trash)
        self.panel.hide()
        self._is_taking = False
        add_delete_area(canvas, self)
        canvas.news.delete_area_entered.connect(self._on_delete_area_entered)
        canvas.news.resized.connect(self._take_place)
        self.trash.changed.connect(self._on_changed)
        self.clicked.connect(self._on_clicked)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Take the theme, the words and the direction."""
        self.panel.refresh()
        self._on_changed()
        self._take_place()

    def sizeHint(self) -> QSize:
        """As large as a finger."""
        side = round(self.fontMetrics().height() * SIDE_LINES)
        return QSize(side, side)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the sign and the count; red and wide open while it takes blocks."""
        theme, line = self.canvas.look.theme, self.fontMetrics().height()
        fill = theme.colour("error_panel" if self._is_taking else "panel")
        sign = theme.colour("error" if self._is_taking else "muted")
        edge = theme.colour("focus") if self.hasFocus() else theme.colour("field_line")
        rect = QRectF(self.rect()).adjusted(2, 2, -2, -2)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            style = Qt.PenStyle.DashLine if self._is_taking else Qt.PenStyle.SolidLine
            painter.setPen(QPen(sign if self._is_taking else edge, 2.5, style))
            painter.setBrush(fill)
            painter.drawRoundedRect(rect, 10, 10)
            inner = line * (0.45 if self._is_taking else 0.65)
            paint_icon(painter, rect.adjusted(inner, inner, -inner, -inner), "trash-2", sign)
            if self.trash.clips:
                side = line * 1.05
                badge = QRectF(rect.right() - side, rect.top(), side, side)
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(theme.colour("accent"))
                painter.drawEllipse(badge)
                font = self.font()
                font.setPointSizeF(font.pointSizeF() * 0.75)
                font.setBold(True)
                painter.setFont(font)
                painter.setPen(theme.colour("accent_text"))
                painter.drawText(badge, Qt.AlignmentFlag.AlignCenter, str(len(self.trash.clips)))

    def _take_place(self) -> None:
        """In the corner where lines end: blocks begin at the other side."""
        view = self.canvas.viewport().geometry()
        self.resize(self.sizeHint())
        is_mirrored = self.canvas.look.measures.is_mirrored
        x = view.left() + MARGIN if is_mirrored else view.right() - MARGIN - self.width()
        self.move(x, view.bottom() - MARGIN - self.height())
        size = self.panel.sizeHint().boundedTo(view.size() - QSize(2 * MARGIN, 6 * MARGIN))
        self.panel.resize(size.expandedTo(QSize(160, 120)))
        left = self.x() if is_mirrored else self.geometry().right() - self.panel.width() + 1
        self.panel.move(QPoint(left, self.y() - MARGIN - self.panel.height()))

    def _on_clicked(self) -> None:
        is_shown = not self.panel.isVisible()
        self.panel.setVisible(is_shown)
        if is_shown:
            self._take_place()
            self.panel.raise_()
            self.panel.shelf.setFocus(Qt.FocusReason.PopupFocusReason)

    def _on_changed(self) -> None:
        number = len(self.trash.clips)
        words = tr("Deleted blocks")
        if number:
            words = count_words(
                number, "Deleted blocks: 1 to bring back", "Deleted blocks: {n} to bring back"
            )
        self.setAccessibleName(words)
        self.setToolTip(words)
        self.update()

    def _on_delete_area_entered(self, is_over: bool) -> None:
        self._is_taking = is_over and is_taking(self.canvas, self)
        self.update()
