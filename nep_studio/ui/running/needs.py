"""What a program needs before it can run: as data, and as a dialog with a button for each thing."""

from __future__ import annotations

import socket
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFrame,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.deployment import rules
from nep_studio.blocks.operations.fixes import add_start
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.background import Background
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.widgets.forms import breakable, keep_bold_room
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host

    from .control import RunControl

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
    problem: Diagnostic | None = None


def needs_of(
    problems: Sequence[Diagnostic],
    nodes: Sequence[PlannedNode],
    board: Mapping[str, NodeStatus],
    answers: Mapping[str, bool],
    *,
    has_rules: bool,
    is_connected: bool,
    strange: Collection[str] = (),
) -> list[Need]:
    """All needs, those that are missing first.

    ``answers`` tells whether a real robot answered at its address; a robot that is not in there
    is still looked for. Nobody has approved the nodes called ``strange`` yet.
    """
    errors = [problem for problem in problems if problem.severity == "error"]
    needs = [_problem(problem) for problem in errors if problem.kind != "no_rule"]
    if not has_rules:
        fix = NeedFix("add_start", tr("Add “when the program starts”"))
        title = tr("Something to do")
        sentence = tr("Nothing happens yet: every program begins with a block that says when.")
        needs.append(Need("missing", title, sentence, (fix,)))
    needs.append(_master(is_connected))
    for node in nodes:
        status = board.get(node.name)
        if node.name in strange:
            title, told = tr("The node {name}", name=node.name), tr("Run asks you about it first.")
            needs.append(Need("automatic", title, told, block=node.block_id, node=node))
            continue
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


def _problem(problem: Diagnostic) -> Need:
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


class NeedsDialog(QDialog):
    """Follows the program, its nodes and its robots as long as it is open."""

    def __init__(self, host: Host, control: RunControl) -> None:
        super().__init__(host.widget)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("What the program needs"))
        self._host, self._control = host, control
        self._answers: dict[str, bool] = {}
        self._asked: set[tuple[str, str]] = set()
        self._background = Background(self)
        self.needs: list[Need] = []
        line = self.fontMetrics().height()
        self._headline = QLabel(wordWrap=True)
        self._headline.setProperty("role", "title")
        self._scroll = QScrollArea(widgetResizable=True)
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
        in_column(
            self._headline, (self._scroll, 1), buttons, of=self, margins=line, spacing=line // 2
        )
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
        strange = self._control.runner.strange(nodes)
        self._ask([node for node in nodes if node.name not in strange])
        language, runner = self._host.services.language, self._control.runner
        needs = needs_of(
            self._host.workbench.checks.problems,
            nodes,
            runner.board.nodes,
            self._answers,
            has_rules=next(rules(document.project, language), None) is not None,
            is_connected=runner.is_connected,
            strange=strange,
        )
        if needs != self.needs:
            self.needs = needs
            self._show()

    def _ask(self, nodes: Sequence[PlannedNode]) -> None:
        """Ask real robots whether they are there, each address once."""
        for node in nodes:
            address = str(node.parameters.get("address", ""))
            if is_real(node) and (node.name, address) not in self._asked:
                self._asked.add((node.name, address))
                self._answers.pop(node.name, None)
                told = partial(self._on_answer, node.name)
                self._background.start(partial(answers_at, address), told, name=node.name)

    def _on_answer(self, name: str, is_there: bool) -> None:
        self._answers[name] = is_there
        self.refresh()

    def _show(self) -> None:
        missing = any(need.state == "missing" for need in self.needs)
        ready = tr("Everything is there: the program can run.")
        self._headline.setText(tr("Before it can run, this is needed:") if missing else ready)
        self.run_button.setEnabled(not missing and self._control.runner.state == "idle")
        inner, line = QWidget(), self.fontMetrics().height()
        rows = [self._row(need, line) for need in self.needs]
        in_column(*rows, 1, of=inner, margins=(0, 0, line // 2, 0), spacing=line // 2)
        self._scroll.setWidget(inner)
        # Let Enter do what comes next: the first thing that is missing, at last Run
        button = inner.findChild(QPushButton) if missing else self.run_button
        if button is not None:
            button.setDefault(True)
            keep_bold_room(button)
            button.setFocus()

    def _row(self, need: Need, line: int) -> QWidget:
        row = QFrame()
        row.setProperty("kind", "card")
        sign_name, colour = LOOKS[need.state]
        sign, words = QLabel(), QVBoxLayout()
        side = round(line * 1.2)
        picture = icon(sign_name, self._host.services.look.theme.colour(colour))
        sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))
        plain = Qt.TextFormat.PlainText  # names and addresses in them are a stranger's
        title = QLabel(breakable(need.title), wordWrap=True, textFormat=plain)
        sentence = QLabel(breakable(need.sentence), wordWrap=True, textFormat=plain)
        title.setProperty("role", "heading")
        sentence.setProperty("role", "hint")
        words.setSpacing(line // 6)
        words.addWidget(title)
        if need.sentence:
            words.addWidget(sentence)
        if need.fixes:
            words.addLayout(in_row(*(self._button(need, fix) for fix in need.fixes), 1))
        box = in_row((sign, 0, Qt.AlignmentFlag.AlignTop), of=row, margins=line // 2)
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
        editor = self._host.workbench.canvas.editor
        self._host.workbench.change(lambda: add_start(editor), "Add a beginning")

    def _on_run(self) -> None:
        self.accept()
        self._control.runner.run()
