"""The page of one way: its steps, what is asked, the QR code, and what arrives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QComboBox, QLabel, QVBoxLayout, QWidget

from nep_studio.blocks.operations.fixes import WATCH
from nep_studio.run.plan import Setting
from nep_studio.ui.theme.look import Look
from nep_studio.ui.watch_view.indicators import WatchListener
from nep_studio.ui.widgets.forms import UNKNOWN, hint
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .choosing import GesturesQuestion, RecordingQuestion
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
from .live import LiveView
from .qr_code import QrCode, WarningHelp
from .questions import Entry, MoreSettings, NetworkQuestion, WornQuestion

LINES_FOR_TWO = 37
"""Narrower than so many lines, what arrives is below the steps, not beside them."""
NETWORK, THIS_COMPUTER = "network", "this computer"


@dataclass(frozen=True)
class Known:
    """What is known before: our addresses, the token, what the project says, its folder."""

    addresses: Sequence[str]
    token: str
    gestures: str = ""
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
        self,
        connector: ConnectorKind,
        known: Known,
        listener: WatchListener,
        look: Look,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.connector, self._known = connector, known
        self._had_code = self._is_sending = False
        self.network = NetworkQuestion(known.addresses)
        self.worn, self.more = WornQuestion(), MoreSettings(connector)
        self.address = Entry()
        self.gestures = GesturesQuestion(known.gestures)
        self.recording = RecordingQuestion(known.folder, look)
        self.warning = WarningHelp(look)
        self.app = QComboBox()
        self.qr_code, self.qr_hint = QrCode(), hint("")
        self.live = LiveView(listener, look, connector.asks_columns)
        self._take(known.settings)
        self.steps = StepsList(steps(connector, self.place), self._extras(), look)
        asked = {step.extra for step in steps(self.connector, self.place)}
        for name, question in self._extras().items():
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
        self.live.redraw()
        self.recording.redraw()
        self.warning.redraw()
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
        left, right = QVBoxLayout(), QVBoxLayout()
        for column in (left, right):
            column.setSpacing(line * 2 // 3)
        left.addWidget(self.steps)
        where = QLabel(tr("Where is it?"))
        where.setProperty("role", "heading")
        left.addWidget(where)
        left.addWidget(self.worn)
        left.addWidget(self.more)
        left.addStretch(1)
        right.addWidget(self.qr_code)
        right.addWidget(self.qr_hint)
        right.addWidget(self.live)
        right.addStretch(1)
        for widget in (where, self.worn):
            widget.setVisible(self.connector.asks_wrist)
        self._both = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._both.setSpacing(line)
        self._both.addLayout(left, 6)
        self._both.addLayout(right, 5)
        box = in_column(heading, of=self, margins=(0, 0, line // 2, 0), spacing=line * 2 // 3)
        if self.connector in APPS:
            box.addWidget(self._app_choice())
        box.addLayout(self._both, 1)

    def _app_choice(self) -> QComboBox:
        for connector in APPS:
            self.app.addItem(app_words(connector), connector.name)
        self.app.setCurrentIndex(APPS.index(self.connector))
        self.app.setAccessibleName(tr("Which app?"))
        self.app.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        return self.app

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
