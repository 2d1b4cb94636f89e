"""A project's robots decide what the fields of blocks offer, and what is told as a problem."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import ROBOT_BLOCK
from nep_studio.ui.canvas.fields.field_edit import view_rect_of
from nep_studio.ui.shell.main_window import MainWindow

PEPPERS_ANIMALS = ["cat", "crow", "eagle", "elephant", "gorilla"]


def robot_block(window: MainWindow) -> str:
    blocks = window.files.document.editor.project.blocks.values()
    return next(block.id for block in blocks if block.type == ROBOT_BLOCK)


@pytest.fixture
def imitating(karate: MainWindow, qtbot: QtBot) -> tuple[MainWindow, str]:
    """The karate example, in which NAO imitates a dog at the end of the first rule."""
    editor = karate.files.document.editor
    stack = editor.project.pages["behaviour"][0]
    block = editor.create("robot.imitate", InStack(stack.id, len(stack.body)))
    editor.apply(SetField(block, "animal", "dog"))
    return karate, block


@pytest.fixture
def offered(qtbot: QtBot) -> Callable[[MainWindow, str, str], list[str]]:
    """Opens a field by a click, reads what it offers, and leaves it."""

    def read(window: MainWindow, block: str, key: str) -> list[str]:
        canvas = window.workbench.canvas
        canvas.show_page("behaviour")
        canvas.sight.fit()
        rect = view_rect_of(canvas, block, key)
        QTest.mouseClick(
            canvas.viewport(),
            Qt.MouseButton.LeftButton,
            Qt.KeyboardModifier.NoModifier,
            rect.center().toPoint(),
        )
        qtbot.waitUntil(lambda: canvas.fields.widget is not None)
        shown = canvas.fields.widget.list
        labels = [shown.item(row).text() for row in range(shown.count())]
        QTest.keyClick(canvas.fields.widget.first(), Qt.Key.Key_Escape)
        return labels

    return read


def test_a_nao_is_offered_its_animals_and_a_pepper_those_that_it_has(
    imitating: tuple[MainWindow, str], offered: Callable[[MainWindow, str, str], list[str]]
) -> None:
    window, block = imitating
    as_nao = offered(window, block, "animal")

    window.files.document.editor.apply(SetField(robot_block(window), "driver", "virtual_pepper"))
    as_pepper = offered(window, block, "animal")

    assert "dog" in as_nao and len(as_nao) == 14
    assert sorted(as_pepper) == PEPPERS_ANIMALS


def test_another_kind_of_robot_is_checked_while_a_person_works(
    imitating: tuple[MainWindow, str], qtbot: QtBot
) -> None:
    window, block = imitating
    editor, checks = window.files.document.editor, window.workbench.checks

    editor.apply(SetField(robot_block(window), "driver", "virtual_pepper"))
    qtbot.waitUntil(lambda: any(one.block == block for one in checks.problems))
    told = next(one for one in checks.problems if one.block == block)
    window.show_problems()
    row = next(row for row in window.workbench.problems.rows if row.problem.block == block)
    qtbot.mouseClick(row.fix_button, Qt.MouseButton.LeftButton)

    assert str(told.sentence).endswith("“dog” is not there for NAO (Pepper).")
    qtbot.waitUntil(lambda: not any(one.block == block for one in checks.problems))
    assert editor.project.blocks[block].fields["animal"] == "cat"


def test_the_robot_that_it_was_before_has_no_problem_again(
    imitating: tuple[MainWindow, str], qtbot: QtBot
) -> None:
    window, block = imitating
    editor, checks = window.files.document.editor, window.workbench.checks
    editor.apply(SetField(robot_block(window), "driver", "virtual_pepper"))
    qtbot.waitUntil(lambda: any(one.block == block for one in checks.problems))

    editor.history.undo()

    qtbot.waitUntil(lambda: not any(one.block == block for one in checks.problems))
