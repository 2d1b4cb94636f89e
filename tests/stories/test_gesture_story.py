"""A teacher at the real window teaches two gestures with a phone, and NAO answers one of them.

The phone is a process that sends as the app Sensor Logger does; it plays recordings of a real
person, of simulated ones where there are none. With NEP_STORY_IMAGES=FOLDER a picture of each step
is kept; tools/story_images.py does so on a virtual screen.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

import dev
from nep_core.wire import messages as m
from nep_studio.blocks.own_gestures import own_gestures, trained_gestures
from nep_studio.ui.plugins.gestures import TrainerPanel
from nep_studio.ui.plugins.gestures.page import TrainerPage
from nep_studio.ui.plugins.watches.dialog import WatchDialog
from nep_studio.ui.shell.main_window import MainWindow
from nodes.perceptual.recognition.streams import takes_of
from nodes.recordings import Recording, read_recording
from nodes.sensory.arm.people import perform
from tests.stories.test_window_story import Newcomer
from tests.ui.checklist.conftest import home, studio, window
from tests.ui.checklist.person import Key

__all__ = ["home", "studio", "window"]

WAIT_MS = 60_000
TAKES, MORE = 3, 1
REST_S = 0.6
RATE_HZ = 50.0
SIMULATED = 4
"""From this take on each performance is one movement: a karate, say, is often two, up and down."""
LEFT = Qt.MouseButton.LeftButton
REAL = Path(dev.__file__).parents[1] / "shared" / "data" / "uhh_gestures"
TITLES = ("push", "turn")
REAL_NAMES = {"push": "forward", "turn": "turn_left"}
SIMULATED_NAMES = {"push": "katana", "turn": "batting"}


def performances(title: str) -> list[Recording]:
    """Four performances of a gesture, each with a rest before and after it."""
    if not REAL.is_dir():
        takes = range(SIMULATED, SIMULATED + TAKES + MORE)
        return [perform(SIMULATED_NAMES[title], 140, take) for take in takes]
    whole = read_recording(REAL / f"j_{REAL_NAMES[title]}.csv")
    return [_cut(whole, one.start_s, one.end_s) for one in takes_of(whole)[: TAKES + MORE]]


def _cut(whole: Recording, start_s: float, end_s: float) -> Recording:
    inside = (whole.t >= start_s) & (whole.t <= end_s)
    t = whole.t[inside]
    step_s = float(np.median(np.diff(whole.t)))
    still = np.zeros((round(REST_S / step_s), 3))
    acc = np.vstack([still, whole.acc[inside], still])
    acc[:, 2] += 9.80665
    assert whole.gyr is not None
    gyr = np.vstack([still, whole.gyr[inside], still])
    times = np.arange(len(acc)) * step_s
    return replace(
        whole, t=times, acc=acc, gyr=gyr, labels=None, gravity_included=True, source=f"{t[0]:.0f}"
    )


def resting(before: Recording) -> Recording:
    """The hand as it is before a movement: held otherwise, it would move on the way there."""
    t = np.arange(round(0.2 * RATE_HZ)) / RATE_HZ
    acc = np.tile(before.acc[:5].mean(axis=0), (len(t), 1))
    return Recording("rest", t, acc, np.zeros_like(acc), None, gravity_included=True)


class Phone:
    """The process that sends, and what it is asked to do."""

    def __init__(self, port: int, folder: Path) -> None:
        self._folder, self._count = folder, 0
        rest = self._written("rest", resting(performances(TITLES[0])[0]))
        url = f"http://127.0.0.1:{port}/data"
        command = [sys.executable, "-m", "tests.stories.wearer", url, str(rest)]
        self._process = subprocess.Popen(
            command,
            cwd=Path(dev.__file__).parent,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
        )

    def make(self, *movements: Recording) -> None:
        """Make these movements, one after the other."""
        assert self._process.stdin is not None
        for movement in movements:
            self._count += 1
            path = self._written(f"movement_{self._count}", movement)
            self._process.stdin.write(f"{path}\n")
            self._process.stdin.flush()

    def _written(self, name: str, recording: Recording) -> Path:
        path = self._folder / f"{name}.csv"
        table = np.column_stack([recording.t, recording.acc, recording.gyr])
        np.savetxt(path, table, "%.5f", ",", header="t,ax,ay,az,gx,gy,gz", comments="")
        return path

    def end(self) -> None:
        """Switch it off."""
        self._process.kill()
        self._process.communicate()


@pytest.fixture
def teacher(window: MainWindow, qtbot: QtBot) -> Iterator[Newcomer]:
    yield Newcomer(window, qtbot)
    window.running.close()


@pytest.fixture
def phone(free_port: int, tmp_path: Path) -> Iterator[Phone]:
    made = Phone(free_port, tmp_path)
    yield made
    made.end()


def connect(teacher: Newcomer, page: TrainerPage, port: int) -> None:
    """Press Connect…, choose the app, and use it."""
    qtbot, window = teacher.qtbot, teacher.window
    qtbot.mouseClick(page.head.watch.button, LEFT)
    qtbot.waitUntil(lambda: window.findChild(WatchDialog) is not None)
    dialog = window.findChild(WatchDialog)
    qtbot.mouseClick(dialog.choosing.cards["sensor_logger"], LEFT)
    dialog.page.more.port.setValue(port)
    qtbot.waitUntil(dialog.use_button.isEnabled, timeout=WAIT_MS)
    teacher.step("connect-phone")
    qtbot.mouseClick(dialog.use_button, LEFT)
    qtbot.waitUntil(lambda: page.controller.is_hearing, timeout=WAIT_MS)


def record(teacher: Newcomer, page: TrainerPage, phone: Phone, title: str) -> None:
    """Type the name of a gesture, press the space bar, make it three times, and stop."""
    qtbot = teacher.qtbot
    qtbot.mouseClick(page.cards.new_button, LEFT)
    teacher.type(title, page.cards.new_name)
    teacher.key(Key.Key_Return, widget=page.cards.new_name)
    qtbot.waitUntil(lambda: page.bar.gesture == title)
    qtbot.mouseClick(page.bar.button, LEFT)
    qtbot.waitUntil(lambda: page.session.state == "takes", timeout=WAIT_MS)
    phone.make(*performances(title)[:TAKES])
    qtbot.waitUntil(lambda: page.session.taken == TAKES, timeout=WAIT_MS)
    teacher.step(f"record-{title}")
    qtbot.mouseClick(page.bar.button, LEFT)
    assert not page.session.is_on
    assert len(own_gestures(teacher.project)[title].takes) == TAKES


def drag_rule(teacher: Newcomer, page: TrainerPage) -> None:
    """Drag “when push” from its card onto the page, and let NAO say something."""
    chip = page.cards.cards["push"].chip
    page.cards.show_card("push")
    start = chip.rect().center()
    target = teacher.canvas.viewport().mapToGlobal(QPoint(120, 60))
    QTest.mousePress(chip, LEFT, Qt.KeyboardModifier.NoModifier, start)
    end = chip.mapFromGlobal(target)
    for part in (0.1, 0.5, 1.0):
        QTest.mouseMove(chip, start + (end - start) * part)
        QApplication.processEvents()
    QTest.mouseRelease(chip, LEFT, Qt.KeyboardModifier.NoModifier, end)
    hat = teacher.block("event.gesture")
    assert hat.fields["gesture"] == "push"
    teacher.qtbot.waitUntil(teacher.canvas.isVisible)
    teacher.qtbot.wait(200)  # until all around it has its place again
    teacher.from_palette("robot.say", teacher.foot(hat.id) + QPoint(100, 20))
    assert [teacher.project.blocks[one].type for one in teacher.body()] == [
        "event.gesture",
        "robot.say",
    ]


@pytest.mark.timeout(240)
def test_a_teacher_teaches_two_gestures_and_nao_answers(
    teacher: Newcomer, window: MainWindow, qtbot: QtBot, phone: Phone, free_port: int
) -> None:
    window.files.new()
    qtbot.waitUntil(lambda: teacher.canvas.isVisible(), timeout=WAIT_MS)
    panel = window.findChild(TrainerPanel)
    window.workbench.panels.show(panel)
    page = panel.opened()

    connect(teacher, page, free_port)
    for title in TITLES:
        record(teacher, page, phone, title)

    if not page.controller.is_up_to_date and page.results.bar.button.isEnabled():
        qtbot.mouseClick(page.results.bar.button, LEFT)
    qtbot.waitUntil(lambda: page.controller.is_up_to_date, timeout=WAIT_MS)
    assert list(trained_gestures(teacher.project)) == list(TITLES)
    page.tabs.setCurrentWidget(page.results)
    teacher.step("results")

    recognised: list[str] = []
    page.trial.recognised.connect(lambda found: recognised.append(found.gesture))
    page.tabs.setCurrentWidget(page.trial)
    phone.make(performances("turn")[TAKES])
    qtbot.waitUntil(lambda: "turn" in recognised, timeout=WAIT_MS)
    teacher.step("try")

    drag_rule(teacher, page)
    teacher.step("rule")
    teacher.press_tool("run")
    teacher.wait_for_state("running")
    qtbot.waitUntil(lambda: _listens(teacher), timeout=WAIT_MS)
    phone.make(performances("push")[TAKES])
    qtbot.waitUntil(lambda: teacher.heard("Hello"), timeout=WAIT_MS)
    teacher.step("nao-answers")
    teacher.press_tool("stop")
    teacher.wait_for_state("idle")


def _listens(teacher: Newcomer) -> bool:
    """Whether the node of the gestures hears the phone."""
    return any(
        isinstance(one, m.NodeState) and one.type == "perceptual" and "listens" in one.description
        for one in teacher.messages
    )
