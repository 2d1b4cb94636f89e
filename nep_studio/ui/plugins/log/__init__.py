"""The log: what happens while a program runs, and all that the window has told."""

from __future__ import annotations

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin


def make(host: Host) -> Parts:
    """The panel below the canvas."""
    from .panel import LogPanel

    services = host.services
    panel = LogPanel(services.runner, services.messages, lambda: services.language, services.look)
    return Parts(NewPanel(panel, "Log", "history", "bottom"))


plugin = Plugin("log", make, order=80, modules=("panel",))
