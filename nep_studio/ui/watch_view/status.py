"""A line that says which watch or phone sends, how well, and lets one be connected."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QLabel, QPushButton, QSizePolicy, QWidget

from nep_studio.run.plan import REPLAY, VIRTUAL_WATCH, PlannedNode
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr

from .indicators import SILENT_S, WatchListener, figure_lines, figures, rate_words

SIGNS: Mapping[str, tuple[str, str]] = {
    "none": ("circle-dashed", "muted"),
    "waiting": ("hourglass", "info"),
    "good": ("circle-check", "success"),
    "fair": ("triangle-alert", "warning"),
    "poor": ("triangle-alert", "warning"),
    "silent": ("unplug", "warning"),
}


@dataclass(frozen=True)
class WatchState:
    """What is shown: the name of a sign, the words, and more for those who want to know."""

    sign: str
    words: str
    more: str = ""


def device_words(planned: PlannedNode | None) -> str:
    """What sends, by how its node was started."""
    if planned is None:
        return tr("A watch")
    if planned.node == VIRTUAL_WATCH:
        return tr("Virtual watch")
    if planned.node == REPLAY:
        return tr("Recording")
    names = {
        "phone_page": tr("Phone"),
        "sensor_logger": "Sensor Logger",
        "phyphox": "phyphox",
        "sensor_server": "SensorServer",
        "paper_watch": tr("Watch"),
        "bluetooth": tr("Bluetooth sensor"),
    }
    return names.get(str(planned.parameters.get("through", "")), tr("Watch or phone"))


def watch_state(listener: WatchListener, awaited: PlannedNode | None = None) -> WatchState:
    """How the watch is that an ear hears; ``awaited`` is a node that waits for one."""
    if not listener.source or (listener.node and listener.silent_s == float("inf")):
        if awaited is None:
            return WatchState("none", tr("No watch or phone sends"))
        words = tr("{device}: nothing has come yet", device=device_words(awaited))
        return WatchState("waiting", words, tr("Is its screen on? Is it still sending?"))
    device = device_words(listener.planned)
    if listener.silent_s >= SILENT_S:
        words = tr("{device} is silent", device=device)
        return WatchState("silent", words, tr("Is its screen on? Is it still sending?"))
    flow = listener.flow
    worst = max((one.grade for one in figures(flow)), key=("good", "fair", "poor").index)
    words = tr("{device}, {rate}", device=device, rate=rate_words(flow.rate_hz))
    return WatchState(worst, words, figure_lines(flow))


class WatchStatus(QWidget):
    """A sign, words such as “Phone, 62 samples a second”, and the button that connects one.

    It hears only while it is shown. ``connect_asked`` tells that the button was pressed.
    """

    connect_asked = Signal()

    def __init__(self, runner: Runner, look: Look) -> None:
        super().__init__()
        self.listener = WatchListener(runner, self)
        self.state = WatchState("", "")
        self._look = look
        self.sign, self.words = QLabel(), ElidedLabel()
        self.button = labelled(
            QPushButton(autoDefault=False),
            text="Connect…",
            tip="Connect a watch or phone, and see how well it sends",
            name="Connect a watch or phone…",
        )
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        words = (self.words, 1, Qt.AlignmentFlag.AlignVCenter)
        between = self.fontMetrics().height() // 3
        in_row(self.sign, words, self.button, of=self, margins=0, spacing=between)
        self.listener.changed.connect(self.refresh)
        self.button.clicked.connect(self.connect_asked)
        look.theme_changed.connect(self._draw_sign)
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Show how the watch is now."""
        state = watch_state(self.listener, self.listener.awaited)
        if state == self.state:
            return
        self.state = state
        self._draw_sign()
        self.words.set_words(state.words)
        self.setToolTip(plain_tip(f"{state.words}\n{state.more}".strip()))
        self.words.setToolTip(self.toolTip())
        self.setAccessibleName(state.words)
        self.setAccessibleDescription(state.more)

    def sizeHint(self) -> QSize:
        """Room for all of its words."""
        hint = super().sizeHint()
        words = self.fontMetrics().horizontalAdvance(self.words.words)
        return QSize(hint.width() + words, hint.height())

    def showEvent(self, event: QShowEvent) -> None:
        """Hear."""
        super().showEvent(event)
        self.listener.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Hear no more: nobody looks."""
        super().hideEvent(event)
        self.listener.stop()

    def _draw_sign(self) -> None:
        name, colour = SIGNS[self.state.sign]
        side = round(self.fontMetrics().height() * 1.1)
        picture = icon(name, self._look.theme.colour(colour))
        self.sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))
