"""The simulated human: whatever a program waits for is done by hand, with mouse and keyboard."""

from __future__ import annotations

from nep_studio.ui.floor import floor_of
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin

LEAST_SHARE = 0.4


def make(host: Host) -> Parts:
    """The panel; hidden until somebody wants it, or a program waits for what is done there."""
    from .panel import HumanPanel

    panel = HumanPanel(host, floor_of(host))
    return Parts(
        NewPanel(panel, "Person", "user", "bottom", least_share=LEAST_SHARE),
        commands={"person.show": lambda: host.show_panel(panel)},
    )


plugin = Plugin("person", make, order=20, modules=("senses", "panel"))
