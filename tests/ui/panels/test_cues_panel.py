"""The cue panel sends by hand what the rules wait for, and an operator can arrange it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.blocks.edits.content import SetField
from nep_studio.project.triggers import kept_cues
from nep_studio.ui.cue_style import invitation
from nep_studio.ui.documents import Document
from nep_studio.ui.plugins.cues import CuePanel
from nep_studio.ui.plugins.cues.arranging import COLOURS, ArrangeDialog, columns_for, ink_on
from nep_studio.ui.plugins.cues.panel import CuePage
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B, build
from tests.ui.theme.colour_seeing import contrast
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

pytestmark = pytest.mark.long

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

WAIT_MS = 30_000
KARATE = [B("event.gesture", {"gesture": "karate"}), B("robot.say", {"text": "Ha"})]
TOUCH = [B("robot_events.touched", {"robot": "NAO"}), B("robot.say", {"text": "Hi"})]
HELLO = [B("robot_events.heard", {"word": "hello"}), B("robot.say", {"text": "Hello you"})]


@pytest.fixture
def panel(window: MainWindow, qtbot: QtBot) -> Iterator[Callable[..., CuePage]]:
    """The panel, shown, over a program of these stacks."""

    def show(*stacks: list[B]) -> CuePage:
        editor = build(window.studio.language, *stacks)
        build(window.studio.language, [B("robots.robot")], page="robots", editor=editor)
        window.files.document = Document(editor, parent=window)
        window.files.document_changed.emit(window.files.document)
        place = window.findChild(CuePanel)
        window.workbench.panels.show(place)
        made = place.opened()
        qtbot.waitUntil(lambda: bool(made.board.buttons) or made.empty.isVisible())
        return made

    yield show
    window.running.close()


def words(panel: CuePage) -> list[str]:
    return [button.text() for button in panel.board.buttons]


def run(window: MainWindow, qtbot: QtBot) -> list[object]:
    """Run the program; all that is heard from now on."""
    heard: list[object] = []
    window.running.runner.arrived.connect(lambda batch: heard.extend(one for _, one in batch))
    window.running.runner.run()
    state = window.running.runner
    qtbot.waitUntil(lambda: state.state == "running", timeout=WAIT_MS)
    return heard


def test_the_buttons_are_what_the_rules_wait_for(panel: Callable[..., CuePage]) -> None:
    shown = panel(KARATE, TOUCH, HELLO)

    assert words(shown) == ["Karate", "Touch the head (NAO)", "“hello”"]


def test_a_program_that_waits_for_nothing_says_so(panel: Callable[..., CuePage]) -> None:
    shown = panel([B("event.started")])

    assert shown.empty.isVisible()
    assert not shown.board.buttons


def test_a_pressed_button_sets_off_the_rule_and_is_noted(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE, TOUCH)
    heard = run(window, qtbot)

    for button in shown.board.buttons:
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    def said() -> set[str]:
        requests = [one for one in heard if isinstance(one, m.ActionRequest)]
        return {one.args["text"] for one in requests if one.action == "say"}

    qtbot.waitUntil(lambda: said() == {"Ha", "Hi"}, timeout=WAIT_MS)
    states = {one.human_state: one.source for one in heard if isinstance(one, m.HumanBehavior)}
    assert states == {"gesture_karate": "cues", "touched_head": "NAO"}
    notes = [shown.log.item(row).text() for row in range(shown.log.count())]
    assert [note.split("  ")[1] for note in notes] == ["Touch the head (NAO)", "Karate"]


def test_words_that_somebody_says_reach_the_rules(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(HELLO)
    heard = run(window, qtbot)

    qtbot.keyClicks(shown.words, "Hello!")
    qtbot.keyClick(shown.words, Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: any(isinstance(one, m.ActionRequest) for one in heard), timeout=WAIT_MS)
    assert shown.words.text() == ""


def test_a_movement_of_the_watch_on_the_screen_is_asked_for(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE)
    run(window, qtbot)
    asked: list[object] = []
    tap = window.running.runner.tap(m.GESTURE_REQUEST, kind=m.GestureRequest, parent=window)
    tap.arrived.connect(lambda batch: asked.extend(heard.message for heard in batch))
    [action] = shown.movements.menu().actions()

    def ask() -> bool:
        action.trigger()
        return bool(asked)

    qtbot.waitUntil(ask, timeout=WAIT_MS)
    assert asked[0].gesture == "karate"


def test_how_an_arm_is_held_can_be_sent_or_shown_by_the_watch(
    panel: Callable[..., CuePage],
) -> None:
    shown = panel([B("event.human_state", {"state": "arm_raised"}), B("robot.say", {"text": "Hi"})])

    [action] = shown.movements.menu().actions()
    assert words(shown) == [action.text()] == ["The arm is raised"]
    [cue] = shown.cues.cues()
    assert (cue.kind, cue.movement) == ("arm", "arm_raised")
    assert invitation(cue) == "Your arm: raised"


def test_without_a_running_program_it_says_why_and_offers_run(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE)

    qtbot.mouseClick(shown.board.buttons[0], Qt.MouseButton.LeftButton)
    told = shown.why_not.text()
    qtbot.mouseClick(shown.run_button, Qt.MouseButton.LeftButton)

    assert told == "The program does not run, so that nobody would hear it."
    assert shown.log.count() == 0
    qtbot.waitUntil(lambda: window.running.runner.state == "running", timeout=WAIT_MS)
    assert shown.why_not.text() == "The program hears you."
    assert not shown.run_button.isVisible()


def test_a_changed_rule_changes_its_button(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE)
    editor = window.files.document.editor
    [hat] = [b.id for b in editor.project.blocks.values() if b.type == "event.gesture"]

    editor.apply(SetField(hat, "gesture", "batting"))

    qtbot.waitUntil(lambda: words(shown) == ["Batting"])


def test_a_hidden_panel_does_no_work(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE)
    shown.hide()
    editor = window.files.document.editor
    [hat] = [b.id for b in editor.project.blocks.values() if b.type == "event.gesture"]

    with qtbot.waitSignal(shown.cues.changed):
        editor.apply(SetField(hat, "gesture", "batting"))

    assert words(shown) == ["Karate"]
    shown.show()
    assert words(shown) == ["Batting"]


def test_an_operator_arranges_colours_keys_and_own_cues(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE, HELLO)
    qtbot.mouseClick(shown.arrange_button, Qt.MouseButton.LeftButton)
    [dialog] = shown.findChildren(ArrangeDialog)

    qtbot.mouseClick(dialog.down_button, Qt.MouseButton.LeftButton)
    dialog.label.clear()
    qtbot.keyClicks(dialog.label, "Chop")
    dialog.colour.setCurrentIndex(3)
    dialog.colour.activated.emit(3)
    dialog.key.setCurrentIndex(7)
    dialog.key.activated.emit(7)
    qtbot.keyClicks(dialog.own, "storm")
    qtbot.mouseClick(dialog.add_state_button, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(dialog.done_button, Qt.MouseButton.LeftButton)

    assert words(shown) == ["“hello”", "Chop", "Storm"]
    chop = kept_cues(window.files.document.project)[1]
    assert (chop.state, chop.colour, chop.key) == ("gesture_karate", list(COLOURS)[3], "7")
    assert window.files.document.is_modified
    window.actions_by_name["undo"].trigger()
    qtbot.waitUntil(lambda: words(shown) == ["Karate", "“hello”"])


def test_a_hidden_cue_has_no_button_and_can_be_shown_again(
    panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE, HELLO)
    for expected in (["“hello”"], ["Karate", "“hello”"]):
        shown.arrange()
        dialog = shown.findChildren(ArrangeDialog)[-1]
        dialog.list.setCurrentRow(0)
        dialog.is_shown.click()
        dialog.done_button.click()

        assert words(shown) == expected


def test_a_name_without_letters_is_refused_with_a_reason(
    panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE)
    shown.arrange()
    dialog = shown.findChildren(ArrangeDialog)[-1]

    qtbot.keyClicks(dialog.own, "!?")
    dialog.add_word_button.click()

    assert dialog.why_not.text() == "A letter or a digit is needed."
    assert len(dialog.cues) == 1
    dialog.reject()


def test_keys_press_their_buttons_but_not_while_words_are_typed(
    panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    shown = panel(KARATE)
    shown.arrange()
    dialog = shown.findChildren(ArrangeDialog)[-1]
    dialog.key.setCurrentIndex(1)
    dialog.key.activated.emit(1)
    dialog.done_button.click()
    refused: list[str] = []
    shown.sending.refused.connect(refused.append)

    qtbot.keyClick(shown.words, Qt.Key.Key_1)
    while_typing = len(refused)
    qtbot.keyClick(shown.board.buttons[0], Qt.Key.Key_1)

    assert while_typing == 0
    assert shown.words.text() == "1"
    assert len(refused) == 1


def test_as_many_buttons_in_a_row_as_fit(panel: Callable[..., CuePage], qtbot: QtBot) -> None:
    board = panel(KARATE, HELLO, TOUCH).board
    one = board.buttons[0].sizeHint().width()

    assert columns_for(board.buttons, one, 6) == 1
    assert columns_for(board.buttons, 2 * one + 6, 6) == 2
    assert columns_for(board.buttons, 20 * one, 6) == 3


@pytest.mark.parametrize("colour", list(COLOURS)[1:])
def test_words_can_be_read_on_every_colour(colour: str) -> None:
    from PySide6.QtGui import QColor

    assert contrast(ink_on(QColor(colour)), QColor(colour)) >= 4.5


def test_after_the_panel_is_gone_nothing_of_it_listens(
    window: MainWindow, panel: Callable[..., CuePage], qtbot: QtBot
) -> None:
    gone: list[bool] = []
    panel(KARATE)
    document = window.files.document
    of_a_show = CuePage(window.host, is_large=True)
    of_a_show.destroyed.connect(lambda: gone.append(True))
    of_a_show.show()

    of_a_show.deleteLater()
    del of_a_show
    qtbot.waitUntil(lambda: bool(gone))

    hat = next(b.id for b in document.project.blocks.values() if b.type == "event.gesture")
    document.editor.apply(SetField(hat, "gesture", "batting"))
    window.files.document_changed.emit(document)
    assert document.is_modified
