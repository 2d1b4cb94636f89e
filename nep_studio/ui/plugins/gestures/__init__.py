"""Gestures: take them down from a watch, teach a recogniser, see how well it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.host import Host, NewAction, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel

if TYPE_CHECKING:
    from .page import TrainerPage


class TrainerPanel(LatePanel["TrainerPage"]):
    """The page of the gestures, made when it is shown: numpy is slow to load."""

    usual_lines, least_lines = (45, 22), (14, 9)


def make(host: Host) -> Parts:
    """The room of the gestures, filled when it is opened."""
    panel = TrainerPanel(lambda: _page(host))
    teach = NewAction(
        "teach_gesture",
        "Teach a gesture…",
        lambda: host.show_panel(panel),
        "hand",
        tip="Make a movement with a watch or phone a few times: the program learns it",
        menu="robots",
    )
    return Parts(NewPanel(panel, "Gestures", "hand", "page"), actions=[teach])


def _page(host: Host) -> TrainerPage:
    from .gesture_controller import GestureController
    from .page import TrainerPage
    from .results.training import Training

    services = host.services
    controller = GestureController(
        services.files, services.runner, services.messages, services.look, services.running
    )
    training = Training(controller, controller)
    controller.runner.closing.connect(training.close)
    page = TrainerPage(controller, training, host.workbench.canvas)
    page.connect_asked.connect(lambda: host.ask("watches.open"))
    return page


plugin = Plugin("gestures", make, order=70)
