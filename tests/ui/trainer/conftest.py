"""A desk of the trainer over a new project, which hears what tests push."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QApplication, QSplitter, QWidget
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import Imu
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.messages import Messages
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.page import TrainerPage
from nep_studio.ui.plugins.gestures.results.training import Training
from nep_studio.ui.running.runner import Heard, Runner, Tap
from nep_studio.ui.theme.look import Look
from tests.ui.trainer.results_controller import OpenProject
from tests.ui.window.conftest import answer, chooser, home, studio, window

__all__ = ["answer", "chooser", "home", "studio", "window"]


class Silence(QObject):
    """A network in which nobody says anything."""

    def tap(
        self, topic: str, *, kind: type | None = None, most: int = 2000, parent: QObject
    ) -> Tap:
        return Tap(topic, kind, most=most, parent=parent)


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
def desk(look: Look, clock: Clock, qtbot: QtBot) -> Iterator[GestureController]:
    """A desk over a project of its own, without the whole window around it."""
    owner = QWidget()
    qtbot.addWidget(owner)
    made = GestureController(OpenProject(), Silence(owner), Messages(owner), look, owner, now=clock)
    yield made
    made.deleteLater()


@pytest.fixture
def canvas(desk: GestureController) -> Canvas:
    """The page of blocks, which the page of the trainer stands below."""
    return Canvas(desk.editor, desk.look.theme)


@pytest.fixture
def page(
    desk: GestureController,
    canvas: Canvas,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> Iterator[TrainerPage]:
    """The page of the trainer, which learns only when it is asked to."""
    desk.runner = Runner(list, desk.parent(), logs=tmp_path / "logs")
    monkeypatch.setattr(Training, "warm", lambda _self: None)
    training = Training(desk, desk)
    training.trains_by_itself = False
    made = TrainerPage(desk, training, canvas)
    outer = QSplitter(Qt.Orientation.Vertical)
    qtbot.addWidget(outer)
    for part in (canvas, made):
        outer.addWidget(part)
    outer.resize(1100, 900)
    outer.setSizes([350, 550])
    outer.show()
    qtbot.waitExposed(outer)
    yield made
    made.session.cancel()
    training.close()
    desk.runner.close()


Push = Callable[..., None]


@pytest.fixture
def push(desk: GestureController, clock: Clock) -> Push:
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
