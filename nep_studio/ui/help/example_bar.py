"""The buttons below a page that has an example: put it on the page, or try it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QSize, Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QWidget

from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.operations.pasting import paste
from nep_studio.blocks.program import PAGES
from nep_studio.blocks.text import sentence
from nep_studio.help.examples import Example
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.insert_bar_places import free_place
from nep_studio.ui.theme import Theme, icon
from nep_studio.ui.words import language_code, tr

from .book import Book
from .drawing import arrange


class ExampleBar(QWidget):
    """Acts on the example of the page. ``try_requested`` brings a project that can run."""

    try_requested = Signal(object)

    def __init__(self, canvas: Canvas, book: Callable[[], Book], parent: QWidget) -> None:
        super().__init__(parent)
        self._canvas, self._book = canvas, book
        self._example: Example | None = None
        self._title = ""
        self.can_insert = True
        self.insert = QPushButton(tr("Put it on the page"))
        self.try_it = QPushButton(tr("Try it"))
        self.try_it.setProperty("kind", "primary")
        self.insert.setToolTip(tr("Put the blocks of the example into your program"))
        self.try_it.setToolTip(tr("Run the example as a project of its own"))
        self.insert.clicked.connect(self.put_on_page)
        self.try_it.clicked.connect(self.ask_to_try)
        gap = self.fontMetrics().height() // 3
        row = QHBoxLayout(self)
        row.setContentsMargins(gap, gap, gap, gap)
        row.addWidget(self.insert, 1)
        row.addWidget(self.try_it, 1)
        self.hide()

    def show_example(self, example: Example | None, title: str) -> None:
        """Act on this example; without one there are no buttons."""
        self._example, self._title = example, title
        self.setVisible(example is not None)
        self.insert.setVisible(self.can_insert)
        if example is not None:
            told = self._spoken(example)
            self.insert.setAccessibleDescription(told)
            self.try_it.setAccessibleDescription(told)

    def dress(self, theme: Theme) -> None:
        """Take the theme and the size of the text."""
        side = self.fontMetrics().height()
        self.insert.setIcon(icon("plus", theme))
        self.try_it.setIcon(icon("play", theme.colour("accent_text")))
        for button in (self.insert, self.try_it):
            button.setIconSize(QSize(side, side))

    def put_on_page(self) -> bool:
        """Put the example's blocks where there is room, each on the page where it belongs."""
        if self._example is None:
            return False
        canvas, made = self._canvas, list[str]()
        clips = {page: self._clip(self._example, page) for page in PAGES}
        if not canvas.attempt(lambda: made.extend(self._put_all(clips))) or not made:
            return False
        canvas.selection.set(made)
        canvas.show_block(made[0])
        told = sentence(canvas.editor.project, canvas.editor.language, made[0])
        canvas.announced.emit(tr("added: {block}", block=told))
        return True

    def ask_to_try(self) -> None:
        """Ask to run the example as a project of its own."""
        if self._example is not None:
            language = self._book().language
            project = self._example.project(language, language_code(), self._title)
            arrange(project, language, self._canvas.measures)
            self.try_requested.emit(project)

    def _clip(self, example: Example, page: str) -> Clip:
        clip = example.clip(self._book().language, language_code(), page)
        arrange(clip.project, self._book().language, self._canvas.measures)
        return clip

    def _put_all(self, clips: Mapping[str, Clip]) -> list[str]:
        """Put the blocks of each page on it, in one step; gives those of the last page."""
        made: list[str] = []
        with self._canvas.editor.transaction("add blocks"):
            for page, clip in clips.items():
                if clip.stacks:
                    made = list(self._put(clip, page))
        return made

    def _put(self, clip: Clip, page: str) -> tuple[str, ...]:
        canvas = self._canvas
        if canvas.editor.project.kind_of_page(canvas.page) != page:
            canvas.show_page(page)
        where = free_place(canvas, clip)
        return paste(canvas.editor, clip, canvas.page, where.x(), where.y())

    def _spoken(self, example: Example) -> str:
        """The example's blocks as sentences."""
        language = self._book().language
        clip = example.clip(language, language_code())
        blocks = (each for root in clip.roots for each in clip.project.within(root))
        definitions = language.of(clip.project).definitions
        steps = (block for block in blocks if not definitions[block.type].is_value)
        return ". ".join(sentence(clip.project, language, block.id) for block in steps)
