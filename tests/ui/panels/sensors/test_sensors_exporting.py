"""Keeping what is shown: recordings that can be replayed, numbers, pictures."""

import time
from pathlib import Path

import pytest
from PySide6.QtGui import QImage

from nep_core.errors import RecordingError
from nep_studio.ui.plugins.sensors.feed import Field
from nep_studio.ui.plugins.sensors.plots import Plots
from nep_studio.ui.plugins.sensors.workspace import export_csv, export_picture
from nep_studio.ui.running.runner import Heard
from nodes.recordings import read_recording
from tests.ui.panels.sensors.conftest import hear

pytestmark = pytest.mark.long


def test_what_is_shown_is_exported_as_a_recording(plots: Plots, tmp_path: Path) -> None:
    hear(plots.feed, 2.0, source="phone")
    plots.set_view(plots.view.with_length(3.0))
    plots.pause()

    paths = export_csv(tmp_path / "shown.csv", plots)

    watch, phone = map(read_recording, paths)
    assert [path.name for path in paths] == ["shown.csv", "shown_2.csv"]
    assert 1.5 < watch.t[-1] < 3.05
    assert watch.acc[:, 2] == pytest.approx(9.8)
    assert watch.gyr is not None
    assert watch.rate_hz == pytest.approx(50, rel=0.1)
    assert 1.5 < phone.t[-1] < 2.05


def test_a_number_is_exported_with_its_times(plots: Plots, tmp_path: Path) -> None:
    for key in plots.curves:
        plots.set_hidden(key, True)
    plots.feed.plot(Field("/a", "b"))
    for at in range(3):
        heard = Heard(time.time() - 1 + at / 10, {"b": at / 4}, "node")
        plots.feed.hear_field("/a", [heard])

    [path] = export_csv(tmp_path / "b.csv", plots)

    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[:3] == ["# topic: /a", "# sender: node", "t_s,b"]
    assert [line.partition(",")[2] for line in lines[3:]] == ["0", "0.25", "0.5"]


def test_an_empty_time_is_not_exported(plots: Plots, tmp_path: Path) -> None:
    plots.feed.streams.clear()
    plots.feed.streams_changed.emit()

    with pytest.raises(RecordingError, match="too few samples"):
        export_csv(tmp_path / "nothing.csv", plots)


def test_a_picture_is_twice_as_sharp(plots: Plots, tmp_path: Path) -> None:
    export_picture(tmp_path / "plots.png", plots)

    image = QImage(str(tmp_path / "plots.png"))
    assert image.size() == plots.size() * 2
    with pytest.raises(RecordingError):
        export_picture(tmp_path / "nowhere" / "plots.png", plots)
