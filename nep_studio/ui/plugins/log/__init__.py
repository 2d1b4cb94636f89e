"""The log: what happens while a program runs, and all that the window has told."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel

if TYPE_CHECKING:
    from .panel import LogPage


class LogPanel(LatePanel["LogPage"]):
    """Makes the log when it is shown for the first time."""

    usual_lines = (30, 10)


def make(host: Host) -> Parts:
    """The panel below the canvas."""

    def new_page() -> LogPage:
        from .panel import LogPage

        services = host.services
        return LogPage(services.runner, services.messages, lambda: services.language, services.look)

    panel = LogPanel(new_page)
    host.services.runner.network_made.connect(panel.opened)  # it tells of what happens from there
    return Parts(NewPanel(panel, "Log", "history", "bottom"))


plugin = Plugin("log", make, order=80)
