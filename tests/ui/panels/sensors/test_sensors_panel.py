"""The page Sensors with real nodes: a watch, a recording that is made and played, a robot."""

import csv
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QMainWindow
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, RobotState
from nep_studio.ui.messages import Message, Messages
from nep_studio.ui.network_feed import NetworkFeed
from nep_studio.ui.plugins.sensors import SensorsPanel
from nep_studio.ui.plugins.sensors.feed import SensorFeed
from nep_studio.ui.plugins.sensors.recorder import Recorder
from nep_studio.ui.plugins.sensors.workspace import Workspace
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.look import Look

pytestmark = pytest.mark.long

NODE_START_MS = 20_000


class Told:
    """Keeps the messages."""

    def __init__(self) -> None:
        self.messages: list[Message] = []

    def show_message(self, message: Message) -> None:
        self.messages.append(message)

    def withdraw(self, message: Message) -> None:
        self.messages.remove(message)

    def clear_passing(self) -> None:
        pass


@pytest.fixture
def host(qtbot: QtBot) -> QMainWindow:
    made = QMainWindow()
    qtbot.addWidget(made)
    made.resize(900, 400)
    return made


@pytest.fixture
def told() -> Told:
    return Told()


@pytest.fixture
def runner(host: QMainWindow, tmp_path: Path) -> Iterator[Runner]:
    made = Runner(lambda: [], host, logs=tmp_path / "logs")
    yield made
    made.close()


@pytest.fixture
def panel(
    host: QMainWindow, runner: Runner, told: Told, look: Look, tmp_path: Path, qtbot: QtBot
) -> Iterator[SensorsPanel]:
    messages = Messages(host)
    messages.show_in(told)
    feed = SensorFeed(runner, host)
    recorder = Recorder(feed)

    def make() -> Workspace:
        network = NetworkFeed(lambda: runner.local.network, host)
        return Workspace(
            feed, recorder, network, runner, messages, look, lambda: tmp_path / "recordings"
        )

    made = SensorsPanel(make)
    host.setCentralWidget(made)
    host.show()
    qtbot.waitExposed(host)
    yield made
    recorder.finish()
    made.hide()


@pytest.fixture
def watch(panel: SensorsPanel, qtbot: QtBot) -> Workspace:
    """The panel while a virtual watch is worn."""
    workspace = panel.opened()
    qtbot.mouseClick(workspace.empty.watch_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(workspace.plots.rows), timeout=NODE_START_MS)
    return workspace


def test_a_closed_panel_has_loaded_nothing(qtbot: QtBot) -> None:
    panel = SensorsPanel(lambda: pytest.fail("made too early"))
    qtbot.addWidget(panel)

    assert panel.page is None
    assert panel.sizeHint().height() > 0


def test_an_empty_panel_says_what_belongs_there(panel: SensorsPanel) -> None:
    workspace = panel.opened()

    assert workspace.pages.currentWidget() is workspace.empty
    assert workspace.empty.watch_button.isVisible()
    assert not workspace.tools.by_name["measure"].isEnabled()


def test_the_watch_is_recorded_and_played_again(
    watch: Workspace, told: Told, runner: Runner, qtbot: QtBot
) -> None:
    qtbot.waitUntil(lambda: runner.board.nodes["virtual_watch"].is_there)
    watch.tools.by_name["record"].trigger()
    qtbot.waitUntil(lambda: watch.recorder.samples > 30)
    assert watch.record_bar.isVisible()
    assert watch.record_bar.words.words.startswith("Recording 0:")
    with qtbot.waitSignal(watch.recorder.stopped) as stopped:
        qtbot.mouseClick(watch.record_bar.stop_button, Qt.MouseButton.LeftButton)
    [[path]] = stopped.args
    runner.stop_node("virtual_watch")

    assert told.messages[-1].title == f"“{path.name}” is kept"
    told.messages[-1].answers[0].do()

    sources = lambda: {key.sender for key in watch.feed.streams}  # noqa: E731 - said twice
    qtbot.waitUntil(lambda: watch.replay_bar.is_playing, timeout=NODE_START_MS)
    qtbot.waitUntil(lambda: path.stem in sources(), timeout=NODE_START_MS)
    qtbot.waitUntil(lambda: not watch.replay_bar.is_playing, timeout=NODE_START_MS)


def test_a_recording_goes_on_while_the_panel_is_hidden(
    watch: Workspace, panel: SensorsPanel, qtbot: QtBot
) -> None:
    watch.tools.by_name["record"].trigger()

    panel.hide()

    assert watch.feed.topics_heard == [IMU]
    assert not watch.plots.is_drawing
    before = watch.recorder.samples
    qtbot.waitUntil(lambda: watch.recorder.samples > before + 20)
    watch.recorder.stop()
    qtbot.waitUntil(lambda: not watch.recorder.is_recording)
    assert watch.feed.topics_heard == []


def test_a_folder_that_cannot_be_written_is_told_with_a_way_out(
    panel: SensorsPanel, told: Told, tmp_path: Path
) -> None:
    (tmp_path / "recordings").write_text("a file is in the way")

    panel.opened().tools.by_name["record"].trigger()

    [message] = told.messages
    assert message.kind == "error"
    assert message.checklist
    assert message.answers[0].words == "Choose a folder…"
    assert not panel.opened().recorder.is_recording


def test_a_gesture_that_fires_is_marked(watch: Workspace, runner: Runner, qtbot: QtBot) -> None:
    state = HumanBehavior(human_state="gesture_karate", certainty=0.93)

    def is_marked() -> bool:
        runner.send(HUMAN_BEHAVIOR, state)
        return bool(watch.feed.marks)

    qtbot.waitUntil(is_marked)

    mark = watch.feed.marks[-1]
    assert mark.words == "karate 93 %"
    assert abs(mark.time_s - time.time()) < 2


def test_any_number_of_the_network_is_plotted(
    watch: Workspace, runner: Runner, qtbot: QtBot
) -> None:
    watch.show_field("/robot_state", "")
    state = RobotState(robot="nao", joints={"HeadYaw": 0.25})
    runner.send("/robot_state", state)
    model = watch.chooser.model
    qtbot.waitUntil(lambda: bool(model.findItems("/robot_state")), timeout=NODE_START_MS)
    [topic] = model.findItems("/robot_state")
    paths = [topic.child(row).text() for row in range(topic.rowCount())]

    topic.child(paths.index("joints.HeadYaw")).setCheckState(Qt.CheckState.Checked)

    def is_plotted() -> bool:
        runner.send("/robot_state", state)
        return len(watch.plots.rows) == 3

    qtbot.waitUntil(is_plotted)
    assert watch.plots.rows[2].row.source == "nao"
    watch.chooser.close()


def test_what_is_shown_is_kept_by_the_menu(watch: Workspace, told: Told, tmp_path: Path) -> None:
    watch.plots.pause()

    watch.export_picture(tmp_path / "plots.png")
    watch.export_numbers(tmp_path / "plots.csv")

    with (tmp_path / "plots.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if not row[0].startswith("#")]
    assert rows[0] == ["t_s", "ax", "ay", "az", "gx", "gy", "gz"]
    assert (tmp_path / "plots.png").stat().st_size > 1000
    assert [message.kind for message in told.messages] == ["success", "success"]


def test_all_words_have_room_at_double_size(
    watch: Workspace, look: Look, qapp: QApplication
) -> None:
    look.set_scale(2.0)

    watch.tools.by_name["measure"].trigger()
    qapp.processEvents()

    assert watch.plots.width() >= watch.split.width() // 3
    row = watch.plots.rows[0]
    assert row.view.height() > row.view.fontMetrics().height()
    look.set_scale(1.0)
