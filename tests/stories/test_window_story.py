"""A newcomer at the real window: tries the karate example, makes a rule, breaks it, and fixes it.

With NEP_STORY_IMAGES=FOLDER a picture of each step is kept; tools/story_images.py does so on a
virtual screen.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QDialog, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from benchmarks.virtual_display import missing_programs
from nep_core.wire import messages as m
from nep_studio.ui.running.needs import NeedsDialog
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import FIRST_SIZE, MainWindow
from tests.ui.checklist.person import Key, Person
from tests.ui.window.conftest import home, studio
from tests.ui.window.putting_away import put_away

__all__ = ["home", "studio"]

WAIT_MS = 60_000
IMAGES_VARIABLE = "NEP_STORY_IMAGES"
IS_ON_A_DISPLAY = bool(os.environ.get("CI")) and not missing_programs()
"""Whether test_window_story_on_a_display.py plays this story, by a process of its own."""
SETTLE_MS = 100
"""What has just changed has its room then."""
LEFT = Qt.MouseButton.LeftButton


class Newcomer(Person):
    """Somebody who has never seen the window, and what happens before their eyes."""

    def __init__(self, window: MainWindow, qtbot: QtBot) -> None:
        super().__init__(window, qtbot)
        self.messages: list[object] = []
        self.glowed: list[str] = []
        self._folder = os.environ.get(IMAGES_VARIABLE, "")
        self._step = 0
        window.running.runner.arrived.connect(self._see)

    def _see(self, batch: list[tuple[str, object]]) -> None:
        self.messages += [message for _, message in batch]
        for block in self.window.running.stage.marks.glowing:
            if block not in self.glowed:
                self.glowed.append(block)

    def step(self, name: str) -> None:
        """Look at the window; a picture is kept where they are collected."""
        self._step += 1
        if self._folder:
            self.qtbot.wait(SETTLE_MS)
            dialogs = [one for one in self.window.findChildren(QDialog) if one.isVisible()]
            shown = dialogs[0] if dialogs else self.window
            shown.grab().save(str(Path(self._folder) / f"story-{self._step}-{name}.png"))

    def press_button(self, root: QWidget, words: str) -> None:
        """Press the button with these words."""

        def found() -> QPushButton | None:
            buttons = root.findChildren(QPushButton)
            return next((b for b in buttons if words in b.text() and b.isVisible()), None)

        self.qtbot.waitUntil(lambda: found() is not None, timeout=WAIT_MS)
        self.qtbot.mouseClick(found(), LEFT)

    def press_tool(self, name: str) -> None:
        """Press a button of the toolbar."""
        button = self.window.toolbar.widgetForAction(self.window.actions_by_name[name])
        self.qtbot.waitUntil(button.isEnabled, timeout=WAIT_MS)
        self.qtbot.mouseClick(button, LEFT)

    def wait_for_state(self, state: str) -> None:
        runner = self.window.running.runner
        self.qtbot.waitUntil(lambda: runner.state == state, timeout=WAIT_MS)

    def heard(self, words: str) -> bool:
        """Whether a robot has begun to say this."""
        requests = {
            one.id
            for one in self.messages
            if isinstance(one, m.ActionRequest) and one.args.get("text") == words
        }
        return any(
            one.id in requests and one.state == "started"
            for one in self.messages
            if isinstance(one, m.ActionResult)
        )


@pytest.fixture
def window(studio: Studio, qtbot: QtBot) -> MainWindow:
    """The window as it is at first."""
    made = MainWindow(studio)
    qtbot.addWidget(made, before_close_func=put_away)
    made.resize(FIRST_SIZE)
    with qtbot.waitActive(made):
        made.show()
        made.activateWindow()
    made.start(None)
    return made


@pytest.fixture
def newcomer(window: MainWindow, qtbot: QtBot) -> Iterator[Newcomer]:
    yield Newcomer(window, qtbot)
    window.running.close()


@pytest.mark.skipif(
    IS_ON_A_DISPLAY and IMAGES_VARIABLE not in os.environ, reason="it is played on a display"
)
@pytest.mark.timeout(240)
def test_a_newcomer_tries_the_karate_example_and_makes_a_rule(
    newcomer: Newcomer, window: MainWindow, qtbot: QtBot
) -> None:
    qtbot.waitUntil(lambda: window.start_page.gallery.is_complete, timeout=WAIT_MS)
    newcomer.step("welcome")
    card = next(c for path, c in window.start_page.cards.items() if path.stem == "karate_greeting")
    qtbot.mouseClick(card, LEFT)
    qtbot.waitUntil(lambda: newcomer.canvas.isVisible(), timeout=WAIT_MS)
    rule = next(
        stack.body
        for stack in newcomer.project.pages["behaviour"]
        if newcomer.project.blocks[stack.body[0]].type == "event.gesture"
    )
    newcomer.step("example")

    newcomer.press_tool("run")
    newcomer.wait_for_state("running")
    qtbot.waitUntil(lambda: newcomer.heard("Impressive!"), timeout=WAIT_MS)
    newcomer.step("impressive")
    says, lights = rule[1], rule[2]
    qtbot.waitUntil(lambda: lights in newcomer.glowed or rule[3] in newcomer.glowed)
    assert newcomer.glowed.index(says) < max(map(newcomer.glowed.index, _seen(newcomer, rule[2:])))
    assert window.running.stage.marks.counts[rule[0]] == 1

    newcomer.press_tool("stop")
    newcomer.wait_for_state("idle")
    newcomer.step("stopped")

    _make_a_rule(newcomer)
    newcomer.step("own-rule")
    newcomer.press_tool("run")
    qtbot.waitUntil(lambda: newcomer.heard("Hello"), timeout=WAIT_MS)
    newcomer.press_tool("stop")
    newcomer.wait_for_state("idle")

    _break_it(newcomer)
    newcomer.press_tool("run")
    qtbot.waitUntil(lambda: bool(window.findChildren(NeedsDialog)), timeout=WAIT_MS)
    dialog = window.findChildren(NeedsDialog)[0]
    newcomer.step("what-is-missing")
    assert not dialog.run_button.isEnabled()
    newcomer.press_button(dialog, "Add")
    qtbot.waitUntil(dialog.run_button.isEnabled, timeout=WAIT_MS)
    newcomer.step("fixed")
    newcomer.messages.clear()
    qtbot.mouseClick(dialog.run_button, LEFT)
    qtbot.waitUntil(lambda: newcomer.heard("Hello"), timeout=WAIT_MS)
    newcomer.press_tool("stop")
    newcomer.wait_for_state("idle")


def _seen(newcomer: Newcomer, blocks: list[str]) -> list[str]:
    return [block for block in blocks if block in newcomer.glowed]


def _make_a_rule(newcomer: Newcomer) -> None:
    """Begin anew, and drag “when the program starts” and “NAO says” out of the palette."""
    newcomer.window.files.new()
    newcomer.qtbot.waitUntil(lambda: not newcomer.project.pages["behaviour"])
    newcomer.look_at_corner()
    newcomer.from_palette("event.started", QPoint(120, 80))
    hat = newcomer.body()[0]
    newcomer.from_palette("robot.say", newcomer.foot(hat) + QPoint(40, 14))
    assert len(newcomer.body()) == 2


def _break_it(newcomer: Newcomer) -> None:
    """Take the robot away from the Robots page."""
    newcomer.canvas.show_page("robots")
    newcomer.look_at_corner()
    newcomer.select(newcomer.body()[0])
    newcomer.key(Key.Key_Delete)
    assert not newcomer.project.pages["robots"]
    newcomer.canvas.show_page("behaviour")
