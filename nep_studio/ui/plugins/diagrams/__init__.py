"""The diagrams: state machines as graphs and behaviour trees as trees, beside their blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel

if TYPE_CHECKING:
    from .panel import DiagramPage

HELP = "howto/diagrams"


class DiagramPanel(LatePanel["DiagramPage"]):
    """Empty until it is shown for the first time: many programs have neither states nor trees."""

    usual_lines, least_lines = (24, 20), (12, 8)


def make(host: Host) -> Parts:
    """The panel of the diagrams, beside the canvas: what is chosen in one is chosen in both."""
    panel = DiagramPanel(lambda: _page(host))
    panel.setProperty("help_page", HELP)
    return Parts(NewPanel(panel, "Diagram", "git-branch", "right"))


def _page(host: Host) -> DiagramPage:
    from .panel import DiagramPage

    return DiagramPage(host)


plugin = Plugin("diagrams", make, order=55)
