"""What a person has to do before a program can run: each thing once, with something to press."""

from __future__ import annotations

import re
import socket

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from nep_studio.blocks.checks.diagnostic import Diagnostic, Fix
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.running.needs import Need, NeedsDialog, in_the_way_to, needs_of
from nep_studio.ui.shell.main_window import MainWindow
from robots.naoqi.probe import Check
from tests.ui.checklist.person import Person

KARATE = PlannedNode("perceptual/gesture", "karate", {}, "a rule waits for this gesture")
REAL = PlannedNode("action/nao", "NAO", {"driver": "naoqi", "address": "10.0.0.9"}, block_id="b1")
AWAY = Check("port", False, "NAO does not answer.", ("Is it switched on?",))


def needs(**more) -> list[Need]:
    given = {"problems": [], "nodes": [], "answers": {}, "has_rules": True, **more}
    lists = [given.pop(key) for key in ("problems", "nodes", "answers")]
    return needs_of(*lists, **given)


def fixes(need: Need) -> list[str]:
    return [fix.name for fix in need.fixes]


def test_what_run_starts_by_itself_is_no_need() -> None:
    assert needs(nodes=[KARATE]) == []


def test_a_program_without_a_beginning_can_get_one() -> None:
    [need] = needs(has_rules=False)

    assert (need.state, fixes(need)) == ("missing", ["add_start"])


def test_an_error_has_its_fix_and_its_block_and_a_warning_is_no_need() -> None:
    fix = Fix("add_robot", "Add the robot")
    error = Diagnostic(
        "error", "unknown_robot", "behaviour", "b7", "There is no such robot.", (), fix
    )
    warning = Diagnostic("warning", "busy", "behaviour", "b8", "It is odd.")

    [need] = needs(problems=[warning, error])

    assert (need.title, need.block) == ("There is no such robot.", "b7")
    assert fixes(need) == ["fix_problem", "show_block"]


def test_the_same_thing_is_listed_once() -> None:
    errors = [
        Diagnostic("error", "no_definition", "behaviour", block, "Nothing says what “jump” does.")
        for block in ("b7", "b8")
    ]

    [need] = needs(problems=errors)

    assert need.block == "b7"


def test_a_real_robot_is_looked_for_and_is_a_need_when_it_does_not_answer() -> None:
    [looking] = needs(nodes=[REAL])
    [missing] = needs(nodes=[REAL], answers={"NAO": AWAY})

    assert looking.state == "looking"
    assert needs(nodes=[REAL], answers={"NAO": None}) == []
    assert (missing.state, missing.block) == ("missing", "b1")
    assert (missing.title, missing.sentence) == ("NAO does not answer.", "Is it switched on?")
    assert fixes(missing) == ["simulator", "connect"]


def test_a_robot_without_an_address_is_one_need() -> None:
    error = Diagnostic("error", "robot_address", "robots", "b1", "Where is NAO?")

    [need] = needs(problems=[error], nodes=[REAL], answers={"NAO": AWAY})

    assert need.title == "Where is NAO?"


@pytest.mark.parametrize("address", ["127.0.0.1:karate", "127.0.0.1:99999999", "a b.local"])
def test_a_wrong_address_is_told_as_the_connect_dialog_tells_it(address: str) -> None:
    check = in_the_way_to("NAO", address)

    assert check is not None and check.step == "name"
    assert check.checklist


def test_who_does_not_answer_is_told_with_what_to_try() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]

    check = in_the_way_to("NAO", f"127.0.0.1:{port}")

    assert check is not None and check.step == "port"
    assert f"127.0.0.1:{port}" in str(check.sentence)


# The dialog.


def shown(window: MainWindow, qtbot: QtBot) -> NeedsDialog:
    window.actions_by_name["needs"].trigger()
    qtbot.waitUntil(lambda: window.findChild(NeedsDialog) is not None)
    return window.findChild(NeedsDialog)


def words(dialog: NeedsDialog) -> list[str]:
    return [label.text() for label in dialog.findChildren(QLabel) if label.text()]


def test_a_program_that_has_all_says_so_in_one_line_and_runs(
    karate: MainWindow, qtbot: QtBot
) -> None:
    asked: list[bool] = []
    karate.running.runner.run_asked.connect(lambda: asked.append(True))
    dialog = shown(karate, qtbot)

    assert words(dialog) == ["You need to do nothing: the program can run."]
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)

    assert asked == [True]
    karate.running.stop()


def test_the_words_are_those_of_everybody(window: MainWindow, qtbot: QtBot) -> None:
    window.files.new()
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    person = Person(window, qtbot)
    person.from_palette("control.if", QPoint(120, 120))
    dialog = shown(window, qtbot)
    qtbot.waitUntil(lambda: len(dialog.needs or ()) == 2)

    told = " ".join(words(dialog))
    assert re.search(r"\b(node|master|launch)", told, re.IGNORECASE) is None
    dialog.reject()
