"""Run, Stop, Pause and Step in the window: checks first, tells how it ended."""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QObject, QSize, Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_core.errors import NepError
from nep_studio.blocks.checks.problem import Problem, page_of
from nep_studio.blocks.checks.problem import Problem as BlockProblem
from nep_studio.blocks.deployment import rules
from nep_studio.blocks.errors import BlocksError, CodeRefused, EditRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.operations.fixes import add_start
from nep_studio.blocks.program import Changes, Project
from nep_studio.project import surroundings, triggers
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import Choices, PlannedNode, plan
from nep_studio.run.session import Ending, Watching
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.words import tr

from .runner import Preparation, Request, Runner
from .stage import Breakpoints, Stage, statement_at

if TYPE_CHECKING:
    from nep_studio.ui.documents import Document
    from nep_studio.ui.host import Host

log = logging.getLogger(__name__)


# What a program needs before it can run, and what is there of it, as data.

NAOQI_PORT = 9559
PROBE_S = 1.5

State = Literal["met", "automatic", "looking", "missing"]
FixName = Literal[
    "add_start", "fix_problem", "show_block", "start_node", "simulator", "address", "connect"
]


@dataclass(frozen=True)
class NeedFix:
    """A button beside a need: what it does, and its words."""

    name: FixName
    words: str


@dataclass(frozen=True)
class Need:
    """Something a program needs.

    ``automatic``: not there yet, but Run starts it. ``block`` and ``node`` are what it is about.
    """

    state: State
    title: str
    sentence: str = ""
    fixes: tuple[NeedFix, ...] = ()
    block: str = ""
    node: PlannedNode | None = None
    problem: Problem | None = None


def needs_of(
    problems: Sequence[Problem],
    nodes: Sequence[PlannedNode],
    board: Mapping[str, NodeStatus],
    answers: Mapping[str, bool],
    *,
    has_rules: bool,
    is_connected: bool,
) -> list[Need]:
    """All needs, those that are missing first.

    ``answers`` tells whether a real robot answered at its address; a robot that is not in there
    is still looked for.
    """
    errors = [problem for problem in problems if problem.severity == "error"]
    needs = [_problem(problem) for problem in errors if problem.kind != "no_rule"]
    if not has_rules:
        needs.append(_rules())
    needs.append(_master(is_connected))
    for node in nodes:
        status = board.get(node.name)
        needs.append(_robot(node, answers) if is_real(node) else _node(node, status))
    order: dict[State, int] = {"missing": 0, "looking": 1, "automatic": 2, "met": 3}
    return sorted(needs, key=lambda need: order[need.state])


def is_real(node: PlannedNode) -> bool:
    """Whether a node drives a robot that stands somewhere."""
    return node.parameters.get("driver") == "naoqi"


def answers_at(address: str) -> bool:
    """Whether something answers at a robot's address; waits a moment for it."""
    host, _, port = address.strip().partition(":")
    try:
        with socket.create_connection((host, int(port or NAOQI_PORT)), PROBE_S):
            return True
    except (OSError, ValueError, OverflowError):
        return False


def _rules() -> Need:
    fix = NeedFix("add_start", tr("Add “when the program starts”"))
    title = tr("Something to do")
    sentence = tr("Nothing happens yet: every program begins with a block that says when.")
    return Need("missing", title, sentence, (fix,))


def _problem(problem: Problem) -> Need:
    fixes = [NeedFix("fix_problem", tr(problem.fix.label))] if problem.fix is not None else []
    if problem.block:
        fixes.append(NeedFix("show_block", tr("Show the block")))
    steps = " ".join(map(tr, problem.checklist))
    return Need("missing", tr(problem.sentence), steps, tuple(fixes), problem.block, None, problem)


def _master(is_connected: bool) -> Need:
    if is_connected:
        return Need("met", tr("The NEP master"), tr("It runs: the nodes can find each other."))
    sentence = tr("It brings the nodes together. Run starts it.")
    return Need("automatic", tr("The NEP master"), sentence)


def _node(node: PlannedNode, status: NodeStatus | None) -> Need:
    title = tr("The node {name}", name=node.name)
    reason = tr(node.reason) if node.reason else ""
    if status is not None and status.is_there:
        return Need("met", title, tr("It runs."), node=node)
    start = NeedFix("start_node", tr("Start it now"))
    told = tr("Run starts it.")
    words = f"{reason[:1].upper()}{reason[1:]}. {told}" if reason else told
    return Need("automatic", title, words, (start,), node.block_id, node)


def _robot(node: PlannedNode, answers: Mapping[str, bool]) -> Need:
    address = str(node.parameters.get("address", ""))
    title = tr("The robot {name} at {address}", name=node.name, address=address)
    if node.name not in answers:
        return Need("looking", title, tr("Looking whether it answers…"), node=node)
    if answers[node.name]:
        return Need("met", title, tr("It answers."), node=node)
    sentence = tr(
        "It does not answer. Is it switched on, and in the same network as this computer?"
        " Press its chest button once: it says its address."
    )
    fixes = (
        NeedFix("simulator", tr("Use the robot on the screen")),
        NeedFix("connect", tr("Find it and test the connection")),
        NeedFix("address", tr("Change the address")),
    )
    return Need("missing", title, sentence, fixes, node.block_id, node)


# The dialog that lists what a program needs, with a button for each thing that is missing.

LOOKS = {
    "met": ("circle-check", "success"),
    "automatic": ("clock", "info"),
    "looking": ("refresh-cw", "muted"),
    "missing": ("circle-alert", "error"),
}


LOOK_MS = 50


class NeedsDialog(QDialog):
    """Follows the program, its nodes and its robots as long as it is open."""

    def __init__(self, host: Host, control: RunControl) -> None:
        super().__init__(host.widget)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("What the program needs"))
        self._host, self._control = host, control
        self._answers: dict[str, bool] = {}
        self._asked: set[tuple[str, str]] = set()
        self._news: SimpleQueue[tuple[str, bool]] = SimpleQueue()
        self._next_look = QTimer(self, interval=LOOK_MS)
        self._next_look.timeout.connect(self._take_answers)
        self.needs: list[Need] = []
        line = self.fontMetrics().height()
        self._headline = QLabel()
        self._headline.setProperty("role", "title")
        self._headline.setWordWrap(True)
        self._scroll = QScrollArea()
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        self._scroll.setAccessibleName(self.windowTitle())
        buttons = QDialogButtonBox()
        self.run_button = buttons.addButton(tr("Run"), QDialogButtonBox.ButtonRole.AcceptRole)
        self.run_button.setProperty("kind", "run")
        self.run_button.setIcon(icon("play", host.services.look.theme, "run_text"))
        self.run_button.setIconSize(icon_room(line))
        close = buttons.addButton(tr("Close"), QDialogButtonBox.ButtonRole.RejectRole)
        close.clicked.connect(self.reject)
        self.run_button.clicked.connect(self._on_run)
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line // 2)
        box.addWidget(self._headline)
        box.addWidget(self._scroll, 1)
        box.addWidget(buttons)
        self.resize(line * 34, line * 26)
        host.workbench.checks.found.connect(self.refresh)
        control.runner.nodes_changed.connect(self.refresh)
        control.runner.connected.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Look again at everything."""
        document = self._host.services.document
        if document is None:
            self.reject()
            return
        nodes = self._control.planned()
        self._ask(nodes)
        language, runner = self._host.services.language, self._control.runner
        needs = needs_of(
            self._host.workbench.checks.problems,
            nodes,
            runner.board.nodes,
            self._answers,
            has_rules=next(rules(document.project, language), None) is not None,
            is_connected=runner.is_connected,
        )
        if needs != self.needs:
            self.needs = needs
            self._show()

    def _ask(self, nodes: list) -> None:  # type: ignore[type-arg]
        """Ask real robots whether they are there, each address once."""
        for node in nodes:
            address = str(node.parameters.get("address", ""))
            if is_real(node) and (node.name, address) not in self._asked:
                self._asked.add((node.name, address))
                self._answers.pop(node.name, None)
                told = (node.name, address, self._news)
                threading.Thread(target=_look_for, args=told, daemon=True).start()
                self._next_look.start()

    def _take_answers(self) -> None:
        while not self._news.empty():
            name, is_there = self._news.get()
            self._answers[name] = is_there
            self.refresh()
        if len(self._answers) == len(self._asked):
            self._next_look.stop()

    def _show(self) -> None:
        missing = [need for need in self.needs if need.state == "missing"]
        if missing:
            words = tr("Before it can run, this is needed:")
        else:
            words = tr("Everything is there: the program can run.")
        self._headline.setText(words)
        self.run_button.setEnabled(not missing and self._control.runner.state == "idle")
        inner = QWidget()
        line = self.fontMetrics().height()
        column = QVBoxLayout(inner)
        column.setContentsMargins(0, 0, line // 2, 0)
        column.setSpacing(line // 2)
        for need in self.needs:
            column.addWidget(self._row(need, line))
        column.addStretch(1)
        self._scroll.setWidget(inner)
        self._lead_on(inner if missing else None)

    def _lead_on(self, rows: QWidget | None) -> None:
        """Let Enter do what comes next: the first thing that is missing, at last Run."""
        fix = rows.findChild(QPushButton) if rows is not None else None
        button = self.run_button if rows is None else fix
        if button is not None:
            button.setDefault(True)
            button.setFocus()

    def _row(self, need: Need, line: int) -> QWidget:
        row = QFrame()
        row.setProperty("kind", "card")
        sign_name, colour = LOOKS[need.state]
        sign, words = QLabel(), QVBoxLayout()
        side = round(line * 1.2)
        picture = icon(sign_name, self._host.services.look.theme.colour(colour))
        sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))
        title, sentence = QLabel(need.title), QLabel(need.sentence)
        title.setWordWrap(True)
        title.setProperty("role", "heading")
        sentence.setWordWrap(True)
        sentence.setProperty("role", "hint")
        words.setSpacing(line // 6)
        words.addWidget(title)
        if need.sentence:
            words.addWidget(sentence)
        buttons = QHBoxLayout()
        for fix in need.fixes:
            buttons.addWidget(self._button(need, fix))
        buttons.addStretch(1)
        if need.fixes:
            words.addLayout(buttons)
        box = QHBoxLayout(row)
        box.setContentsMargins(line // 2, line // 2, line // 2, line // 2)
        box.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        box.addSpacing(line // 3)
        box.addLayout(words, 1)
        row.setAccessibleName(f"{need.title} {need.sentence}")
        return row

    def _button(self, need: Need, fix: NeedFix) -> QPushButton:
        button = QPushButton(fix.words)
        button.clicked.connect(lambda: self._fix(need, fix))
        return button

    def _fix(self, need: Need, fix: NeedFix) -> None:
        workbench, control = self._host.workbench, self._control
        match fix.name:
            case "fix_problem" if need.problem is not None:
                workbench.fix(need.problem)
            case "add_start":
                self._add_start()
            case "start_node" if need.node is not None:
                control.runner.start_node(need.node)
            case "simulator":
                self.accept()
                control.use_simulator()
            case "connect" if need.node is not None:
                self.accept()
                self._host.ask("connecting.open", need.node.name)
            case "show_block" | "address":
                self.accept()
                workbench.show_block(need.block)
        self.refresh()

    def _add_start(self) -> None:
        workbench = self._host.workbench
        try:
            workbench.show_block(add_start(workbench.canvas.editor))
        except EditRefused as refusal:
            self._host.services.messages.refuse(refusal.sentence, refusal.checklist)
        workbench.checks.start()

    def _on_run(self) -> None:
        self.accept()
        self._control.runner.run()


def _look_for(name: str, address: str, news: SimpleQueue[tuple[str, bool]]) -> None:
    """Tell whether a robot is there; the dialog may be gone by then, so that it is not touched."""
    news.put((name, answers_at(address)))


AT_ONCE = frozenset((triggers.KEY, surroundings.KEY))
"""What a project keeps that a running program needs no new start for."""


class RunControl(QObject):
    """Runs the window's project; it stays when the window's contents are made anew.

    ``became_stale`` tells that the blocks have changed since the program was started.
    """

    became_stale = Signal()

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        self._host = host
        self.runner = Runner(self.planned, self, logs=host.services.settings.folder_for("logs"))
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
        workbench = self._host.workbench
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
        self._host.services.files.open_example(path, self._run_soon)

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
            self._host.services.messages.refuse(
                "Another program is running.", ("Stop it, then try again.",)
            )
            return
        language = self._host.services.language
        try:
            code = generate_program(project, language)
            nodes = plan(project, language, Choices(), Path.cwd())
        except (BlocksError, NepError) as error:
            self._host.services.messages.tell_error(error)
            return
        self._was_stopped = self._has_begun = self.is_stale = False
        self.stage.clear()  # its blocks are not on the canvas: there others may have their names
        self.runner.start(Request(code, tuple(nodes), Watching((), self.line_s)))

    def planned(self) -> list[PlannedNode]:
        """The nodes that the open project needs now."""
        document = self._host.services.document
        if document is None:
            return []
        language = self._host.services.language
        choices = Choices(virtual=self._virtual)
        return plan(document.project, language, choices, document.folder)

    def toggle_breakpoint(self) -> None:
        """Pause at the selected blocks, or no longer."""
        canvas = self._host.workbench.canvas
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
        NeedsDialog(self._host, self).open()

    # Run

    def _on_run_asked(self) -> None:
        """Check first; the answer comes when the checks are done."""
        if self._host.services.document is None:
            self._host.services.messages.refuse(
                "There is no project to run.", ("Open or make one first.",)
            )
            return
        if self.runner.state == "running":
            self.stop()
            self._is_to_run_again = True
            return
        self._is_waiting = True
        self._host.workbench.checks.start()

    def _on_problems_found(self, problems: list[BlockProblem]) -> None:
        if not self._is_waiting:
            return
        self._is_waiting = False
        document = self._host.services.document
        if document is None or self.runner.state != "idle":
            return
        language = self._host.services.language
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
        host = self._host
        try:
            nodes = self.planned()
        except (BlocksError, NepError) as error:
            host.services.messages.tell_error(error)
            return
        self._was_stopped = self._has_begun = self.is_stale = False
        host.workbench.show_run_problem(None)
        host.services.messages.clear_passing()
        if self._told_of_end is not None:
            host.services.messages.withdraw(self._told_of_end)
            self._told_of_end = None
        self.stage.begin(code)
        watching = Watching(self.breakpoints.lines(code), self.line_s)
        self.runner.start(Request(code, tuple(nodes), watching))

    def _on_refused(self, error: BlocksError) -> None:
        self._preparation = None
        workbench = self._host.workbench
        answers = []
        if isinstance(error, CodeRefused):
            answers.append(Answer(tr("Show the block"), lambda: workbench.show_block(error.block)))
        self._host.services.messages.tell_error(error, *answers)

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
        host = self._host
        if not any("robot" in one.parameters for one in self.planned()):
            return
        for panel in host.workbench.panels.all:
            if panel.name == "RobotsPanel" and not host.services.settings.is_chosen(panel.name):
                host.show_panel(panel.widget)

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
        messages, problem = self._host.services.messages, ending.problem
        if problem is None:
            if not self._was_stopped:
                messages.confirm(tr("The program has ended."))
            return
        answers = [Answer(tr("Run again"), self.runner.run)]
        block = self.stage.marks.code.block_at(ending.line)
        if block is not None and block in self._host.workbench.canvas.editor.project.blocks:
            self._mark(block, ending)
            workbench = self._host.workbench
            answers.insert(0, Answer(tr("Show the block"), lambda: workbench.show_block(block)))
        if not self._has_begun and self._has_real_robots():
            answers.insert(0, Answer(tr("Use the robot on the screen"), self.use_simulator))
        messages.tell_problem(problem, *answers)
        self._told_of_end = messages.history[-1].message

    def _mark(self, block: str, ending: Ending) -> None:
        """Show the sentence at the block that failed."""
        workbench = self._host.workbench
        project = workbench.canvas.editor.project
        assert ending.problem is not None
        page = page_of(project, block)
        sentence, steps = ending.problem.sentence, ending.problem.checklist
        problem = BlockProblem("error", "run", page, block, sentence, steps)
        workbench.show_run_problem(problem)
        workbench.show_block(block)

    def _has_real_robots(self) -> bool:
        return any(one.parameters.get("driver") == "naoqi" for one in self.planned())
