"""Gestures: take them down from a watch, teach a recogniser, see how well it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from .gesture_controller import TrainerDesk
    from .page import TrainerPage

LEAST_SHARE = 0.55
"""How much of the height beside the canvas gestures need."""


def make(host: Host) -> Parts:
    """The panel below the canvas; its page is made when it is opened."""
    from .panel import TrainerPanel

    panel = TrainerPanel(lambda: _page(host))
    return Parts(NewPanel(panel, tr("Gestures"), "hand", "bottom", least_share=LEAST_SHARE))


def desk_of(host: Host) -> TrainerDesk:
    """The one desk; what it heard stays when the panel is made anew."""
    from .gesture_controller import TrainerDesk

    services = host.services

    def make_desk() -> TrainerDesk:
        return TrainerDesk(
            services.files, services.runner, services.messages, services.look, services.running
        )

    return host.keep(TrainerDesk, make_desk)


def _page(host: Host) -> TrainerPage:
    from .page import TrainerPage
    from .results.training import Training

    desk = desk_of(host)

    def make_training() -> Training:
        training = Training(desk, desk)
        desk.runner.closing.connect(training.close)
        return training

    page = TrainerPage(desk, host.keep(Training, make_training), host.workbench.canvas)
    page.connect_asked.connect(lambda: host.ask("watches.open"))
    return page


plugin = Plugin("gestures", make, order=70, modules=("panel",))
