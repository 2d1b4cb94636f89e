"""The pane with the Python of the blocks: read it, find blocks by it, change it."""

from __future__ import annotations

import math
from collections.abc import Iterable

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QGuiApplication, QHideEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QPushButton, QVBoxLayout, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import BlocksError, CodeRefused, EditRefused
from nep_studio.blocks.generate.program import ProgramGenerator, generate_launch
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Changes
from nep_studio.blocks.slices import Sliced, Steps
from nep_studio.ui.canvas.selection import Selection
from nep_studio.ui.edits import edits_of
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.message_cards import MessageText
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .code_text import CodeText

# The Python of the page that is shown, made again after each edit; a long one in slices.

FRAME_MS = 16
SLICE_S = 0.008
"""How long the making may take of one frame of the screen."""

BETWEEN_SLICES_MS = 4


class LiveCode(QObject):
    """Follows an editor; it works only while it is ``awake``, that is, while somebody looks.

    ``made`` gives the Code; ``refused`` the CodeRefused, when a block cannot become code;
    ``began`` says that it takes longer than one slice: what comes of it comes later.
    """

    began = Signal()
    made = Signal(object)
    refused = Signal(object)

    def __init__(self, editor: Editor, parent: QObject) -> None:
        super().__init__(parent)
        self._editor = editor
        self._generator: ProgramGenerator | None = None
        self._procedures = -1
        self._page = "behaviour"
        self._is_awake = False
        self._is_old = True
        self.code: Code | None = None
        self._next_frame = QTimer(self, singleShot=True, interval=FRAME_MS)
        self._next_frame.timeout.connect(self.start)
        self._work: Sliced[Code] | None = None
        self._next_slice = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next_slice.timeout.connect(self._on_next_slice)

    @property
    def program(self) -> Code | None:
        """The program as it is now, where it was made already."""
        is_made = self._is_awake and not self._is_old and self._work is None
        return self.code if is_made and self._page == "behaviour" else None

    def set_editor(self, editor: Editor) -> None:
        """Follow another project."""
        if self._is_awake:
            self._follow(False)
        self._editor = editor
        self._generator = self.code = None
        if self._is_awake:
            self._follow(True)
        self._grow_old()

    def _follow(self, is_followed: bool) -> None:
        edits = edits_of(self._editor)
        if is_followed:
            edits.edited.connect(self._on_edited)
            edits.settled.connect(self._on_settled)
        else:
            edits.edited.disconnect(self._on_edited)
            edits.settled.disconnect(self._on_settled)

    def show_page(self, page: str) -> None:
        """Give the code of the kind of this page: the program, or what starts robots and nodes."""
        kind = self._editor.project.kind_of_page(page)
        if kind != self._page:
            self._page = kind
            self._grow_old()

    def use_language(self) -> None:
        """The editor speaks another language now."""
        self._generator = None
        self._grow_old()

    def set_awake(self, is_awake: bool) -> None:
        """Work only while somebody looks; what is edited meanwhile is not followed."""
        if is_awake != self._is_awake:
            self._is_awake = is_awake
            self._follow(is_awake)
        if not is_awake:
            self.cancel()
            self._is_old = True
        elif self._is_old:
            self.start()

    def start(self) -> None:
        """Begin to make the code: most is made at once, a long one bit by bit."""
        if not self.make(SLICE_S):
            self.began.emit()
            self._next_slice.start()

    def make(self, slice_s: float = math.inf) -> bool:
        """Make the code now, for so long at most; whether it is over."""
        self.cancel()
        self._is_old = False
        self._work = Sliced(self._steps())
        return self._take_slice(slice_s)

    def cancel(self) -> None:
        """Give up what is being made; it is old then."""
        self._next_frame.stop()
        self._next_slice.stop()
        if self._work is not None:
            self._work.cancel()
            self._work, self._is_old = None, True

    def _on_next_slice(self) -> None:
        if self._work is not None and not self._take_slice(SLICE_S):
            self._next_slice.start()

    def _take_slice(self, slice_s: float) -> bool:
        """Make a part of the code, and tell when it is whole; whether it is over."""
        work = self._work
        assert work is not None
        try:
            if not work.run(slice_s):
                return False
        except CodeRefused as refusal:
            self._work = self.code = None
            self.refused.emit(refusal)
            return True
        self._work, self.code = None, work.result
        self.made.emit(self.code)
        return True

    def _steps(self) -> Steps[Code]:
        editor = self._editor
        if self._page != "behaviour":
            yield
            return generate_launch(editor.project, editor.language)
        if self._generator is None or self._procedures != editor.project.procedure_revision:
            self._procedures = editor.project.procedure_revision
            self._generator = ProgramGenerator(editor.project, editor.language)
        return (yield from self._generator.steps())

    def _on_edited(self, _changes: Changes) -> None:
        self.cancel()
        self._is_old = True

    def _on_settled(self, _changes: Changes) -> None:
        if self._is_old:
            self.start()

    def _grow_old(self) -> None:
        self.cancel()
        self._is_old = True
        if self._is_awake:
            self._next_frame.start()


class CodePane(QWidget):
    """Shows the code of an editor; ``block_asked`` asks to see the block of a line."""

    block_asked = Signal(str)
    applied = Signal()

    def __init__(self, editor: Editor, look: Look, selection: Selection) -> None:
        super().__init__()
        self._editor, self._look = editor, look
        self._selection = selection
        self._kind = "behaviour"
        self.is_editing = False
        self.live = LiveCode(editor, self)
        self.text = CodeText(look, self)
        self.note = QFrame()
        self.note.hide()
        self.copy_button, self.edit_button = QPushButton(), QPushButton()
        self.apply_button, self.discard_button = QPushButton(), QPushButton()
        labelled(self, name="Python")
        self.apply_button.setProperty("kind", "primary")
        gap = self.fontMetrics().height() // 3
        self.title = ElidedLabel(all_or_none=True)
        self.title.setProperty("role", "hint")
        self.buttons = in_row((self.title, 1), margins=(2 * gap, gap, gap, gap), spacing=gap)
        self.setMinimumWidth(9 * self.fontMetrics().height())  # its buttons can do without words
        for button in (self.copy_button, self.edit_button, self.discard_button, self.apply_button):
            self.buttons.addWidget(button)
        QVBoxLayout(self.note)
        in_column(self.buttons, self.note, (self.text, 1), of=self, margins=0, spacing=0)
        self.text.setStyleSheet("QPlainTextEdit { border: none; border-radius: 0; }")
        self._connect()
        self._on_theme_changed()
        follow_words(self, self._show_buttons)

    def _connect(self) -> None:
        self.live.began.connect(self._on_code_began)
        self.live.made.connect(self._on_code_made)
        self.live.refused.connect(self._on_code_refused)
        self.text.line_clicked.connect(self._on_line_clicked)
        self.copy_button.clicked.connect(self._on_copy_clicked)
        self.edit_button.clicked.connect(self.begin_editing)
        self.apply_button.clicked.connect(self.apply)
        self.discard_button.clicked.connect(self._end_editing)
        self._look.theme_changed.connect(self._on_theme_changed)
        self._selection.changed.connect(self._mark)

    # What is shown

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the words on the buttons where there is room for them."""
        super().resizeEvent(event)
        self._name_buttons()

    def set_editor(self, editor: Editor) -> None:
        """Show the code of another project."""
        self._editor = editor
        self._end_editing()
        self.live.set_editor(editor)

    def show_page(self, page: str) -> None:
        """Show the code of this kind of page."""
        kind = self._editor.project.kind_of_page(page)
        if kind != self._kind and self.is_editing:
            return  # the person is writing; the page may be another one meanwhile
        self._kind = kind
        self.live.show_page(page)
        self._show_buttons()

    def showEvent(self, event: QShowEvent) -> None:
        """Work while somebody looks."""
        super().showEvent(event)
        self.live.set_awake(not self.is_editing)
        self._mark()

    def hideEvent(self, event: QHideEvent) -> None:
        """Rest when nobody looks."""
        super().hideEvent(event)
        self.live.set_awake(False)

    def _mark(self) -> None:
        """Mark the lines of the selected blocks."""
        code = self.live.code
        if code is None or self.is_editing or not self.isVisible():
            return
        lines = {line for block in self._selection.ids for line in self._lines_of(code, block)}
        self.text.mark_lines(sorted(lines))

    def _lines_of(self, code: Code, block: str) -> Iterable[int]:
        """The lines of a block; a value is in the lines of the statement that it belongs to."""
        project = self._editor.project
        while block in project.blocks:
            lines = code.lines_of(block)
            if lines:
                return lines
            block = project.parents[block].owner
        return ()

    def _on_code_began(self) -> None:
        self.title.set_words(tr("Making the Python…"))
        if self.live.code is None and not self.is_editing:
            self.text.show_text("")  # not that of another project

    def _on_code_made(self, code: Code) -> None:
        if self.is_editing:
            return
        self._show_title()
        self.note.hide()
        self.text.show_text(code.text)
        self._mark()

    def _on_code_refused(self, refusal: CodeRefused) -> None:
        if self.is_editing:
            return
        self._show_buttons()
        show = Answer(tr("Show the block"), lambda: self.block_asked.emit(refusal.block), "primary")
        self._tell(refusal, *([show] if refusal.block else []))

    def _on_line_clicked(self, line: int) -> None:
        code = self.live.code
        block = code.block_at(line) if code is not None and not self.is_editing else None
        if block is not None:
            self.block_asked.emit(block)

    def _on_copy_clicked(self) -> None:
        self.text.show_rest()
        QGuiApplication.clipboard().setText(self.text.toPlainText() + "\n")

    # Changing it

    def begin_editing(self) -> None:
        """Let the person change the text."""
        self.live.make()
        self.is_editing = True
        self.live.set_awake(False)
        self.text.mark_lines(())
        self.text.set_editable(True)
        self.text.setFocus()
        self._show_buttons()

    def apply(self) -> None:
        """Make the blocks what the text says; when it cannot be, nothing has changed."""
        from nep_studio.blocks.from_python.learning import CodeUnread
        from nep_studio.blocks.from_python.updating import update_from_python

        self.text.mark_wrong(())
        try:
            with self._editor.history.as_own():
                update_from_python(self._editor, self.text.toPlainText() + "\n")
        except CodeUnread as error:
            self.text.mark_wrong([error.line])
            self._tell(error)
            return
        except (CodeRefused, EditRefused) as error:
            self._tell(error)
            return
        self._end_editing()
        self.applied.emit()

    def _end_editing(self) -> None:
        """Forget what was typed, if it was not applied."""
        self.note.hide()
        if not self.is_editing:
            return
        self.is_editing = False
        self.text.mark_wrong(())
        self.text.set_editable(False)
        self._show_buttons()
        self.live.show_page(self._kind)
        self.live.start()
        self.live.set_awake(self.isVisible())

    def _tell(self, error: BlocksError, *answers: Answer) -> None:
        """Say above the text what is wrong."""
        box = self.note.layout()
        assert box is not None
        while (item := box.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        checklist = tuple(map(tr, error.checklist))
        box.addWidget(MessageText(Message("error", tr(error.title), tr(error.sentence), checklist)))
        for answer in answers:
            button = QPushButton(answer.words)
            button.clicked.connect(answer.do)
            box.addWidget(button)
        self.note.setProperty("kind", "error")
        self.note.style().unpolish(self.note)
        self.note.style().polish(self.note)
        self.note.show()

    def _show_buttons(self) -> None:
        can_edit = self._kind == "behaviour"
        self.copy_button.setVisible(not self.is_editing)
        self.edit_button.setVisible(not self.is_editing and can_edit)
        self.apply_button.setVisible(self.is_editing)
        self.discard_button.setVisible(self.is_editing)
        self._name_buttons()
        self._show_title()

    def _show_title(self) -> None:
        can_edit = self._kind == "behaviour"
        reading = tr("Made from the blocks") if can_edit else tr("Starts the robots and nodes")
        self.title.set_words(tr("You are changing the Python") if self.is_editing else reading)

    def _name_buttons(self) -> None:
        """Give the buttons their words, or where these have no room, signs and tips alone."""
        names = {
            self.copy_button: tr("Copy"),
            self.edit_button: tr("Edit"),
            self.apply_button: tr("Apply"),
            self.discard_button: tr("Discard"),
        }
        for button, words in names.items():
            button.setText(words)
            button.setAccessibleName(words)
        shown = [button for button in names if not button.isHidden()]
        wanted = sum(button.sizeHint().width() + self.buttons.spacing() for button in shown)
        is_narrow = wanted + 3 * self.buttons.spacing() > self.width()
        for button, words in names.items():
            button.setText("" if is_narrow else words)
            button.setToolTip(words if is_narrow else "")

    def _on_theme_changed(self) -> None:
        theme = self._look.theme
        self.copy_button.setIcon(icon("copy", theme))
        self.edit_button.setIcon(icon("pencil", theme))
        self.discard_button.setIcon(icon("x", theme))
        self.apply_button.setIcon(icon("check", theme.colour("accent_text")))
