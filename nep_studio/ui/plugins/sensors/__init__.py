"""The sensors: curves of what they measure, live, recorded and played back."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QApplication

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel

if TYPE_CHECKING:
    from .workspace import Workspace

RECORDINGS = "recordings"
"""The folder of recordings, beside the project that was used last."""


class SensorsPanel(LatePanel["Workspace"]):
    """Empty until it is shown for the first time: numpy and pyqtgraph are slow to load."""

    usual_lines, least_lines = (45, 16), (12, 7)


def make(host: Host) -> Parts:
    """The room of the sensors; numpy and what draws the plots are loaded when it is opened."""
    panel = SensorsPanel(lambda: _workspace(host))

    def plot(topic: str, field: str = "") -> None:
        """Plot a number of a topic; without a field, let the person choose."""
        host.show_panel(panel)
        panel.opened().show_field(topic, field)

    place = NewPanel(panel, "Sensors", "activity", "page")
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
