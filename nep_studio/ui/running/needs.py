"""What a person has to do before a program can run: as data, and as a dialog with buttons."""

from __future__ import annotations

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
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.background import Background
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.widgets.forms import breakable, fit_on_screen, keep_bold_room
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host
    from robots.naoqi.probe import Check

    from .control import RunControl

State = Literal["looking", "missing"]
FixName = Literal["add_start", "fix_problem", "show_block", "simulator", "connect"]


@dataclass(frozen=True)
class NeedFix:
    """A button beside a need: what it does, and its words."""

    name: FixName
    words: str


@dataclass(frozen=True)
class Need:
    """Something that a person has to do before a program can run.

    A robot is ``looking`` as long as it is not known. ``block`` and ``node`` are what it is about.
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
    answers: Mapping[str, Check | None],
    *,
    has_rules: bool,
    strange: Collection[str] = (),
) -> list[Need]:
    """What a person has to do, each thing once; what Run does by itself is none of it.

    ``answers`` tells what stands in the way to a real robot, None where it answers; one that is
    not in there is still looked for. Nobody has approved the nodes called ``strange`` yet.
    """
    errors = [problem for problem in problems if problem.severity == "error"]
    needs = [_problem(problem) for problem in errors if problem.kind != "no_rule"]
    if not has_rules:
        fix = NeedFix("add_start", tr("Add “when the program starts”"))
        title = tr("Something to do")
        sentence = tr("Nothing happens yet: every program begins with a block that says when.")
        needs.append(Need("missing", title, sentence, (fix,)))
    told = {problem.block for problem in errors} - {""}
    needs += [
        need
        for node in nodes
        if is_real(node) and node.name not in strange and node.block_id not in told
        if (need := _robot(node, answers)) is not None
    ]
    once = {(need.title, need.fixes): need for need in reversed(needs)}
    return sorted(reversed(once.values()), key=lambda need: need.state == "looking")


def is_real(node: PlannedNode) -> bool:
    """Whether a node drives a robot that stands somewhere."""
    return node.parameters.get("driver") == "naoqi"


def in_the_way_to(robot: str, address: str) -> Check | None:
    """The step that fails on the way to a robot, as the dialog that connects one tells it.

    None when the robot answers and lets us in. Takes some seconds.
    """
    from robots.naoqi.discovery import saved_login
    from robots.naoqi.probe import probe
    from robots.naoqi.wire.line import Login

    saved = saved_login(address)
    login = Login(saved.user, saved.password) if saved is not None else None
    for check in probe(address, login, robot):
        if not check.is_ok or check.step == "login":
            return None if check.is_ok else check
    return None


def _problem(problem: Diagnostic) -> Need:
    fixes = [NeedFix("fix_problem", tr(problem.fix.label))] if problem.fix is not None else []
    if problem.block:
        fixes.append(NeedFix("show_block", tr("Show the block")))
    steps = " ".join(map(tr, problem.checklist))
    return Need("missing", tr(problem.sentence), steps, tuple(fixes), problem.block, None, problem)


def _robot(node: PlannedNode, answers: Mapping[str, Check | None]) -> Need | None:
    """What has to be done about a real robot; None when it answers."""
    if node.name not in answers:
        address = str(node.parameters.get("address", ""))
        title = tr("The robot {name} at {address}", name=node.name, address=address)
        return Need("looking", title, tr("Looking whether it answers…"), node=node)
    check = answers[node.name]
    if check is None:
        return None
    fixes = (
        NeedFix("simulator", tr("Use the robot on the screen")),
        NeedFix("connect", tr("Find it and test the connection")),
    )
    steps = " ".join(map(tr, check.checklist))
    return Need("missing", tr(check.sentence), steps, fixes, node.block_id, node)


# The dialog that lists what a program needs, with a button for each thing that is missing.

LOOKS = {
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
        self._answers: dict[str, Check | None] = {}
        self._asked: set[tuple[str, str]] = set()
        self._background = Background(self)
        self.needs: list[Need] | None = None
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
        host.workbench.checks.found.connect(self.refresh)
        control.runner.state_changed.connect(self._show)
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
        language = self._host.services.language
        needs = needs_of(
            self._host.workbench.checks.problems,
            nodes,
            self._answers,
            has_rules=next(rules(document.project, language), None) is not None,
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
                look = partial(in_the_way_to, node.name, address)
                self._background.start(look, told, name=node.name)

    def _on_answer(self, name: str, check: Check | None) -> None:
        self._answers[name] = check
        self.refresh()

    def _show(self, _state: object = None) -> None:
        needs = self.needs or []
        missing = any(need.state == "missing" for need in needs)
        if missing:
            self._headline.setText(tr("Before it can run, this is needed:"))
        else:
            self._headline.setText(tr("You need to do nothing: the program can run."))
        self.run_button.setEnabled(not missing and self._control.runner.state == "idle")
        inner, line = QWidget(), self.fontMetrics().height()
        rows = [self._row(need, line) for need in needs]
        in_column(*rows, 1, of=inner, margins=(0, 0, line // 2, 0), spacing=line // 2)
        self._scroll.setWidget(inner)
        self._scroll.setVisible(bool(rows))
        fit_on_screen(self, 34, 26)
        if not rows:
            self.resize(self.width(), self.minimumSizeHint().height())
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
            case "simulator":
                self.accept()
                control.use_simulator()
            case "connect" if need.node is not None:
                self.accept()
                self._host.ask("connecting.open", need.node.name)
            case "show_block":
                self.accept()
                workbench.show_block(need.block)
        self.refresh()

    def _add_start(self) -> None:
        editor = self._host.workbench.canvas.editor
        self._host.workbench.change(lambda: add_start(editor), "Add a beginning")

    def _on_run(self) -> None:
        self.accept()
        self._control.runner.run()
