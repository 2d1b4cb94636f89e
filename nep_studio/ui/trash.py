"""What was deleted in this session, to be brought back; undo does not empty it."""

from __future__ import annotations

from collections import deque
from itertools import count

from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.operations.copying import Clip
from nep_studio.blocks.operations.pasting import paste
from nep_studio.blocks.program import PAGES
from nep_studio.blocks.text import sentence
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.insert_bar_places import free_place
from nep_studio.ui.words import count_words, tr

MOST_KEPT = 50


class Trash(QObject):
    """Keeps the last deleted blocks of one canvas, the newest first."""

    changed = Signal()

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.canvas = canvas
        self.clips: deque[tuple[int, Clip]] = deque(maxlen=MOST_KEPT)
        self._numbers = count(1)
        canvas.blocks_deleted.connect(self.add)

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
        canvas.announced.emit(tr("brought back"))
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
