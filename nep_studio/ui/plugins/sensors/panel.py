"""The sensors panel beside the canvas; what draws in it is loaded when it is opened."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

    from .feed import SensorFeed
    from .recorder import Recorder
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


def add_sensors_panel(window: MainWindow) -> SensorsPanel:
    """Put the plots of sensors below the canvas; call it each time the workbench is made."""
    panel = SensorsPanel(lambda: _workspace(window))
    added = window.add_side_panel(panel, tr("Sensors"), "activity", "bottom", is_shown=False)
    window.workbench.panels.give_room(added, LEAST_SHARE)
    return panel


def show_topic(window: MainWindow, topic: str, field: str = "") -> None:
    """Open the panel and plot a number of a topic; without a field, let the person choose."""
    panel = window.workbench.findChild(SensorsPanel)
    if isinstance(panel, SensorsPanel):
        window.workbench.panels.show(panel)
        panel.opened().show_field(topic, field)


def _workspace(window: MainWindow) -> Workspace:
    """The contents of a panel; what was heard stays when the window is made anew."""
    from nep_studio.ui.network_feed import feed_of

    from .feed import SensorFeed
    from .recorder import Recorder
    from .workspace import Workspace

    runner, owner = window.running.runner, window.running
    feed = owner.findChild(SensorFeed) or SensorFeed(runner, owner)
    recorder = feed.findChild(Recorder) or _recorder(feed)
    network = feed_of(owner, lambda: runner.local.network)
    look, settings = window.studio.look, window.settings

    def folder() -> Path:
        return settings.last_folder / RECORDINGS

    return Workspace(feed, recorder, network, runner, window.messages, look, folder)


def _recorder(feed: SensorFeed) -> Recorder:
    """A recorder that ends its files when the program ends."""
    from .recorder import Recorder

    recorder = Recorder(feed)
    app = QApplication.instance()
    if app is not None:
        app.aboutToQuit.connect(recorder.finish)
    return recorder
