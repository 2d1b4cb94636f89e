"""New blocks that are dragged in: from the palette, other windows, headers, or as copies."""

from __future__ import annotations

from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel

from nep_studio.blocks.operations.copying import clip_of, to_text
from tests.blocks.block_building import B

CTRL, ALT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier
FREE = QPointF(620, 480)


def say(text: str) -> B:
    return B("robot.say", {"text": text})


def story() -> list[B]:
    return [B("event.started"), say("one"), say("two"), say("three")]


def undone(desk) -> bytes:
    """The program after one step back, which must be a single one."""
    assert desk.editor.history.undo()
    return desk.file


def test_a_copy_is_dragged_with_ctrl_and_alt(desk):
    desk = desk(story())
    before, two = desk.file, desk.body()[2]

    desk.put(two, FREE, CTRL | ALT)

    [copied] = desk.body(1)
    assert len(desk.body(0)) == 4
    assert desk.editor.project.blocks[copied].fields["text"] == "two"
    assert (desk.corner(copied) - FREE).manhattanLength() < 2
    assert undone(desk) == before


def test_the_variable_of_a_header_is_dragged_out_as_a_block(desk):
    desk = desk([B("event.started"), B("control.for_each", {"variable": "v1"})])
    before, loop = desk.file, desk.body()[1]
    start = desk.field(loop, "variable")

    desk.mouse.drop(start, start + QPointF(300, 250))

    [reporter] = desk.body(1)
    assert desk.editor.project.blocks[reporter].type == "variable.get"
    assert desk.editor.project.blocks[reporter].fields["variable"] == "v1"
    assert undone(desk) == before


def test_a_new_block_is_dragged_in_from_another_widget(desk, qtbot):
    desk = desk(story())
    before, last = desk.file, desk.canvas.sight.view_rect_of(desk.body()[-1])
    palette = QLabel("palette")
    qtbot.addWidget(palette)
    palette.show()
    clip = clip_of(desk.editor.language, "robot.say", text="new")
    pressed = palette.mapToGlobal(QPoint(5, 5))
    desk.canvas.begin_external_drag(clip, pressed, palette)
    target = desk.canvas.viewport().mapToGlobal(last.bottomLeft().toPoint() + QPoint(40, 24))

    QTest.mousePress(palette, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    for step in range(1, 6):
        place = pressed + (target - pressed) * step / 5
        QTest.mouseMove(palette, palette.mapFromGlobal(place))
    QTest.mouseRelease(palette, Qt.MouseButton.LeftButton, pos=palette.mapFromGlobal(target))

    new = desk.editor.project.blocks[desk.body()[-1]]
    assert len(desk.body()) == 5
    assert new.fields["text"] == "new"
    assert undone(desk) == before


def test_a_new_block_that_is_let_go_outside_the_view_is_not_made(desk, qtbot):
    desk = desk(story())
    before, palette = desk.file, QLabel("palette")
    qtbot.addWidget(palette)
    clip = clip_of(desk.editor.language, "robot.say")
    desk.canvas.begin_external_drag(clip, palette.mapToGlobal(QPoint(5, 5)), palette)
    outside = desk.canvas.viewport().mapToGlobal(QPoint(-200, 300))

    QTest.mousePress(palette, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    QTest.mouseMove(palette, palette.mapFromGlobal(outside))
    is_carried = desk.canvas.layers.sprite is not None
    QTest.mouseRelease(palette, Qt.MouseButton.LeftButton, pos=palette.mapFromGlobal(outside))

    assert is_carried
    assert desk.canvas.layers.sprite is None
    assert desk.file == before


def test_a_click_on_the_palette_drags_nothing_in(desk, qtbot):
    desk = desk(story())
    before = desk.file
    palette = QLabel("palette")
    qtbot.addWidget(palette)
    clip = clip_of(desk.editor.language, "robot.say")
    desk.canvas.begin_external_drag(clip, palette.mapToGlobal(QPoint(5, 5)), palette)

    QTest.mouseClick(palette, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))

    assert desk.canvas.pointing.gesture is None
    assert desk.file == before


HELD = (Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)


def drag_in(desk, data: QMimeData, *, to: QPointF) -> None:
    """What the system sends when something is dragged in from another window, and dropped."""
    viewport, copy = desk.canvas.viewport(), Qt.DropAction.CopyAction
    held = (data, *HELD)
    start = QPoint(500, 20)
    QApplication.sendEvent(viewport, QDragEnterEvent(start, copy, *held))
    for step in range(1, 5):
        place = (QPointF(start) + (to - QPointF(start)) * step / 4).toPoint()
        QApplication.sendEvent(viewport, QDragMoveEvent(place, copy, *held))
    QApplication.sendEvent(viewport, QDropEvent(to, copy, *held))


def test_the_text_of_blocks_is_dropped_in_as_blocks(desk):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setText(to_text(clip_of(desk.editor.language, "robot.say", text="from afar")))

    drag_in(desk, data, to=FREE)

    [new] = desk.body(1)
    assert desk.editor.project.blocks[new].fields["text"] == "from afar"
    assert undone(desk) == before


def test_any_other_text_is_not_taken(desk):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setText("{ not blocks")

    drag_in(desk, data, to=FREE)

    assert desk.file == before
    assert desk.canvas.pointing.gesture is None


def test_a_file_is_left_to_the_window_around(desk, tmp_path):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(tmp_path / "greeting.nep"))])
    enter = QDragEnterEvent(QPoint(9, 9), Qt.DropAction.CopyAction, data, *HELD)

    QApplication.sendEvent(desk.canvas.viewport(), enter)

    assert not enter.isAccepted()
    assert desk.canvas.pointing.gesture is None
    assert desk.file == before


def test_a_block_of_another_page_is_refused(desk, qtbot):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setText(to_text(clip_of(desk.editor.language, "robots.robot")))

    with qtbot.waitSignal(desk.canvas.news.refused) as refused:
        drag_in(desk, data, to=FREE)

    assert "belongs on the page" in str(refused.args[0])
    assert desk.file == before
