"""A desk of the trainer over a new project, which hears what tests push."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from nep_core.messages import Imu
from nep_studio.ui.messages import Messages
from nep_studio.ui.running.tap import Heard
from nep_studio.ui.theme import Look
from nep_studio.ui.trainer.desk import TrainerDesk
from tests.ui.trainer.results_desk import OpenProject
from tests.ui.window.conftest import answer, chooser, home, studio, window

__all__ = ["answer", "chooser", "home", "studio", "window"]


class Clock:
    """The time that the desk believes it is."""

    def __init__(self) -> None:
        self.time_s = 1000.0

    def __call__(self) -> float:
        return self.time_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def look(qapp: QApplication) -> Iterator[Look]:
    made = Look(qapp, "light")
    yield made
    made.deleteLater()


@pytest.fixture
def desk(look: Look, clock: Clock, qtbot: QtBot) -> Iterator[TrainerDesk]:
    """A desk over a project of its own, without the whole window around it."""
    owner = QWidget()
    qtbot.addWidget(owner)
    made = TrainerDesk(OpenProject(), None, Messages(owner), look, owner, now=clock)
    yield made
    made.deleteLater()


Push = Callable[..., None]


@pytest.fixture
def push(desk: TrainerDesk, clock: Clock) -> Push:
    """Lets the desk hear samples as the network would bring them, in batches of a tenth of a s."""

    def do(
        acc: np.ndarray,
        gyr: np.ndarray | None = None,
        *,
        rate_hz: float = 50.0,
        source: str = "watch",
        start_s: float | None = None,
        gravity_included: bool = True,
        wrist: str = "",
    ) -> None:
        stream = desk.streams.get(source)
        begin = (stream.last_t + 1 / rate_hz if stream else 0.0) if start_s is None else start_s
        step = max(1, round(rate_hz / 10))
        for at in range(0, len(acc), step):
            rows = acc[at : at + step]
            turns = None if gyr is None else gyr[at : at + step].tolist()
            t = begin + (at + np.arange(len(rows))) / rate_hz
            message = Imu(
                source=source,
                rate_hz=rate_hz,
                t=t.tolist(),
                acc=rows.tolist(),
                gyr=turns,
                gravity_included=gravity_included,
                wrist=wrist,
            )
            clock.time_s += len(rows) / rate_hz
            desk.hear([Heard(clock.time_s, message, "node")])

    return do
