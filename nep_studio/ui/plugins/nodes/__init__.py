"""What runs: a card for each node, its log, and what is told when one comes to grief."""

from __future__ import annotations

from nep_studio.run.plan import PROGRAM
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.network_feed import feed_of
from nep_studio.ui.widgets.questions import tell_not_saved


def make(host: Host) -> Parts:
    """The panel below the canvas, and what is told of nodes."""
    from .notifications import NodeNotifier
    from .panel import NodesPanel

    services, workbench = host.services, host.workbench
    runner = services.runner
    panel = NodesPanel(runner, feed_of(host), services.look)

    def show_log(name: str) -> None:
        host.show_panel(panel)
        panel.open_log(name)

    notifier = panel.notifier = NodeNotifier(host, show_log, panel)

    def start(name: str) -> None:
        if name == PROGRAM:
            runner.run()
        else:
            notifier.expect_start(name)
            notifier.fixes.start(name)

    def stop(name: str) -> None:
        if name == PROGRAM:
            services.running.stop()
        else:
            notifier.expect_stop(name)
            runner.stop_node(name)

    def restart(name: str) -> None:
        notifier.expect_restart(name)
        runner.restart_node(name)

    panel.start_asked.connect(start)
    panel.stop_asked.connect(stop)
    panel.restart_asked.connect(restart)
    panel.empty.page_button.clicked.connect(lambda: workbench.canvas.show_page("robots"))
    panel.log.saving_failed.connect(
        lambda path, reason: tell_not_saved(services.messages, path, reason)
    )
    services.running.plan_changed.connect(panel.refresh_plan)
    place = NewPanel(panel, "What runs", "network", "bottom")
    return Parts(place, commands={"nodes.show_log": show_log})


plugin = Plugin("nodes", make, order=40, modules=("notifications", "panel"))
