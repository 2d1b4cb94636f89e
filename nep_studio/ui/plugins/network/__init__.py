"""The network view: nodes and topics as a live graph, and the messages of each topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.network_feed import feed_of
from nep_studio.ui.widgets.questions import tell_not_saved
from nep_studio.ui.words import tr

from .panel import NetworkPanel

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow


# Brings the network panel into a window.

LEAST_SHARE = 0.45
"""How much of the height beside the canvas a graph needs to be of use."""


def add_network_panel(window: MainWindow) -> NetworkPanel:
    """Add the panel below the canvas; call it each time the workbench is made.

    Connect its ``plot_requested`` to the sensors panel and its ``node_chosen`` to the node panel.
    """
    runner, workbench = window.running.runner, window.workbench
    feed = feed_of(window.running, lambda: runner.local.network)
    panel = NetworkPanel(feed, lambda: runner.board.nodes, runner, window.look)
    added = window.add_side_panel(panel, tr("Network"), "share-2", "bottom", is_shown=False)
    panel.run_asked.connect(runner.run)
    panel.saving_failed.connect(lambda path, reason: tell_not_saved(window.messages, path, reason))

    workbench.panels.give_room(added, LEAST_SHARE)
    return panel
