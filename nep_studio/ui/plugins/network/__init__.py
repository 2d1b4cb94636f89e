"""The network view: nodes and topics as a live graph, and the messages of each topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.network_feed import feed_of
from nep_studio.ui.widgets.layouts import LatePanel
from nep_studio.ui.widgets.questions import tell_not_saved

if TYPE_CHECKING:
    from .panel import NetworkWorkspace


class NetworkPanel(LatePanel["NetworkWorkspace"]):
    """Empty until it is shown for the first time: few people look at the network."""

    usual_lines = (40, 18)

    def __init__(self, host: Host) -> None:
        super().__init__(lambda: _workspace(host))
        self._sharing = ("", "", "")

    def opened(self) -> NetworkWorkspace:
        """What is in it; it knows at once who else is let in."""
        is_new = self.page is None
        page = super().opened()
        if is_new:
            page.show_sharing(*self._sharing)
        return page

    def show_sharing(self, words: str, more: str, icon_name: str) -> None:
        """Say that the network is open to other computers; no ``words`` when it is not."""
        self._sharing = (words, more, icon_name)
        if self.page is not None:
            self.page.show_sharing(words, more, icon_name)


def make(host: Host) -> Parts:
    """The room of the network; what is chosen in it is shown by other panels."""
    panel = NetworkPanel(host)
    place = NewPanel(panel, "Network", "share-2", "page")
    return Parts(place, commands={"network.show_sharing": panel.show_sharing})


def _workspace(host: Host) -> NetworkWorkspace:
    from .panel import NetworkWorkspace

    services, runner = host.services, host.services.runner
    made = NetworkWorkspace(feed_of(host), runner, services.look)
    made.empty.run_button.clicked.connect(runner.run)
    made.sharing_button.clicked.connect(lambda: host.ask("sharing.open"))
    for view in (made.graph, made.list):
        view.node_chosen.connect(lambda name: host.ask("nodes.show_log", name))
    pane = made.pane
    pane.saving_failed.connect(lambda path, why: tell_not_saved(services.messages, path, why))
    pane.plot_requested.connect(lambda topic, field: host.ask("sensors.plot", topic, field))
    return made


plugin = Plugin("network", make, order=50)
