"""Lists of animations, postures and things show what each looks like."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from nep_studio.ui.canvas.fields.field_edit import view_rect_of
from nep_studio.ui.robot_view.small_pictures import small_picture


def opened(window, block_type: str, key: str):
    """Press a field of a new block of the page, as a person does."""
    canvas = window.workbench.canvas
    editor = canvas.editor
    block = editor.create(block_type, editor.new_stack("behaviour", 40, 40))
    canvas.show_block(block)
    place = view_rect_of(canvas, block, key).center().toPoint()
    QTest.mouseClick(canvas.viewport(), Qt.MouseButton.LeftButton, pos=place)
    return canvas.fields.widget, block


def colours(icon) -> int:
    """How many colours an icon has: a sign has one."""
    image = icon.pixmap(40).toImage()
    places = [(x, y) for x in range(image.width()) for y in range(image.height())]
    return len({image.pixel(x, y) for x, y in places if image.pixelColor(x, y).alpha() == 255})


@pytest.mark.parametrize(
    ("block_type", "key", "least"),
    [
        ("robot.play", "animation", 30),
        ("robot.do", "posture", 9),
        ("robot.imitate", "animal", 10),
    ],
)
def test_what_a_robot_can_do_is_seen_in_the_list(karate, qtbot, block_type, key, least) -> None:
    popup, _ = opened(karate, block_type, key)

    qtbot.waitUntil(lambda: not popup._undrawn)

    icons = [popup.list.item(row).icon() for row in range(popup.list.count())]
    assert len(icons) >= least
    assert sum(colours(icon) > 8 for icon in icons) == len(icons)


def test_the_list_is_there_before_its_pictures(karate) -> None:
    popup, _ = opened(karate, "robot.play", "animation")

    assert popup.isVisible()
    assert len(popup._undrawn) > 30


def test_an_animation_of_the_project_has_a_plain_sign() -> None:
    for table, value in (
        ("animations", "my_own_wave"),
        ("things", "sound"),
        ("animations", "../x"),
    ):
        picture = small_picture(table, value, model="", theme="light", side=40, ratio=1.0)
        assert picture is None


def test_a_picture_is_drawn_once_for_each_screen_and_theme(qapp) -> None:
    asked = {"model": "", "side": 40, "ratio": 2.0}
    first = small_picture("postures", "posture_sit", theme="light", **asked)

    assert first is small_picture("postures", "posture_sit", theme="light", **asked)
    assert first is not small_picture("postures", "posture_sit", theme="dark", **asked)
    assert first.width() == 80
    assert first.devicePixelRatio() == 2.0


def test_things_are_seen_in_the_list_and_what_cannot_be_seen_has_a_sign(karate, qtbot) -> None:
    popup, _ = opened(karate, "robot_events.sees", "thing")

    qtbot.waitUntil(lambda: not popup._undrawn)

    rows = [popup.list.item(row) for row in range(popup.list.count())]
    assert {row.text(): colours(row.icon()) > 2 for row in rows} == {
        "a face": True,
        "the red ball": True,
        "a sound": False,
    }
