"""What runs: a card for each node, its log, and what is told when one comes to grief."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.run.plan import PROGRAM
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.network_feed import feed_of
from nep_studio.ui.widgets.layouts import LatePanel
from nep_studio.ui.widgets.questions import tell_not_saved

from .notifications import NodeNotifier

if TYPE_CHECKING:
    from .panel import NodesPage


class NodesPanel(LatePanel["NodesPage"]):
    """Makes the cards when it is shown for the first time; its ``notifier`` is there before."""

    usual_lines = (40, 11)

    def __init__(self, host: Host) -> None:
        super().__init__(self._new_page)
        self._host = host
        self.notifier = NodeNotifier(host, self.show_log, self)

    def show_log(self, name: str) -> None:
        """Show what a node writes."""
        self._host.show_panel(self)
        self.opened().open_log(name)

    def _new_page(self) -> NodesPage:
        from .panel import NodesPage

        services, workbench = self._host.services, self._host.workbench
        page = NodesPage(services.runner, feed_of(self._host), services.look)
        page.start_asked.connect(self._start)
        page.stop_asked.connect(self._stop)
        page.restart_asked.connect(self._restart)
        page.empty.page_button.clicked.connect(lambda: workbench.canvas.show_page("robots"))
        page.log.saving_failed.connect(
            lambda path, reason: tell_not_saved(services.messages, path, reason)
        )
        services.running.plan_changed.connect(page.refresh_plan)
        return page

    def _start(self, name: str) -> None:
        if name == PROGRAM:
            self._host.services.runner.run()
        else:
            self.notifier.expect_start(name)
            self.notifier.fixes.start(name)

    def _stop(self, name: str) -> None:
        if name == PROGRAM:
            self._host.services.running.stop()
        else:
            self.notifier.expect_stop(name)
            self._host.services.runner.stop_node(name)

    def _restart(self, name: str) -> None:
        self.notifier.expect_restart(name)
        self._host.services.runner.restart_node(name)


def make(host: Host) -> Parts:
    """The panel below the canvas, and what is told of nodes."""
    panel = NodesPanel(host)
    place = NewPanel(panel, "What runs", "network", "bottom")
    return Parts(place, commands={"nodes.show_log": panel.show_log})


plugin = Plugin("nodes", make, order=40, modules=("notifications",))
