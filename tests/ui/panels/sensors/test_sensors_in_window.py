"""The page Sensors in the real window: opened late, kept when the language changes."""

import subprocess
import sys
from collections.abc import Iterator

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.run.plan import PlannedNode
from nep_studio.ui.plugins.sensors import SensorsPanel
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.words import tr
from tests.ui.window.conftest import chooser, home, karate, studio, window

pytestmark = pytest.mark.long

__all__ = ["chooser", "home", "karate", "studio", "window"]

NODE_START_MS = 20_000


def panel_of(window: MainWindow) -> SensorsPanel:
    return window.workbench.findChild(SensorsPanel)


@pytest.fixture
def opened(karate: MainWindow, qtbot: QtBot) -> Iterator[MainWindow]:
    karate.workbench.panels.show(panel_of(karate))
    yield karate
    karate.running.close()


def test_the_panel_loads_nothing_slow_before_it_is_shown() -> None:
    code = (
        "import sys; import nep_studio.ui.plugins.sensors; "
        "sys.exit('numpy' in sys.modules or 'pyqtgraph' in sys.modules)"
    )

    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_the_panel_is_hidden_at_first_and_its_place_has_room(
    karate: MainWindow, qtbot: QtBot
) -> None:
    panel = panel_of(karate)
    assert panel.page is None

    karate.workbench.panels.show(panel)

    assert panel.page is not None
    qtbot.waitUntil(panel.page.empty.isVisible)
    assert panel.height() >= 0.7 * karate.workbench.height()
    assert panel.width() >= 0.6 * karate.workbench.width()
    karate.running.close()


def test_what_was_heard_stays_when_the_language_changes(opened: MainWindow, qtbot: QtBot) -> None:
    workspace = panel_of(opened).opened()
    workspace.start_watch()
    qtbot.waitUntil(lambda: bool(workspace.plots.rows), timeout=NODE_START_MS)
    workspace.record()

    opened.studio.choose_language("de")

    titles = [row.row.title for row in workspace.plots.rows]
    assert titles == [tr("Acceleration"), tr("Gyroscope")] != ["Acceleration", "Gyroscope"]
    assert workspace.record_bar.isVisible()
    recorder = workspace.recorder
    samples = recorder.samples
    qtbot.waitUntil(lambda: recorder.samples > samples + 20)
    recorder.stop()
    qtbot.waitUntil(lambda: not recorder.is_recording)


def test_a_topic_is_plotted_from_elsewhere_in_the_window(opened: MainWindow, qtbot: QtBot) -> None:
    panel = panel_of(opened)
    opened.running.runner.start_node(PlannedNode("sensory/virtual_watch", "virtual_watch", {}))

    opened.host.ask("sensors.plot", "/node_state", "pid")

    assert panel.isVisible()
    plots = panel.opened().plots
    titles = lambda: [row.row.title for row in plots.rows]  # noqa: E731 - said in one place
    qtbot.waitUntil(lambda: "pid" in titles(), timeout=NODE_START_MS)
