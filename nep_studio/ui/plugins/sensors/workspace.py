"""The panel once it is open: tools, plots, the list of curves, and the files of both ways."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from PySide6.QtCore import QBuffer, QIODevice, QPoint, Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices, QHideEvent, QPixmap, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QLabel, QPushButton, QScrollArea, QSplitter, QStackedWidget, QWidget

from faults.files import whole_file, write_whole
from nep_core.errors import NepError, RecordingError
from nep_core.wire.messages import IMU
from nep_studio.run.plan import VIRTUAL_WATCH, PlannedNode
from nep_studio.ui.labels import labelled
from nep_studio.ui.messages import Answer, Messages
from nep_studio.ui.network_feed import NetworkFeed
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint, plain_label
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import count_words, tr
from nodes.recordings import MAY_WRITE, Recording, write_recording, writing

from .curve_list import CurveList, FieldChooser
from .curves import Curve, CurveKey
from .feed import Field, SensorFeed
from .plots import Plots
from .recorder import RECORDING, RecordBar, Recorder, ReplayBar
from .streams import ImuStream, Samples, StreamKey
from .tools import Hand, Tools

# Keeps what the plots show: as CSV files that can be replayed, and as a picture.

_SHARPNESS = 2.0


def export_csv(path: Path, plots: Plots) -> list[Path]:
    """Write the time that is shown, of each stream with a curve that is shown.

    What a sensor measured is written as a recording, with all its axes; numbers of topics as
    t_s and the number. The first file is called ``path``, the others after it. Raises
    RecordingError; "too few samples" when there is nothing to write.
    """
    shown = [curve for curve in plots.curves.values() if curve.key not in plots.hidden]
    keys = list(dict.fromkeys(curve.key.stream for curve in shown))
    start_s, end_s = plots.shown_s
    written: list[Path] = []
    for key in keys:
        samples = plots.samples(key).between(start_s, end_s)
        kept = np.isfinite(samples.values[0])
        samples = Samples(samples.t[kept], samples.values[:, kept])
        if len(samples.t) >= 2:
            written.append(_named(path, len(written)))
            _write(written[-1], plots, key, samples)
    if not written:
        raise RecordingError(
            "The time that is shown has too few samples to keep.",
            checklist=("Show a time in which something was measured, then export again.",),
        )
    return written


def export_picture(path: Path, widget: QWidget) -> list[Path]:
    """Write a picture of the plots, twice as sharp as a usual screen; raises RecordingError."""
    ratio = max(_SHARPNESS, widget.devicePixelRatioF())
    pixmap = QPixmap(widget.size() * ratio)
    pixmap.setDevicePixelRatio(ratio)
    widget.render(pixmap, QPoint())
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    pixmap.save(buffer, "PNG")
    try:
        write_whole(path, bytes(buffer.data().data()))
    except OSError as error:
        raise RecordingError(
            "The picture {path} cannot be written.", checklist=MAY_WRITE, path=path
        ) from error
    return [path]


def _write(path: Path, plots: Plots, key: StreamKey, samples: Samples) -> None:
    stream = plots.feed.streams.get(key)
    if key.path:
        _write_numbers(path, plots.curves[CurveKey(key, 0)], samples)
        return
    sensor = stream if isinstance(stream, ImuStream) else None
    acc, gyr = samples.values[:3].T, samples.values[4:7].T
    recording = Recording(
        source=key.sender,
        t=samples.t - samples.t[0],
        acc=acc,
        gyr=gyr if np.isfinite(gyr).all() else None,
        labels=None,
        gravity_included=sensor is None or sensor.gravity_included,
        simulated=sensor is not None and sensor.simulated,
    )
    write_recording(path, recording)


def _write_numbers(path: Path, curve: Curve, samples: Samples) -> None:
    """Write a file that spreadsheets read; it is whole or not there."""
    key = curve.key.stream
    lines = [f"# topic: {key.topic}\n# sender: {key.sender}\nt_s,{key.path}\n"]
    times = samples.t - samples.t[0]
    pairs = zip(times, samples.values[0], strict=True)
    lines += [f"{time_s:.6f},{value:.9g}\n" for time_s, value in pairs]
    with writing(path), whole_file(path) as file:
        file.write("".join(lines).encode())


def _named(path: Path, number: int) -> Path:
    return path if number == 0 else path.with_name(f"{path.stem}_{number + 1}{path.suffix}")


# What the panel says while nothing is measured: what belongs there, and the first steps.

_WIDEST_LINES = 30


class EmptyPage(QScrollArea):
    """Offers a watch, a recording, or any number of the network."""

    watch_asked = Signal()
    replay_asked = Signal()
    choose_asked = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setWidgetResizable(True)
        inside, middle = QWidget(), Qt.AlignmentFlag.AlignCenter
        title = plain_label(alignment=middle)
        labelled(title, text="What sensors measure is drawn here as curves.")
        title.setProperty("role", "heading")
        told = hint(
            "Start a simulated watch, play a recording, or connect a watch or phone: "
            "its curves appear by themselves. You can also choose any number that a node sends."
        )
        told.setAlignment(middle)
        self.watch_button = labelled(QPushButton(), text="Start the virtual watch")
        self.watch_button.setProperty("kind", "primary")
        self.replay_button = labelled(QPushButton(), text="Replay a recording…")
        self.choose_button = labelled(QPushButton(), text="Choose numbers…")
        row = in_row(1, self.watch_button, self.replay_button, self.choose_button, 1)
        in_column(1, title, told, row, 1, of=inside)
        self.setWidget(inside)
        self.watch_button.clicked.connect(self.watch_asked)
        self.replay_button.clicked.connect(self.replay_asked)
        self.choose_button.clicked.connect(self.choose_asked)

    def show_starting(self, is_starting: bool) -> None:
        """Say that the watch is on its way."""
        labelled(
            self.watch_button,
            text="The virtual watch starts…" if is_starting else "Start the virtual watch",
        )
        self.watch_button.setEnabled(not is_starting)


WATCH = "virtual_watch"
"""The name of the watch that is started here."""


class Workspace(QWidget):
    """Shows a feed; ``folder`` says where recordings are to be kept."""

    def __init__(
        self,
        feed: SensorFeed,
        recorder: Recorder,
        network: NetworkFeed,
        runner: Runner,
        messages: Messages,
        look: Look,
        folder: Callable[[], Path],
    ) -> None:
        super().__init__()
        self.feed, self.recorder = feed, recorder
        self._runner, self._messages, self._network = runner, messages, network
        self._folder = folder
        self.plots = Plots(feed, look)
        self.hand = Hand(self.plots)
        self.tools = Tools(self.plots, self.hand, recorder, look)
        self.list = CurveList(self.plots, look)
        self.record_bar = RecordBar(recorder, look)
        self.replay_bar = ReplayBar(look)
        self.empty = EmptyPage()
        self.measured = QLabel(wordWrap=True)
        self.measured.hide()
        self.chooser: FieldChooser | None = None
        self._lay_out()
        self._connect()
        self._on_rows_changed()

    def _lay_out(self) -> None:
        side = QWidget()
        line = self.fontMetrics().height()
        self.measured.setContentsMargins(line // 2, line // 4, line // 2, line // 4)
        in_column(self.measured, (self.list, 1), of=side, margins=0)
        self.split = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False)
        self.split.addWidget(self.plots)
        self.split.addWidget(side)
        self.split.setStretchFactor(0, 1)
        self.pages = QStackedWidget()
        self.pages.addWidget(self.empty)
        self.pages.addWidget(self.split)
        bars = (self.tools, self.record_bar, self.replay_bar)
        in_column(*bars, (self.pages, 1), of=self, margins=0, spacing=0)

    def _connect(self) -> None:
        self.plots.rows_changed.connect(self._on_rows_changed)
        self.plots.cursors_changed.connect(self._share_room)
        self.list.measured.connect(self._on_measured)
        self.list.header().sectionCountChanged.connect(lambda *_: self._share_room())
        self.empty.watch_asked.connect(self.start_watch)
        self.empty.replay_asked.connect(self.choose_recording)
        self.empty.choose_asked.connect(self.choose_fields)
        actions = self.tools.by_name
        actions["choose"].triggered.connect(lambda: self.choose_fields())
        actions["record"].triggered.connect(lambda: self.record())
        actions["replay"].triggered.connect(lambda: self.choose_recording())
        actions["csv"].triggered.connect(lambda: self._export("csv"))
        actions["png"].triggered.connect(lambda: self._export("png"))
        self.replay_bar.start_asked.connect(partial(self._runner.start_node, is_wanted=True))
        self.replay_bar.stop_asked.connect(lambda: self._runner.stop_node(RECORDING))
        self._runner.nodes_changed.connect(self._on_nodes_changed)
        self._runner.node_failed.connect(self._on_node_failed)
        self.recorder.failed.connect(self._on_recording_failed)
        self.recorder.stopped.connect(self._on_recording_stopped)

    # What a person asks for

    def start_watch(self) -> None:
        """Let a simulated person wear a watch."""
        self.empty.show_starting(True)
        planned = PlannedNode(VIRTUAL_WATCH, WATCH, {}, tr("it was asked for"))
        self._runner.start_node(planned, is_wanted=True)

    def show_field(self, topic: str, path: str) -> None:
        """Plot a number of a topic; without a path, let a person choose one."""
        if topic == IMU:
            return  # its curves are there by themselves
        if path:
            self.feed.plot(Field(topic, path))
        else:
            self.choose_fields(topic)

    def choose_fields(self, topic: str = "") -> None:
        """Let a person choose what is plotted."""
        if self.chooser is None:
            self.chooser = FieldChooser(self.feed, self._network, self)
        self.chooser.show_topic(topic)
        self.chooser.show()
        self.chooser.raise_()

    def record(self, folder: Path | None = None) -> None:
        """Record what sensors measure, from now on."""
        try:
            self.recorder.start(folder or self._folder())
        except RecordingError as error:
            self._on_recording_failed(error)

    def choose_recording(self) -> None:
        """Ask for a recording, and play it."""
        kinds, title = (tr("Recordings (*.csv)"), tr("All files (*)")), tr("Replay a recording")
        ask_for_path(self, title, self._folder(), self.replay_bar.choose, kinds=kinds)

    def _export(self, kind: str) -> None:
        name = time.strftime(f"sensors_%Y-%m-%d_%H-%M-%S.{kind}")
        words = tr("Numbers") if kind == "csv" else tr("Picture")
        keep = self.export_numbers if kind == "csv" else self.export_picture
        kinds = (f"{words} (*.{kind})", tr("All files (*)"))
        ask_for_path(self, tr("Export"), self._folder() / name, keep, "save", kinds)

    def export_numbers(self, path: Path) -> None:
        """Keep the numbers of the time that is shown."""
        self._keep(lambda: export_csv(path, self.plots))

    def export_picture(self, path: Path) -> None:
        """Keep a picture of the plots and of the list of curves."""
        self._keep(lambda: export_picture(path, self.split))

    def _keep(self, write: Callable[[], list[Path]]) -> None:
        try:
            paths = write()
        except RecordingError as error:
            self._messages.tell_error(error)
            return
        self._messages.confirm(_kept(paths), self._show_folder(paths[0].parent))

    # What happens

    def _on_rows_changed(self) -> None:
        self.pages.setCurrentIndex(1 if self.plots.rows else 0)
        if self.plots.rows:
            self.empty.show_starting(False)
            self._share_room()

    def _share_room(self) -> None:
        """Give the list what it needs, as long as the plots keep the larger part."""
        wanted = self.list.header().length() + 2 * self.fontMetrics().height()
        width = max(self.split.width(), 1)
        side = min(wanted, width // 2)
        self.split.setSizes([width - side, side])

    def _on_measured(self, words: str) -> None:
        self.measured.setText(words)
        self.measured.setVisible(bool(words))

    def _on_nodes_changed(self, names: list[str]) -> None:
        if RECORDING in names:
            self.replay_bar.see(self._runner.board.nodes.get(RECORDING))

    def _on_node_failed(self, name: str, _error: NepError) -> None:
        if name == WATCH:
            self.empty.show_starting(False)
        elif name == RECORDING:
            self.replay_bar.note_end()

    def _on_recording_failed(self, error: RecordingError) -> None:
        answer = Answer(tr("Choose a folder…"), self._choose_folder)
        self._messages.tell_error(error, answer)

    def _choose_folder(self) -> None:
        title = tr("Choose a folder for recordings")
        ask_for_path(self, title, self._folder(), self.record, "folder")

    def _on_recording_stopped(self, paths: list[Path]) -> None:
        if not paths:
            self._messages.confirm(tr("Nothing was measured, so nothing was recorded"))
            return
        play = Answer(tr("Replay"), lambda: self.replay_bar.choose(paths[0]))
        self._messages.confirm(_kept(paths), play, self._show_folder(paths[0].parent))

    def _show_folder(self, folder: Path) -> Answer:
        url = QUrl.fromLocalFile(str(folder))
        return Answer(tr("Show the folder"), lambda: QDesktopServices.openUrl(url), "quiet")

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the plots their part."""
        super().resizeEvent(event)
        self._share_room()

    def showEvent(self, event: QShowEvent) -> None:
        """Hear what is plotted."""
        super().showEvent(event)
        self.feed.watch(True)

    def hideEvent(self, event: QHideEvent) -> None:
        """Hear nothing while nobody looks."""
        super().hideEvent(event)
        self.feed.watch(False)


def _kept(paths: list[Path]) -> str:
    """What to say of files that were written."""
    return count_words(
        len(paths),
        "“{name}” is kept",
        "{n} files are kept, the first is “{name}”",
        name=paths[0].name,
    )
