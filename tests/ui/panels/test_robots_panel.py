"""The robots panel, with a real node of a virtual robot on a real network, and by itself."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication, QMainWindow
from pytestqt.qtbot import QtBot

from nep_core import messages as m
from nep_studio.plan import PlannedNode
from nep_studio.studio_language import studio_language
from nep_studio.ui.panels.robots.panel import RobotsPanel
from nep_studio.ui.panels.robots.scene import PARTS
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.running.tap import Heard
from nep_studio.ui.theme import Look, load_fonts

NAO = PlannedNode("action/nao", "NAO", {"robot": "NAO", "driver": "virtual", "address": ""})
REAL = PlannedNode(
    "action/nao", "Anna", {"robot": "Anna", "driver": "naoqi", "address": "192.168.1.10"}
)
WATCH = PlannedNode("sensory/virtual_watch", "watch")
NODE_START_MS = 20_000


@pytest.fixture
def planned() -> list[PlannedNode]:
    return [NAO, REAL, WATCH]


@pytest.fixture
def host(qtbot: QtBot) -> QMainWindow:
    made = QMainWindow()
    qtbot.addWidget(made)
    made.resize(360, 900)
    return made


@pytest.fixture
def runner(host: QMainWindow, planned: list[PlannedNode], tmp_path: Path) -> Iterator[Runner]:
    made = Runner(lambda: planned, host, logs=tmp_path)
    yield made
    made.close()


@pytest.fixture
def panel(
    host: QMainWindow, runner: Runner, qapp: QApplication, qtbot: QtBot
) -> Iterator[RobotsPanel]:
    load_fonts()
    look = Look(qapp, "light")
    made = RobotsPanel(runner, studio_language(), look)
    host.setCentralWidget(made)
    host.show()
    qtbot.waitExposed(host)
    yield made
    look.deleteLater()


def state(**parts: object) -> m.RobotState:
    usual = {"robot": "NAO", "joints": {}, "posture": "Stand"}
    return m.RobotState(**{**usual, **parts})  # type: ignore[arg-type]


def hear(panel: RobotsPanel, *states: m.RobotState) -> None:
    panel._tap.arrived.emit([Heard(one.time, one, "NAO") for one in states])


def test_robots_of_the_project_are_there_before_they_run(panel: RobotsPanel) -> None:
    nao, anna = panel.cards["NAO"], panel.cards["Anna"]

    assert list(panel.cards) == ["NAO", "Anna"]
    assert (nao.kind.words, anna.kind.words) == ("On this screen", "A real NAO at 192.168.1.10")
    assert nao.health.text() == "Not started"
    assert not nao.touch.isVisible()
    assert not panel.hint.isVisible()


def test_a_project_without_robots_says_how_one_takes_part(
    panel: RobotsPanel, planned: list[PlannedNode]
) -> None:
    planned.clear()

    panel.refresh()

    assert panel.cards == {}
    assert panel.hint.isVisible()
    assert "Robots page" in panel.hint.text()


def test_what_a_robot_says_and_how_it_is_can_be_read_and_heard(panel: RobotsPanel) -> None:
    hear(panel, state(saying="old"), state(saying="Impressive!", battery=0.15, moving=True))

    card = panel.cards["NAO"]
    assert card.bubble.words == "Impressive!"
    spoken = card.accessibleDescription()
    for words in ("Posture: stand", "Moves", "Battery 15%: charge it soon", "Impressive!"):
        assert words in spoken


@pytest.mark.parametrize(
    ("posture", "words"), [("SitRelax", "relax"), ("LyingBack", "back"), ("Unheard", "Unheard")]
)
def test_postures_are_told_in_words(panel: RobotsPanel, posture: str, words: str) -> None:
    hear(panel, state(posture=posture, listening=["yes", "no"]))

    spoken = panel.cards["NAO"].accessibleDescription()
    assert words in spoken.split("Posture: ")[1].split(".")[0]
    assert "Listens for “yes” or “no”" in spoken


def test_what_a_robot_does_is_told_until_it_is_done(panel: RobotsPanel, runner: Runner) -> None:
    hear(panel, state())
    asked = m.ActionRequest(id="7", robots=["NAO"], action="play", args={"animation": "wave"})

    def answered(how: m.ActionState) -> tuple[str, m.ActionResult]:
        return m.ACTION_RESULT, m.ActionResult(id="7", robot="NAO", state=how)

    runner.arrived.emit([(m.ACTION_REQUEST, asked), answered("started")])
    assert "plays the animation wave" in panel.cards["NAO"].accessibleDescription()
    runner.arrived.emit([answered("done")])

    assert "plays" not in panel.cards["NAO"].accessibleDescription()


def colours_in(panel: RobotsPanel) -> set[str]:
    image = panel.cards["NAO"].scene.grab().toImage()
    return {
        QColor(image.pixel(x, y)).name()
        for x in range(image.width())
        for y in range(image.height() // 2)
    }


def test_the_eyes_have_the_colours_of_the_lights(panel: RobotsPanel) -> None:
    hear(panel, state(leds={"LeftFaceLeds": 0x12E01B, "RightFaceLeds": 0xE0121B}))

    assert {"#12e01b", "#e0121b"} <= colours_in(panel)


def test_every_part_that_can_be_touched_is_where_it_is_drawn(panel: RobotsPanel) -> None:
    hear(panel, state())
    scene = panel.cards["NAO"].scene

    found = [scene.part_at(scene.place_of(sensor)) for sensor in PARTS]

    assert found == list(PARTS)
    assert scene.part_at(scene.rect().topLeft().toPointF()) == ""


def test_a_real_robot_cannot_be_touched_from_here(panel: RobotsPanel) -> None:
    hear(panel, state(robot="Anna"))

    card = panel.cards["Anna"]
    assert not card.touch.isVisible()
    assert card.scene.part_at(card.scene.place_of("head_front")) == ""


def test_a_robot_that_nobody_planned_has_a_card_while_it_is_heard(panel: RobotsPanel) -> None:
    hear(panel, state(robot="Guest"))

    assert list(panel.cards) == ["NAO", "Anna", "Guest"]
    assert panel.cards["Guest"].health.text() == "Ready"


def test_a_hidden_panel_listens_to_nothing(panel: RobotsPanel, host: QMainWindow) -> None:
    tap = panel._tap

    host.hide()

    assert panel._tap is None
    assert tap._is_closed


def test_a_running_robot_is_shown_touched_and_gone_when_it_stops(
    panel: RobotsPanel, runner: Runner, qtbot: QtBot
) -> None:
    """A real node in a process of its own: its state comes, and a click on its head arrives."""
    card = panel.cards["NAO"]
    runner.start_node(NAO)
    qtbot.waitUntil(lambda: "Posture: stand" in card.facts.text(), timeout=NODE_START_MS)
    scene, felt = card.scene, []
    place = scene.place_of("head_front").toPoint()

    qtbot.mousePress(scene, Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(lambda: bool(scene._state.sensors.get("head_front")), timeout=5000)
    felt.append(scene._state.sensors["head_front"])
    qtbot.mouseRelease(scene, Qt.MouseButton.LeftButton, pos=place + QPoint(1, 1))
    qtbot.waitUntil(lambda: not scene._state.sensors.get("head_front"), timeout=5000)
    runner.stop_node("NAO")

    qtbot.waitUntil(lambda: card.health.text() == "Stopped", timeout=NODE_START_MS)
    assert felt == [1.0]
    assert card.facts.text() == ""
