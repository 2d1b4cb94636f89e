"""The buttons inside blocks, and the comments that they open."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QContextMenuEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.edits.content import SetComment, SetFlag
from nep_studio.blocks.places import InInput
from nep_studio.blocks.text import sentence

PLAIN = Qt.KeyboardModifier.NoModifier
LEFT = Qt.MouseButton.LeftButton


def press(desk, kind: str, key: str = "", number: int = 0) -> None:
    """Press the mouse on a button inside the block."""
    placed = desk.canvas.page_layout.placed(desk.block)
    buttons = [p for p in placed.box.pieces if p.piece == "button" and p.kind == kind]
    wanted = [p for p in buttons if p.key == key and number in (0, p.number)]
    piece = wanted[0]
    x = placed.x + piece.x + piece.height / 2
    if placed.box.is_mirrored:
        x = placed.x + piece.x + piece.width - piece.height / 2
    at = desk.canvas.sight.camera.to_view(x, placed.y + piece.y + piece.height / 2).toPoint()
    QTest.mouseClick(desk.canvas.viewport(), LEFT, PLAIN, at)


def pull(widget, by: QPoint) -> None:
    """Drag a widget by its middle."""
    start = widget.rect().center()
    QTest.mousePress(widget, LEFT, PLAIN, start)
    QTest.mouseMove(widget, start + by)
    QTest.mouseRelease(widget, LEFT, PLAIN, start + by)


def test_plus_adds_an_else_if_in_place(controller_of) -> None:
    desk = controller_of("control.if")

    press(desk, "add", "also")

    assert desk.editor.project.blocks[desk.block].groups["also"] == 1
    assert desk.new_steps() == 1


def test_the_plus_says_what_it_adds(controller_of) -> None:
    desk = controller_of("control.if")

    pieces = desk.canvas.page_layout.placed(desk.block).box.pieces

    assert {p.text for p in pieces if p.kind == "add"} == {"else if", "else"}


def test_minus_removes_the_item_beside_it(controller_of) -> None:
    desk = controller_of("text.join", **{"item.1": "a", "item.2": "b"})
    press(desk, "add", "item")

    press(desk, "remove", "item", number=1)

    assert desk.editor.project.blocks[desk.block].groups["item"] == 2
    assert desk.value("item.1") == "b"


def test_a_block_in_a_removed_item_is_put_beside(controller_of) -> None:
    desk = controller_of("text.join")
    press(desk, "add", "item")
    inner = desk.editor.create("text.text", InInput(desk.block, "item.3"))

    press(desk, "remove", "item", number=3)

    stack = desk.editor.project.stack_of(inner)
    assert stack.body == [inner]
    assert stack.x > desk.editor.project.stack_of(desk.block).x


def test_alt_with_the_arrows_moves_an_item(controller_of) -> None:
    desk = controller_of("text.join", **{"item.1": "a", "item.2": "b"})

    desk.click("item.1")
    QTest.keyClick(desk.widget, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)

    assert (desk.value("item.1"), desk.value("item.2")) == ("b", "a")
    assert desk.fields.place == (desk.block, "item.2")
    assert desk.new_steps() == 1


def test_a_folded_block_says_its_sentence_and_how_much_is_in_it(controller_of) -> None:
    desk = controller_of("text.join")
    for number in (1, 2):
        desk.editor.create("text.text", InInput(desk.block, f"item.{number}"))
    desk.editor.apply(SetFlag(desk.block, "collapsed", True))

    texts = [p.text for p in desk.canvas.page_layout.placed(desk.block).box.pieces]
    press(desk, "expand")

    assert texts[1].startswith("join")
    assert texts[2] == "· 2 blocks"
    assert not desk.editor.project.blocks[desk.block].collapsed


def test_a_comment_is_written_beside_its_block_in_one_step(controller_of) -> None:
    desk = controller_of("control.wait")

    desk.fields.comments.open(desk.block)
    bubble = desk.fields.comments.bubble
    QTest.keyClicks(bubble.text, "be patient")
    QTest.keyClick(bubble.text, Qt.Key.Key_Escape)

    assert desk.editor.project.blocks[desk.block].comment == "be patient"
    assert desk.new_steps() == 1
    assert desk.fields.comments.bubble is None


def test_the_comment_button_opens_and_closes_the_comment(controller_of) -> None:
    desk = controller_of("control.wait")
    desk.editor.apply(SetComment(desk.block, "hello"))

    press(desk, "comment")
    bubble = desk.fields.comments.bubble
    block_right = desk.canvas.sight.view_rect_of(desk.block).right()

    assert bubble.text.toPlainText() == "hello"
    assert bubble.geometry().left() > block_right
    press(desk, "comment")
    assert desk.fields.comments.bubble is None
    press(desk, "comment")
    desk.click_elsewhere()
    assert desk.fields.comments.bubble is None


def test_a_comment_is_resized_by_its_corner(controller_of) -> None:
    desk = controller_of("control.wait")
    desk.editor.apply(SetComment(desk.block, "hello"))
    desk.fields.comments.open(desk.block)
    bubble = desk.fields.comments.bubble
    before = bubble.size()

    pull(bubble.corner, QPoint(60, 40))

    block = desk.editor.project.blocks[desk.block]
    assert bubble.width() == before.width() + 60
    assert (block.comment_width, block.comment_height) == (280, 150)
    desk.editor.history.undo()
    assert block.comment_width == 0


def test_a_mirrored_comment_is_at_the_left(controller_of) -> None:
    desk = controller_of("control.wait", is_mirrored=True)

    desk.fields.comments.open(desk.block)

    bubble = desk.fields.comments.bubble.geometry()
    assert bubble.right() < desk.canvas.sight.view_rect_of(desk.block).left()


def test_a_hat_is_short_until_its_plus_unfolds_what_happens_when_it_comes_again(
    controller_of,
) -> None:
    desk = controller_of("event.gesture")
    block = desk.editor.project.blocks[desk.block]
    before = sentence(desk.editor.project, desk.editor.language, desk.block)

    press(desk, "add", "repeated")
    unfolded = sentence(desk.editor.project, desk.editor.language, desk.block)
    was_steps, was_field = desk.new_steps(), dict(block.fields)
    press(desk, "remove", "repeated", number=1)

    assert before == "when the gesture karate is made"
    assert unfolded == "when the gesture karate is made, if it comes again carry on"
    assert was_steps == 1 and was_field["again.1"] == "ignore"
    assert sentence(desk.editor.project, desk.editor.language, desk.block) == before
    assert "again.1" not in block.fields


def test_the_plus_of_a_hat_takes_no_more_room_than_its_sign(controller_of) -> None:
    desk = controller_of("event.gesture")

    box = desk.canvas.page_layout.placed(desk.block).box
    [plus] = [piece for piece in box.pieces if piece.kind == "add"]

    assert not plus.text and plus.width == plus.height


def test_what_unfolds_is_in_the_menu_of_the_block_for_who_has_no_mouse(controller_of) -> None:
    desk = controller_of("event.gesture")
    desk.canvas.selection.set([desk.block])
    desk.canvas.setFocus()

    def choose(name: str) -> None:
        place = desk.canvas.sight.view_rect_of(desk.block).center().toPoint()
        keys = QContextMenuEvent.Reason.Keyboard
        QApplication.sendEvent(desk.canvas.viewport(), QContextMenuEvent(keys, place, place))
        menu = desk.canvas.menu
        action = next(a for a in menu.actions() if a.objectName() == name)
        menu.setActiveAction(action)
        QTest.keyClick(menu, Qt.Key.Key_Return)

    choose("add.repeated")
    added = dict(desk.editor.project.blocks[desk.block].groups)
    choose("remove.repeated")

    assert added == {"repeated": 1}
    assert desk.editor.project.blocks[desk.block].groups == {"repeated": 0}
