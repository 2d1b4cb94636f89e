"""The benchmark of the plots: its goals are those of the design, and a missing curve is told."""

import pytest
from PySide6.QtWidgets import QApplication

from benchmarks import _sensors_child, sensors
from benchmarks.__main__ import benchmark_names, complete
from nep_studio.ui.plugins.sensors.feed import SensorFeed
from nep_studio.ui.theme.look import Look

pytestmark = pytest.mark.qt_log_ignore("This plugin does not support")

FIGURES = {"share": 12.0, "frames": 62.0, "reference share": 100.0}


def test_the_benchmark_is_registered() -> None:
    assert "sensors" in benchmark_names(sensors_folder())


def sensors_folder():
    from benchmarks import __main__ as runner

    return runner.FOLDER


@pytest.mark.parametrize(
    ("change", "is_ok"),
    [
        ({}, True),
        ({"share": 26.0}, False),
        ({"frames": 30.0}, False),
        ({"reference share": 40.0}, False),
    ],
)
def test_a_missed_goal_is_told(change: dict[str, float], is_ok: bool) -> None:
    rows = [complete(row) for row in sensors.drawing(FIGURES | change, "sensors")]

    assert all(row["ok"] for row in rows) is is_ok


def test_curves_that_are_not_drawn_are_no_success(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch
) -> None:
    feed = SensorFeed(_sensors_child.NoTaps())
    look = Look(qapp, "light")
    plots = _sensors_child.plots_of(feed, look)
    plots.draw()

    _sensors_child.check_curves(plots)

    monkeypatch.setattr("nep_studio.ui.plugins.sensors.curves_view.lines", lambda *_: [])
    plots.resize(900, 300)
    plots.draw()
    with pytest.raises(RuntimeError, match="is not drawn"):
        _sensors_child.check_curves(plots)
    plots.hide()
    plots.deleteLater()
    look.deleteLater()
