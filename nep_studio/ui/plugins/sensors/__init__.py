"""The sensors: curves of what they measure, live, recorded and played back."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QApplication

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from .workspace import Workspace

RECORDINGS = "recordings"
"""The folder of recordings, beside the project that was used last."""

LEAST_SHARE = 0.4
"""How much of the height beside the canvas plots need to be of use."""


def make(host: Host) -> Parts:
    """The panel below the canvas; numpy and what draws the plots are loaded when it is opened."""
    from .panel import SensorsPanel

    panel = SensorsPanel(lambda: _workspace(host))

    def plot(topic: str, field: str = "") -> None:
        """Plot a number of a topic; without a field, let the person choose."""
        host.show_panel(panel)
        panel.opened().show_field(topic, field)

    place = NewPanel(panel, tr("Sensors"), "activity", "bottom", least_share=LEAST_SHARE)
    return Parts(place, commands={"sensors.plot": plot})


def _workspace(host: Host) -> Workspace:
    """The contents of the panel; what was heard stays when it is made anew."""
    from nep_studio.ui.network_feed import feed_of

    from .feed import SensorFeed
    from .recorder import Recorder
    from .workspace import Workspace

    services = host.services
    runner, settings = services.runner, services.settings
    feed = host.keep(SensorFeed, lambda: SensorFeed(runner, services.running))

    def make_recorder() -> Recorder:
        """One that ends its files when the program ends."""
        recorder = Recorder(feed)
        app = QApplication.instance()
        if app is not None:
            app.aboutToQuit.connect(recorder.finish)
        return recorder

    def folder() -> Path:
        return settings.last_folder / RECORDINGS

    recorder, network = host.keep(Recorder, make_recorder), feed_of(host)
    return Workspace(feed, recorder, network, runner, services.messages, services.look, folder)


plugin = Plugin("sensors", make, order=60, modules=("panel",))
