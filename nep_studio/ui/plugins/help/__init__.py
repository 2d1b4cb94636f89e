"""The help inside the window: its pages, the panel that shows them, and the way to them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from nep_studio.ui.actions import on_the_canvas, shortcuts_of
from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel

if TYPE_CHECKING:
    from .panel import HelpPages
    from .repository import Rows

Listener = Callable[["HelpPages", str], object]


class HelpPanel(LatePanel["HelpPages"]):
    """Makes the help when it is shown for the first time."""

    usual_lines = (24, 30)


def make(host: Host) -> Parts:
    """The panel beside the canvas, and what the Help menu asks for."""
    from .help_controller import HelpController, open_documentation

    services, workbench = host.services, host.workbench

    def shortcuts() -> Rows:
        return [*shortcuts_of(host.actions.by_name.values()), *on_the_canvas()]

    def new_pages() -> HelpPages:
        from .panel import HelpPages

        return HelpPages(workbench.canvas, services.look, lambda: services.language, shortcuts)

    panel = HelpPanel(new_pages)
    controller = HelpController(panel, new_pages, workbench.panels, workbench.helpers.opening)
    controller.try_requested.connect(services.running.try_project)
    for menu in host.menus.values():
        controller.listen(menu)

    def follow(listener: Listener) -> None:
        """Tell of each page that is shown, and where."""

        def follow_pages(shown: HelpPages) -> None:
            shown.page_shown.connect(partial(listener, shown))

        controller.panel_made.connect(follow_pages)
        if panel.page is not None:
            follow_pages(panel.page)

    commands: dict[str, Callable[..., object]] = {
        "help.answer": controller.answer,
        "help.open": controller.open,
        "help.search": controller.search,
        "help.documentation": lambda: open_documentation(services.messages),
        "help.follow": follow,
    }
    return Parts(NewPanel(panel, "Help", "circle-question-mark", "right"), commands=commands)


plugin = Plugin("help", make, order=110, modules=("help_controller",))
