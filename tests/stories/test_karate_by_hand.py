"""A teacher makes the karate story from nothing: a few clicks and drags, or five phrases.

Each thing that the hand does is noted; the list, and how long it may be, is the promise.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.ui.canvas.fields.choice import ChoicePopup, plain
from nep_studio.ui.plugins.person.panel import HumanPanel
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.checklist.person import CTRL, Key, Person
from tests.ui.window.conftest import chooser, home, studio, window

__all__ = ["chooser", "home", "studio", "window"]

WAIT_MS = 60_000
LEFT = Qt.MouseButton.LeftButton
STORY = [
    ["event.started", "robot.do", "robot.say"],
    ["event.gesture", "robot.say", "robot.play"],
]


class Teacher(Person):
    """Uses the window as it is at the first start; what the hand does is counted."""

    def __init__(self, window: MainWindow, qtbot: QtBot) -> None:
        super().__init__(window, qtbot)
        self.pointer: list[str] = []
        self.texts_typed: list[str] = []
        self.heard: list[object] = []
        self.pages: set[str] = set()
        self.reds: list[str] = []
        window.running.runner.arrived.connect(
            lambda batch: self.heard.extend(message for _, message in batch)
        )

    def look(self) -> None:
        """What the eyes see after each thing that was done: the page, and whether it is red."""
        self.qtbot.wait(450)  # the checks come a moment after an edit
        workbench = self.window.workbench
        assert workbench.rooms.shown is None
        self.pages.add(self.canvas.page)
        self.reds += [one.kind for one in workbench.problems.shown if one.severity == "error"]

    def click_on(self, what: str, widget: QWidget, at: QPoint | None = None) -> None:
        """Click what the eye sees: nothing may lie over it."""
        place = at or widget.rect().center()
        top = widget.window()
        assert top.rect().contains(widget.mapTo(top, place)), what
        self.pointer.append(f"click {what}")
        QTest.mouseClick(widget, LEFT, pos=place)

    def drag_out(self, block_type: str, to: QPoint) -> str:
        """Drag a block out of the palette, scrolling there first where it is not seen."""
        shelf = self.palette.shelf
        stock = shelf._stock.project
        types = [stock.blocks[e.sample].type if e.sample else "" for e in shelf.entries]
        number = types.index(block_type)
        seen = QRect(QPoint(), shelf.viewport().size())
        if not seen.contains(shelf.rect_of(number)):
            self.pointer.append("turn the wheel over the blocks")
            shelf._go_to(number)
        rect = shelf.rect_of(number)
        start = QPoint(rect.left() + 8, rect.top() + 12 + (14 if "event." in block_type else 0))
        end = shelf.viewport().mapFromGlobal(self.canvas.viewport().mapToGlobal(to))
        before = set(self.project.blocks)
        self.pointer.append(f"drag {block_type}")
        self.drop(start, end, widget=shelf.viewport())
        [made] = [b for b in self.project.blocks if b not in before]
        self.look()
        return made

    def below(self, block: str) -> QPoint:
        """A hand that is not exact: some way off from where the next block belongs."""
        return self.foot(block) + QPoint(22, 26)

    def write(self, block: str, text: str) -> None:
        """Click a field of text, and type."""
        self.click_on("the words", self.canvas.viewport(), self.piece(block, "text"))
        self.texts_typed.append(text)
        self.type_on(text)
        self.look()

    def type_on(self, text: str) -> None:
        """Type where the keyboard is, which may go elsewhere meanwhile; then Enter."""
        for letter in text:
            QTest.keyClicks(QApplication.focusWidget(), letter)
        QTest.keyClick(QApplication.focusWidget(), Key.Key_Return)

    def choose_in(self, block: str, key: str, words: str) -> None:
        """Click a field of choices, then one of them."""
        self.click_on(f"the {key}", self.canvas.viewport(), self.piece(block, key))
        [popup] = [one for one in self.window.findChildren(ChoicePopup) if one.isVisible()]
        [item] = [
            item
            for row in range(popup.list.count())
            if plain((item := popup.list.item(row)).text()) == words
        ]
        view = popup.list.viewport()
        if not view.rect().contains(popup.list.visualItemRect(item)):
            self.pointer.append("turn the wheel over the choices")
            popup.list.scrollToItem(item)
        self.click_on(words, view, popup.list.visualItemRect(item).center())
        self.look()

    def asked(self) -> list[m.ActionRequest]:
        """What robots were asked for, each once."""
        found = [one for one in self.heard if isinstance(one, m.ActionRequest)]
        return list({one.id: one for one in found}.values())

    def said(self) -> list[str]:
        return [str(one.args["text"]) for one in self.asked() if one.action == "say"]

    def played(self) -> list[str]:
        return [str(one.args["animation"]) for one in self.asked() if one.action == "play"]

    def made(self) -> list[list[str]]:
        """The types of the blocks, stack by stack."""
        stacks = self.project.pages["behaviour"]
        return [[self.project.blocks[block].type for block in stack.body] for stack in stacks]


@pytest.fixture
def teacher(window: MainWindow, qtbot: QtBot) -> Teacher:
    window.resize(1280, 800)
    return Teacher(window, qtbot)


def start_empty(teacher: Teacher) -> None:
    buttons = teacher.window.start_page.findChildren(QPushButton)
    teacher.click_on("Start empty", next(b for b in buttons if b.text() == "Start empty"))
    teacher.qtbot.waitUntil(teacher.canvas.isVisible)


def shown(window: MainWindow, kind: type) -> QWidget:
    return next(one.widget for one in window.workbench.panels.all if isinstance(one.widget, kind))


def until(teacher: Teacher, holds: Callable[[], bool]) -> None:
    teacher.qtbot.waitUntil(holds, timeout=WAIT_MS)


def test_the_karate_story_by_mouse(teacher: Teacher, qtbot: QtBot) -> None:
    window = teacher.window

    start_empty(teacher)
    teacher.look()
    hat = teacher.drag_out("event.started", QPoint(60, 60))
    stand = teacher.drag_out("robot.do", teacher.below(hat))
    say = teacher.drag_out("robot.say", teacher.below(stand))
    teacher.write(say, "Show me a karate chop!")
    gesture = teacher.drag_out("event.gesture", QPoint(60, 330))
    answer = teacher.drag_out("robot.say", teacher.below(gesture))
    teacher.write(answer, "Impressive!")
    play = teacher.drag_out("robot.play", teacher.below(answer))
    teacher.choose_in(play, "animation", "karate")
    run = window.toolbar.widgetForAction(window.actions_by_name["run"])
    teacher.click_on("Run", run)
    until(teacher, lambda: "Show me a karate chop!" in teacher.said())
    human = shown(window, HumanPanel)
    assert human.isVisible() and shown(window, RobotsPanel).isVisible()
    until(teacher, lambda: human.stimuli.has_watch)
    [button] = human.waiting.buttons
    teacher.click_on("Make the gesture", button)
    until(teacher, lambda: "karate" in teacher.played())

    assert teacher.made() == STORY
    assert teacher.said()[:2] == ["Show me a karate chop!", "Impressive!"]
    assert teacher.reds == [] and teacher.pages == {"behaviour"}
    assert len(teacher.pointer) <= 16, teacher.pointer
    assert len(teacher.texts_typed) == 2


def test_the_karate_story_in_five_phrases(teacher: Teacher, qtbot: QtBot) -> None:
    start_empty(teacher)
    phrases = (
        "when the program starts",
        "NAO says Show me a karate chop!",
        "when the gesture karate is made",
        "NAO says Impressive!",
        "NAO plays the animation karate",
    )
    teacher.key(Key.Key_Space, CTRL)
    for phrase in phrases:
        teacher.type_on(phrase)
        teacher.look()
    teacher.key(Key.Key_F5)
    human = shown(teacher.window, HumanPanel)
    until(teacher, lambda: human.isVisible() and human.stimuli.has_watch)
    until(teacher, lambda: "Show me a karate chop!" in teacher.said())
    [button] = human.waiting.buttons
    button.setFocus()
    QTest.keyClick(button, Key.Key_Space)
    until(teacher, lambda: "karate" in teacher.played())

    assert teacher.made() == [
        ["event.started", "robot.say"],
        ["event.gesture", "robot.say", "robot.play"],
    ]
    assert teacher.reds == [] and teacher.pages == {"behaviour"}
