"""Screen readers find every visible block, hear what it is, and where the keyboard is."""

from __future__ import annotations

import pytest
import shiboken6
from PySide6.QtCore import QPoint
from PySide6.QtGui import QAccessible

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.edits.content import SetComment, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.accessibility import described, interface_of, make_accessible
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build

NAME, DESCRIPTION = QAccessible.Text.Name, QAccessible.Text.Description


@pytest.fixture
def view(qtbot) -> Canvas:
    does = [B("robot.say", {"text": "one"}), B("control.wait"), B("control.wait")]
    number = B("math.arithmetic", {"a": 4, "b": 6})
    repeat = B("control.repeat", {}, {"times": number}, {"do": does})
    far_away = [B("event.started")]
    editor = build(studio_language(), [B("event.started"), repeat], *[far_away] * 9)
    view = Canvas(editor, load_theme("light"))
    make_accessible(view)
    qtbot.addWidget(view)
    view.resize(600, 500)
    view.show()
    qtbot.waitExposed(view)
    return view


def block_of(view: Canvas, block_type: str) -> str:
    return next(b.id for b in view.editor.project.blocks.values() if b.type == block_type)


def test_the_canvas_is_a_tree_of_the_blocks_in_view(view: Canvas) -> None:
    tree = QAccessible.queryAccessibleInterface(view)

    names = [tree.child(number).text(NAME) for number in range(tree.childCount())]

    assert tree.role() == QAccessible.Role.Tree
    assert names[:2] == ["when the program starts", "repeat 4 + 6 times, contains 3 blocks"]
    assert len(names) < 11


def test_a_block_has_the_blocks_inside_it_as_children(view: Canvas) -> None:
    tree = interface_of(view)
    repeat = tree.block(block_of(view, "control.repeat"))

    inside = [repeat.child(number) for number in range(repeat.childCount())]

    assert next(child.text(NAME) for child in inside) == "4 + 6"
    assert [repeat.indexOfChild(child) for child in inside] == [0, 1, 2, 3]
    assert all(child.parent() is repeat for child in inside)
    assert repeat.parent() is tree
    assert inside[1].text(DESCRIPTION) == "1 of 3, level 2"


def test_a_place_on_the_screen_leads_to_the_block_there(view: Canvas) -> None:
    tree = interface_of(view)
    say = tree.block(block_of(view, "robot.say"))
    rect = say.rect()

    found = tree.childAt(rect.left() + 3, rect.center().y())

    assert found is say
    assert tree.rect().contains(rect)
    assert tree.childAt(rect.right() + 150, rect.center().y() + 5) is None


def test_what_a_block_looks_like_is_said_in_words(view: Canvas) -> None:
    wait = block_of(view, "control.wait")
    view.editor.apply(SetFlag(wait, "disabled", True))
    view.editor.apply(SetComment(wait, "a short rest"))
    view.problems.show([Diagnostic("error", "x", "behaviour", wait, "It waits too long.")])

    item = interface_of(view).block(wait)

    assert item.text(NAME) == (
        "wait 1 seconds, switched off, comment: a short rest, problem: It waits too long."
    )
    assert item.state().disabled


def test_a_folded_block_hides_its_children(view: Canvas) -> None:
    repeat = block_of(view, "control.repeat")
    view.editor.apply(SetFlag(repeat, "collapsed", True))

    item = interface_of(view).block(repeat)

    assert item.childCount() == 0
    assert item.state().collapsed
    assert interface_of(view).block(block_of(view, "robot.say")).state().invisible


@pytest.mark.parametrize("inside", ["code.lines", "code.value", "robot.say"])
def test_a_folded_block_tells_that_there_is_python_in_it(view: Canvas, inside: str) -> None:
    """On the canvas and to screen readers; other folded blocks do not say so."""
    value = B("code.value", {"code": "1 + 1"})
    inner = B("control.wait", inputs={"seconds": value}) if inside == "code.value" else B(inside)
    repeat = B("control.repeat", bodies={"do": [B("control.repeat", bodies={"do": [inner]})]})
    build(view.editor.language, [B("event.started"), repeat], editor=view.editor)
    outer = next(
        one.id
        for one in view.editor.project.blocks.values()
        if one.type == "control.repeat"
        if view.editor.project.blocks[one.bodies["do"][0]].type == "control.repeat"
    )

    view.editor.apply(SetFlag(outer, "collapsed", True))

    has_python = inside.startswith("code.")
    told = described(view.editor, outer)
    drawn = [piece.text for piece in view.page_layout.placed(outer).box.pieces]
    assert ("Python inside" in told) is has_python
    assert any("Python inside" in text for text in drawn) is has_python


def test_the_block_of_the_keyboard_has_the_focus(view: Canvas) -> None:
    QAccessible.setActive(True)
    say = block_of(view, "robot.say")
    view.setFocus()

    view.selection.set([say])

    focused = interface_of(view).focusChild()
    assert focused.text(NAME).startswith("NAO says one")
    assert focused.state().selected
    QAccessible.setActive(False)


def test_a_deleted_block_is_not_valid_any_more(view: Canvas) -> None:
    wait = block_of(view, "control.wait")
    item = interface_of(view).block(wait)

    view.editor.apply(DeleteBlocks(wait, 1))

    assert not interface_of(view).block("b999").isValid()
    assert wait not in interface_of(view)._blocks
    del item


def test_screen_readers_are_left_no_pointer_to_a_block_of_a_canvas_that_is_gone(qapp) -> None:
    editor = build(studio_language(), [B("event.started"), B("robot.say")])
    view = Canvas(editor, load_theme("light"))
    number = QAccessible.uniqueId(interface_of(view).block(block_of(view, "robot.say")))
    assert QAccessible.accessibleInterface(number) is not None

    shiboken6.delete(view)

    assert QAccessible.accessibleInterface(number) is None


def test_blocks_outside_the_view_say_so(view: Canvas) -> None:
    last = view.editor.project.pages["behaviour"][-1].body[0]

    item = interface_of(view).block(last)

    assert item.state().offscreen
    assert (
        not view.viewport()
        .rect()
        .contains(view.viewport().mapFromGlobal(QPoint(item.rect().x(), item.rect().y())))
    )
