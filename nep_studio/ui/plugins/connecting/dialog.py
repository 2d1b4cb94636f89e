"""The dialog that connects a real robot: choose or write its address, test it, use it."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QSignalBlocker, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFormLayout,
    QFrame,
    QGridLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QPushButton,
    QWidget,
)

from nep_studio.ui.background import Job, Tell
from nep_studio.ui.labels import plain_tip
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import (
    card_around,
    fit_on_screen,
    hint,
    label_of,
    plain_label,
    styled,
)
from nep_studio.ui.widgets.layouts import in_column, in_row, scrolled
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from robots.naoqi.discovery import FoundRobot
    from robots.naoqi.probe import AboutRobot, Check

# Looks for robots and tests the way to one, in threads of their own; news come as signals.


class RobotSearch(Job):
    """Robots that announce themselves in the network."""

    found = Signal(str, str)
    """The name and the address of a robot."""

    def start(self, seconds: float, interfaces: Sequence[str] = ()) -> None:
        """Listen for some seconds; ``interfaces`` as in ``find_robots``."""

        def work(cancelled: threading.Event, tell: Tell) -> None:
            from robots.naoqi.discovery import find_robots

            find_robots(tell, cancelled, seconds=seconds, interfaces=interfaces)

        self._start(work, self._tell_found)

    def _tell_found(self, what: object) -> None:
        robot = cast("FoundRobot", what)
        self.found.emit(robot.name, robot.address)


class RobotTest(Job):
    """The steps on the way to a robot."""

    checked = Signal(object)
    """The Check of a step."""

    def start(self, address: str, user: str, password: str, robot: str) -> None:
        """Try every step; the login is used when there is a password."""

        def work(cancelled: threading.Event, tell: Tell) -> None:
            from robots.naoqi.probe import probe
            from robots.naoqi.wire.line import Login

            login = Login(user, password) if password else None
            for check in probe(address, login, robot):
                if cancelled.is_set():
                    return
                tell(check)

        self._start(work, self.checked.emit)


# The robots that were found in the network, with the search that finds them.

BY_MOUSE = Qt.TextInteractionFlag.TextSelectableByMouse
SEARCH_S = 4.0
ADDRESS = Qt.ItemDataRole.UserRole
ROWS = 3


class FoundList(QWidget):
    """``chosen`` gives the address of the robot that a person picks."""

    chosen = Signal(str)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.interfaces: tuple[str, ...] = ()
        self.search = RobotSearch(self)
        self.robots = QListWidget()
        self.told = hint("")
        self.progress = QProgressBar(textVisible=False, minimum=0, maximum=0)
        self.button = QPushButton(autoDefault=False)
        line = self.fontMetrics().height()
        self.robots.setAccessibleName(tr("Robots in this network"))
        self.robots.setIconSize(QSize(round(line * 1.4), round(line * 1.4)))
        self.robots.setFixedHeight(round(line * 1.9) * ROWS)
        self.progress.setAccessibleName(tr("Looking for robots…"))
        foot = in_row((self.told, 1), self.button)
        in_column(self.robots, self.progress, foot, of=self, margins=0, spacing=line // 3)
        self.search.found.connect(self._on_found)
        self.search.ended.connect(self._show_end)
        self.robots.currentItemChanged.connect(self._on_chosen)
        self.robots.itemClicked.connect(self._on_chosen)
        self.button.clicked.connect(self._on_pressed)

    def start(self) -> None:
        """Look for robots, for a few seconds."""
        self.robots.clear()
        self.told.setText(tr("Looking for robots…"))
        self.button.setText(tr("Stop looking"))
        self.progress.setVisible(True)
        self.search.start(SEARCH_S, self.interfaces)

    def stop(self) -> None:
        """Look no longer."""
        self.search.stop()
        self._show_end("")

    def _on_pressed(self) -> None:
        if self.search.is_running:
            self.stop()
        else:
            self.start()

    def _on_found(self, name: str, address: str) -> None:
        item = QListWidgetItem(icon("bot", self._look.theme), f"{name}   {address}")
        item.setData(ADDRESS, address)
        item.setToolTip(plain_tip(address))
        self.robots.addItem(item)

    def _show_end(self, problem: str) -> None:
        self.progress.setVisible(False)
        self.button.setText(tr("Look again"))
        self.told.setText(self._outcome(problem))

    def _outcome(self, problem: str) -> str:
        count = self.robots.count()
        if count:
            return count_words(count, "1 robot was found.", "{n} robots were found.")
        if problem:
            return tr(
                "This computer cannot look for robots: it is in no network. Connect it to the"
                " network of the robot."
            )
        return tr(
            "No robot has announced itself. Press its chest button once: it says its address."
            " Write it below."
        )

    def _on_chosen(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self.chosen.emit(item.data(ADDRESS))

    def hideEvent(self, event: QHideEvent) -> None:
        """Nobody looks at what is found any more."""
        super().hideEvent(event)
        self.search.stop()


# The steps of the way to a robot, each with a sign and a sentence that says how it went.

SIGNS = {
    "waiting": ("circle-dashed", "muted"),
    "trying": ("refresh-cw", "info"),
    "ok": ("circle-check", "success"),
    "failed": ("circle-alert", "error"),
}


def step_questions() -> dict[str, str]:
    """What each step asks, by its name in the probe, in their order."""
    return {
        "name": tr("Is the address known?"),
        "port": tr("Does something answer there?"),
        "naoqi": tr("Is it a NAOqi robot?"),
        "login": tr("Does it let us in?"),
        "services": tr("Can it do what the blocks ask for?"),
        "robot": tr("How is it?"),
    }


def state_words() -> dict[str, str]:
    """How a step is, for those who cannot see its sign."""
    return {
        "waiting": tr("not tried yet"),
        "trying": tr("trying…"),
        "ok": tr("all right"),
        "failed": tr("did not work"),
    }


class StepsView(QFrame):
    """One row for each step; below the one that failed stands what to try."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._questions = step_questions()
        self._signs: dict[str, QLabel] = {}
        self._words: dict[str, QLabel] = {}
        self.states: dict[str, str] = {}
        self.advice = QLabel(
            wordWrap=True, textFormat=Qt.TextFormat.PlainText, textInteractionFlags=BY_MOUSE
        )
        self.advice_card = card_around(self.advice, "warning")
        line = self.fontMetrics().height()
        grid = QGridLayout()
        grid.setColumnStretch(1, 1)
        grid.setVerticalSpacing(line // 3)
        for row, step in enumerate(self._questions):
            sign, words = QLabel(), QLabel(wordWrap=True, textInteractionFlags=BY_MOUSE)
            grid.addWidget(sign, row, 0, Qt.AlignmentFlag.AlignTop)
            grid.addWidget(words, row, 1)
            self._signs[step], self._words[step] = sign, words
        card, gap = styled(self, kind="card"), line // 2
        in_column(grid, self.advice_card, of=card, margins=gap, spacing=gap)
        self.clear()

    def clear(self) -> None:
        """No step has been tried."""
        for step in self._questions:
            self._show(step, "waiting", self._questions[step])
        self.advice_card.hide()

    def begin(self) -> None:
        """The first step is being tried."""
        self.clear()
        first, question = next(iter(self._questions.items()))
        self._show(first, "trying", question)

    def take(self, check: Check) -> None:
        """Show how a step went, and that the next one is being tried."""
        self._show(check.step, "ok" if check.is_ok else "failed", tr(check.sentence))
        if not check.is_ok:
            lines = [tr("Try this, in this order:"), *(f"•  {tr(it)}" for it in check.checklist)]
            self.advice.setText("\n".join(lines))
            self.advice_card.setVisible(bool(check.checklist))
            return
        steps = list(self._questions)
        for step in steps[steps.index(check.step) + 1 :][:1]:
            self._show(step, "trying", self._questions[step])

    def _show(self, step: str, state: str, words: str) -> None:
        name, colour = SIGNS[state]
        side = round(self.fontMetrics().height() * 1.1)
        picture = icon(name, self._look.theme.colour(colour))
        self._signs[step].setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))
        label = styled(self._words[step], role="hint" if state == "waiting" else "")
        label.setText(words)
        label.style().polish(label)
        label.setAccessibleName(f"{words} {state_words()[state]}")
        self.states[step] = state


USUAL_USER = "nao"


class ConnectDialog(QDialog):
    """``used`` gives the robot of the project, then address, user, password and fingerprint."""

    used = Signal(str, str, str, str, str)

    def __init__(self, robots: list[str], look: Look, parent: QWidget | None = None) -> None:
        """``robots`` are those of the project, the one that is meant first."""
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Connect a robot"))
        self.found = FoundList(look)
        self.steps = StepsView(look)
        self.test = RobotTest(self)
        self.robot = QComboBox()
        self.robot.addItems(robots)
        self.address = QLineEdit(placeholderText="192.168.1.10")
        self.user = QLineEdit(USUAL_USER)
        self.password = QLineEdit(echoMode=QLineEdit.EchoMode.Password)
        self.asks_password = QCheckBox(tr("It asks for user and password"))
        self.test_button = styled(
            QPushButton(tr("Test the connection"), default=True), kind="primary"
        )
        self.use_button = styled(
            QPushButton(tr("Use this robot"), autoDefault=False), kind="primary"
        )
        self.close_button = QPushButton(tr("Close"), autoDefault=False)
        self.about = plain_label(textInteractionFlags=BY_MOUSE)
        self._about_card = card_around(self.about, "info")
        self._tested = ("", "", "", "")
        self._lay_out()
        self._connect()
        self._update()

    def open(self) -> None:
        """Show it, and begin to look for robots."""
        super().open()
        self.found.start()
        self.address.setFocus()

    # Layout

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        page = QWidget()
        robots = styled(QLabel(tr("Robots in this network")), role="heading")
        address = styled(QLabel(tr("Its address")), role="heading")
        parts = (robots, self.found, address, self._form(), self.steps, self._about_card, 1)
        in_column(*parts, of=page, margins=(0, 0, line // 2, 0), spacing=line * 2 // 3)
        self._area = scrolled(page)
        foot = in_row(1, self.close_button, self.use_button)
        in_column((self._area, 1), foot, of=self, margins=line, spacing=line // 2)
        fit_on_screen(self, 32, 44)

    def _form(self) -> QFormLayout:
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.ExpandingFieldsGrow)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        form.addRow(label_of("Address", self.address), self.address)
        form.addRow("", self.asks_password)
        self._user_label = label_of("User", self.user)
        self._password_label = label_of("Password", self.password)
        form.addRow(self._user_label, self.user)
        form.addRow(self._password_label, self.password)
        self._kept = hint(
            "The password is kept on this computer, for you alone. It is in no project."
        )
        form.addRow("", self._kept)
        form.addRow(label_of("In this project it is", self.robot), self.robot)
        form.addRow("", in_row(self.test_button, 1))
        return form

    def _connect(self) -> None:
        self.found.chosen.connect(self._on_chosen)
        for field in (self.address, self.user, self.password):
            field.textEdited.connect(self._on_changed)
        self.asks_password.toggled.connect(self._on_changed)
        self.test_button.clicked.connect(self._on_test)
        self.test.checked.connect(self._on_checked)
        self.test.ended.connect(self._on_ended)
        self.use_button.clicked.connect(self._on_use)
        self.close_button.clicked.connect(self.reject)

    # What happens

    def show_address(self, address: str, user: str = "", password: str = "") -> None:
        """Begin with an address that is known, and its login if there is one."""
        self.address.setText(address)
        if password:
            self.asks_password.setChecked(True)
            self.user.setText(user)
            self.password.setText(password)
        self._update()

    @property
    def _login(self) -> tuple[str, str]:
        if not self.asks_password.isChecked():
            return "", ""
        return self.user.text().strip(), self.password.text()

    def _on_chosen(self, address: str) -> None:
        self.address.setText(address)
        self._on_changed()

    def _on_changed(self) -> None:
        """What was tested is not what is written any more."""
        self.test.stop()
        self.steps.clear()
        self._tested = ("", "", "", "")
        self._update()

    def _update(self) -> None:
        wants_login = self.asks_password.isChecked()
        rows = (self._user_label, self.user, self._password_label, self.password, self._kept)
        for widget in rows:
            widget.setVisible(wants_login)
        is_good = self._tested[0] != ""
        self.test_button.setEnabled(bool(self.address.text().strip()) and not self.test.is_running)
        self.use_button.setEnabled(is_good)
        self._about_card.setVisible(is_good)

    def _on_test(self) -> None:
        self.found.stop()
        self._tested = ("", "", "", "")
        self.steps.begin()
        self._area.ensureWidgetVisible(self.steps)
        user, password = self._login
        name = self.robot.currentText() or "NAO"
        self.test.start(self.address.text(), user, password, name)
        self._update()

    def _on_checked(self, check: Check) -> None:
        self.steps.take(check)
        if check.step == "login" and not check.is_ok:
            with QSignalBlocker(self.asks_password):  # what was told of the test stays
                self.asks_password.setChecked(True)
        if check.about is not None:
            self._tested = (self.address.text().strip(), *self._login, check.about.fingerprint)
            self.about.setText(about_words(check.about))
        self._update()

    def _on_ended(self) -> None:
        self._update()
        outcome = self._about_card if self._tested[0] else self.steps
        QTimer.singleShot(0, self, lambda: self._area.ensureWidgetVisible(outcome))
        if self.use_button.isEnabled():
            self.use_button.setFocus()
            self.use_button.setDefault(True)

    def _on_use(self) -> None:
        self.used.emit(self.robot.currentText(), *self._tested)
        self.accept()

    def done(self, result: int) -> None:
        """Look and test no longer."""
        self.found.search.stop()
        self.test.stop()
        super().done(result)


def about_words(about: AboutRobot) -> str:
    """What a robot says of itself, one line each."""
    lines = [tr("Name: {name}", name=about.name or "NAO")]
    if about.battery >= 0:
        lines.append(tr("Battery: {percent} %", percent=round(about.battery * 100)))
    if about.version:
        lines.append(tr("NAOqi: {version}", version=about.version))
    if about.body:
        lines.append(tr("Body: {body}", body=about.body))
    return "\n".join(lines)
