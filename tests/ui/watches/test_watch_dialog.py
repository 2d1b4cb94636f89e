"""The dialog that connects a watch or phone, with a node that really runs and a real sender."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from nep_core.errors import NodeStartError
from nep_core.launcher import LaunchedNode
from nep_core.messages import Imu, NodeState
from nep_studio.blocks.deployment import node_entries
from nep_studio.plan import PlannedNode
from nep_studio.ui.main_window import MainWindow
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.running.tap import Heard
from nep_studio.ui.theme import Look, themes
from nep_studio.ui.watches import dialog as dialog_module
from nep_studio.ui.watches.choosing import offers
from nep_studio.ui.watches.dialog import Plan, WatchDialog
from nep_studio.ui.watches.ways import WAYS
from nodes.sensory.phone_page.server import page_urls
from nodes.sensory.ways import WAYS as WAYS_OF_THE_NODE
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

ADDRESS, TOKEN = "192.168.1.23", "abcDEF123456"

SENDER = """
import socket, sys, time
door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for n in range(100_000):
    swing = 8.0 if n // 10 % 2 else 0.0
    line = f"{n * 20},{swing},0.1,9.8\\n"
    door.sendto(line.encode(), ("127.0.0.1", int(sys.argv[1])))
    time.sleep(0.02)
"""


class RecordingRunner(Runner):
    """Notes which nodes are to run, and runs none."""

    def __init__(self, owner: QObject, logs: Path) -> None:
        super().__init__(list, owner, logs=logs)
        self.asked: list[tuple[str, object]] = []

    def start_node(self, planned: PlannedNode) -> None:
        self.asked.append(("start", planned))
        self.local.planned[planned.name] = planned

    def stop_node(self, name: str) -> None:
        self.asked.append(("stop", name))

    @property
    def started(self) -> list[PlannedNode]:
        return [what for verb, what in self.asked if isinstance(what, PlannedNode)]

    def tell(self, event: str, description: str = "", pid: int = 7, **measures: float) -> None:
        """What the node would tell."""
        state = NodeState(
            node="watch",
            type="sensory",
            event=event,
            description=description,
            pid=pid,
            measures=measures,
        )
        self.board.update(state)
        self.nodes_changed.emit(["watch"])


@pytest.fixture
def runner(qapp: QApplication, tmp_path: Path) -> Iterator[RecordingRunner]:
    owner = QObject()
    made = RecordingRunner(owner, tmp_path)
    yield made
    made.close()


@pytest.fixture(autouse=True)
def settles_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dialog_module, "SETTLE_MS", 0)


Open = Callable[..., WatchDialog]


@pytest.fixture
def open_dialog(runner: RecordingRunner, qapp: QApplication, qtbot: QtBot) -> Iterator[Open]:
    made: list[WatchDialog] = []

    def make(plan: Plan | None = None, addresses: tuple[str, ...] = (ADDRESS,)) -> WatchDialog:
        look = Look(qapp, "light")
        one = WatchDialog(runner, plan or Plan("watch"), TOKEN, look, None, lambda: addresses)
        one.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
        qtbot.addWidget(one)
        one.begin()
        made.append(one)
        return one

    yield make
    for one in made:
        one.close()


def press(qtbot: QtBot, button) -> None:
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def choose(dialog: WatchDialog, way: str, qtbot: QtBot) -> None:
    """Click the card of a way, and the app in the list if it is one of several."""
    cards = dialog.choosing.cards
    press(qtbot, cards[way] if way in cards else cards["sensor_logger"])
    if way not in cards:
        app = dialog.page.app
        app.setCurrentIndex(app.findData(way))
        app.activated.emit(app.currentIndex())
    qtbot.waitUntil(lambda: not dialog._settling.isActive())


def send(dialog: WatchDialog, *, moves: bool) -> None:
    acc = [(0.0, 0.0, 9.8), (8.0 if moves else 0.1, 0.0, 9.8)]
    message = Imu(source="192.168.1.7", rate_hz=50.0, t=[1.0, 1.02], acc=acc)
    dialog.ear.hear([Heard(time.time(), message, "watch")])
    dialog._update()


def test_it_asks_what_one_has_the_easiest_first(open_dialog: Open) -> None:
    dialog = open_dialog()

    ways = [one.way for one in offers()]

    assert ways == list(dialog.choosing.cards)
    assert ways[:2] == ["phone_page", "sensor_logger"]
    assert not dialog.isModal()
    assert dialog.focusWidget() is dialog.choosing.cards["phone_page"]
    assert not dialog.use_button.isVisible()


def test_every_way_of_the_node_can_be_reached_and_has_its_usual_port() -> None:
    for name, kind in WAYS_OF_THE_NODE.items():
        assert name in WAYS
        assert not WAYS[name].listens or WAYS[name].port == kind.port
        assert WAYS[name].asks_address == kind.needs_address


@pytest.mark.parametrize("way", WAYS)
def test_the_steps_of_every_way_fit_in_plain_words(
    way: str, open_dialog: Open, qtbot: QtBot
) -> None:
    dialog = open_dialog()

    choose(dialog, way, qtbot)

    steps = dialog.page.steps
    assert 1 <= len(steps.words) <= 4
    assert all(label.text() for label in steps.words)
    if WAYS[way].listens:
        copied = "".join(line.text.text() for line in steps.copy_lines if line is not None)
        assert ADDRESS in copied


def test_the_code_of_the_phone_page_is_shown_once_the_network_is_let_in(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "phone_page", qtbot)
    page = dialog.page
    assert not page.qr_code.isVisible()
    assert runner.started[-1].parameters["listen_on"] == "this computer"
    runner.tell("ready", "waits for a phone")

    press_switch(page.network.switch, qtbot)

    qtbot.waitUntil(lambda: len(runner.started) == 2)
    assert page.qr_code.isVisible()
    [url] = page_urls(8443, TOKEN, [ADDRESS])
    assert page.qr_code.accessibleName() == url
    assert dict(runner.started[-1].parameters) == {
        "through": "phone_page",
        "port": 8443,
        "listen_on": "network",
        "token": TOKEN,
    }
    runner.tell("ready", "waits for a phone", pid=8)
    send(dialog, moves=False)
    assert not page.qr_code.isVisible()  # it is not needed while the phone sends


def press_switch(switch, qtbot: QtBot) -> None:
    place = switch.rect().center()
    place.setX(switch.fontMetrics().height() // 2)
    qtbot.mouseClick(switch, Qt.MouseButton.LeftButton, pos=place)


def test_the_address_is_copied_with_one_press(open_dialog: Open, qtbot: QtBot) -> None:
    dialog = open_dialog()
    choose(dialog, "sensor_logger", qtbot)
    [line] = [one for one in dialog.page.steps.copy_lines if one is not None]

    press(qtbot, line.button)

    assert QGuiApplication.clipboard().text() == f"http://{ADDRESS}:8000/data"
    assert line.button.text() == "Copied"


def test_another_port_and_columns_of_ones_own_reach_the_node(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")
    page = dialog.page
    page.more.toggle.click()

    page.more.port.setValue(9001)
    page.more.columns.setText("t,ax,ay,az")
    page.more.columns.editingFinished.emit()

    qtbot.waitUntil(lambda: runner.started[-1].parameters.get("columns") == "t,ax,ay,az")
    assert runner.started[-1].parameters["port"] == 9001
    assert page.steps.copy_lines[3].text.text() == "9001"


def test_where_it_is_worn_is_asked_and_told_to_the_node(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "paper_watch", qtbot)
    assert runner.started[-1].parameters["wrist"] == "left"
    runner.tell("ready")

    dialog.page.worn.buttons["right"].click()

    qtbot.waitUntil(lambda: runner.started[-1].parameters["wrist"] == "right")


def test_nothing_is_started_until_the_address_of_the_app_is_written(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "phyphox", qtbot)
    assert runner.started == []
    assert dialog.page.live.title.text() == "Something is still missing"

    qtbot.keyClicks(dialog.page.address, "192.168.1.44:8080")
    qtbot.keyClick(dialog.page.address, Qt.Key.Key_Return)

    qtbot.waitUntil(lambda: runner.started != [])
    assert runner.started[-1].parameters["address"] == "192.168.1.44:8080"


def test_a_movement_turns_the_dot_green_and_the_numbers_are_told(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    live = dialog.page.live
    assert live.dot.state == "waiting"
    assert not dialog.use_button.isEnabled()

    runner.tell("ready", "waits for a watch on UDP port 8085")
    assert dialog.use_button.isEnabled()
    send(dialog, moves=False)
    assert (live.dot.state, live.title.text()) == ("still", "It sends. Now move it")
    told = "192.168.1.7 sends 50 samples a second; reads t, ax, ay, az"
    runner.tell("connected", told, rate_hz=49.8, loss=0.2, drift_ppm=12.0, gaps=1, delay_ms=38)
    send(dialog, moves=True)

    assert (live.dot.state, live.title.text()) == ("moved", "It moves: all is well")
    assert live.understood.text() == told
    numbers = [row[2].text() for row in live.rows]
    assert numbers == ["50 a second", "20 %", "1", "38 ms", "+0.04 s an hour"]
    assert live.curve.isVisible()


def test_after_ten_silent_seconds_it_says_what_to_look_at(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")
    dialog._update()
    assert not dialog.page.live.advice_card.isVisible()

    dialog._waiting_since_s -= 11
    dialog._update()

    advice = dialog.page.live.advice.text()
    assert dialog.page.live.advice_card.isVisible()
    assert "“Let this network in” is off" in advice
    assert f"{ADDRESS}:8085" in advice
    assert "firewall" in advice and "UDP port 8085" in advice
    assert "same Wi-Fi" in advice


def test_a_computer_in_no_network_says_so_and_looks_again(open_dialog: Open, qtbot: QtBot) -> None:
    dialog = open_dialog(addresses=())
    choose(dialog, "phone_page", qtbot)
    network = dialog.page.network
    assert network.missing.isVisible()
    dialog._find_addresses = lambda: [ADDRESS]

    press(qtbot, network.again)

    assert not network.missing.isVisible()
    assert network.address == ADDRESS


def test_a_node_that_cannot_start_is_told_with_what_to_try(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)

    sentence = "UDP port 8085 cannot be opened: address already in use."
    runner.node_failed.emit("watch", NodeStartError(sentence, checklist=("Choose another port.",)))

    assert dialog.page.live.dot.state == "failed"
    assert dialog.page.live.sentence.text() == sentence
    assert "Choose another port." in dialog.page.live.advice.text()
    assert not dialog.use_button.isEnabled()


def test_closing_it_stops_the_watch_that_is_not_used(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")

    press(qtbot, dialog.close_button)

    assert runner.asked[-1] == ("stop", "watch")


def test_closed_while_the_node_starts_it_is_stopped_as_soon_as_it_is_there(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)

    dialog.close()
    assert [verb for verb, _ in runner.asked] == ["start"]
    runner.tell("ready")

    assert runner.asked[-1] == ("stop", "watch")


def test_a_watch_that_ran_before_comes_back_when_another_is_not_used(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    before = PlannedNode("sensory/smartwatch", "watch", {"through": "tcp", "port": 8086})
    runner.local.planned["watch"] = before
    runner.local.launcher.nodes["watch"] = LaunchedNode("watch", None, [])
    runner.tell("connected", pid=3)
    dialog = open_dialog(Plan("watch", before.parameters))
    assert dialog.page.way.name == "tcp"  # what is used is shown at once
    choose_other(dialog, "udp", qtbot)
    runner.tell("ready", pid=8)
    assert runner.started[-1].parameters["through"] == "udp"

    press(qtbot, dialog.close_button)

    assert runner.asked[-1] == ("start", before)
    assert runner.told_elsewhere == set()


def choose_other(dialog: WatchDialog, way: str, qtbot: QtBot) -> None:
    press(qtbot, dialog.back_button)
    choose(dialog, way, qtbot)


def test_a_code_is_drawn_in_whole_pixels_black_on_white(qtbot: QtBot, qapp: QApplication) -> None:
    from nep_studio.ui.watches.qr_code import QUIET, QrCode, modules_of

    Look(qapp, "dark")
    code = QrCode()
    qtbot.addWidget(code)
    url = page_urls(8443, TOKEN, [ADDRESS])[0]
    code.show_url(url)
    code.resize(233, 240)
    code.show()

    image = code.grab().toImage()

    modules = modules_of(url)
    module = code.module_pixels()
    side = (len(modules) + 2 * QUIET) * module
    left, top = (image.width() - side) // 2, (image.height() - side) // 2
    colours = {image.pixelColor(left + x, top + y).name() for x in range(side) for y in range(side)}
    assert colours == {"#000000", "#ffffff"}
    for y, row in enumerate(modules, QUIET):
        for x, is_dark in enumerate(row, QUIET):
            middle = image.pixelColor(left + x * module + 1, top + y * module + 1).name()
            assert middle == ("#000000" if is_dark else "#ffffff")
    Look(qapp, "light")


@pytest.mark.parametrize("theme", themes())
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_no_button_of_it_is_cut_off_in_any_look(
    qtbot: QtBot, qapp: QApplication, runner: RecordingRunner, theme: str, scale: float
) -> None:
    look = Look(qapp, theme, scale)
    made = WatchDialog(runner, Plan("watch"), TOKEN, look, None, lambda: [ADDRESS])
    qtbot.addWidget(made)
    made.begin()
    made.show_way("udp")
    QApplication.processEvents()

    shown = [one for one in made.findChildren(QPushButton) if one.isVisible()]

    assert len(shown) >= 4
    for button in shown:
        assert button.width() >= button.fontMetrics().horizontalAdvance(button.text())
    for label in made.page.findChildren(QLabel):
        if label.isVisible() and label.wordWrap():
            assert label.height() >= label.heightForWidth(label.width()) - 1, label.text()
    made.close()
    Look(qapp, "light")


# In the window, with real processes


def watches(window: MainWindow):
    editor = window.workbench.canvas.editor
    return [
        one
        for one in node_entries(editor.project, editor.language)
        if one.node == "sensory/smartwatch"
    ]


@pytest.fixture
def sender(free_port: int) -> Iterator[int]:
    """A process that sends lines to a port, as an app on a phone does."""
    process = subprocess.Popen([sys.executable, "-c", SENDER, str(free_port)])
    yield free_port
    process.kill()
    process.wait()


def test_a_watch_is_connected_moved_and_used_and_run_takes_it_over(
    karate: MainWindow, sender: int, qtbot: QtBot
) -> None:
    kit = karate.actions_by_name["connect_watch"]
    kit.trigger()
    dialog = karate.findChild(WatchDialog)
    choose(dialog, "udp", qtbot)
    dialog.page.more.port.setValue(sender)
    runner = karate.running.runner

    qtbot.waitUntil(lambda: dialog.page.live.dot.state == "moved")
    qtbot.waitUntil(lambda: dialog.ear.flow.rate_hz > 20)
    qtbot.waitUntil(dialog.use_button.isEnabled)
    launched = runner.local.launcher.nodes["watch"]
    pid = launched.pid
    assert "t (ms), ax, ay, az (m/s²)" in dialog.page.live.understood.text()
    press(qtbot, dialog.use_button)

    [entry] = watches(karate)
    assert entry.name == "watch"
    assert entry.parameters["port"] == sender
    planned = runner.planned()
    assert not any(node.node == "sensory/virtual_watch" for node in planned)
    [watch] = [node for node in planned if node.name == "watch"]
    assert runner.local.planned["watch"] == watch  # so that Run takes it over
    runner.local.start([watch])
    assert runner.local.launcher.nodes["watch"].pid == pid
    karate.workbench.canvas.editor.history.undo()
    assert watches(karate) == []


def test_a_port_that_is_taken_is_told_in_a_sentence(
    karate: MainWindow, free_port: int, qtbot: QtBot
) -> None:
    import socket

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", free_port))
        karate.actions_by_name["connect_watch"].trigger()
        dialog = karate.findChild(WatchDialog)
        choose(dialog, "udp", qtbot)
        dialog.page.more.port.setValue(free_port)

        qtbot.waitUntil(lambda: dialog.page.live.dot.state == "failed")

        opened = f"UDP port {free_port} cannot be opened"
        qtbot.waitUntil(lambda: dialog.page.live.sentence.text().startswith(opened))
        assert "Choose another port" in dialog.page.live.advice.text()
        press(qtbot, dialog.close_button)
        assert watches(karate) == []
        assert [told.message.title for told in karate.messages.history] == []


def test_a_watch_that_is_in_use_is_asked_about(
    karate: MainWindow, qtbot: QtBot, answer: Callable
) -> None:
    from nep_studio.blocks.operations.sensing import use_watch

    editor = karate.workbench.canvas.editor
    use_watch(editor, {"through": "udp", "port": 8085}, "use")
    state = NodeState(node="watch", type="sensory", event="connected", pid=5)
    karate.running.runner.board.update(state)

    karate.actions_by_name["connect_watch"].trigger()
    answer(karate, "Connect another one")

    qtbot.waitUntil(lambda: karate.findChild(WatchDialog) is not None)
    assert karate.findChild(WatchDialog).plan.name == "watch 2"


def test_there_is_one_dialog_and_another_project_closes_it(
    karate: MainWindow, qtbot: QtBot
) -> None:
    action = karate.actions_by_name["connect_watch"]
    action.trigger()
    action.trigger()
    [dialog] = karate.findChildren(WatchDialog)
    assert action in karate.menus["robots"].actions()

    with qtbot.waitSignal(dialog.finished):
        karate.files.new()
