"""What stands around the canvas beside the workbench's own panels: each room adds itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction

from nep_studio.ui.plugins.connecting import add_connecting
from nep_studio.ui.plugins.cues.panel import add_cues_panel
from nep_studio.ui.plugins.exporting import NEEDS_PROJECT, add_exporting
from nep_studio.ui.plugins.gestures.panel import add_trainer_panel
from nep_studio.ui.plugins.help import add_help
from nep_studio.ui.plugins.log.panel import add_log_panel
from nep_studio.ui.plugins.motion import add_motion
from nep_studio.ui.plugins.network import add_network_panel
from nep_studio.ui.plugins.nodes import add_nodes_panel
from nep_studio.ui.plugins.person.panel import add_human_panel
from nep_studio.ui.plugins.robots.panel import add_robots_panel
from nep_studio.ui.plugins.sensors.panel import add_sensors_panel, show_topic
from nep_studio.ui.plugins.sharing import add_sharing
from nep_studio.ui.plugins.show import add_show_mode
from nep_studio.ui.plugins.study import add_study
from nep_studio.ui.plugins.tour.tour import add_tour
from nep_studio.ui.plugins.watches import add_watches

from .command_palette import add_command_palette

if TYPE_CHECKING:
    from .main_window import MainWindow

WITH_A_PROJECT = (*NEEDS_PROJECT, "show_mode", "show_at_start")
"""The actions of rooms that need an open project."""


def add_rooms(window: MainWindow) -> Iterator[None]:
    """Add the panels and their actions, in the order of their tabs: one room at each step."""
    add_robots_panel(window)
    yield
    add_human_panel(window)
    yield
    add_cues_panel(window)
    yield
    nodes = add_nodes_panel(window)
    yield
    network = add_network_panel(window)
    network.node_chosen.connect(lambda _name: window.workbench.panels.show(nodes))
    network.node_chosen.connect(nodes.open_log)
    yield
    add_sensors_panel(window)
    network.plot_requested.connect(lambda topic, field: show_topic(window, topic, field))
    yield
    add_trainer_panel(window)
    yield
    add_log_panel(window)
    yield
    add_exporting(window)
    add_show_mode(window)
    yield
    help_desk = add_help(window)
    help_desk.try_requested.connect(window.running.try_project)
    yield
    add_tour(window)
    yield
    add_study(window)
    yield
    add_connecting(window)
    add_watches(window)
    add_sharing(window, network)
    add_motion(window)
    yield
    add_command_palette(window)
    _put_into_menus(window)


def _put_into_menus(window: MainWindow) -> None:
    actions, menus = window.actions_by_name, window.menus
    after_picture = _after(menus["file"].actions(), actions["picture"])
    menus["file"].insertActions(
        after_picture, [actions[name] for name in ("save_python", "copy_python", "print")]
    )
    menus["view"].addSeparator()
    menus["view"].addActions([actions[name] for name in ("show_mode", "show_at_start", "palette")])


def _after(actions: list[QAction], one: QAction) -> QAction:
    return actions[actions.index(one) + 1]
