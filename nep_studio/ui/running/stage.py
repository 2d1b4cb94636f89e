"""Shows on the canvas what a running program does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from nep_core import messages as m
from nep_studio.blocks.generate.reporter_places import ReporterPlaces
from nep_studio.blocks.generate.source_map import Code
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.menu_entries import MenuEntry, MenuPlace
from nep_studio.ui.words import tr

from .breakpoints import Breakpoints
from .marks import Marks
from .overlay import RunOverlay, touched
from .runner import Runner

if TYPE_CHECKING:
    from collections.abc import Iterable

Batch = list[tuple[str, object]]


class Stage(QObject):
    """The glow, the pauses, the counts and the values on one canvas at a time."""

    def __init__(self, runner: Runner, breakpoints: Breakpoints) -> None:
        super().__init__(runner)
        self.marks = Marks()
        self.overlay = RunOverlay()
        self.overlay.marks = self.marks
        self._breakpoints = breakpoints
        self._canvas: Canvas | None = None
        runner.arrived.connect(self._on_arrived)
        runner.state_changed.connect(self._on_state_changed)
        breakpoints.changed.connect(self._on_breakpoints_changed)

    def show_on(self, canvas: Canvas) -> None:
        """Show it on this canvas from now on."""
        self._canvas = canvas
        canvas.overlays.append(self.overlay)
        canvas.menu_sections.append(self._menu)

    def begin(self, code: Code) -> None:
        """A program is about to run: nothing is known of it yet."""
        places = None
        if self._canvas is not None and code.text:
            editor = self._canvas.editor
            places = ReporterPlaces(code, editor.project, editor.language)
        self.marks = self.overlay.marks = Marks(code, places)
        self.overlay.names = dict(code.variables)
        self._repaint_all()

    def clear(self) -> None:
        """Forget what ran: another project is shown."""
        self.begin(Code("", ()))

    def _on_arrived(self, batch: Batch) -> None:
        states = [message for _, message in batch if isinstance(message, m.ProgramState)]
        if not states:
            return
        before = self._shown()
        values, results = dict(self.marks.values), _copied(self.marks.results)
        paused = dict(self.marks.paused)
        counts = self.marks.counts.copy()
        for state in states:
            self.marks.take(state)
        has_fewer = bool(counts - self.marks.counts)  # the program was started again
        if has_fewer or (values, results) != (self.marks.values, self.marks.results):
            self._repaint_all()
        else:
            self._touch(before ^ self._shown())
            self._touch(self.marks.counts - counts, with_chips=True)
        self._follow(paused)

    def _shown(self) -> frozenset[str]:
        marks = self.marks
        return marks.glowing | marks.around | frozenset(marks.paused.values())

    def _follow(self, before: dict[str, str]) -> None:
        """Show the block at which the program has just paused."""
        new = [block for thread, block in self.marks.paused.items() if before.get(thread) != block]
        canvas = self._canvas
        if new and canvas is not None and new[0] in canvas.editor.project.blocks:
            canvas.show_block(new[0])

    def _touch(self, blocks: Iterable[str], *, with_chips: bool = False) -> None:
        if self._canvas is not None and self._canvas.isVisible():
            touched(self._canvas, blocks, with_chips=with_chips)

    def _repaint_all(self) -> None:
        if self._canvas is not None:
            self._canvas.viewport().update()

    def _on_state_changed(self, state: str) -> None:
        if state == "idle":
            before = self._shown()
            self.marks.still()
            self._touch(before)

    def _on_breakpoints_changed(self) -> None:
        self.overlay.breakpoints = self._breakpoints.ids
        self._repaint_all()

    def _menu(self, canvas: Canvas, place: MenuPlace) -> list[MenuEntry]:
        """Let the program pause at a block."""
        if place.hit is None or canvas.editor.project.kind_of_page(canvas.page) != "behaviour":
            return []
        block = statement_at(canvas, place.hit.block)
        if not block:
            return []
        is_on = block in self._breakpoints.ids
        words = tr("Do not pause here any more") if is_on else tr("Pause here")
        toggle = self._breakpoints.toggle
        return [MenuEntry("breakpoint", words, lambda: toggle([block]), "pause", True, "F9")]


def _copied(results: dict[str, dict[str, str]]) -> dict[str, dict[str, str]]:
    return {statement: dict(given) for statement, given in results.items()}


def statement_at(canvas: Canvas, block: str) -> str:
    """The block that does something which a block is, or is a part of; "" where there is none."""
    project, language = canvas.editor.project, canvas.editor.language
    while block in project.blocks:
        definition = language.definitions.get(project.blocks[block].type)
        if definition is not None and definition.shape in ("statement", "c", "cap", "hat"):
            return block
        parent = project.parents.get(block)
        block = parent.owner if parent is not None else ""
    return ""
