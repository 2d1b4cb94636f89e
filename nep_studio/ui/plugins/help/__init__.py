"""The help inside the window: its pages, the panel that shows them, and the way to them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from nep_studio.ui.actions import on_the_canvas, shortcuts_of
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin

if TYPE_CHECKING:
    from .panel import HelpPanel
    from .repository import Rows

Listener = Callable[["HelpPanel", str], object]


def make(host: Host) -> Parts:
    """The panel beside the canvas, and what the Help menu asks for."""
    from .help_controller import HelpController, open_documentation
    from .panel import HelpPanel

    services, workbench = host.services, host.workbench

    def shortcuts() -> Rows:
        return [*shortcuts_of(host.actions.by_name.values()), *on_the_canvas()]

    def new_panel() -> HelpPanel:
        return HelpPanel(workbench.canvas, services.look, lambda: services.language, shortcuts)

    panel = new_panel()
    controller = HelpController(panel, new_panel, workbench.panels, workbench.helpers.opening)
    controller.try_requested.connect(services.running.try_project)
    for menu in host.menus.values():
        controller.listen(menu)

    def follow(listener: Listener) -> None:
        """Tell of each page that is shown, and in which panel."""

        def follow_panel(shown: HelpPanel) -> None:
            shown.page_shown.connect(partial(listener, shown))

        controller.panel_made.connect(follow_panel)
        follow_panel(controller.panel)

    commands: dict[str, Callable[..., object]] = {
        "help.answer": controller.answer,
        "help.open": controller.open,
        "help.search": controller.search,
        "help.documentation": lambda: open_documentation(services.messages),
        "help.follow": follow,
    }
    return Parts(NewPanel(panel, "Help", "circle-question-mark", "right"), commands=commands)


plugin = Plugin("help", make, order=110, modules=("repository", "panel", "help_controller"))
