"""What the pictures of the rooms around the canvas show: help, cues, nodes, commands."""

from __future__ import annotations

from image_scenes import SCENES, scene
from image_window import Stage, picture, quiet
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget

from nep_studio.ui.plugins.gestures import TrainerPanel
from nep_studio.ui.plugins.watches.dialog import WatchDialog
from nep_studio.ui.shell.main_window import MainWindow

__all__ = ["SCENES"]


def _panel(window: MainWindow, name: str) -> QWidget:
    """Show a panel by its name in the settings."""
    panel = next(one for one in window.workbench.panels.all if one.name == name)
    window.workbench.panels.show(panel.widget)
    return panel.widget


@scene("help")
def help_page(stage: Stage) -> QImage:
    """The page of a block, with its example."""
    with stage.window() as window:
        window.host.ask("help.open", "block/robot.say")
        quiet()
        quiet()
        return picture(window)


@scene("robots-and-nodes")
def robots_and_nodes(stage: Stage) -> QImage:
    """What the karate example needs, before it runs."""
    with stage.window() as window:
        _panel(window, "RobotsPanel")
        _panel(window, "NodesPanel")
        quiet()
        return picture(window)


@scene("cues")
def cues(stage: Stage) -> QImage:
    """A button for each thing that may happen in the theatre piece."""
    with stage.window(example="theatre_cues") as window:
        _panel(window, "CuePanel")
        quiet()
        return picture(window)


@scene("commands")
def commands(stage: Stage) -> QImage:
    """All that can be done, found by a few letters."""
    with stage.window() as window:
        window.actions_by_name["palette"].trigger()
        quiet()
        return picture(window)


@scene("gestures")
def gestures(stage: Stage) -> QImage:
    """Three gestures that were taught, with their takes."""
    with stage.window(example="own_gestures") as window:
        panel = window.findChild(TrainerPanel)
        assert panel is not None
        window.workbench.panels.show(panel)
        quiet()
        return picture(window)


@scene("connect-watch")
def connect_watch(stage: Stage) -> QImage:
    """What somebody may have to send movements with."""
    with stage.window() as window:
        window.actions_by_name["connect_watch"].trigger()
        quiet()
        dialog = window.findChild(WatchDialog)
        assert dialog is not None
        return dialog.grab().toImage()
