"""What is known of a watch that sends, and the line that tells it."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import Imu, NodeState
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.running.runner import Heard, Runner
from nep_studio.ui.theme.look import Look
from nep_studio.ui.watch_view.indicators import Flow, Receiving, figures
from nep_studio.ui.watch_view.status import WatchStatus

STILL = (0.0, 0.0, 9.81)


def batch(first: int, rate_hz: float = 50.0, count: int = 5, **more) -> Imu:
    acc = more.pop("acc", [STILL] * count)
    t = [(first + n) / rate_hz for n in range(count)]
    return Imu(source="192.168.1.7", rate_hz=rate_hz, t=t, acc=acc, **more)


def heard_for(seconds: float, rate_hz: float = 50.0) -> Receiving:
    watch = Receiving()
    for first in range(0, round(seconds * rate_hz), 5):
        watch.hear(batch(first, rate_hz), 100.0 + first / rate_hz)
    return watch


def test_the_rate_is_counted_from_what_arrives() -> None:
    watch = heard_for(3.0)

    assert watch.rate_hz(102.9) == pytest.approx(50, abs=0.5)
    assert watch.rate_hz(110.0) == 0.0
    assert not watch.is_sending(110.0)


def test_missing_samples_are_a_gap_and_a_loss_until_they_are_a_minute_old() -> None:
    watch = heard_for(1.0)

    watch.hear(batch(60), 101.2)

    flow = watch.flow(101.2, {})
    assert flow.gaps == 1
    assert flow.loss == pytest.approx(10 / 65)
    assert watch.flow(170.0, {}).gaps == 0


def test_a_device_that_lies_still_has_not_moved_one_that_is_turned_over_has() -> None:
    watch = heard_for(2.0)
    assert not watch.has_moved

    watch.hear(batch(105, acc=[STILL, (0.0, 3.0, 9.0), (0.0, 9.0, 3.0), STILL, STILL]), 102.1)

    assert watch.has_moved
    assert watch.movement_m_s2 == pytest.approx(9.0)


def test_what_the_node_measures_goes_before_what_is_counted_here() -> None:
    measures = {"rate_hz": 62.0, "loss": 0.25, "gaps": 3.0, "drift_ppm": -40.0, "delay_ms": 180.0}

    flow = heard_for(1.0).flow(101.0, measures)

    assert flow == Flow(62.0, 0.25, 3, -40.0, 180.0)


def test_every_number_has_its_words() -> None:
    told = {one.name: one for one in figures(Flow(62.4, 0.25, 3, -40.0, 180.0))}

    assert (told["Samples"].number, told["Samples"].grade) == ("62 a second", "good")
    assert (told["Lost"].number, told["Lost"].grade) == ("25 %", "poor")
    assert (told["Gaps"].number, told["Gaps"].grade) == ("3", "fair")
    assert (told["Delay"].number, told["Delay"].grade) == ("180 ms", "fair")
    assert (told["Clock"].number, told["Clock"].grade) == ("-0.14 s an hour", "good")
    assert all(one.words for one in told.values())


def test_what_nobody_can_tell_is_not_told() -> None:
    assert [one.name for one in figures(Flow(50.0))] == ["Samples", "Gaps"]


@pytest.fixture
def runner(qapp: QApplication, tmp_path: Path) -> Iterator[Runner]:
    owner = QObject()
    made = Runner(list, owner, logs=tmp_path)
    yield made
    made.close()


@pytest.fixture
def status(runner: Runner, qapp: QApplication, qtbot: QtBot) -> WatchStatus:
    made = WatchStatus(runner, Look(qapp, "light"))
    qtbot.addWidget(made)
    made.show()
    return made


def send(status: WatchStatus, node: str, message: Imu) -> None:
    status.listener.hear([Heard(time.time(), message, node)])
    status.refresh()


def test_without_a_watch_the_line_says_so_and_offers_one(status: WatchStatus, qtbot: QtBot) -> None:
    assert status.words.words == "No watch or phone sends"

    with qtbot.waitSignal(status.connect_asked):
        qtbot.mouseClick(status.button, Qt.MouseButton.LeftButton)


def test_a_phone_is_named_with_its_rate_and_its_losses_are_in_the_tool_tip(
    status: WatchStatus, runner: Runner
) -> None:
    phone = PlannedNode("sensory/smartwatch", "watch", {"through": "phone_page"})
    runner.local.planned["watch"] = phone
    measures = {"rate_hz": 62.0, "loss": 0.01, "delay_ms": 40.0}
    state = NodeState(node="watch", type="sensory", event="connected", measures=measures)
    runner.board.update(state)

    send(status, "watch", batch(0))

    assert status.state.sign == "good"
    assert status.words.words == "Phone, 62 samples a second"
    assert "Lost: 1.0 % (next to nothing is missing)" in status.toolTip()
    assert "Delay: 40 ms" in status.toolTip()
    assert status.accessibleName() == status.words.words


def test_a_real_watch_goes_before_a_simulated_one(status: WatchStatus, runner: Runner) -> None:
    runner.local.planned["virtual"] = PlannedNode("sensory/virtual_watch", "virtual", {})

    send(status, "virtual", batch(0, simulated=True))
    assert status.words.words.startswith("Virtual watch")
    send(status, "watch", batch(0))
    send(status, "virtual", batch(5, simulated=True))

    assert status.words.words.startswith("A watch,")


def test_a_watch_that_is_waited_for_is_named(status: WatchStatus, runner: Runner) -> None:
    phone = PlannedNode("sensory/smartwatch", "watch", {"through": "phone_page"})
    runner.local.planned["watch"] = phone
    runner.board.update(NodeState(node="watch", type="sensory", event="ready"))

    status.refresh()

    assert status.state.sign == "waiting"
    assert status.words.words == "Phone: nothing has come yet"


def test_a_watch_that_falls_silent_is_said_to_be(status: WatchStatus) -> None:
    send(status, "watch", batch(0))

    status.listener.receiving.heard_s -= 3.0
    status.refresh()

    assert status.state.sign == "silent"
    assert status.words.words == "A watch is silent"


def test_it_hears_only_while_it_is_shown(status: WatchStatus, runner: Runner) -> None:
    assert len(runner._taps) == 1

    status.hide()

    assert not math.isfinite(status.listener.silent_s)
    assert all(tap._is_closed for tap in runner._taps)
