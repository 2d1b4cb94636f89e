"""What a person does with a running program in tests: press its buttons, and see what happens."""

from __future__ import annotations

from PySide6.QtCore import Qt
from pytestqt.exceptions import TimeoutError as PytestQtTimeoutError
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B

WAIT_MS = 30_000
LONG_WAIT = B("control.wait", {"seconds": 600})
WAIT_A_LITTLE = B("control.wait", {"seconds": 0.05})


class Seen:
    """The states that the program went through, and what it told."""

    def __init__(self, window: MainWindow) -> None:
        self.states: list[str] = []
        self.messages: list[object] = []
        self.glowing: list[frozenset[str]] = []
        runner, stage = window.running.runner, window.running.stage
        runner.state_changed.connect(self.states.append)
        runner.arrived.connect(lambda batch: self.messages.extend(one for _, one in batch))
        runner.arrived.connect(lambda _: self.glowing.append(stage.marks.glowing))

    def said(self) -> list[str]:
        requests = [one for one in self.messages if isinstance(one, m.ActionRequest)]
        return [one.args["text"] for one in requests if one.action == "say"]


def blocks_of(window: MainWindow, block_type: str) -> list[str]:
    blocks = window.workbench.canvas.editor.project.blocks.values()
    return [block.id for block in blocks if block.type == block_type]


def block_of(window: MainWindow, block_type: str) -> str:
    return blocks_of(window, block_type)[0]


def press(window: MainWindow, qtbot: QtBot, name: str) -> None:
    """Press a button of the toolbar."""
    button = window.toolbar.widgetForAction(window.actions_by_name[name])
    assert button.isEnabled(), name
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def state_is(window: MainWindow, qtbot: QtBot, state: str) -> None:
    runner = window.running.runner
    try:
        qtbot.waitUntil(lambda: runner.state == state, timeout=WAIT_MS)
    except PytestQtTimeoutError as error:
        logs = [
            f"{file.name}: {file.read_text()[-2000:]}" for file in runner.local.logs.glob("*.log")
        ]
        events = {name: node.event for name, node in runner.board.nodes.items()}
        raise AssertionError(f"it is {runner.state}, nodes {events}\n" + "\n".join(logs)) from error


def has_run(window: MainWindow, qtbot: QtBot, seen: Seen) -> None:
    """Wait for the end of a program; one that ends at once runs for less than a look at it."""
    qtbot.waitUntil(lambda: "running" in seen.states, timeout=WAIT_MS)
    state_is(window, qtbot, "idle")


def health(window: MainWindow, name: str) -> str:
    status = window.running.runner.board.nodes.get(name)
    return status.health if status is not None else ""
