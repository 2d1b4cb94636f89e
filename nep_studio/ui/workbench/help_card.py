"""A small card beside a block that says what it is; and what opening a block does."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from html import escape
from itertools import islice

from PySide6.QtCore import QObject, QRect, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QPushButton, QTextBrowser

from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.operations.finding import Subject, subjects_of
from nep_studio.blocks.procedures import CALL, header_of, procedure_of
from nep_studio.blocks.slots import RESULTS
from nep_studio.blocks.text import sentence
from nep_studio.help.texts import block_page
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.fields.editors import hint_of
from nep_studio.ui.canvas.fields.field_edit import beside
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .find_bar import FindBar
from .palette.entries import Stock, does, python

# What the card says about a block: its kind, its places, its Python.

MOST_CHOICES = 8
MOST_INSIDE = 200
"""A block with more blocks inside shows the Python of a fresh one: that is soon made and read."""


def card_text(editor: Editor, block_id: str) -> str:
    """All about a block, as rich text."""
    project, language = editor.project, editor.language
    definition = language.definitions[project.blocks[block_id].type]
    parts = [f"<h3>{escape(sentence(project, language, block_id))}</h3>"]
    parts += [f"<p>{escape(text)}</p>" for text in _about(definition)]
    own = project.procedures.get(procedure_of(definition.id))
    if own is not None and own.origin is not None:
        title, version = own.origin.title or own.origin.pack, own.origin.version
        told = tr("It is from “{title}”, version {version}.", title=title, version=version)
        parts.append(f"<p>{escape(told)}</p>")
    places = "".join(f"<li>{escape(words)}</li>" for words in _places(editor, block_id))
    if places:
        parts.append(f"<p>{escape(tr('Its places:'))}</p><ul>{places}</ul>")
    code = _python(editor, block_id)
    if code:
        parts.append(f"<p>{escape(tr('In Python:'))}</p>")
        parts.append(f"<pre dir='ltr' style='white-space: pre-wrap'>{escape(code)}</pre>")
    return "".join(parts)


def _about(definition: Definition) -> Iterator[str]:
    yield from (text for text in does(definition) if text)
    yield shape_words(definition)
    yield from flag_words(definition)
    if "silent" in definition.flags:
        yield tr("It is for people who read the program: the robot does nothing.")
    yield tr("Blocks like this are in “{category}”.", category=definition.category.title)


def shape_words(definition: Definition) -> str:
    """What such blocks are for, by their shape."""
    if definition.is_last:
        return tr("It ends what is above it: no block comes after it.")
    if definition.shape == "reporter":
        result = tr(RESULTS[definition.result or "any"])
        return tr("It is a value to put into a place of another block: {result}.", result=result)
    return {
        "hat": tr("It begins a stack: the blocks below it belong to it."),
        "c": tr("It holds other blocks, and decides when or how often they run."),
        "boolean": tr("It answers yes or no, in a place with the same pointed shape."),
    }.get(definition.shape, tr("It is one step: when it is done, the block below it follows."))


def flag_words(definition: Definition) -> Iterator[str]:
    """Where such blocks belong, how the robot must be for them, and how it is afterwards."""
    flags = {
        "in_loop": tr("It belongs inside a loop."),
        "stands": tr("The robot must stand for it."),
        "stands_up": tr("The robot stands afterwards."),
        "rests": tr("The robot rests afterwards, and cannot move until it wakes up."),
    }
    return (told for flag, told in flags.items() if flag in definition.flags)


def _places(editor: Editor, block_id: str) -> Iterator[str]:
    """Each place once, with what it takes."""
    block = editor.project.blocks[block_id]
    definition = editor.language.definitions[block.type]
    told: set[str] = set()
    for key, slot in definition.keys(block.groups):
        if slot.name not in told:
            told.add(slot.name)
            choices = list(editor.language.choices_of(slot, block, key).values())
            yield _place(slot, choices)


def _place(slot: Slot, choices: list[str]) -> str:
    if not choices:
        return hint_of(slot)
    shown = ", ".join(choices[:MOST_CHOICES])
    more = ", …" if len(choices) > MOST_CHOICES else ""
    return f"{hint_of(slot)} ({shown}{more})"


def _python(editor: Editor, block_id: str) -> str:
    project = editor.project
    inside = project.within([block_id])
    if next(islice(inside, MOST_INSIDE, None), None) is None:
        return python(project, editor.language, block_id)
    stock = Stock(editor)
    return python(stock.project, stock.language, stock.sample(project.blocks[block_id].type))


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
        self.more = QPushButton(tr("More…"))
        self.more.setProperty("kind", "quiet")
        self.more.setToolTip(tr("The page about this block (F1)"))
        self.more.clicked.connect(self._ask_for_more)
        self.more.hide()
        more = (self.more, 0, Qt.AlignmentFlag.AlignTrailing)
        in_column(self.text, more, of=self, margins=self.fontMetrics().height() // 2)

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
        self.canvas, self._find_bar = canvas, find_bar
        self.is_page_shown: Callable[[], bool] | None = None
        canvas.news.block_opened.connect(self.open)
        canvas.news.help_requested.connect(lambda: self.answer(canvas.selection.cursor))

    def answer(self, block: str) -> None:
        """Tell about a block: on its page where that is open, else on a small card."""
        blocks = self.canvas.editor.project.blocks
        is_page_shown = self.is_page_shown is not None and self.is_page_shown()
        if block in blocks and is_page_shown and not self._is_told(blocks[block].type):
            self.page_asked.emit(block_page(blocks[block].type))
        else:
            self.show_card(block)

    def open(self, block: str) -> None:
        """Show what there is to see of a block without a field."""
        canvas = self.canvas
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
        editor = self.canvas.editor
        found = editor.project.blocks.get(block)
        if found is not None and found.type in editor.language.definitions:
            card = HelpCard(self.canvas, block)
            card.more_asked.connect(self.page_asked)
            if self.is_page_shown is not None:
                card.offer_more()
            card.show_beside()

    def _is_told(self, block_type: str) -> bool:
        """Whether the person who made an own block says what it does: no page knows that."""
        definition = self.canvas.editor.language.definitions.get(block_type)
        return definition is not None and bool(definition.about)

    def _value_subject(self, block: str) -> Subject | None:
        """The variable or parameter that a block stands for, and nothing else."""
        editor = self.canvas.editor
        definition = editor.language.definitions.get(editor.project.blocks[block].type)
        if definition is None or not definition.is_value:
            return None
        kinds = {slot.kind.name for slot in definition.slots.values()}
        if kinds - {"variable"}:
            return None
        subject = next(iter(subjects_of(editor.project, editor.language, block)), None)
        return subject if subject and subject.kind in ("variable", "parameter") else None
