"""The network view: nodes and topics as a live graph, and the messages of each topic."""

from __future__ import annotations

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.network_feed import feed_of
from nep_studio.ui.widgets.questions import tell_not_saved


def make(host: Host) -> Parts:
    """The room of the network; what is chosen in it is shown by other panels."""
    from .panel import NetworkPanel

    services, runner = host.services, host.services.runner
    panel = NetworkPanel(feed_of(host), runner, services.look)
    panel.empty.run_button.clicked.connect(runner.run)
    panel.sharing_button.clicked.connect(lambda: host.ask("sharing.open"))
    for view in (panel.graph, panel.list):
        view.node_chosen.connect(lambda name: host.ask("nodes.show_log", name))
    pane = panel.pane
    pane.saving_failed.connect(lambda path, why: tell_not_saved(services.messages, path, why))
    pane.plot_requested.connect(lambda topic, field: host.ask("sensors.plot", topic, field))
    place = NewPanel(panel, "Network", "share-2", "page")
    return Parts(place, commands={"network.show_sharing": panel.show_sharing})


plugin = Plugin("network", make, order=50, modules=("graph_view", "panel"))
