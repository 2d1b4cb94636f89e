"""Run, Stop, Pause and Step in the window: checks first, tells how it ended."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.errors import NepError
from nep_studio import cues, surroundings
from nep_studio.blocks.checks import Problem as BlockProblem
from nep_studio.blocks.checks.problem import page_of
from nep_studio.blocks.deployment import rules
from nep_studio.blocks.errors import BlocksError, CodeRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Changes, Project
from nep_studio.plan import Choices, PlannedNode, plan
from nep_studio.session import Ending, Watching
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr

from .breakpoints import Breakpoints
from .needs import NeedsDialog
from .play import Request
from .preparing import Preparation
from .runner import Runner
from .stage import Stage, statement_at

if TYPE_CHECKING:
    from nep_studio.ui.documents import Document
    from nep_studio.ui.main_window import MainWindow

log = logging.getLogger(__name__)

AT_ONCE = frozenset((cues.KEY, surroundings.KEY))
"""What a project keeps that a running program needs no new start for."""


class RunControl(QObject):
    """Runs the window's project; it stays when the window's contents are made anew.

    ``became_stale`` tells that the blocks have changed since the program was started.
    """

    became_stale = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.runner = Runner(self.planned, self, logs=window.settings.folder_for("logs"))
        self.breakpoints = Breakpoints(self)
        self.stage = Stage(self.runner, self.breakpoints)
        self.line_s = 0.0
        self._virtual: frozenset[str] = frozenset()
        """The real robots that the one on the screen stands in for."""
        self._document: Document | None = None
        self._preparation: Preparation | None = None
        self._told_of_end: Message | None = None
        """What went wrong with the last run; it is over when the next one begins."""
        self._is_waiting = False
        self._was_stopped = False
        self._has_begun = False
        self._is_to_run_again = False
        self.is_stale = False
        """Whether the blocks have changed since the program was started."""
        self.runner.run_asked.connect(self._on_run_asked)
        self.runner.state_changed.connect(self._on_state_changed)
        self.runner.ended.connect(self._on_ended)
        self.breakpoints.changed.connect(self._on_watching_changed)

    def attach(self) -> None:
        """Work with the workbench that the window has now."""
        workbench = self._window.workbench
        self.stage.show_on(workbench.canvas)
        workbench.problems_found.connect(self._on_problems_found)

    def follow(self, document: Document | None) -> None:
        """Another project is shown, or none: what runs belongs to the one before."""
        if document is self._document:
            return
        if self._document is not None:
            self._document.editor.history.unlisten(self._on_edited)
        if document is not None:
            document.editor.history.listen(self._on_edited)
        self._document = document
        self._virtual = frozenset()
        self.stop()
        self.stage.clear()
        self.breakpoints.clear()

    def try_example(self, path: Path) -> None:
        """Open an example, and run it; only it, should the person go elsewhere instead."""
        self._window.files.open_example(path, self._run_soon)

    def _run_soon(self) -> None:
        self._is_to_run_again = self.runner.state != "idle"
        if not self._is_to_run_again:
            QTimer.singleShot(0, self, self.runner.run)

    def close(self) -> None:
        """Stop everything, and wait for it."""
        self.stop()
        self.runner.close()

    def try_project(self, project: Project) -> None:
        """Run a little program of the help; the project on the canvas stays as it is."""
        if self.runner.state != "idle" or self._preparation is not None:
            self._window.messages.refuse(
                "Another program is running.", ("Stop it, then try again.",)
            )
            return
        language = self._window.studio.language
        try:
            code = generate_program(project, language)
            nodes = plan(project, language, Choices(), Path.cwd())
        except (BlocksError, NepError) as error:
            self._window.messages.tell_error(error)
            return
        self._was_stopped = self._has_begun = self.is_stale = False
        self.stage.clear()  # its blocks are not on the canvas: there others may have their names
        self.runner.start(Request(code, tuple(nodes), Watching((), self.line_s)))

    def planned(self) -> list[PlannedNode]:
        """The nodes that the open project needs now."""
        document = self._window.files.document
        if document is None:
            return []
        language = self._window.studio.language
        choices = Choices(virtual=self._virtual)
        return plan(document.project, language, choices, document.folder)

    def toggle_breakpoint(self) -> None:
        """Pause at the selected blocks, or no longer."""
        canvas = self._window.workbench.canvas
        blocks = {statement_at(canvas, block) for block in canvas.selection.ids} - {""}
        if blocks:
            self.breakpoints.toggle(blocks)

    def set_pace(self, line_s: float) -> None:
        """Stay so long at each block."""
        self.line_s = line_s
        self._on_watching_changed()

    def use_simulator(self) -> None:
        """Let the robots on the screen play the parts of the real ones, and run."""
        self._virtual |= frozenset(  # those that it stands in for already stay with it
            planned.name
            for planned in self.planned()
            if planned.parameters.get("driver") == "naoqi"
        )
        self.runner.run()

    def show_needs(self) -> None:
        """List what the program needs, and what is there of it."""
        NeedsDialog(self._window, self).open()

    # Run

    def _on_run_asked(self) -> None:
        """Check first; the answer comes when the checks are done."""
        if self._window.files.document is None:
            self._window.messages.refuse(
                "There is no project to run.", ("Open or make one first.",)
            )
            return
        if self.runner.state == "running":
            self.stop()
            self._is_to_run_again = True
            return
        self._is_waiting = True
        self._window.workbench.checks.start()

    def _on_problems_found(self, problems: list[BlockProblem]) -> None:
        if not self._is_waiting:
            return
        self._is_waiting = False
        document = self._window.files.document
        if document is None or self.runner.state != "idle":
            return
        language = self._window.studio.language
        has_rules = next(rules(document.project, language), None) is not None
        if not has_rules or any(problem.severity == "error" for problem in problems):
            self.show_needs()
            return
        self.begin()

    def begin(self) -> None:
        """Run the program as it is now; its Python is made first."""
        document = self._document
        if document is None or self._preparation is not None:
            return
        preparation = self._preparation = Preparation(document.editor, self)
        preparation.done.connect(self._on_prepared)
        preparation.refused.connect(self._on_refused)

    def _on_prepared(self, code: Code) -> None:
        self._preparation = None
        window = self._window
        try:
            nodes = self.planned()
        except (BlocksError, NepError) as error:
            window.messages.tell_error(error)
            return
        self._was_stopped = self._has_begun = self.is_stale = False
        window.workbench.show_run_problem(None)
        window.messages.clear_passing()
        if self._told_of_end is not None:
            window.messages.withdraw(self._told_of_end)
            self._told_of_end = None
        self.stage.begin(code)
        watching = Watching(self.breakpoints.lines(code), self.line_s)
        self.runner.start(Request(code, tuple(nodes), watching))

    def _on_refused(self, error: BlocksError) -> None:
        self._preparation = None
        workbench = self._window.workbench
        answers = []
        if isinstance(error, CodeRefused):
            answers.append(Answer(tr("Show the block"), lambda: workbench.show_block(error.block)))
        self._window.messages.tell_error(error, *answers)

    def stop(self) -> None:
        """Stop everything that moves."""
        self._was_stopped = True
        self._is_waiting = self._is_to_run_again = False
        if self._preparation is not None:
            self._preparation.cancel()
            self._preparation = None
        self.runner.stop()

    def _on_watching_changed(self) -> None:
        code = self.stage.marks.code
        self.runner.watch(Watching(self.breakpoints.lines(code), self.line_s))

    # How it went

    def _on_state_changed(self, state: str) -> None:
        if state == "running":
            self._has_begun = True
            self._show_robots()

    def _show_robots(self) -> None:
        """Let a person who has never shown nor hidden the robots see them at the first run."""
        window = self._window
        if not any("robot" in one.parameters for one in self.planned()):
            return
        for panel in window.workbench.panels.all:
            if panel.name == "RobotsPanel" and not window.settings.is_chosen(panel.name):
                window.workbench.panels.show(panel.widget)

    def _on_edited(self, changes: Changes) -> None:
        if changes.kept and changes.kept <= AT_ONCE and not changes.stacks:
            return
        if self.runner.state != "idle" and not self.is_stale:
            self.is_stale = True
            self.became_stale.emit()

    def _on_ended(self, ending: Ending) -> None:
        if self._is_to_run_again:
            self._is_to_run_again = False
            self.runner.run()
            return
        messages, problem = self._window.messages, ending.problem
        if problem is None:
            if not self._was_stopped:
                messages.confirm(tr("The program has ended."))
            return
        answers = [Answer(tr("Run again"), self.runner.run)]
        block = self.stage.marks.code.block_at(ending.line)
        if block is not None and block in self._window.workbench.canvas.editor.project.blocks:
            self._mark(block, ending)
            workbench = self._window.workbench
            answers.insert(0, Answer(tr("Show the block"), lambda: workbench.show_block(block)))
        if not self._has_begun and self._has_real_robots():
            answers.insert(0, Answer(tr("Use the robot on the screen"), self.use_simulator))
        messages.tell_problem(problem, *answers)
        self._told_of_end = messages.history[-1].message

    def _mark(self, block: str, ending: Ending) -> None:
        """Show the sentence at the block that failed."""
        workbench = self._window.workbench
        project = workbench.canvas.editor.project
        assert ending.problem is not None
        page = page_of(project, block)
        sentence, steps = ending.problem.sentence, ending.problem.checklist
        problem = BlockProblem("error", "run", page, block, sentence, steps)
        workbench.show_run_problem(problem)
        workbench.show_block(block)

    def _has_real_robots(self) -> bool:
        return any(one.parameters.get("driver") == "naoqi" for one in self.planned())
