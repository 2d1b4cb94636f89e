"""Insert blocks by typing what they say: a line with suggestions, over the canvas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFontInfo, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QApplication, QFrame, QLabel, QLineEdit, QScrollArea, QWidget

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.places import Place
from nep_studio.settings import Settings
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.canvas.layout.page import boxes_of
from nep_studio.ui.canvas.painting.painter import BlockPainter
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .palette.accessible_list import make_list_accessible, tell_current
from .placing import insert_clip

# The suggestions of the insert bar, painted as the blocks that they are.

SCALE = 0.85
"""How large blocks are in the list beside those of the canvas at its usual size."""

HIGHEST_ROW = 150.0
"""How much of a suggestion is shown, in units of the measures."""

EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)


@dataclass
class Row:
    """A suggestion: its blocks, laid out, and its sentence."""

    clip: Clip
    label: str
    chain: Chain
    y: float = 0.0
    height: float = 0.0


class SuggestionList(QWidget):
    """Shows suggestions, the best first; ``chosen`` says that one was clicked."""

    chosen = Signal(int)

    def __init__(self, canvas: Canvas, parent: QWidget) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self.rows: list[Row] = []
        self._scale = SCALE
        self.current = 0
        self.accessible: object = None
        self.setMouseTracking(True)
        labelled(self, name="Suggestions")
        make_list_accessible(self, self)

    def show_clips(self, clips: Sequence[tuple[Clip, str]]) -> None:
        """Show these blocks with their sentences, and point at the first."""
        look, language = self._canvas.look, self._canvas.editor.language
        measures = look.measures
        self._painter = BlockPainter(look.theme, language, measures, look.block_font)
        size = QFontInfo(self.font()).pixelSize() / QFontInfo(look.block_font).pixelSize()
        self._scale = SCALE * size
        self.rows, self.current = [], 0
        y, gap = 4.0, measures.line * 0.35
        for clip, label in clips:
            layout = Layout(clip.project, language, measures)
            row = Row(clip, label, layout.chain(clip.roots[0]), y)
            whole = (row.chain.height + measures.notch_depth) * self._scale
            row.height = min(whole, HIGHEST_ROW * measures.unit * size) + gap
            y += row.height
            self.rows.append(row)
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """As large as the blocks."""
        widest = max((row.chain.width * self._scale for row in self.rows), default=200.0)
        last = self.rows[-1] if self.rows else None
        return QSize(round(widest) + 24, round(last.y + last.height + 4) if last else 0)

    def go(self, step: int) -> None:
        """Point at the next suggestion, or the one before."""
        if self.rows:
            self.current = (self.current + step) % len(self.rows)
            self.update()
            tell_current(self)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the rows."""
        theme, is_mirrored = self._canvas.look.theme, self._canvas.look.measures.is_mirrored
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            for number, row in enumerate(self.rows):
                rect = self._rect(row)
                if number == self.current:
                    painter.setPen(QPen(theme.colour("focus"), 2))
                    painter.setBrush(theme.colour("selection"))
                    painter.drawRoundedRect(rect.adjusted(2, 1, -2, -1), 7, 7)
                painter.save()
                painter.setClipRect(rect)
                x = rect.right() - 12 if is_mirrored else 12.0
                painter.translate(QPointF(x, row.y + 4))
                painter.scale(self._scale, self._scale)
                self._painter.paint(painter, boxes_of(row.chain, EVERYWHERE), self._scale)
                painter.restore()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Point at what is under the mouse."""
        number = self._row_at(event.position())
        if number >= 0 and number != self.current:
            self.current = number
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Choose what is clicked."""
        number = self._row_at(event.position())
        if number >= 0 and event.button() == Qt.MouseButton.LeftButton:
            self.chosen.emit(number)

    def event(self, event: QEvent) -> bool:
        """Show the whole sentence of a suggestion that is cut."""
        if event.type() == QEvent.Type.ToolTip and self.rows:
            self.setToolTip(plain_tip(self.rows[self.current].label))
        return super().event(event)

    def _rect(self, row: Row) -> QRectF:
        return QRectF(0, row.y, self.width(), row.height)

    def _row_at(self, point: QPointF) -> int:
        found = (n for n, row in enumerate(self.rows) if self._rect(row).contains(point))
        return next(found, -1)

    # For screen readers

    def item_count(self) -> int:
        """How many suggestions there are."""
        return len(self.rows)

    def item_text(self, number: int) -> str:
        """What a suggestion says."""
        return self.rows[number].label

    def item_rect(self, number: int) -> QRect:
        """Where a suggestion is on the screen."""
        rect = self._rect(self.rows[number]).toAlignedRect()
        return QRect(self.mapToGlobal(QPoint(rect.x(), rect.y())), rect.size())

    def current_item(self) -> int:
        """The suggestion that is pointed at, or -1."""
        return self.current if self.rows else -1


MOST_SHOWN = 8
OPENER = "/"


class InsertBar(QFrame):
    """Opens where the block is to go; Enter inserts, Esc goes back to the canvas.

    While it is there, double clicks on the empty page and letters typed on the canvas open it.
    """

    def __init__(self, canvas: Canvas, settings: Settings | None = None) -> None:
        super().__init__(canvas)
        self.setObjectName("insert_bar")
        self.canvas = canvas
        self._settings = settings
        self._at: QPointF | None = None
        self._place: Place | None = None
        self.line = labelled(
            QLineEdit(self),
            placeholder="What should happen? For example: say hello twice",
            name="Insert a block by typing",
        )
        self.line.textChanged.connect(self._on_typed)
        self.line.installEventFilter(self)
        self.list = SuggestionList(canvas, self)
        self.list.chosen.connect(self.insert)
        self.area = QScrollArea(self, widgetResizable=True)
        self.area.setWidget(self.list)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.hint = QLabel(self, wordWrap=True)
        self.hint.setProperty("role", "hint")
        in_column(self.line, self.area, self.hint, of=self, margins=8)
        canvas.keyboard.type_letter = self._on_letter
        canvas.news.page_double_clicked.connect(self.open)
        canvas.news.page_changed.connect(self.hide)
        self.refresh()
        follow_words(self, self._suggest_again)

    def refresh(self) -> None:
        """Take the theme."""
        theme = self.canvas.look.theme
        self.setStyleSheet(
            f"#insert_bar {{ background: {theme.colour('menu').name()};"
            f" border: 2px solid {theme.colour('focus').name()}; border-radius: 8px; }}"
            f"#insert_bar QScrollArea, #insert_bar QScrollArea > QWidget > QWidget"
            f" {{ background: {theme.colour('menu').name()}; border: none; }}"
        )
        self.hide()

    def _suggest_again(self) -> None:
        if self.isVisible():
            self._on_typed(self.line.text())

    def open(
        self, at: QPointF | None = None, text: str = "", *, place: Place | None = None
    ) -> None:
        """Ask for a block: for a place, loose for a point of the page, or for after the cursor."""
        self._at, self._place = at, place
        self.canvas.pointing.cancel()
        self.line.setText(text)
        self._on_typed(text)
        self.show()
        self.raise_()
        self._move()
        self.line.setFocus(Qt.FocusReason.PopupFocusReason)

    def insert(self, number: int, *, stays: bool = False) -> bool:
        """Put a suggestion into the program; the bar stays open when it is asked to."""
        if not 0 <= number < len(self.list.rows):
            return False
        clip = self.list.rows[number].clip
        with self.canvas.editor.history.as_own():  # what it says was typed
            if not insert_clip(self.canvas, clip, at=self._at, place=self._place):
                return False
        self._at = self._place = None
        if stays:
            self.line.clear()
            self._on_typed("")
            self._move()
        else:
            self._leave()
        return True

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the keys of the line, and see that the person leaves it."""
        if watched is self.line and isinstance(event, QKeyEvent):
            return event.type() == QEvent.Type.KeyPress and self._press(event)
        is_left = watched is self.line and event.type() == QEvent.Type.FocusOut
        if is_left and not self._holds_focus():
            self.hide()
        return super().eventFilter(watched, event)

    def _press(self, event: QKeyEvent) -> bool:
        key = event.key()
        if key in (Qt.Key.Key_Down, Qt.Key.Key_Up):
            self.list.go(1 if key == Qt.Key.Key_Down else -1)
            row = self.list.rows[self.list.current] if self.list.rows else None
            if row is not None:
                self.area.ensureVisible(0, round(row.y + row.height / 2), 0, round(row.height))
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            stays = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
            self.insert(self.list.current, stays=stays)
        elif key in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab):
            self._complete()
        elif key == Qt.Key.Key_Escape:
            self._leave()
        else:
            return False
        return True

    def _complete(self) -> None:
        """Write the suggestion out, so that its values can be changed."""
        if self.list.rows:
            label = self.list.rows[self.list.current].label
            self.line.setText(label.replace("…", "").strip())

    def _on_letter(self, letter: str) -> None:
        self.open(None, "" if letter == OPENER else letter)

    def _on_typed(self, text: str) -> None:
        from nep_studio.blocks.typing_in.suggesting import clip_of_suggestion, fitting, suggestions

        editor = self.canvas.editor
        recent = self._settings.recent_blocks if self._settings is not None else []
        fits = fitting(editor, self._place) if self._place is not None else self._is_of_page
        found = suggestions(
            text, editor.language, editor.project, fits, recents=recent, limit=MOST_SHOWN
        )
        clips = [(clip_of_suggestion(editor, one), one.label) for one in found]
        self.list.show_clips(clips)
        self.hint.setText(self._words(text, len(found)))
        if self.isVisible():
            self._move()

    def _is_of_page(self, definition: Definition) -> bool:
        kind = self.canvas.editor.project.kind_of_page(self.canvas.page)
        return definition.page == kind and not definition.id.startswith("my.define.")

    def _words(self, text: str, count: int) -> str:
        if text.strip() and not count:
            return tr("No block says that. Try other words, such as “wait 2” or “repeat”.")
        if not count:
            return tr("Type what should happen.")
        return tr("Enter inserts, Ctrl+Enter inserts and goes on, Tab completes, Esc closes.")

    def _move(self) -> None:
        """Be where the block is to go, inside the view."""
        view = self.canvas.viewport()
        line = self.fontMetrics().height()
        wide = min(max(self.list.sizeHint().width() + 40, 24 * line), view.width() - 16)
        rows = min(self.list.sizeHint().height() + 4, max(view.height() // 2, 6 * line))
        self.area.setFixedHeight(rows if self.list.rows else 0)
        self.setFixedWidth(wide)
        self.adjustSize()
        corner = view.geometry().topLeft() + self._target()
        if self.canvas.look.measures.is_mirrored:
            corner.setX(corner.x() - wide)
        x = min(max(corner.x(), 8), max(8, view.width() - wide - 8))
        y = min(max(corner.y(), 8), max(8, view.height() - self.height() - 8))
        self.move(x, y)

    def _target(self) -> QPoint:
        camera, view = self.canvas.sight.camera, self.canvas.viewport()
        if self._at is not None:
            return camera.to_view(self._at.x(), self._at.y()).toPoint()
        cursor = self.canvas.selection.cursor
        rect = self.canvas.sight.view_rect_of(cursor) if cursor else None
        if rect is None or not rect.intersects(view.rect()):
            return QPoint(view.width() // 3, view.height() // 3)
        corner = rect.bottomRight() if self.canvas.look.measures.is_mirrored else rect.bottomLeft()
        return corner.toPoint() + QPoint(0, 6)

    def _holds_focus(self) -> bool:
        focused = QApplication.focusWidget()
        return focused is not None and (focused is self or self.isAncestorOf(focused))

    def _leave(self) -> None:
        self.hide()
        self.canvas.setFocus(Qt.FocusReason.OtherFocusReason)
