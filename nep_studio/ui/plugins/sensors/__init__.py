"""The sensors: curves of what they measure, live, recorded and played back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin

if TYPE_CHECKING:
    from .workspace import Workspace

RECORDINGS = "recordings"
"""The folder of recordings, beside the project that was used last."""

LEAST_SHARE = 0.4
"""How much of the height beside the canvas plots need to be of use."""


class SensorsPanel(QWidget):
    """Empty until it is shown for the first time: numpy and pyqtgraph are slow to load."""

    def __init__(self, make: Callable[[], Workspace]) -> None:
        super().__init__()
        self._make = make
        self.workspace: Workspace | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)

    def opened(self) -> Workspace:
        """What is in it; made now if it is not there yet."""
        if self.workspace is None:
            self.workspace = self._make()
            box = self.layout()
            if box is not None:
                box.addWidget(self.workspace)
        return self.workspace

    def sizeHint(self) -> QSize:
        """Room for two plots and the list of curves."""
        line = self.fontMetrics().height()
        return QSize(line * 45, line * 16)

    def minimumSizeHint(self) -> QSize:
        """Less is of no use."""
        line = self.fontMetrics().height()
        return QSize(line * 12, line * 7)

    def showEvent(self, event: QShowEvent) -> None:
        """Open it."""
        self.opened()
        super().showEvent(event)


def make(host: Host) -> Parts:
    """The panel below the canvas; numpy and what draws the plots are loaded when it is opened."""
    panel = SensorsPanel(lambda: _workspace(host))

    def plot(topic: str, field: str = "") -> None:
        """Plot a number of a topic; without a field, let the person choose."""
        host.show_panel(panel)
        panel.opened().show_field(topic, field)

    place = NewPanel(panel, "Sensors", "activity", "bottom", least_share=LEAST_SHARE)
    return Parts(place, commands={"sensors.plot": plot})


def _workspace(host: Host) -> Workspace:
    """The contents of the panel; what is recorded is kept when the program ends."""
    from nep_studio.ui.network_feed import feed_of

    from .feed import SensorFeed
    from .recorder import Recorder
    from .workspace import Workspace

    services = host.services
    runner, settings = services.runner, services.settings
    feed = SensorFeed(runner, services.running)

    recorder, network = Recorder(feed), feed_of(host)
    app = QApplication.instance()
    if app is not None:
        app.aboutToQuit.connect(recorder.finish)

    def folder() -> Path:
        return settings.last_folder / RECORDINGS

    return Workspace(feed, recorder, network, runner, services.messages, services.look, folder)


plugin = Plugin("sensors", make, order=60)
