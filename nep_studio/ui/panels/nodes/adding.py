"""Brings the node panel into a window, with what is told of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.problems import Problem
from nep_studio.session import PROGRAM
from nep_studio.ui.panels.network.feed import feed_of
from nep_studio.ui.words import tr

from .panel import NodesPanel
from .telling import NodeTelling

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow


def add_nodes_panel(window: MainWindow) -> NodesPanel:
    """Add the panel below the canvas; call it each time the workbench is made."""
    running, workbench = window.running, window.workbench
    runner = running.runner
    panel = NodesPanel(runner, feed_of(running, lambda: runner.local.network), window.look)
    window.add_side_panel(panel, tr("Nodes"), "network", "bottom", is_shown=False)

    def open_log(name: str) -> None:
        workbench.panels.show(panel)
        panel.open_log(name)

    telling = panel.telling = NodeTelling(window, open_log, panel)

    def start(name: str) -> None:
        if name == PROGRAM:
            runner.run()
        else:
            telling.expect_start(name)
            telling.fixes.start(name)

    def stop(name: str) -> None:
        if name == PROGRAM:
            running.stop()
        else:
            telling.expect_stop(name)
            runner.stop_node(name)

    def restart(name: str) -> None:
        telling.expect_restart(name)
        runner.restart_node(name)

    panel.start_asked.connect(start)
    panel.stop_asked.connect(stop)
    panel.restart_asked.connect(restart)
    panel.page_asked.connect(lambda: workbench.canvas.show_page("robots"))
    panel.log.saving_failed.connect(lambda path, reason: tell_not_saved(window, path, reason))
    workbench.problems_found.connect(lambda _problems: panel.refresh_plan())
    return panel


def tell_not_saved(window: MainWindow, path: str, reason: str) -> None:
    """Say that a file could not be written, and what to try."""
    why = tr(reason.lower())
    sentence = tr("The file {path} could not be written: {reason}.", path=path, reason=why)
    steps = ("Choose another folder.", "Is there room on the disk?")
    window.messages.tell_problem(Problem("The file was not saved", sentence, steps))
