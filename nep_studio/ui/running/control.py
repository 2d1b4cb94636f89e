"""What the window does about a run: what is open, what stands in the way, and how it ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.checks.diagnostic import Diagnostic, Severity
from nep_studio.blocks.code_text import plainly_in_a_line
from nep_studio.blocks.deployment import names_used, node_entries, robot_entries
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import ON_ERROR, Changes, Project
from nep_studio.problems import Problem
from nep_studio.project.triggers import Kind, Occurrence, occurrences_of
from nep_studio.project.trust import Concern
from nep_studio.run.controller import (
    BecameStale,
    Begun,
    Checked,
    Ended,
    Event,
    NeedsApproval,
    Refused,
    Subject,
    Troubled,
)
from nep_studio.run.gate import concerns_of
from nep_studio.run.plan import VIRTUAL_WATCH, WATCHES, Choices, PlannedNode
from nep_studio.ui.edits import edits_of
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr
from nep_studio.ui.workbench.pages_bar import page_title

from .needs import NeedsDialog, is_real
from .runner import Runner
from .stage import Breakpoints, Stage, statement_at
from .trust import TrustDialog

if TYPE_CHECKING:
    from nep_studio.ui.documents import Document
    from nep_studio.ui.host import Host


class RunControl(QObject):
    """Runs the window's project.

    ``became_stale`` tells that the blocks have changed since the program was started,
    ``plan_changed`` that the project needs other nodes now, or nodes with other settings.
    """

    became_stale = Signal()
    plan_changed = Signal()

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        self._host = host
        logs = host.services.settings.folder_for("logs")
        self.runner = Runner(self.planned, self, subject=self._subject, logs=logs)
        self.breakpoints = Breakpoints(self)
        self.stage = Stage(self.runner, self.breakpoints)
        self.line_s = 0.0
        self._virtual: frozenset[str] = frozenset()
        """The real robots that the one on the screen stands in for."""
        self._document: Document | None = None
        self._ran: Document | None = None
        """What was open when the program was started."""
        self._plan: tuple[Subject, list[PlannedNode]] | None = None
        """The nodes of the open project, as it was when it was settled or somebody asked."""
        self._is_settled = False
        """Whether nothing was edited since it was looked what the nodes follow from."""
        self._wanted: object = None
        """What the nodes of the open project follow from, as it was when it was last told."""
        self._troubles: dict[int, Message] = {}
        """What was told of lines of the program while it ran."""
        self._marked: Message | None = None
        """What was told of a project that brings more than blocks."""
        self._told_of_end: Message | None = None
        """What went wrong with the last run; it is over when the next one begins."""
        self._away: set[str] = set()
        """The robots that did not answer when something was last heard of the way to them."""
        self.runner.told.connect(self._on_told)
        self.runner.nodes_changed.connect(self._on_nodes_changed)
        self.runner.approval_needed.connect(self._on_approval_needed)
        self.runner.keep_own = self._keep_own
        self.asks_over: QWidget | None = None
        """Where it asks, instead of over the window: a show covers that."""
        self.breakpoints.changed.connect(self._on_watching_changed)

    @property
    def is_stale(self) -> bool:
        """Whether the blocks have changed since the program was started."""
        return self.runner.controller.is_stale

    def attach(self) -> None:
        """Show on the canvas what runs, now that there is one."""
        self.stage.show_on(self._host.workbench.canvas)

    def follow(self, document: Document | None) -> None:
        """Another project is shown, or none: what runs belongs to the one before."""
        if document is self._document:
            return
        if self._document is not None:
            edits = edits_of(self._document.editor)
            edits.edited.disconnect(self._on_edited)
            edits.settled.disconnect(self._on_settled)
        if document is not None:
            edits = edits_of(document.editor)
            edits.edited.connect(self._on_edited)
            edits.settled.connect(self._on_settled)
        self._document = document
        self._virtual = frozenset()
        self._on_settled(Changes(whole=True))
        self.stop()
        self.stage.clear()
        self.breakpoints.clear()
        self._withdraw_mark()
        QTimer.singleShot(0, self, self._mark_strange)

    def _mark_strange(self) -> None:
        """Say that the open project brings what nobody here has approved; nothing runs yet."""
        if self._document is None or self._marked is not None or not self._strange():
            return
        self._marked = Message(
            "info",
            tr("“{name}” brings more than blocks", name=plainly_in_a_line(self._document.title)),
            tr("You are asked about it before it runs."),
            answers=(Answer(tr("See what it brings…"), self._show_strange),),
        )
        self._host.services.messages.tell(self._marked)

    def _strange(self) -> Sequence[Concern]:
        """What nobody here has approved in the open project."""
        if self._document is None:
            return ()
        self._keep_own()
        project, language = self._document.project, self._host.services.language
        found = concerns_of(project, language, self._document.folder)
        return self.runner.gate.unapproved(found)

    def _show_strange(self) -> None:
        if left := self._strange():
            self._ask(left, self.runner.run)
        else:
            self._withdraw_mark()

    def _withdraw_mark(self) -> None:
        if self._marked is not None:
            self._host.services.messages.withdraw(self._marked)
            self._marked = None

    def try_example(self, path: Path) -> None:
        """Open an example, and run it; only it, should the person go elsewhere instead."""
        self._host.services.files.open_example(path, self.runner.controller.run_next)

    def close(self) -> None:
        """Stop everything, and wait for it."""
        self.runner.close()

    def try_project(self, project: Project) -> None:
        """Run a little program of the help; the project on the canvas stays as it is."""
        if self.runner.controller.state != "idle":
            self._host.services.messages.refuse(
                "Another program is running.", ("Stop it, then try again.",)
            )
            return
        subject = Subject(project, self._host.services.language, Path.cwd())
        found = concerns_of(project, subject.language, subject.folder)
        self.runner.gate.vouch(concern.key for concern in found)  # the help is ours
        self.runner.controller.try_out(subject)

    def planned(self) -> list[PlannedNode]:
        """The nodes that the open project needs now."""
        document = self._host.services.document
        if document is None:
            return []
        language = self._host.services.language
        subject = Subject(document.project, language, document.folder, self._choices())
        if self._plan is None or self._plan[0] != subject or not self._is_settled:
            self._plan = subject, subject.nodes()
        return list(self._plan[1])

    def toggle_breakpoint(self) -> None:
        """Pause at the selected blocks, or no longer."""
        canvas = self._host.workbench.canvas
        blocks = {statement_at(canvas, block) for block in canvas.selection.ids} - {""}
        if blocks:
            self.breakpoints.toggle(blocks)

    def end_on_error(self, does_end: bool) -> None:
        """Let an error of one rule end the whole program, or let the other rules go on."""
        document = self._host.services.document
        if document is not None and document.project.ends_on_error != does_end:
            label = tr("change what an error ends")
            document.editor.apply(SetExtra(ON_ERROR, "end" if does_end else None), label)

    def set_pace(self, line_s: float) -> None:
        """Stay so long at each block."""
        self.line_s = line_s
        self._on_watching_changed()

    def use_simulator(self) -> None:
        """Let the robots on the screen play the parts of the real ones, and run."""
        self._virtual |= frozenset(  # those that it stands in for already stay with it
            planned.name for planned in self.planned() if is_real(planned)
        )
        self.plan_changed.emit()
        self.runner.run()

    def show_needs(self) -> None:
        """List what the program needs of the person."""
        self._host.workbench.checks.ask()
        NeedsDialog(self._host, self).open()

    def stop(self) -> None:
        """Stop everything that moves."""
        self.runner.stop()

    # What is to be run

    def _subject(self) -> Subject | None:
        document = self._host.services.document
        if document is None:
            self._host.services.messages.refuse(
                "There is no project to run.", ("Open or make one first.",)
            )
            return None
        self._keep_own()
        workbench, language = self._host.workbench, self._host.services.language
        subject = Subject(document.project, language, document.folder, self._choices())
        is_in_order, code = workbench.checks.is_in_order, workbench.code.live.program
        kept = document.kept_file
        is_planned = self._plan is not None and self._plan[0] == subject and self._is_settled
        known = self._plan[1] if self._plan is not None and is_planned and is_in_order else None
        return replace(subject, kept=kept, is_in_order=is_in_order, code=code, known=known)

    def _choices(self) -> Choices:
        """Who stands in for what, and the watch that somebody has left running."""
        tried = self.runner.told_elsewhere
        running = (node for node in self.runner.running if node.name not in tried)
        left = (node for node in running if node.node in WATCHES)
        return Choices(virtual=self._virtual, watch=next(left, None))

    def _stop_other_watches(self, nodes: Sequence[PlannedNode]) -> None:
        """Let no simulated person move who was left beside the watch of the program."""
        wanted = {node.name for node in nodes if node.is_sensory}
        left = [one.name for one in self.runner.running if one.node == VIRTUAL_WATCH]
        for name in left if wanted else ():
            if name not in wanted:
                self.runner.stop_node(name)

    def _keep_own(self) -> None:
        if self._document is not None:
            self._document.authorship.keep()

    def _on_edited(self, changes: Changes) -> None:
        self._is_settled = False
        self.runner.controller.edited(changes)

    def _on_settled(self, changes: Changes) -> None:
        """Look whether the nodes can be others now; what is kept may belong to any of them."""
        wanted: object = None
        if (document := self._document) is not None:
            project, language = document.project, document.editor.language
            wanted = (
                document.folder,
                node_entries(project, language),
                robot_entries(project, language),
                list(names_used(project, language, "gesture")),
                list(names_used(project, language, "arm")),
            )
        self._is_settled = True
        if changes.whole or changes.kept or wanted != self._wanted:
            self._wanted, self._plan = wanted, None
            self.planned()  # while the person looks: Run need not wait for it
            self.plan_changed.emit()

    def _on_watching_changed(self) -> None:
        self.runner.controller.watch(self.breakpoints.ids, self.line_s)

    # How it goes

    def _on_told(self, event: Event) -> None:
        match event:
            case Checked(problems, can_run):
                self._plan = None  # files may be there now that were not when it was made
                self._host.workbench.checks.take(problems)
                if not can_run:
                    self.show_needs()
            case Refused(error, is_shown):
                answers = []
                if isinstance(error, CodeRefused) and is_shown:
                    workbench, block = self._host.workbench, error.block
                    answers.append(
                        Answer(tr("Show the block"), lambda: workbench.show_block(block))
                    )
                self._host.services.messages.tell_error(error, *answers)
            case NeedsApproval(concerns, subject, request):
                self._ask(concerns, lambda: self.runner.begin(subject, request))
            case Begun(request):
                self._ran = self._document
                # Nothing is known of the program yet, and nothing of the last one counts any more
                messages = self._host.services.messages
                self._host.workbench.show_run_problem(None)
                self._host.workbench.checks.ask()
                messages.clear_passing()
                while self._troubles:
                    messages.withdraw(self._troubles.popitem()[1])
                if self._told_of_end is not None:
                    messages.withdraw(self._told_of_end)
                    self._told_of_end = None
                self._stop_other_watches(request.nodes)
                if request.is_shown:
                    self._show_who_acts(request.nodes)
                # blocks that are not on the canvas may have the names of others there
                self.stage.begin(request.code if request.is_shown else Code("", ()))
            case BecameStale():
                self.became_stale.emit()
            case Troubled(problem, line, is_error) if self._ran is self._document:
                self._tell_trouble(problem, line, is_error)
            case Ended(runs_again=False) if self._ran is self._document:
                self._tell_end(event)

    def _on_approval_needed(self, concerns: Sequence[Concern], start: Callable[[], object]) -> None:
        self._ask(concerns, start)

    def _ask(self, concerns: Sequence[Concern], start: Callable[[], object]) -> None:
        """Ask whether all this may run, and let it start then."""

        def approve() -> None:
            self.runner.gate.approve(concerns)
            self._withdraw_mark()
            if self._document is not None:
                self._document.authorship.look_again()
            start()

        document = self._document
        name = document.title if document is not None else ""
        over = self.asks_over or self._host.widget
        dialog = TrustDialog(over, self._host.services.look, name, concerns, self._titles())
        dialog.accepted.connect(approve)
        dialog.open()

    def _titles(self) -> Mapping[str, str]:
        """What the pages of the project are called."""
        if self._document is None:
            return {}
        project = self._document.project
        return {page: page_title(project, page) for page in project.pages}

    def _show_who_acts(self, nodes: Sequence[PlannedNode]) -> None:
        """Show the robots, and what is done by hand when the program waits for that."""
        if any("robot" in node.parameters for node in nodes):
            self._host.ask("robots.show")
        document = self._host.services.document
        if document is None:
            return
        waits_for = occurrences_of(document.project, document.editor.language)
        if any(_is_by_hand(one, nodes) for one in waits_for):
            self._host.ask("person.show")

    # How it goes on, and how it ended

    def _tell_trouble(self, problem: Problem, line: int, is_error: bool) -> None:
        """Tell of a rule that has failed, or of a warning, while the program goes on."""
        answers = []
        block = self.stage.marks.code.block_at(line)
        if block is not None and block in self._host.workbench.canvas.editor.project.blocks:
            self._mark(block, problem, "error" if is_error else "warning")
            workbench = self._host.workbench
            answers.append(Answer(tr("Show the block"), lambda: workbench.show_block(block)))
        messages = self._host.services.messages
        messages.tell_problem(problem, *answers, kind="error" if is_error else "warning")
        self._troubles[line] = messages.history[-1].message

    def _tell_end(self, end: Ended) -> None:
        messages, problem = self._host.services.messages, end.ending.problem
        messages.clear_passing()  # that it runs is not true any more
        if problem is None:
            if not end.was_stopped:
                messages.confirm(tr("The program has ended."))
            return
        if (same := self._troubles.pop(end.ending.line, None)) is not None:
            messages.withdraw(same)  # the end says the same, and that it is the end
        answers = [Answer(tr("Run again"), self.runner.run)]
        block = self.stage.marks.code.block_at(end.ending.line)
        if block is not None and block in self._host.workbench.canvas.editor.project.blocks:
            self._mark(block, problem)
            workbench = self._host.workbench
            answers.insert(0, Answer(tr("Show the block"), lambda: workbench.show_block(block)))
        answers = [*self._ways_to_a_robot(had_begun=end.had_begun), *answers]
        messages.tell_problem(problem, *answers)
        self._told_of_end = messages.history[-1].message

    def _ways_to_a_robot(self, *, had_begun: bool) -> list[Answer]:
        """What helps when a real robot was not there, or has gone."""
        real = [node.name for node in self.planned() if is_real(node)]
        meant = [name for name in real if name in self._away] or ([] if had_begun else real)
        if not meant:
            return []
        use = Answer(tr("Use the robot on the screen"), self.use_simulator)
        find = tr("Find it and test the connection")
        return [use, Answer(find, lambda: self._host.ask("connecting.open", meant[0]))]

    def _on_nodes_changed(self, names: Sequence[str]) -> None:
        for name in names:
            status = self.runner.board.nodes.get(name)
            if status is not None and status.event == "connection_failed":
                self._away.add(name)
            elif status is not None and status.is_there:
                self._away.discard(name)

    def _mark(self, block: str, problem: Problem, severity: Severity = "error") -> None:
        """Show the sentence at the block that failed."""
        workbench = self._host.workbench
        page = workbench.canvas.editor.project.page_of(block)
        sentence, steps = problem.sentence, problem.checklist
        shown = Diagnostic("error", "run", page, block, sentence, steps)
        workbench.show_run_problem(replace(shown, severity=severity))
        workbench.show_block(block)


BY_A_PERSON: frozenset[Kind] = frozenset(
    (
        *("word", "face", "distance", "touch", "gesture", "arm", "ball", "mark", "sound"),
        *("emotion", "state"),
    )
)
"""What somebody does before a robot; the rest is measured, or happens by itself."""


def _is_by_hand(what: Occurrence, nodes: Sequence[PlannedNode]) -> bool:
    """Whether the person at this computer does it: no real robot, no watch is there for it."""
    if what.kind in ("gesture", "arm"):
        virtual = (node for node in nodes if node.node == VIRTUAL_WATCH)
        return any(not node.parameters.get("gestures") for node in virtual)
    return what.kind in BY_A_PERSON and not any(is_real(node) for node in nodes)
