"""A small card beside a block that says what it is; and what opening a block does."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QRect, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QPushButton, QTextBrowser, QVBoxLayout

from nep_studio.blocks.operations.finding import Subject, subjects_of
from nep_studio.blocks.procedures import CALL, header_of, procedure_of
from nep_studio.help.texts import block_page
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.fields.field_edit import beside
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.words import tr

from .find_bar import FindBar
from .help_card_words import card_text

WIDTH_LETTERS = 46


class HelpCard(QFrame):
    """Tells about one block; a press elsewhere or Esc takes it away.

    ``more_asked`` brings the page of the block, for which there is a button and F1.
    """

    more_asked = Signal(str)

    def __init__(self, canvas: Canvas, block: str) -> None:
        super().__init__(canvas, Qt.WindowType.Popup)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setObjectName("help_card")
        direction = Qt.LayoutDirection
        mirrored = canvas.look.measures.is_mirrored
        self.setLayoutDirection(direction.RightToLeft if mirrored else direction.LeftToRight)
        self._canvas, self._block = canvas, block
        self.text = QTextBrowser()
        self.text.setFrameShape(QFrame.Shape.NoFrame)
        self.text.setHtml(card_text(canvas.editor, block))
        told = self.text.toPlainText()
        self.setAccessibleName(tr("Help"))
        self.setAccessibleDescription(told)
        self.text.setAccessibleName(told)
        theme = canvas.look.theme
        self.setStyleSheet(
            f"#help_card {{ background: {theme.colour('menu').name()};"
            f" border: 1px solid {theme.colour('field_line').name()}; }}"
            f" QTextBrowser {{ background: {theme.colour('menu').name()};"
            f" color: {theme.colour('text').name()}; }}"
        )
        box = QVBoxLayout(self)
        box.setContentsMargins(*(self.fontMetrics().height() // 2,) * 4)
        box.addWidget(self.text)
        self.more = QPushButton(tr("More…"))
        self.more.setProperty("kind", "quiet")
        self.more.setToolTip(tr("The page about this block (F1)"))
        self.more.clicked.connect(self._ask_for_more)
        self.more.hide()
        box.addWidget(self.more, 0, Qt.AlignmentFlag.AlignTrailing)

    def offer_more(self) -> None:
        """Have a button that leads to the page about the block."""
        self.more.show()

    def show_beside(self) -> None:
        """Show it beside its block, inside the screen; what is too long scrolls."""
        rect = self._canvas.sight.view_rect_of(self._block)
        if rect is None:
            self.deleteLater()
            return
        viewport = self._canvas.viewport()
        visible = rect.toAlignedRect() & viewport.rect()
        head = QRect(visible.topLeft(), QSize(visible.width(), min(visible.height(), 60)))
        head.moveTopLeft(viewport.mapToGlobal(head.topLeft()))
        room = room_around(self._canvas)
        self.ensurePolished()
        most = room.height() * 2 // 3
        line = self.fontMetrics().height()
        width = self.fontMetrics().averageCharWidth() * WIDTH_LETTERS
        document = self.text.document()
        document.setTextWidth(width - 2 * line)
        below = 0 if self.more.isHidden() else self.more.sizeHint().height()
        wanted = round(document.size().height()) + 2 * line + below
        self.resize(QSize(width, min(wanted, most)).expandedTo(self.minimumSizeHint()))
        mirrored = self._canvas.look.measures.is_mirrored
        self.move(beside(head, self.size(), room, is_mirrored=mirrored))
        self.show()
        # shown, it may be larger than it was made: its style is known only now
        self.move(beside(head, self.size(), room, is_mirrored=mirrored))
        self.text.setFocus(Qt.FocusReason.PopupFocusReason)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc takes it away, F1 leads to the page."""
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        elif event.key() == Qt.Key.Key_F1 and not self.more.isHidden():
            self._ask_for_more()
        else:
            super().keyPressEvent(event)

    def _ask_for_more(self) -> None:
        block_type = self._canvas.editor.project.blocks[self._block].type
        self.close()
        self.more_asked.emit(block_page(block_type))


class BlockOpening(QObject):
    """What opening a block of a canvas shows: a definition, uses, or what the block is.

    ``page_asked`` brings the page about a block; while ``is_page_shown``, the small card is left
    out.
    """

    page_asked = Signal(str)

    def __init__(self, canvas: Canvas, find_bar: FindBar) -> None:
        super().__init__(canvas)
        self._canvas, self._find_bar = canvas, find_bar
        self.is_page_shown: Callable[[], bool] | None = None
        canvas.news.block_opened.connect(self.open)
        canvas.news.help_requested.connect(self._on_help_requested)

    @property
    def canvas(self) -> Canvas:
        """The canvas whose blocks are opened."""
        return self._canvas

    def answer(self, block: str) -> None:
        """Tell about a block: on its page where that is open, else on a small card."""
        blocks = self._canvas.editor.project.blocks
        if block in blocks and self.is_page_shown is not None and self.is_page_shown():
            self.page_asked.emit(block_page(blocks[block].type))
        else:
            self.show_card(block)

    def open(self, block: str) -> None:
        """Show what there is to see of a block without a field."""
        canvas = self._canvas
        project = canvas.editor.project
        if block not in project.blocks:
            return
        block_type = project.blocks[block].type
        header = header_of(project, procedure_of(block_type))
        subject = self._value_subject(block)
        if block_type.startswith(CALL) and header:
            canvas.show_block(header)
            canvas.selection.set([header])
        elif subject is not None:
            self._find_bar.show_uses(subject)
        else:
            self.show_card(block)

    def show_card(self, block: str) -> None:
        """Tell about a block, beside it."""
        editor = self._canvas.editor
        found = editor.project.blocks.get(block)
        if found is not None and found.type in editor.language.definitions:
            card = HelpCard(self._canvas, block)
            card.more_asked.connect(self.page_asked)
            if self.is_page_shown is not None:
                card.offer_more()
            card.show_beside()

    def _value_subject(self, block: str) -> Subject | None:
        """The variable or parameter that a block stands for, and nothing else."""
        editor = self._canvas.editor
        definition = editor.language.definitions.get(editor.project.blocks[block].type)
        if definition is None or not definition.is_value:
            return None
        kinds = {slot.kind.name for slot in definition.slots.values()}
        if kinds - {"variable"}:
            return None
        subject = next(iter(subjects_of(editor.project, editor.language, block)), None)
        return subject if subject and subject.kind in ("variable", "parameter") else None

    def _on_help_requested(self, page: str) -> None:
        self.answer(self._canvas.selection.cursor)
