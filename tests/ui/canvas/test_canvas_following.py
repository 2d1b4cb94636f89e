"""The view follows the block that runs, and leaves a person alone who is busy."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication

from nep_studio.ui.canvas import following
from nep_studio.ui.canvas.layout.index import Rect
from tests.blocks.block_building import B


@pytest.fixture
def tall(desk, monkeypatch):
    """A stack that is much higher than the view, and nobody has moved the view lately."""
    monkeypatch.setattr(following, "QUIET_S", 0.4)
    monkeypatch.setattr(following, "REST_MS", 50)
    made = desk([B("event.started"), *(B("robot.say", {"text": f"{n}"}) for n in range(60))])
    made.canvas.following._rest.setInterval(following.GLIDE_MS + 50)
    return made


def is_seen(desk, block: str) -> bool:
    placed = desk.canvas.page_layout.placed(block)
    head = Rect(placed.x, placed.y, 20, 20)
    seen = desk.canvas.sight.visible_page_rect()
    return seen.holds(head.x, head.y) and seen.holds(head.right, head.bottom)


def turn_wheel(desk, notches: int) -> None:
    at = QPointF(500, 400)
    place = QPointF(desk.canvas.viewport().mapToGlobal(at.toPoint()))
    event = QWheelEvent(
        at,
        place,
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(desk.canvas.viewport(), event)


def test_the_view_glides_to_the_block_that_runs(tall, qtbot) -> None:
    last, places = tall.body()[-1], []
    tall.canvas.news.view_changed.connect(lambda: places.append(tall.canvas.sight.camera.y))

    tall.canvas.following.follow(frozenset({last}))

    qtbot.waitUntil(lambda: is_seen(tall, last))
    assert len(places) > 2
    assert places == sorted(places)


def test_a_running_block_that_is_seen_moves_nothing(tall, qtbot) -> None:
    before = tall.canvas.sight.camera.y

    tall.canvas.following.follow(frozenset({tall.body()[2], tall.body()[-1]}))
    qtbot.wait(following.GLIDE_MS + 100)

    assert tall.canvas.sight.camera.y == before


def test_who_has_just_scrolled_is_left_alone_for_a_while(tall, qtbot) -> None:
    last = tall.body()[-1]
    turn_wheel(tall, -2)
    looked_at = tall.canvas.sight.camera.y

    tall.canvas.following.follow(frozenset({last}))
    stayed = tall.canvas.sight.camera.y == looked_at

    assert stayed
    qtbot.waitUntil(lambda: is_seen(tall, last))


def test_who_scrolls_against_the_glide_wins(tall, qtbot) -> None:
    tall.canvas.following.follow(frozenset({tall.body()[-1]}))
    qtbot.waitUntil(lambda: tall.canvas.sight.camera.y > 60)

    turn_wheel(tall, 1)
    at = tall.canvas.sight.camera.y
    qtbot.wait(200)

    assert tall.canvas.sight.camera.y == at


def test_nothing_moves_while_blocks_are_dragged(tall, qtbot) -> None:
    before = tall.canvas.sight.camera.y
    tall.mouse.drag(tall.grip(tall.body()[3]), QPointF(500, 300))

    tall.canvas.following.follow(frozenset({tall.body()[-1]}))
    qtbot.wait(following.GLIDE_MS + 100)

    assert tall.canvas.sight.camera.y == before


def test_a_person_can_do_without(tall, qtbot) -> None:
    tall.canvas.following.is_on = False

    tall.canvas.following.follow(frozenset({tall.body()[-1]}))
    qtbot.wait(following.GLIDE_MS + 100)

    assert tall.canvas.sight.camera.y < 60
