"""The stage, with a real node of a virtual robot on a real network, and by itself."""

from __future__ import annotations

import psutil
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QMainWindow
from pytestqt.qtbot import QtBot

from nep_core.errors import NodeStartError
from nep_core.wire import messages as m
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.look import Look
from robots.body.limbs import TOUCH_SENSORS
from tests.ui.panels.robots.conftest import NAO, WATCH, hear, state

pytestmark = pytest.mark.long

NODE_START_MS = 30_000


def test_robots_of_the_project_are_there_before_they_run(panel: RobotsPanel) -> None:
    nao, anna = panel.cards["NAO"], panel.cards["Anna"]

    assert list(panel.cards) == ["NAO", "Anna"]
    assert (nao.kind.words, anna.kind.words) == ("On this screen", "A real NAO at 192.168.1.10")
    assert nao.health.text() == "Not started"
    assert not nao.touch.isVisible()
    assert not panel.hint.isVisible()
    assert tuple(panel.stage.view.room.robots) == ("NAO", "Anna")


def test_a_project_without_robots_says_how_one_takes_part(
    panel: RobotsPanel, planned: list[PlannedNode]
) -> None:
    planned.clear()

    panel.refresh()

    assert panel.cards == {}
    assert not panel.stage.view.room.robots
    assert panel.hint.isVisible()
    assert "page Robots" in panel.hint.text()


def test_what_a_robot_says_and_how_it_is_can_be_read_and_heard(panel: RobotsPanel) -> None:
    hear(panel, state(saying="old"), state(saying="Impressive!", battery=0.15, moving=True))

    spoken = panel.cards["NAO"].accessibleDescription()
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


def test_long_words_of_a_posture_widen_no_card(panel: RobotsPanel, host: QMainWindow) -> None:
    host.resize(200, 900)

    hear(panel, state(posture="StandInit", battery=1.0))

    card = panel.cards["NAO"]
    assert "ready to walk" in card.facts.text()
    assert card.minimumSizeHint().width() <= panel.area.viewport().width()


def test_what_a_robot_does_is_told_until_it_is_done(panel: RobotsPanel, runner: Runner) -> None:
    hear(panel, state())
    asked = m.ActionRequest(id="7", robots=["NAO"], action="play", args={"animation": "wave"})

    def answered(how: m.ActionState) -> tuple[str, m.ActionResult]:
        return m.ACTION_RESULT, m.ActionResult(id="7", robot="NAO", state=how)

    runner.arrived.emit([(m.ACTION_REQUEST, asked), answered("started")])
    assert "plays the animation wave" in panel.cards["NAO"].accessibleDescription()
    runner.arrived.emit([answered("done")])

    assert "plays" not in panel.cards["NAO"].accessibleDescription()


def test_a_real_robot_is_in_the_scene_but_cannot_be_touched_from_here(panel: RobotsPanel) -> None:
    hear(panel, state(robot="Anna"))

    card = panel.cards["Anna"]
    assert not card.touch.isVisible()
    assert not panel.stage.view.room.can_touch("Anna")
    assert not panel.stage.view.room.robots["Anna"].is_pale
    assert card.kind.words.startswith("A real NAO")


def test_a_robot_that_nobody_planned_has_a_card_while_it_is_heard(panel: RobotsPanel) -> None:
    hear(panel, state(robot="Guest"))

    assert list(panel.cards) == ["NAO", "Anna", "Guest"]
    assert panel.cards["Guest"].health.text() == "Ready"


def test_every_sensor_of_the_card_is_one_that_the_view_knows(panel: RobotsPanel) -> None:
    hear(panel, state())
    view = panel.stage.view

    assert set(view.room.scene().robots[0].figure.sensors) == set(TOUCH_SENSORS)


def test_a_fall_is_told_and_a_button_helps_it_up(
    panel: RobotsPanel, runner: Runner, qtbot: QtBot
) -> None:
    sent: list[object] = []
    runner.send = lambda topic, message: sent.append(message) or True  # type: ignore[method-assign]
    hear(panel, state(posture="LyingBack", fallen=True))
    card = panel.cards["NAO"]
    assert card.fallen.isVisible()
    assert "It has fallen." in card.accessibleDescription()

    qtbot.mouseClick(card.fallen.help_button, Qt.MouseButton.LeftButton)
    hear(panel, state())

    [request] = sent
    assert isinstance(request, m.ActionRequest)
    assert (request.robots, request.action) == (["NAO"], "do")
    assert request.args == {"posture": "posture_stand"}
    assert not card.fallen.isVisible()


def test_a_hidden_panel_listens_to_nothing(panel: RobotsPanel, host: QMainWindow) -> None:
    tap = panel._tap

    host.hide()

    assert panel._tap is None
    assert tap._is_closed


def test_the_scene_can_be_large_and_comes_back(panel: RobotsPanel, qtbot: QtBot) -> None:
    qtbot.mouseClick(panel.stage.tools.large, Qt.MouseButton.LeftButton)
    large = panel.large
    assert large is not None
    qtbot.waitUntil(large.isVisible)
    panel.hide()
    hear(panel, state(saying="Here I am"))
    assert panel.stage.window() is large
    assert panel.elsewhere.isVisibleTo(panel)

    qtbot.keyClick(large, Qt.Key.Key_F11)
    assert large.isFullScreen()
    qtbot.keyClick(large, Qt.Key.Key_Escape)
    qtbot.keyClick(large, Qt.Key.Key_Escape)

    assert panel.large is None
    assert panel._tap is None
    panel.show()
    assert panel.stage.isVisible()
    assert panel.stage.window() is panel.window()


def test_many_robots_with_long_names_keep_the_panel_narrow(
    panel: RobotsPanel, planned: list[PlannedNode], look: Look, host: QMainWindow
) -> None:
    planned += [PlannedNode("action/nao", f"{n} " + "Very long name " * 6) for n in range(4)]
    look.set_scale(2.0)

    panel.refresh()

    assert len(panel.cards) == 6
    assert panel.minimumSizeHint().width() < 420
    look.set_scale(1.0)


def test_a_running_robot_is_shown_touched_put_back_and_gone_when_it_stops(
    panel: RobotsPanel, runner: Runner, qtbot: QtBot
) -> None:
    """A real node in a process of its own: its state comes, and a click on its head arrives."""
    card, view = panel.cards["NAO"], panel.stage.view
    runner.start_node(NAO)
    qtbot.waitUntil(lambda: "Posture: stand" in card.facts.text(), timeout=NODE_START_MS)
    view.look_from("front")
    place = view.place_of("NAO", "head_front")
    assert place is not None

    def felt() -> float:
        robot = view.room.robots["NAO"]
        return 0.0 if robot.is_pale else robot.goal.sensors.get("head_front", 0.0)

    qtbot.mousePress(view, Qt.MouseButton.LeftButton, pos=place.toPoint())
    qtbot.waitUntil(lambda: felt() > 0)
    qtbot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=place.toPoint() + QPoint(1, 1))
    qtbot.waitUntil(lambda: felt() == 0)
    runner.stop_node("NAO")

    qtbot.waitUntil(lambda: card.health.text() == "Stopped", timeout=NODE_START_MS)
    assert card.facts.text() == ""
    assert view.room.robots["NAO"].is_pale


def test_a_running_robot_that_is_pushed_falls_and_is_helped_up(
    panel: RobotsPanel, runner: Runner, qtbot: QtBot
) -> None:
    card = panel.cards["NAO"]
    runner.start_node(NAO)
    qtbot.waitUntil(lambda: "Posture: stand" in card.facts.text(), timeout=NODE_START_MS)

    runner.send(m.SENSE_REQUEST, m.SenseRequest(robot="NAO", sense="push", place=(1.0, 0.0, 0.3)))
    qtbot.waitUntil(lambda: bool(card.fallen and card.fallen.isVisible()), timeout=NODE_START_MS)
    qtbot.mouseClick(card.fallen.help_button, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: not card.fallen.isVisible(), timeout=60_000)
    qtbot.waitUntil(lambda: "Posture: stand" in card.facts.text(), timeout=60_000)


def test_robots_begin_beside_each_other_and_are_put_back(
    panel: RobotsPanel, runner: Runner, planned: list[PlannedNode], qtbot: QtBot
) -> None:
    """Two real nodes: the second stands beside the first, and comes back after a walk."""
    second = PlannedNode("action/nao", "NAO2", {"robot": "NAO2", "driver": "virtual"})
    planned[:] = [NAO, second]
    panel.refresh()
    runner.start_node(second)

    def y() -> float:
        state = panel._heard.get("NAO2")
        return state.base[1] if state is not None else 0.0

    qtbot.waitUntil(lambda: abs(y() + 0.8) < 0.05, timeout=NODE_START_MS)
    runner.send(m.SENSE_REQUEST, m.SenseRequest(robot="NAO2", sense="place", place=(1.0, 2.0, 0.0)))
    qtbot.waitUntil(lambda: abs(y() - 2.0) < 0.05)

    qtbot.mouseClick(panel.cards["NAO2"].back, Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: abs(y() + 0.8) < 0.05)


def test_another_kind_of_robot_is_drawn_from_its_own_folder(
    panel: RobotsPanel, planned: list[PlannedNode]
) -> None:
    planned[:] = [NAO, PlannedNode("action/nao", "P", {"robot": "P", "model": "pepper"})]

    panel.refresh()

    figures = {one.name: one.figure for one in panel.stage.view.room.scene().robots}
    assert set(figures["P"].body.names) != set(figures["NAO"].body.names)


def test_the_scene_stays_where_it_is_while_robots_say_one_thing_after_the_other(
    panel: RobotsPanel, runner: Runner, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    monkeypatch.setattr(runner, "state", "running")
    hear(panel, state(saying="Hello"))
    qtbot.wait(300)
    scene = panel.stage.geometry()

    hear(panel, state(saying=""))
    qtbot.wait(300)
    assert panel.stage.geometry() == scene


def test_who_still_waits_for_the_network_starts_nothing_after_the_end(runner: Runner) -> None:
    runner.start_node(WATCH)
    before = set(psutil.Process().children(recursive=True))

    runner.close()
    with pytest.raises(NodeStartError):
        runner.local.open()  # what a thread does whose turn comes now

    assert not runner.is_connected
    assert set(psutil.Process().children(recursive=True)) <= before
