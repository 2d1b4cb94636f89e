"""What is done by hand sets off the rules of a real program, with a virtual robot that runs."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.project.triggers import Occurrence
from nep_studio.run.installation import studio_language
from nep_studio.ui.plugins.person.panel import HumanPanel
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B
from tests.ui.panels.human.conftest import RUN_MS, said

pytestmark = pytest.mark.long

LANGUAGE = studio_language()
Human = Callable[..., HumanPanel]
Run = Callable[[], list[object]]


def click(qtbot: QtBot, button: object) -> None:
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def rule(hat: str, **fields: object) -> list[B]:
    return [B(hat, dict(fields)), B("robot.say", {"text": hat})]


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
    qtbot.waitUntil(lambda: bool(panel.stimuli.noticing(panel.occurrences()[3])), timeout=RUN_MS)

    for hat, control in zip(HATS, list(panel.waiting.buttons), strict=True):
        click(qtbot, control)
        qtbot.waitUntil(lambda hat=hat: hat in said(heard), timeout=RUN_MS)

    assert set(HATS) <= set(said(heard))


def test_a_gesture_and_a_raised_arm_soon_after_it_set_off_their_rule(
    human: Human, run: Run, qtbot: QtBot
) -> None:
    """A real watch node moves, and two real nodes recognise the gesture and the posture."""
    gesture, arm = (
        B("sensing.was_seen", {"state": state, "seconds": 2})
        for state in ("gesture_karate", "arm_raised")
    )
    both = B("logic.junction", {"junction": "and"}, {"a": gesture, "b": arm})
    panel = human([B("event.true", {}, {"condition": both}), B("robot.say", {"text": "Ha"})])
    heard = run()
    qtbot.waitUntil(lambda: panel.stimuli.has_watch, timeout=RUN_MS)
    karate, raised = panel.waiting.buttons

    click(qtbot, karate)
    click(qtbot, raised)

    qtbot.waitUntil(lambda: "Ha" in said(heard), timeout=RUN_MS)
    told = [one for one in heard if isinstance(one, m.HumanBehavior)]
    wanted = ("gesture_karate", "arm_raised")
    assert {one.source for one in told if one.human_state in wanted} == {"karate", "arm"}


def test_what_is_told_moves_no_button_and_goes_with_its_project(
    human: Human, window: MainWindow, run: Run, qtbot: QtBot
) -> None:
    panel = human(rule("robot_events.heard", word="hello"))
    heard = run()
    [button] = panel.waiting.buttons
    before = button.mapToGlobal(QPoint())

    click(qtbot, button)
    qtbot.waitUntil(lambda: "robot_events.heard" in said(heard), timeout=RUN_MS)

    assert panel.told.text() and button.mapToGlobal(QPoint()) == before
    window.files.new()
    assert panel.told.text() == ""


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
    qtbot.waitUntil(lambda: bool(panel.stimuli.noticing(panel.occurrences()[1])), timeout=RUN_MS)

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

    karate = next(one for one in panel.gestures.buttons if one.occurrence.value == "karate")
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

    is_told = panel.stimuli.begin(Occurrence("touch", "head", "the head", "Anna"))
    is_measured = panel.stimuli.begin(Occurrence("sensor", "battery", "battery", "Anna", 5.0))

    def told() -> list[tuple[str, str]]:
        return [(one.human_state, one.source) for one in heard if isinstance(one, m.HumanBehavior)]

    qtbot.waitUntil(lambda: told() == [("touched_head", "Anna")], timeout=RUN_MS)
    assert is_told and not is_measured
    assert panel.told.text().startswith("Anna is not on this screen")


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

    qtbot.waitUntil(lambda: bool(panel.stimuli.noticing(panel.occurrences()[0])), timeout=RUN_MS)
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
