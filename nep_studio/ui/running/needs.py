"""The dialog that lists what a program needs, with a button for each thing that is missing."""

from __future__ import annotations

import threading
from queue import SimpleQueue
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt, QTimer
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

from nep_studio.blocks.deployment import rules
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.starting import add_start
from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.connecting.adding import open_connecting
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

from .needs_list import Need, NeedFix, answers_at, is_real, needs_of

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow

    from .control import RunControl

LOOKS = {
    "met": ("circle-check", "success"),
    "automatic": ("clock", "info"),
    "looking": ("refresh-cw", "muted"),
    "missing": ("circle-alert", "error"),
}


LOOK_MS = 50


class NeedsDialog(QDialog):
    """Follows the program, its nodes and its robots as long as it is open."""

    def __init__(self, window: MainWindow, control: RunControl) -> None:
        super().__init__(window)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("What the program needs"))
        self._window, self._control = window, control
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
        self.run_button.setIcon(icon("play", window.look.theme, "run_text"))
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
        window.workbench.checks.found.connect(self.refresh)
        control.runner.nodes_changed.connect(self.refresh)
        control.runner.connected.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Look again at everything."""
        document = self._window.files.document
        if document is None:
            self.reject()
            return
        nodes = self._control.planned()
        self._ask(nodes)
        language, runner = self._window.studio.language, self._control.runner
        needs = needs_of(
            self._window.workbench.checks.problems,
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
        picture = icon(sign_name, self._window.look.theme.colour(colour))
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
        workbench, control = self._window.workbench, self._control
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
                open_connecting(self._window, need.node.name)
            case "show_block" | "address":
                self.accept()
                workbench.show_block(need.block)
        self.refresh()

    def _add_start(self) -> None:
        workbench = self._window.workbench
        try:
            workbench.show_block(add_start(workbench.canvas.editor))
        except EditRefused as refusal:
            self._window.messages.refuse(refusal.sentence, refusal.checklist)
        workbench.checks.start()

    def _on_run(self) -> None:
        self.accept()
        self._control.runner.run()


def _look_for(name: str, address: str, news: SimpleQueue[tuple[str, bool]]) -> None:
    """Tell whether a robot is there; the dialog may be gone by then, so that it is not touched."""
    news.put((name, answers_at(address)))
