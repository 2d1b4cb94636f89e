"""The simulated human: whatever a program waits for can be done by hand, and it hears of it."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.own_gestures import OwnGesture, OwnTake, keep_gesture
from nep_studio.run.installation import studio_language
from nep_studio.ui.floor import floor_of
from nep_studio.ui.plugins.person.panel import HumanPanel
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.panels.human.conftest import RUN_MS

LANGUAGE = studio_language()
Human = Callable[..., HumanPanel]
Run = Callable[[], list[object]]


def click(qtbot: QtBot, button: object) -> None:
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def words(panel: HumanPanel) -> list[str]:
    return [button.words for button in panel.waiting.buttons]


def rule(hat: str, **fields: object) -> list[B]:
    return [B(hat, dict(fields)), B("robot.say", {"text": hat})]


def test_what_the_program_waits_for_comes_first(human: Human) -> None:
    panel = human(
        rule("robot_events.heard", word="hello & bye"),
        rule("robot_events.touched"),
        rule("robot_events.sees_face_of", name="Anna"),
        rule("robot_events.idle", seconds=5),
    )

    assert words(panel) == ["Say “hello & bye”", "Touch the head (NAO)", "Anna comes (NAO)"]
    assert panel.waiting.words.text() == "Do nothing for 5 s"
    assert panel.sections[0].heading.text() == "Your program waits for"
    assert "Anna" in [panel.person.name.itemText(n) for n in range(panel.person.name.count())]


def test_how_an_arm_is_held_has_buttons_of_its_own(human: Human) -> None:
    panel = human(
        rule("event.human_state", state="arm_raised"),
        rule("event.human_state", state="arm_level"),
        rule("event.human_state", state="arm_lowered"),
    )

    every = ["Raise the arm", "Hold the arm level", "Let the arm hang"]
    assert words(panel) == every
    assert [button.words for button in panel.gestures.arms.values()] == every


def test_a_program_that_waits_for_nothing_says_so(human: Human) -> None:
    panel = human([B("event.started")])

    assert words(panel) == []
    assert panel.waiting.words.text() == "This program waits for nothing."


def test_a_changed_rule_changes_its_button(human: Human, window: MainWindow, qtbot: QtBot) -> None:
    panel = human(rule("robot_events.heard", word="hello"))
    editor = window.files.document.editor
    [hat] = [one.id for one in editor.project.blocks.values() if one.type == "robot_events.heard"]

    editor.apply(SetField(hat, "word", "goodbye"))

    qtbot.waitUntil(lambda: words(panel) == ["Say “goodbye”"])


NOTHING_HAPPENS = (
    *("event.started", "goal.when_goal", "code.program", "goal.goal_asked", "tree.tree"),
    *("event.told", "time.every", "time.at", "state.begins"),
    *("state.told", "state.after", "state.done"),
)
"""Hats for which a person does nothing: the program, the clock or another rule begins them."""
ASKING = ("event.true", "goal.goal_when", "plan.true_while", "state.when")
"""Hats that wait for whatever is asked in their place."""


def hats_and_questions() -> list[str]:
    return [
        one.id
        for one in LANGUAGE.definitions.values()
        if (one.shape == "hat" and one.id not in NOTHING_HAPPENS)
        or (one.is_value and one.category.id in ("sensing", "robot_senses"))
    ]


def test_there_is_a_control_for_every_hat_and_question(human: Human) -> None:
    blocks, without = hats_and_questions(), []

    for block in blocks:
        panel = human(program_with(block))
        if not words(panel) and "Do nothing" not in panel.waiting.words.text():
            without.append(block)

    assert len(blocks) > 20
    assert without == []


def program_with(block: str) -> list[B]:
    if block in ASKING:
        return [B(block, {}, {"condition": B("robot_senses.is_touched")})]
    if LANGUAGE.definitions[block].shape == "hat":
        return [B(block, {"state": "please"} if block == "goal.goal" else {})]
    return [B("event.started"), B("variable.set", {"variable": "v1"}, {"value": B(block)})]


def test_gestures_that_were_recorded_in_the_project_can_be_made(
    human: Human, window: MainWindow, qtbot: QtBot
) -> None:
    panel = human(rule("robot_events.heard", word="hello"))
    takes = (OwnTake("t1", "r1", 0.0, 1.0),)
    editor = window.files.document.editor

    editor.apply(keep_gesture("big_wave", OwnGesture("big wave", takes=takes)), "record")

    def titles() -> list[str]:
        return [button.words for button in panel.gestures.buttons]

    qtbot.waitUntil(lambda: "Big wave" in titles())
    assert "big_wave" in panel.watch_gestures()
    editor.history.undo()
    qtbot.waitUntil(lambda: "Big wave" not in titles())


def test_without_a_running_program_it_says_why_and_offers_run(
    human: Human, window: MainWindow, qtbot: QtBot
) -> None:
    panel = human(rule("robot_events.heard"))

    click(qtbot, panel.waiting.buttons[0])
    told = panel.told.text()
    click(qtbot, panel.run_button)

    assert told == "The program does not run, so that nobody would notice it."
    runner = window.running.runner
    qtbot.waitUntil(lambda: runner.state == "running", timeout=RUN_MS)
    assert not panel.run_button.isVisible()
    assert panel.state.text() == "What you do here is noticed."


def test_a_person_comes_closer_in_the_scene_and_goes(
    human: Human, window: MainWindow, qtbot: QtBot
) -> None:
    panel, floor = human(rule("robot_events.person")), floor_of(window.host)

    panel.person.is_there.click()
    panel.person.name.setEditText("Clara")
    panel.person.way.setValue(50)
    [person] = floor.things
    panel.person.is_there.click()

    assert (person.kind, person.name) == ("person", "Clara")
    assert person.place[:2] == pytest.approx((0.5, 0.0))
    assert floor.things == []
    assert not window.files.document.is_modified


def test_a_visitor_that_is_moved_in_the_scene_moves_the_slider(
    human: Human, window: MainWindow
) -> None:
    from nep_studio.project.surroundings import moved

    panel, floor = human(rule("robot_events.person")), floor_of(window.host)
    panel.person.is_there.click()

    floor.change(moved(floor.things[0], 3.0, 0.0))

    assert panel.person.way.value() == 300
    assert panel.person.way_words.text() == "3.0 m: far"


def test_everything_is_as_at_the_start_again(human: Human, window: MainWindow) -> None:
    panel, floor = human(rule("robot_events.person")), floor_of(window.host)
    for check in (panel.person.is_there, panel.things.ball, panel.things.mark):
        check.click()
    panel.sensors.sliders["battery"].setValue(5)
    assert len(floor.things) == 3

    panel.reset_button.click()

    assert floor.things == []
    assert panel.sensors.sliders["battery"].value() == 100
    assert not panel.things.ball.isChecked()


def test_with_several_robots_one_is_chosen(human: Human, window: MainWindow, qtbot: QtBot) -> None:
    panel = human(rule("robot_events.heard"), robots=("NAO", "NAO2"))

    panel.robot.setCurrentText("NAO2")

    assert panel.robot.isVisible()
    assert panel.stimuli.robot == "NAO2"


def test_a_hidden_panel_listens_to_nothing(human: Human, window: MainWindow) -> None:
    panel = human(rule("robot_events.heard", word="hello"))
    tap = panel._tap

    panel.hide()

    assert panel._tap is None
    assert tap._is_closed
