"""The find bar: looks through the whole program, and shows where a thing is used."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer
from PySide6.QtGui import QHideEvent, QKeyEvent, QPainter, QShowEvent
from PySide6.QtWidgets import QFrame, QLabel, QLineEdit, QToolButton, QWidget

from nep_studio.blocks.editor import History
from nep_studio.blocks.edits.content import SetFlag
from nep_studio.blocks.operations.finding import Subject, definition_of, find, subjects_of, uses_of
from nep_studio.blocks.procedures import parameters, words
from nep_studio.blocks.program import Changes, Project
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.canvas.painting.overlay import rings
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import count_words, tr

# The overlay that marks what was found.


class HitOverlay:
    """A broad line around each found block in view, and a broader one around the current."""

    def __init__(self) -> None:
        self._ids: frozenset[str] = frozenset()
        self._current = ""

    def show(self, ids: Sequence[str], current: str) -> None:
        """Mark these."""
        self._ids, self._current = frozenset(ids), current

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the lines; only blocks in view are looked at, however many were found."""
        if not self._ids:
            return
        colour = view.look.theme.colour("search_hit")
        pixel = 1 / view.sight.camera.scale
        shown = view.page_layout.boxes(view.sight.visible_page_rect())
        found = [placed for placed in shown if placed.box.block in self._ids]
        rings(painter, view, found, colour, 4 * pixel)
        current = view.page_layout.placed(self._current) if self._current else None
        if current is not None:
            rings(painter, view, [current], view.look.theme.colour("focus"), 9 * pixel)
            rings(painter, view, [current], colour, 5 * pixel)


# What the subjects of the find bar are called.


def subject_name(project: Project, subject: Subject) -> str:
    """What a thing is called: variables and own blocks are known by ids."""
    if subject.kind == "variable":
        variable = project.variable(subject.name)
        return variable.name if variable is not None else subject.name
    own, _, parameter = subject.name.partition(".")
    procedure = project.procedures.get(own)
    if subject.kind == "procedure" and procedure is not None:
        return words(procedure)
    if subject.kind == "parameter" and procedure is not None:
        named = {p.id: p.name for p in parameters(procedure)}
        return named.get(parameter, parameter)
    return subject.name


class FindBar(QFrame):
    """Finds by words, or shows the uses of a subject; hits are marked on the canvas.

    It is hidden until it is opened, and lives above the canvas.
    """

    def __init__(self, canvas: CanvasHost, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.canvas = canvas
        self.hits: tuple[str, ...] = ()
        self.index = -1
        self._subject: Subject | None = None
        self._history: History | None = None
        self._is_following = False
        self._overlay = HitOverlay()
        canvas.news.page_changed.connect(self._listen)
        canvas.news.uses_requested.connect(self.show_uses)
        self.title = QLabel(self)
        self.line = labelled(
            QLineEdit(self), placeholder="Find in the program", name="Find in the program"
        )
        self.count = QLabel(self)
        self.previous = explained(QToolButton(self), "Previous (Shift+Enter)")
        self.next = explained(QToolButton(self), "Next (Enter)")
        self.away = explained(QToolButton(self), "Close (Esc)")
        labelled(self, name="Find")
        self._later = QTimer(self, singleShot=True, interval=0)
        self._arrange()
        follow_words(self, self.refresh)
        self.hide()

    # Opening

    def refresh(self) -> None:
        """Take the theme, the words and the project of the canvas."""
        theme, side = self.canvas.look.theme, self.fontMetrics().height()
        for button, name in (
            (self.previous, "chevron-up"),
            (self.next, "chevron-down"),
            (self.away, "x"),
        ):
            button.setIcon(icon(name, theme))
            button.setIconSize(QSize(side, side))
        self._listen()
        if self.isVisible():
            self._search(is_new=False)

    def open(self, text: str | None = None) -> None:
        """Ask for words to find."""
        self._show_subject(None)
        self._listen()
        self.show()
        if text is not None:
            self.line.setText(text)
        self.line.selectAll()
        self.line.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self._search(is_new=True)

    def show_uses(self, subject: Subject) -> None:
        """Show all blocks that name a thing."""
        self._listen()
        self._show_subject(subject)
        self.show()
        self._search(is_new=True)
        self.next.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def show_uses_of(self, block: str) -> bool:
        """Show the uses of what a block names first; False when it names nothing."""
        subject = self._subject_of(block)
        if subject is None:
            self.canvas.news.refused.emit(tr("This block names nothing that is used elsewhere."))
            return False
        self.show_uses(subject)
        return True

    def go_to_definition(self, block: str) -> bool:
        """Show where what a block names is defined; False when it is nowhere."""
        editor, subject = self.canvas.editor, self._subject_of(block)
        found = definition_of(editor.project, editor.language, subject) if subject else None
        if found is None:
            self.canvas.news.refused.emit(
                tr("What this block names is not defined in this program.")
            )
            return False
        self._reveal(found)
        return True

    def close_bar(self) -> None:
        """Mark nothing any more, and give the canvas the keyboard."""
        self.hits, self.index = (), -1
        self._mark()
        self.hide()
        self.canvas.area.setFocus(Qt.FocusReason.OtherFocusReason)

    # Going

    def step(self, by: int) -> None:
        """Go so many hits on, or back; after the last comes the first."""
        if not self.isVisible():
            self.open()
            return
        if self.hits:
            self._go(0 if self.index < 0 and by > 0 else (self.index + by) % len(self.hits))

    def _go(self, index: int) -> None:
        self.index = index
        block = self.hits[index]
        self._reveal(block)
        self._tell()
        self._mark()

    def _reveal(self, block: str) -> None:
        """Show a block: on its page, and out of the blocks that are folded around it."""
        canvas = self.canvas
        project, editor = canvas.editor.project, canvas.editor
        folded, owner = [], project.parents[block].owner
        while owner in project.blocks:
            if project.blocks[owner].collapsed:
                folded.append(owner)
            owner = project.parents[owner].owner
        if folded:
            with editor.transaction(tr("unfold blocks")):
                for outer in folded:
                    editor.apply(SetFlag(outer, "collapsed", False))
        canvas.show_block(block)
        canvas.selection.set([block])

    # Searching

    def _search(self, *, is_new: bool) -> None:
        editor = self.canvas.editor
        before = self.hits[self.index] if 0 <= self.index < len(self.hits) else ""
        if self._subject is not None:
            self.hits = uses_of(editor.project, editor.language, self._subject)
        else:
            self.hits = find(editor.project, editor.language, self.line.text())
        if before in self.hits:
            self.index = self.hits.index(before)
        else:
            self.index = -1
            if is_new and self.hits:
                self._go(self._first_hit())
        self._tell()
        self._mark()

    def _first_hit(self) -> int:
        """The first hit on the page that is shown, so that one does not jump away while typing."""
        project, page = self.canvas.editor.project, self.canvas.page_layout.page
        here = {stack.id for stack in project.pages.get(page, [])}
        on_page = (n for n, b in enumerate(self.hits) if project.stack_of(b).id in here)
        return next(on_page, 0)

    def _tell(self) -> None:
        is_asked = bool(self.line.text().strip()) or self._subject is not None
        if self.hits:
            number = max(self.index, 0) + 1
            told = tr("{number} of {count}", number=number, count=len(self.hits))
        else:
            told = tr("Nothing found") if is_asked else ""
        if told != self.count.text():
            self.count.setText(told)
            self.canvas.news.announced.emit(told)
        wrong = "wrong" if is_asked and not self.hits else ""
        if self.line.property("state") != wrong:
            self.line.setProperty("state", wrong)
            self.line.style().polish(self.line)
        for button in (self.previous, self.next):
            button.setEnabled(bool(self.hits))
        if self._subject is not None:
            name, count = subject_name(self.canvas.editor.project, self._subject), len(self.hits)
            uses = count_words(count, "1 use of {name}", "{n} uses of {name}", name=name)
            self.title.setText(uses)

    def _mark(self) -> None:
        current = self.hits[self.index] if 0 <= self.index < len(self.hits) else ""
        self._overlay.show(self.hits, current)
        self.canvas.layers.show_overlay(self._overlay, is_shown=bool(self.hits))
        self.canvas.area.viewport().update()

    # Subjects

    def _subject_of(self, block: str) -> Subject | None:
        editor = self.canvas.editor
        if block not in editor.project.blocks:
            return None
        return next(iter(subjects_of(editor.project, editor.language, block)), None)

    def _show_subject(self, subject: Subject | None) -> None:
        self._subject = subject
        self.title.setVisible(subject is not None)
        self.line.setVisible(subject is None)

    # Put together

    def _arrange(self) -> None:
        row = in_row(self.title, (self.line, 1), self.count, of=self, margins=(8, 4, 8, 4))
        for button in (self.previous, self.next, self.away):
            row.addWidget(button)
            button.setAutoRaise(True)
        self.previous.clicked.connect(lambda: self.step(-1))
        self.next.clicked.connect(lambda: self.step(1))
        self.away.clicked.connect(self.close_bar)
        self.line.textEdited.connect(lambda: self._search(is_new=True))
        self._later.timeout.connect(lambda: self._search(is_new=False))
        self.installEventFilter(self)
        for widget in (self.line, self.previous, self.next, self.away):
            widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Enter and F3 go on, with Shift back; Esc closes."""
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        key = event.key()
        is_back = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if key == Qt.Key.Key_Escape:
            self.close_bar()
        elif key == Qt.Key.Key_F3 or (
            key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and watched is self.line
        ):
            self.step(-1 if is_back else 1)
        else:
            return super().eventFilter(watched, event)
        return True

    def _listen(self) -> None:
        history = self.canvas.editor.history
        if history is not self._history:
            if self._history is not None:
                self.hits, self.index = (), -1
            self._rest()
            self._history = history
            if self.isVisible():
                self._follow()

    def showEvent(self, event: QShowEvent) -> None:
        """Follow the program."""
        super().showEvent(event)
        self._follow()

    def hideEvent(self, event: QHideEvent) -> None:
        """Follow nothing while nobody looks."""
        super().hideEvent(event)
        self._rest()

    def _follow(self) -> None:
        if self._history is not None and not self._is_following:
            self._is_following = True
            self._history.listen(self._on_changes)

    def _rest(self) -> None:
        if self._history is not None and self._is_following:
            self._is_following = False
            self._history.unlisten(self._on_changes)

    def _on_changes(self, changes: Changes) -> None:
        blocks = self.canvas.editor.project.blocks
        self.hits = tuple(hit for hit in self.hits if hit in blocks)
        self._later.start()
