"""What tests of the plots share: a feed, plots of it, and a sensor that was heard."""

import time
from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import Imu
from nep_studio.ui.plugins.sensors.feed import SensorFeed
from nep_studio.ui.plugins.sensors.plots import Plots
from nep_studio.ui.plugins.sensors.tools import Hand
from nep_studio.ui.running.runner import Heard, Tap
from nep_studio.ui.theme.look import Look


class Silence(QObject):
    """A network in which nobody says anything."""

    def tap(
        self, topic: str, *, kind: type | None = None, most: int = 2000, parent: QObject
    ) -> Tap:
        return Tap(topic, kind, most=most, parent=parent)


def hear(feed: SensorFeed, seconds: float = 4.0, source: str = "watch") -> None:
    """Let a sensor have measured up to now, fifty times a second."""
    now_s = time.time()
    for start_s in np.arange(0, seconds, 0.1):
        t = start_s + np.arange(5) / 50
        acc = [(3 * float(np.sin(2 * np.pi * 2 * x)), 1.0, 9.8) for x in t]
        message = Imu(source=source, rate_hz=50, t=t.tolist(), acc=acc, gyr=acc)
        arrived_s = now_s - seconds + float(t[-1])
        feed.hear_imu([Heard(arrived_s, message, "node")])


@pytest.fixture
def look(qapp: QApplication) -> Iterator[Look]:
    made = Look(qapp, "light")
    yield made
    made.choose("light")
    made.deleteLater()


@pytest.fixture
def feed(qapp: QApplication, monkeypatch: pytest.MonkeyPatch) -> Iterator[SensorFeed]:
    monkeypatch.setattr("nep_studio.ui.plugins.sensors.feed._moment", lambda heard: heard.time_s)
    silence = Silence()
    made = SensorFeed(silence, silence)
    yield made
    silence.deleteLater()


@pytest.fixture
def plots(feed: SensorFeed, look: Look, qtbot: QtBot) -> Plots:
    """Plots in which four seconds of a watch are seen, standing still."""
    made = Plots(feed, look)
    qtbot.addWidget(made)
    made.resize(800, 400)
    made.hand = Hand(made)
    made.show()
    qtbot.waitExposed(made)
    hear(feed)
    made.draw()
    return made
