"""The stage: one scene with all robots of the project, and a card for each."""

from __future__ import annotations

from nep_studio.ui.floor import floor_of
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.speech import sound_of


def make(host: Host) -> Parts:
    """The panel at the far side of the canvas; it follows the page Robots."""
    from .panel import RobotsPanel
    from .participants import Starts

    services, runner = host.services, host.services.runner
    panel = RobotsPanel(
        runner,
        lambda: services.language,
        services.look,
        floor_of(host),
        sound_of(host),
        Starts(runner, runner),
    )
    services.running.plan_changed.connect(panel.refresh)
    services.files.document_changed.connect(panel.begin_anew)
    panel.stage.tools.real.triggered.connect(lambda: host.ask("connecting.open"))
    shown = {"robots.show": lambda: host.show_panel(panel)}
    return Parts(NewPanel(panel, "Stage", "bot", "stage", is_shown=True), commands=shown)


plugin = Plugin("robots", make, order=10, modules=("stage", "panel"))
