"""The simulated human: whatever a program waits for can be done by hand, and it hears of it."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_core import messages as m
from nep_studio.blocks.edits import SetField
from nep_studio.happenings import Happening
from nep_studio.studio_language import studio_language
from nep_studio.ui.main_window import MainWindow
from nep_studio.ui.panels.human.panel import HumanPanel
from nep_studio.ui.panels.robots.floor import floor_of
from tests.blocks.block_building import B
from tests.ui.panels.human.conftest import RUN_MS, said

LANGUAGE = studio_language()
Human = Callable[..., HumanPanel]
Run = Callable[[], list[object]]


def click(qtbot: QtBot, button: object) -> None:
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def words(panel: HumanPanel) -> list[str]:
    return [button.words for button in panel.waiting.buttons]


def button(panel: HumanPanel, start: str) -> object:
    return next(one for one in panel.waiting.buttons if one.words.startswith(start))


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


def hats_and_questions() -> list[str]:
    return [
        one.id
        for one in LANGUAGE.definitions.values()
        if (one.shape == "hat" and one.id not in ("event.started", "goal.when_goal"))
        or (one.is_value and one.category.id in ("sensing", "robot_senses"))
    ]


@pytest.mark.parametrize("block", hats_and_questions())
def test_there_is_a_control_for_every_hat_and_question(human: Human, block: str) -> None:
    is_hat = LANGUAGE.definitions[block].shape == "hat"
    asked = B("variable.set", {"variable": "v1"}, {"value": B(block)}) if not is_hat else None
    fields = {"state": "please"} if block == "goal.goal" else {}

    panel = human([B("event.started"), asked] if asked else [B(block, fields)])

    assert words(panel) or "Do nothing" in panel.waiting.words.text()


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


HATS: dict[str, dict[str, object]] = {
    "event.human_state": {"state": "storm"},
    "event.gesture": {"gesture": "karate"},
    "goal.goal": {"state": "please"},
    "robot_events.touched": {"part": "hand_left"},
    "robot_events.heard": {"word": "hello"},
    "robot_events.sees": {"thing": "ball"},
    "robot_events.sees_face_of": {"name": "Anna"},
    "robot_events.sees_mark": {"number": 64},
    "robot_events.person": {"distance": "close"},
    "robot_events.sensor": {"sensor": "battery", "side": "under", "value": 30},
    "robot_events.emotion": {"emotion": "sad"},
}


def test_every_hat_is_set_off_by_its_control(human: Human, run: Run, qtbot: QtBot) -> None:
    """A real program with a virtual robot: each button is pressed, its rule speaks."""
    panel = human(*(rule(hat, **fields) for hat, fields in HATS.items()))
    heard = run()
    qtbot.waitUntil(lambda: bool(panel.hands.noticing(panel.happenings()[3])), timeout=RUN_MS)

    for hat, control in zip(HATS, list(panel.waiting.buttons), strict=True):
        click(qtbot, control)
        qtbot.waitUntil(lambda hat=hat: hat in said(heard), timeout=RUN_MS)

    assert set(HATS) <= set(said(heard))


def test_when_nothing_happens_the_idle_rule_begins(human: Human, run: Run, qtbot: QtBot) -> None:
    human(rule("robot_events.idle", seconds=0.5))

    heard = run()

    qtbot.waitUntil(lambda: "robot_events.idle" in said(heard), timeout=RUN_MS)


QUESTIONS = {
    "robot_senses.is_touched": {"part": "head_rear"},
    "robot_senses.sees": {"thing": "ball"},
    "robot_senses.sees_face_of": {"name": "Ben"},
    "robot_senses.person_is": {"distance": "close"},
    "robot_senses.is_in": {"posture": "posture_sit"},
}


def test_questions_are_answered_by_what_is_done(human: Human, run: Run, qtbot: QtBot) -> None:
    """A real program asks again and again, until what is done by hand makes it true."""
    stacks = []
    for block, fields in QUESTIONS.items():
        until = B("control.wait_until", {}, {"condition": B(block, fields)})
        stacks.append([B("event.started"), until, B("robot.say", {"text": block})])
    panel = human(*stacks, rule("robot_events.heard"))
    heard = run()
    qtbot.waitUntil(lambda: bool(panel.hands.noticing(panel.happenings()[1])), timeout=RUN_MS)

    for control in list(panel.waiting.buttons):
        if control.words.startswith("Touch"):
            qtbot.mousePress(control, Qt.MouseButton.LeftButton)
            qtbot.waitUntil(lambda: "robot_senses.is_touched" in said(heard), timeout=RUN_MS)
            qtbot.mouseRelease(control, Qt.MouseButton.LeftButton)
        else:
            click(qtbot, control)

    def missing() -> set[str]:
        return set(QUESTIONS) - set(said(heard))

    qtbot.waitUntil(lambda: missing() == set(), timeout=RUN_MS)


def test_words_are_said_with_the_keyboard(human: Human, run: Run, qtbot: QtBot) -> None:
    panel = human(rule("robot_events.heard", word="good morning"))
    heard = run()

    qtbot.keyClicks(panel.words, "Good morning!")
    qtbot.keyClick(panel.words, Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: "robot_events.heard" in said(heard), timeout=RUN_MS)
    assert panel.words.text() == ""


def test_a_gesture_comes_from_the_watch_or_is_told_by_hand_with_its_certainty(
    human: Human, window: MainWindow, run: Run, qtbot: QtBot
) -> None:
    panel = human(rule("robot_events.heard"))
    heard = run()
    assert "told by hand" in panel.gestures.how.text()
    panel.gestures.certainty.setValue(60)

    karate = next(one for one in panel.gestures.buttons if one.happening.value == "karate")
    click(qtbot, karate)

    def told() -> list[m.HumanBehavior]:
        return [one for one in heard if isinstance(one, m.HumanBehavior)]

    qtbot.waitUntil(lambda: bool(told()), timeout=RUN_MS)
    assert (told()[0].human_state, told()[0].certainty) == ("gesture_karate", 0.6)
    assert panel.told.text() == "Told by hand: Make the gesture karate"


def test_what_a_robot_elsewhere_would_notice_is_told_by_hand_but_not_what_it_measures(
    human: Human, run: Run, qtbot: QtBot
) -> None:
    panel = human(rule("robot_events.heard"))
    heard = run()

    is_told = panel.hands.begin(Happening("touch", "head", "the head", "Anna"))
    is_measured = panel.hands.begin(Happening("sensor", "battery", "battery", "Anna", 5.0))

    def told() -> list[tuple[str, str]]:
        return [(one.human_state, one.source) for one in heard if isinstance(one, m.HumanBehavior)]

    qtbot.waitUntil(lambda: told() == [("touched_head", "Anna")], timeout=RUN_MS)
    assert is_told and not is_measured
    assert panel.told.text().startswith("Anna is not on this screen")


def test_a_person_comes_closer_in_the_scene_and_goes(
    human: Human, window: MainWindow, qtbot: QtBot
) -> None:
    panel, floor = human(rule("robot_events.person")), floor_of(window)

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
    from nep_studio.surroundings import moved

    panel, floor = human(rule("robot_events.person")), floor_of(window)
    panel.person.is_there.click()

    floor.change(moved(floor.things[0], 3.0, 0.0))

    assert panel.person.way.value() == 300
    assert panel.person.way_words.text() == "3.0 m: far"


def test_everything_is_as_at_the_start_again(human: Human, window: MainWindow) -> None:
    panel, floor = human(rule("robot_events.person")), floor_of(window)
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
    assert panel.hands.robot == "NAO2"


def test_a_hidden_panel_listens_to_nothing(human: Human, window: MainWindow) -> None:
    panel = human(rule("robot_events.heard", word="hello"))
    tap = panel._tap

    panel.hide()

    assert panel._tap is None
    assert tap._is_closed


def test_a_word_that_a_robot_listens_for_has_a_button_meanwhile(
    human: Human, run: Run, qtbot: QtBot
) -> None:
    wait = B("robot_speech.wait_for_word", {"word": "yes", "seconds": 60})
    panel = human([B("event.started"), wait, B("robot.say", {"text": "Thank you"})])
    heard = run()
    qtbot.waitUntil(lambda: bool(panel.listening.buttons), timeout=RUN_MS)

    click(qtbot, panel.listening.buttons[0])

    qtbot.waitUntil(lambda: "Thank you" in said(heard), timeout=RUN_MS)
    qtbot.waitUntil(lambda: not panel.listening.buttons, timeout=RUN_MS)


def test_sensors_are_slid_a_sound_passes_and_a_push_makes_it_fall(
    human: Human, run: Run, qtbot: QtBot
) -> None:
    panel = human(rule("robot_events.heard"))
    run()

    def state() -> m.RobotState:
        return panel.visitors.states.get("NAO") or m.RobotState(robot="NAO", joints={})

    qtbot.waitUntil(lambda: bool(panel.hands.noticing(panel.happenings()[0])), timeout=RUN_MS)
    panel.sensors.sliders["sonar_left"].setValue(40)
    panel.sensors.sliders["battery"].setValue(10)
    qtbot.waitUntil(lambda: state().sensors.get("sonar_left") == 0.4, timeout=RUN_MS)
    qtbot.waitUntil(lambda: state().battery == 0.1, timeout=RUN_MS)
    click(qtbot, panel.things.sounds[90])
    qtbot.waitUntil(lambda: state().sees.get("sound", (0, 0, 0))[1] > 0.9, timeout=RUN_MS)
    qtbot.waitUntil(lambda: "sound" not in state().sees, timeout=RUN_MS)
    click(qtbot, panel.reset_button)
    qtbot.waitUntil(lambda: state().sensors.get("sonar_left", 0.0) > 2.0, timeout=RUN_MS)

    click(qtbot, panel.body.pushes[180])

    qtbot.waitUntil(lambda: state().fallen, timeout=RUN_MS)
