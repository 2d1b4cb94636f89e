"""The help inside the window: its pages, the panel that shows them, and the way to them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from nep_studio.ui.actions import on_the_canvas, shortcuts_of
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from .panel import HelpPanel
    from .repository import Rows

Listener = Callable[["HelpPanel", str], object]


def make(host: Host) -> Parts:
    """The panel beside the canvas, and what the Help menu asks for."""
    from .help_controller import HelpDesk, open_documentation
    from .panel import HelpPanel

    services, workbench = host.services, host.workbench

    def shortcuts() -> Rows:
        return [*shortcuts_of(host.actions.by_name.values()), *on_the_canvas()]

    def new_panel() -> HelpPanel:
        return HelpPanel(workbench.canvas, services.look, services.language, shortcuts)

    panel = new_panel()
    desk = HelpDesk(panel, new_panel, workbench.panels, workbench.helpers.opening)
    desk.try_requested.connect(services.running.try_project)
    for menu in host.menus.values():
        desk.listen(menu)

    def follow(listener: Listener) -> None:
        """Tell of each page that is shown, and in which panel."""

        def follow_panel(shown: HelpPanel) -> None:
            shown.page_shown.connect(partial(listener, shown))

        desk.panel_made.connect(follow_panel)
        follow_panel(desk.panel)

    commands: dict[str, Callable[..., object]] = {
        "help.answer": desk.answer,
        "help.open": desk.open,
        "help.search": desk.search,
        "help.documentation": lambda: open_documentation(services.messages),
        "help.follow": follow,
    }
    return Parts(NewPanel(panel, tr("Help"), "circle-question-mark", "right"), commands=commands)


plugin = Plugin("help", make, order=110, modules=("repository", "panel", "help_controller"))
