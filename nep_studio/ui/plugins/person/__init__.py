"""The simulated human: whatever a program waits for is done by hand, with mouse and keyboard."""

from __future__ import annotations

from nep_studio.ui.floor import floor_of
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin


def make(host: Host) -> Parts:
    """The panel under the robots; hidden until somebody, or a program that runs, wants it."""
    from .panel import HumanPanel

    panel = HumanPanel(host, floor_of(host))
    shown = {"person.show": lambda: host.show_panel(panel)}
    return Parts(NewPanel(panel, "Person", "user", "person"), commands=shown)


plugin = Plugin("person", make, order=20, modules=("senses", "panel"))
