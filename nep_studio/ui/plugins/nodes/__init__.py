"""The node panel: a card for each node, its log, and what is told when one comes to grief."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.run.session import PROGRAM
from nep_studio.ui.network_feed import feed_of
from nep_studio.ui.widgets.questions import tell_not_saved
from nep_studio.ui.words import tr

from .notifications import NodeTelling
from .panel import NodesPanel

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow


# Brings the node panel into a window, with what is told of nodes.


def add_nodes_panel(window: MainWindow) -> NodesPanel:
    """Add the panel below the canvas; call it each time the workbench is made."""
    running, workbench = window.running, window.workbench
    runner = running.runner
    panel = NodesPanel(runner, feed_of(running, lambda: runner.local.network), window.look)
    window.add_side_panel(panel, tr("Nodes"), "network", "bottom", is_shown=False)

    def open_log(name: str) -> None:
        workbench.panels.show(panel)
        panel.open_log(name)

    telling = panel.telling = NodeTelling(window, open_log, panel)

    def start(name: str) -> None:
        if name == PROGRAM:
            runner.run()
        else:
            telling.expect_start(name)
            telling.fixes.start(name)

    def stop(name: str) -> None:
        if name == PROGRAM:
            running.stop()
        else:
            telling.expect_stop(name)
            runner.stop_node(name)

    def restart(name: str) -> None:
        telling.expect_restart(name)
        runner.restart_node(name)

    panel.start_asked.connect(start)
    panel.stop_asked.connect(stop)
    panel.restart_asked.connect(restart)
    panel.page_asked.connect(lambda: workbench.canvas.show_page("robots"))
    panel.log.saving_failed.connect(
        lambda path, reason: tell_not_saved(window.messages, path, reason)
    )
    workbench.problems_found.connect(lambda _problems: panel.refresh_plan())
    return panel
