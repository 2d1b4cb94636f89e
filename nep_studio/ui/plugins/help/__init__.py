"""The help inside the window: its pages, the panel that shows them, and the way to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.shell.help_dialogs import on_the_canvas, shortcuts_of
from nep_studio.ui.words import tr

from .help_controller import HelpDesk
from .panel import HelpPanel
from .repository import Rows

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow


# Brings the help into a main window, whose Help menu asks it.


def add_help(window: MainWindow) -> HelpDesk:
    """Add the help to a window whose menus are made; the desk goes with the workbench.

    Its ``try_requested`` brings a Project that can run as it is.
    """
    workbench = window.workbench

    def shortcuts() -> Rows:
        return [*shortcuts_of(window.actions_by_name.by_name.values()), *on_the_canvas()]

    def new_panel() -> HelpPanel:
        return HelpPanel(workbench.canvas, window.look, window.studio.language, shortcuts)

    panel, icon_name = new_panel(), "circle-question-mark"
    window.add_side_panel(panel, tr("Help"), icon_name, "right", is_shown=False)
    desk = HelpDesk(panel, new_panel, workbench.panels, workbench.helpers.opening)
    window.later.desk = desk
    for menu in window.menus.values():
        desk.listen(menu)
    return desk
