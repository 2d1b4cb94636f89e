"""Does what the buttons of the messages about nodes say."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from nep_studio.blocks.deployment import ROBOT_BLOCK
from nep_studio.blocks.edits import SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.own_master import MASTER
from nep_studio.plan import PlannedNode
from nep_studio.ui.connecting.adding import open_connecting
from nep_studio.ui.messages import Answer
from nep_studio.ui.words import tr

from .notices import Fix

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow


class NodeFixes:
    """Fixes of one window; ``open_log`` shows the log of a node."""

    def __init__(self, window: MainWindow, open_log: Callable[[str], None]) -> None:
        self._window, self._open_log = window, open_log

    def plan_of(self, name: str) -> PlannedNode | None:
        """How a node is wanted now: as the project says, else as it was started."""
        runner = self._window.running.runner
        found = {one.name: one for one in runner.planned()}
        return found.get(name) or runner.local.planned.get(name)

    def block_of(self, name: str) -> str:
        """The block that a node comes from; "" when it has none on a page."""
        plan = self.plan_of(name)
        blocks = self._window.workbench.canvas.editor.project.blocks
        return plan.block_id if plan is not None and plan.block_id in blocks else ""

    def answer(self, fix: Fix, name: str) -> Answer:
        """The button of a fix."""
        words: Mapping[Fix, str] = {
            "start": tr("Start it again"),
            "restart": tr("Restart it"),
            "show_log": tr("Show its log"),
            "show_settings": tr("Show its settings"),
            "use_virtual": tr("Use the robot on the screen"),
            "test_connection": tr("Find it and test the connection"),
            "change_address": tr("Change the address"),
            "run": tr("Run again"),
            "stop": tr("Stop"),
        }
        look = "primary" if fix in ("start", "restart", "use_virtual", "run") else "quiet"
        return Answer(words[fix], lambda: self.do(fix, name), look)  # type: ignore[arg-type]

    def do(self, fix: Fix, name: str) -> None:
        """Do what a fix says."""
        match fix:
            case "start":
                self.start(name)
            case "restart":
                self._window.running.runner.restart_node(name)
            case "show_log":
                self._open_log(name)
            case "show_settings":
                self._window.workbench.show_block(self.block_of(name))
            case "use_virtual":
                self._use_virtual(name)
            case "test_connection":
                open_connecting(self._window, name)
            case "change_address":
                self._change_address(name)
            case "run":
                self._window.running.runner.run()
            case "stop":
                self._window.running.stop()

    def start(self, name: str) -> None:
        """Start a node as it is wanted now; or the network, when its master is gone."""
        if name == MASTER:
            self._window.running.runner.open_network()
            return
        plan = self.plan_of(name)
        if plan is not None:
            self._window.running.runner.start_node(plan)

    def _use_virtual(self, name: str) -> None:
        """Let the robot be the one on the screen: in the project, where it can be undone."""
        block, workbench = self._robot_block(name), self._window.workbench
        if not block:
            return
        editor = workbench.canvas.editor
        try:
            with editor.transaction(tr("use the robot on the screen")):
                editor.apply(SetField(block, "driver", "virtual"))
        except EditRefused as refusal:
            self._window.messages.refuse(refusal.sentence, refusal.checklist)
            return
        self.start(name)  # the running one is as it was before, so it is started anew

    def _change_address(self, name: str) -> None:
        """Show the robot's block with its address open to be written."""
        block, workbench = self._robot_block(name), self._window.workbench
        if block:
            workbench.show_block(block)
            workbench.canvas.fields.open(block, "address")

    def _robot_block(self, name: str) -> str:
        block = self.block_of(name)
        project = self._window.workbench.canvas.editor.project
        return block if block and project.blocks[block].type == ROBOT_BLOCK else ""
