"""The page of one way: its steps, what is asked, the QR code, and what arrives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QComboBox,
    QFrame,
    QGridLayout,
    QLabel,
    QWidget,
)

from nep_core.wire.messages import Imu
from nep_studio.blocks.operations.fixes import WATCH
from nep_studio.problems import Problem
from nep_studio.run.plan import Setting
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.watch_view.indicators import (
    SILENT_S,
    Figure,
    LittleCurve,
    MoveDot,
    Moving,
    WatchListener,
    figures,
)
from nep_studio.ui.watch_view.status import SIGNS
from nep_studio.ui.widgets.forms import UNKNOWN, hint, quiet_button
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .choosing import (
    Entry,
    GesturesQuestion,
    MoreSettings,
    NetworkQuestion,
    RecordingQuestion,
    WornQuestion,
)
from .connectors import (
    APPS,
    PHONE_PAGE,
    ConnectorKind,
    Place,
    StepsList,
    app_words,
    silence_steps,
    steps,
)
from .connectors import connector_title as title_of
from .qr_code import QrCode, WarningHelp

# What arrives, live: a dot that answers movement, a curve, numbers, and what to try in silence.

MOST_FIGURES = 5


class LiveView(QFrame):
    """A card; ``show_state`` says what it is about, the ear gives the rest."""

    def __init__(self, listener: WatchListener, look: Look, has_columns: bool = False) -> None:
        """``has_columns``: what arrives are lines, of which the columns can be corrected."""
        super().__init__()
        self._has_columns = has_columns
        self.setProperty("kind", "card")
        self._listener, self._look = listener, look
        self.dot, self.curve = MoveDot(look), LittleCurve(look)
        self.title, self.sentence, self.understood = QLabel(), QLabel(), QLabel()
        self.correct_button = quiet_button("Correct the columns…")
        self.advice = QLabel()
        self.advice_card = QFrame()
        self.rows = [(QLabel(), QLabel(), QLabel(), QLabel()) for _ in range(MOST_FIGURES)]
        self._understood: list[str] = []
        self._grades: list[str] = [""] * MOST_FIGURES
        self._lay_out()
        listener.heard.connect(self._on_heard)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.title.setProperty("role", "heading")
        self.understood.setProperty("role", "hint")
        for label in (self.title, self.sentence, self.understood, self.advice):
            label.setWordWrap(True)
            label.setTextFormat(Qt.TextFormat.PlainText)
        for label in (self.sentence, self.understood, self.advice):
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        words = in_column(self.title, self.sentence, 1)
        head = in_row((self.dot, 0, Qt.AlignmentFlag.AlignTop), (words, 1), spacing=line // 2)
        self.advice_card.setProperty("kind", "warning")
        in_column(self.advice, of=self.advice_card)
        grid = QGridLayout()
        grid.setColumnStretch(3, 1)
        grid.setHorizontalSpacing(line // 2)
        grid.setVerticalSpacing(line // 6)
        for at, row in enumerate(self.rows):
            row[3].setWordWrap(True)
            row[3].setProperty("role", "hint")
            for column, label in enumerate(row):
                grid.addWidget(label, at, column, Qt.AlignmentFlag.AlignTop)
        correct = (self.correct_button, 0, Qt.AlignmentFlag.AlignLeading)
        parts = (head, self.curve, grid, self.understood, correct, self.advice_card)
        in_column(*parts, of=self, margins=line // 2, spacing=line // 2)

    def show_waiting(self, title: str, sentence: str, advice: Sequence[str] = ()) -> None:
        """Nothing has arrived yet; ``advice``: what to look at."""
        self._show("waiting", title, sentence)
        self._advise(advice)

    def show_problem(self, problem: Problem) -> None:
        """It does not go, and what to try."""
        self._show("failed", tr(problem.title), tr(problem.sentence))
        self._advise([tr(step) for step in problem.checklist])

    def show_arriving(self, advice: Sequence[str] = ()) -> None:
        """Samples come, or came until a moment ago: ``advice`` is for the latter."""
        receiving = self._listener.receiving
        if self._listener.silent_s >= SILENT_S:
            words = tr("Nothing has come for {n} s.", n=round(self._listener.silent_s))
            self._show("waiting", tr("It has fallen silent"), words)
        elif receiving.has_moved:
            self._show("moved", tr("It moves: all is well"), self._counted())
        else:
            words = tr("Turn it over, or wave it once: the dot becomes green.")
            self._show("still", tr("It sends. Now move it"), words)
        self._advise(advice)
        self._show_figures(figures(self._listener.flow) if self._listener.is_sending else [])
        self.understood.setText("\n".join(self._told()))
        self.understood.setVisible(bool(self.understood.text()))
        self.correct_button.setVisible(self._has_columns and self.understood.isVisibleTo(self))

    def _told(self) -> list[str]:
        """How the node understands what arrives, and what it warns of."""
        status = self._listener.status
        if status is None or not status.fault.sentence:
            return []
        told = tr(status.fault.sentence)
        if status.event == "warning":
            return [*self._understood, told]
        self._understood = [told]
        return self._understood

    def _counted(self) -> str:
        receiving = self._listener.receiving
        if receiving.has_rotation:
            return tr("Acceleration and rotation arrive.")
        return tr("Acceleration arrives; it has no gyroscope, which is enough.")

    def _show(self, state: Moving, title: str, sentence: str) -> None:
        is_there = state in ("still", "moved")
        self.dot.show_movement(state, self._listener.receiving.movement_m_s2 if is_there else 0.0)
        if title != self.title.text():
            self.title.setText(title)
            announce(self, title)
        self.sentence.setText(sentence)
        self.sentence.setVisible(bool(sentence))
        self.curve.setVisible(is_there)
        if not is_there:
            self._show_figures([])
            self.understood.hide()
            self.correct_button.hide()

    def _advise(self, advice: Sequence[str]) -> None:
        lines = [tr("Try this, in this order:"), *(f"•  {step}" for step in advice)]
        self.advice.setText("\n".join(lines))
        self.advice_card.setVisible(bool(advice))

    def _show_figures(self, told: Sequence[Figure]) -> None:
        for at, (sign, name, number, words) in enumerate(self.rows):
            figure = told[at] if at < len(told) else None
            for label in (sign, name, number, words):
                label.setVisible(figure is not None)
            if figure is None:
                continue
            name.setText(figure.name)
            number.setText(figure.number)
            words.setText(figure.words)
            number.setAccessibleName(f"{figure.name}: {figure.number}, {figure.words}")
            if self._grades[at] != figure.grade:
                self._grades[at] = figure.grade
                self._draw_sign(sign, figure.grade)

    def redraw(self) -> None:
        """Draw the signs in another theme."""
        for (sign, *_), grade in zip(self.rows, self._grades, strict=True):
            if grade:
                self._draw_sign(sign, grade)

    def _draw_sign(self, sign: QLabel, grade: str) -> None:
        name, colour = SIGNS[grade]
        side = round(self.fontMetrics().height() * 0.95)
        picture = icon(name, self._look.theme.colour(colour))
        sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))

    def _on_heard(self, batch: list[Imu]) -> None:
        self.curve.take(batch)
        if self.dot.state in ("still", "moved"):
            self.dot.show_movement(self.dot.state, self._listener.receiving.movement_m_s2)


# The page of one way: its steps, what is asked, the QR code, and what arrives.

LINES_FOR_TWO = 37
"""Narrower than so many lines, what arrives is below the steps, not beside them."""
NETWORK, THIS_COMPUTER = "network", "this computer"


@dataclass(frozen=True)
class Known:
    """What is known before: our addresses, the token, what the project says, its folder."""

    addresses: Sequence[str]
    token: str
    gestures: Mapping[str, str] = field(default_factory=dict)
    """What a simulated person can make, names to titles."""
    wanted: Sequence[str] = ()
    """Those of them that it begins with."""
    folder: Path = field(default_factory=Path)
    settings: Mapping[str, Setting] = field(default_factory=dict)
    """Those of the watch that the project has, when it comes in the same way."""


class WayPage(QWidget):
    """``changed`` tells of other ``settings``; ``connector_asked`` that another app was chosen.

    ``came_into_view`` gives what should be seen now.
    """

    changed = Signal()
    connector_asked = Signal(str)
    came_into_view = Signal(QWidget)

    def __init__(
        self, connector: ConnectorKind, known: Known, listener: WatchListener, look: Look
    ) -> None:
        super().__init__()
        self.connector, self._known = connector, known
        self._had_code = self._is_sending = False
        self.network = NetworkQuestion(known.addresses)
        self.worn, self.more = WornQuestion(), MoreSettings(connector)
        self.address = Entry()
        self.gestures = GesturesQuestion(known.gestures, known.wanted)
        self.recording = RecordingQuestion(known.folder, look)
        self.warning = WarningHelp(look)
        self.app = QComboBox()
        self.qr_code, self.qr_hint = QrCode(), hint("")
        self.live = LiveView(listener, look, connector.asks_columns)
        self._take(known.settings)
        told, questions = steps(connector, self.place), self._extras()
        self.steps = StepsList(told, questions, look)
        asked = {step.extra for step in told}
        for name, question in questions.items():
            if name not in asked:
                question.setParent(self)
                question.hide()
        self._lay_out()
        self._connect()
        self._update()

    # What was chosen

    @property
    def place(self) -> Place:
        """Where this computer is found by this way."""
        address = self.network.address or UNKNOWN
        port = self.more.port.value() if self.connector.port else 0
        url = f"https://{address}:{port}/{self._known.token}/"
        return Place(address, port, url if self.connector == PHONE_PAGE else "")

    @property
    def settings(self) -> dict[str, Setting] | None:
        """The parameters of the node; None as long as something is missing."""
        if self.connector.node != WATCH:
            return self._source.settings
        found: dict[str, Setting] = {"through": self.connector.name}
        if address := self.address.text().strip():
            found["address"] = address
        elif self.connector.needs_address:
            return None
        if self.connector.listens:
            found["port"] = self.more.port.value()
            found["listen_on"] = NETWORK if self.network.is_open else THIS_COMPUTER
        if self.connector == PHONE_PAGE:
            found["token"] = self._known.token
        if self.connector.asks_wrist:
            found["wrist"] = self.worn.worn
        return {**found, **self.more.settings}

    @property
    def advice(self) -> tuple[str, ...]:
        """What to look at when nothing arrives."""
        is_open, address = self.network.is_open, self.address.text().strip()
        return silence_steps(self.connector, self.place, is_open, address)

    @property
    def _source(self) -> GesturesQuestion | RecordingQuestion:
        return self.recording if self.connector.name == "recording" else self.gestures

    def _take(self, settings: Mapping[str, Setting]) -> None:
        """Begin with what the project says."""
        if self.connector.node != WATCH:
            self._source.show_settings(settings)
            return
        self.worn.choose(str(settings.get("wrist") or self.connector.worn))
        self.address.setText(str(settings.get("address", "")))
        self.network.switch.setChecked(settings.get("listen_on") == NETWORK)
        self.more.show_settings(settings)

    def show_sending(self, is_sending: bool) -> None:
        """A device sends, or does so no more: its code is not needed meanwhile."""
        if is_sending != self._is_sending:
            self._is_sending = is_sending
            self._update()
            self.came_into_view.emit(self.live)

    def redraw(self) -> None:
        """Draw icons and pictures in another theme."""
        for one in (self.live, self.recording, self.warning):
            one.redraw()
        for line in self.steps.copy_lines:
            if line is not None:
                line.redraw()

    # Layout

    def _extras(self) -> dict[str, QWidget]:
        self.address.setAccessibleName(tr("Address"))
        self.address.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.address.setPlaceholderText(
            "" if self.connector.name == "bluetooth" else "192.168.1.20:8080"
        )
        return {
            "network": self.network,
            "warning": self.warning,
            "address": self.address,
            "gestures": self.gestures,
            "recording": self.recording,
        }

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        heading = QLabel(title_of(self.connector), wordWrap=True)
        heading.setProperty("role", "title")
        where, between = QLabel(tr("Where is it?")), line * 2 // 3
        where.setProperty("role", "heading")
        left = in_column(self.steps, where, self.worn, self.more, 1, spacing=between)
        right = in_column(self.qr_code, self.qr_hint, self.live, 1, spacing=between)
        self._both = in_row((left, 6), (right, 5), spacing=line)
        margins = (0, 0, line // 2, 0)
        in_column(heading, self.app, (self._both, 1), of=self, margins=margins, spacing=between)
        for widget in (where, self.worn):
            widget.setVisible(self.connector.asks_wrist)
        self._offer_apps()

    def _offer_apps(self) -> None:
        for connector in APPS:
            self.app.addItem(app_words(connector), connector.name)
        self.app.setCurrentIndex(self.app.findData(self.connector.name))
        self.app.setAccessibleName(tr("Which app?"))
        self.app.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self.app.setVisible(self.connector in APPS)

    def _connect(self) -> None:
        for question in (self.network, self.worn, self.more, self.gestures, self.recording):
            question.changed.connect(self._on_changed)
        self.address.written.connect(self._on_changed)
        self.live.correct_button.clicked.connect(self._on_correct)
        self.app.activated.connect(lambda _row: self.connector_asked.emit(self.app.currentData()))

    def _on_correct(self) -> None:
        self.more.toggle.setChecked(True)
        self.more.columns.setFocus()
        QTimer.singleShot(0, self, lambda: self.came_into_view.emit(self.more))

    def _on_changed(self) -> None:
        self._update()
        self.changed.emit()

    def _update(self) -> None:
        """Fill in this computer's address and port."""
        self.steps.fill(steps(self.connector, self.place))
        is_page = self.connector == PHONE_PAGE
        has_code = is_page and self.network.is_open and bool(self.network.address)
        has_code = has_code and not self._is_sending  # what arrives is looked at then
        self.qr_code.show_url(self.place.url if has_code else "")
        self.qr_code.setVisible(has_code)
        if has_code and not self._had_code:
            self.came_into_view.emit(self.qr_code)
        self._had_code = has_code
        self.qr_hint.setText(tr("The code appears here once “Let this network in” is on."))
        self.qr_hint.setVisible(is_page and not has_code and not self._is_sending)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Two columns where there is room for them."""
        super().resizeEvent(event)
        is_wide = self.width() >= self.fontMetrics().height() * LINES_FOR_TWO
        directions = QBoxLayout.Direction
        wanted = directions.LeftToRight if is_wide else directions.TopToBottom
        if self._both.direction() != wanted:
            self._both.setDirection(wanted)
