"""What stands around the canvas beside the workbench's own panels: each room adds itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.ui.panels.log.panel import add_log_panel
from nep_studio.ui.panels.robots.panel import add_robots_panel
from nep_studio.ui.study.adding import add_study
from nep_studio.ui.tour.tour import add_tour

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow


def add_rooms(window: MainWindow) -> None:
    """Add the panels and their actions, in the order of their tabs."""
    add_robots_panel(window)
    add_log_panel(window)
    add_study(window)
    add_tour(window)
    window.start_page.try_requested.connect(window.running.try_example)
