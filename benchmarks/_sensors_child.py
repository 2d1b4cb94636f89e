"""Measures the plots of sensors in a process of its own, and a plain use of pyqtgraph."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable

import numpy as np
import psutil
import pyqtgraph
from PySide6.QtCore import QEventLoop, QObject, Qt, QTimer
from PySide6.QtGui import QFontMetricsF
from PySide6.QtWidgets import QApplication, QWidget

from nep_core.wire.messages import IMU, Imu
from nep_studio.ui.plugins.sensors.feed import SensorFeed
from nep_studio.ui.plugins.sensors.measuring import TimeView
from nep_studio.ui.plugins.sensors.plots import Plots
from nep_studio.ui.plugins.sensors.streams import MAGNITUDE, ImuStream, StreamKey
from nep_studio.ui.running.runner import Heard, Tap
from nep_studio.ui.theme.look import Look, load_fonts

RATE_HZ = 1000
WINDOW_S = 30.0
SIZE = (1200, 420)
BATCH_MS = 30
MEASURED_S = 6.0
HIDDEN_S = 3.0
HOURS = 2.0
FRAMES_OF_REFERENCE = 25


class NoTaps(QObject):
    """Hears nothing: the batches are given by hand."""

    def tap(
        self, topic: str, *, kind: type | None = None, most: int = 2000, parent: QObject
    ) -> Tap:
        return Tap(topic, kind, most=most, parent=parent)


class Watch:
    """A sensor whose clock is the wall's: six numbers, waves with noise."""

    def __init__(self, first_s: float) -> None:
        self.t = first_s
        self._noise = np.random.default_rng(7)

    def batch(self, until_s: float) -> Imu:
        count = max(0, int((until_s - self.t) * RATE_HZ))
        t = self.t + np.arange(count) / RATE_HZ
        self.t += count / RATE_HZ
        waves = np.sin(np.outer(t % 100, (9.0, 6.0, 3.0, 12.0, 5.0, 2.0)))
        rows = waves * 4 + self._noise.normal(0, 0.3, (count, 6))
        acc, gyr = rows[:, :3].tolist(), rows[:, 3:].tolist()
        return Imu(source="watch", rate_hz=RATE_HZ, t=t.tolist(), acc=acc, gyr=gyr)


def run_for(seconds: float) -> None:
    loop = QEventLoop()
    QTimer.singleShot(round(seconds * 1000), loop, loop.quit)
    loop.exec()


def share_of(seconds: float) -> float:
    """Percent of one core that this process takes from now on."""
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    run_for(seconds)
    return 100 * (time.process_time() - cpu_s) / (time.perf_counter() - wall_s)


def plots_of(feed: SensorFeed, look: Look) -> Plots:
    """The plots with six curves over 30 s, filled."""
    plots = Plots(feed, look)
    plots.resize(*SIZE)
    plots.show()
    watch = Watch(time.time() - WINDOW_S - 1)
    while watch.t < time.time() - 0.01:
        end_s = min(watch.t + 0.03, time.time())
        message = watch.batch(end_s)
        hear_at(feed, message, end_s)
    for key, curve in plots.curves.items():
        plots.set_hidden(key, curve.name == MAGNITUDE)
    plots.set_view(TimeView(WINDOW_S))
    beat = QTimer(plots, interval=BATCH_MS, timerType=Qt.TimerType.PreciseTimer)
    beat.timeout.connect(lambda: feed.hear_imu([Heard(time.time(), watch.batch(time.time()), "")]))
    beat.start()
    return plots


def hear_at(feed: SensorFeed, message: Imu, arrived_s: float) -> None:
    """Let a batch have come earlier."""
    key = StreamKey(IMU, "watch")
    if key not in feed.streams:
        feed.hear_imu([Heard(arrived_s, message, "")])
        feed.streams[key] = ImuStream(key)
    stream = feed.streams[key]
    if isinstance(stream, ImuStream):
        stream.hear(message, arrived_s)


def frames_of(plots: Plots) -> Callable[[], int]:
    """Counts how often the curves are painted."""
    view = plots.rows[0].view
    before = type(view).paintEvent
    count = [0]

    def paint(self: QWidget, event: object) -> None:
        count[0] += self is view
        before(self, event)  # type: ignore[arg-type]

    type(view).paintEvent = paint  # type: ignore[method-assign]
    return lambda: count[0]


def check_curves(plots: Plots) -> None:
    """See that all curves are there, from side to side: what is not drawn costs nothing."""
    for row in plots.rows:
        image = row.view.grab().toImage()
        for curve in row.row.curves:
            if curve.key in plots.hidden:
                continue
            colour = curve.look.pen(plots.look.theme, QFontMetricsF(plots.font())).color()
            middle = image.width() // 2
            for first, last in ((0, middle), (middle, image.width())):
                places = ((x, y) for x in range(first, last) for y in range(image.height()))
                if not any(image.pixelColor(x, y) == colour for x, y in places):
                    raise RuntimeError(f"The curve {curve.name} of {row.row.title} is not drawn.")


def live(look: Look) -> dict[str, float]:
    """What it costs to draw, and to be hidden."""
    feed = SensorFeed(NoTaps())
    plots = plots_of(feed, look)
    counted = frames_of(plots)
    run_for(0.5)
    frames, wall_s = counted(), time.perf_counter()
    share = share_of(MEASURED_S)
    frames_hz = (counted() - frames) / (time.perf_counter() - wall_s)
    check_curves(plots)
    samples = feed.streams[StreamKey(IMU, "watch")].total
    plots.hide()
    for beat in plots.findChildren(QTimer, options=Qt.FindChildOption.FindDirectChildrenOnly):
        if beat.interval() == BATCH_MS:
            beat.stop()  # the feed hears nothing while nobody watches
    run_for(0.3)
    hidden = share_of(HIDDEN_S)
    return {"share": share, "frames": frames_hz, "hidden": hidden, "samples": samples}


def reference() -> dict[str, float]:
    """The same curves as pyqtgraph draws them when it is given all samples at each frame."""
    window = pyqtgraph.GraphicsLayoutWidget()
    window.resize(*SIZE)
    curves = []
    for row in range(2):
        plot = window.addPlot(row=row, col=0)
        plot.setXRange(-WINDOW_S, 0, padding=0)
        plot.setYRange(-6, 6)
        curves += [plot.plot(pen=number) for number in range(3)]
    window.show()
    QApplication.processEvents()
    count = round(WINDOW_S * RATE_HZ)
    t = np.linspace(-WINDOW_S, 0, count)
    noise = np.random.default_rng(7).normal(0, 0.3, count)
    cpu_s = time.process_time()
    for frame in range(FRAMES_OF_REFERENCE):
        for number, curve in enumerate(curves):
            curve.setData(t, 4 * np.sin((t + frame / 60) * (number + 2)) + noise)
        QApplication.processEvents()
    frame_ms = 1000 * (time.process_time() - cpu_s) / FRAMES_OF_REFERENCE
    window.close()
    return {"reference share": frame_ms * 60 / 10}


def memory() -> dict[str, float]:
    """How much more memory there is after hours than after the first minutes, in MB."""
    feed = SensorFeed(NoTaps())
    key = StreamKey(IMU, "watch")
    stream = feed.streams[key] = ImuStream(key)
    now_s, watch, process = time.time(), Watch(0.0), psutil.Process()
    first_mb = 0.0
    while watch.t < HOURS * 3600:
        stream.hear(watch.batch(watch.t + 0.5), now_s + watch.t)
        if not first_mb and stream.total > 2.2 * 100_000:
            first_mb = process.memory_info().rss / 1e6
    grown_mb = process.memory_info().rss / 1e6 - first_mb
    return {"grown": grown_mb, "kept": stream.size_bytes / 1e6, "heard": float(stream.total)}


def main() -> None:
    app = QApplication([])
    load_fonts()
    found = reference() | live(Look(app, "light"))
    if "memory" in sys.argv:
        found |= memory()
    print(json.dumps(found))


if __name__ == "__main__":
    main()
