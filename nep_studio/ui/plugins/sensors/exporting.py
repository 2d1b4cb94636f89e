"""Keeps what the plots show: as CSV files that can be replayed, and as a picture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QPixmap
from PySide6.QtWidgets import QFileDialog, QWidget

from nep_core.errors import RecordingError
from nep_core.places import whole_file
from nep_studio.ui.words import tr
from nodes.recordings import MAY_WRITE, Recording, write_recording, writing

from .curves import Curve, CurveKey
from .plots import Plots
from .streams import ImuStream, Samples, StreamKey

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
        samples = _without_gaps(samples)
        if len(samples.t) >= 2:
            written.append(_named(path, len(written)))
            _write(written[-1], plots, key, samples)
    if not written:
        raise RecordingError(
            "The time that is shown has too few samples to keep.",
            checklist=("Show a time in which something was measured, then export again.",),
        )
    return written


def export_picture(path: Path, widget: QWidget) -> None:
    """Write a picture of the plots, twice as sharp as a usual screen; raises RecordingError."""
    ratio = max(_SHARPNESS, widget.devicePixelRatioF())
    pixmap = QPixmap(widget.size() * ratio)
    pixmap.setDevicePixelRatio(ratio)
    widget.render(pixmap, QPoint())
    if not pixmap.save(str(path), "PNG"):
        raise RecordingError(
            "The picture {path} cannot be written.", checklist=MAY_WRITE, path=path
        )


def _write(path: Path, plots: Plots, key: StreamKey, samples: Samples) -> None:
    stream = plots.feed.streams.get(key)
    if key.path:
        _write_numbers(path, plots.curves[CurveKey(key, 0)], samples)
        return
    is_imu = isinstance(stream, ImuStream)
    values = samples.values
    has_rotation = bool(np.isfinite(values[4:7]).all())
    recording = Recording(
        source=key.sender,
        t=samples.t - samples.t[0],
        acc=values[:3].T,
        gyr=values[4:7].T if has_rotation else None,
        labels=None,
        gravity_included=stream.gravity_included if isinstance(stream, ImuStream) else True,
        simulated=stream.simulated if is_imu and isinstance(stream, ImuStream) else False,
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


def _without_gaps(samples: Samples) -> Samples:
    kept = np.isfinite(samples.values[0])
    return Samples(samples.t[kept], samples.values[:, kept])


def _named(path: Path, number: int) -> Path:
    return path if number == 0 else path.with_name(f"{path.stem}_{number + 1}{path.suffix}")


# Asks for files: recordings to play, places for what is exported.

OnChosen = Callable[[Path], object]


class SensorFiles:
    """Asks with the system's dialogs; nothing is called when the person thinks better of it."""

    def choose_recording(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which recording to play."""
        dialog = QFileDialog(parent, tr("Replay a recording"), str(folder))
        dialog.setNameFilters([tr("Recordings (*.csv)"), tr("All files (*)")])
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        _open(dialog, on_chosen)

    def choose_place(
        self, parent: QWidget, suggested: Path, kind: str, on_chosen: OnChosen
    ) -> None:
        """Ask where a file is to be kept; ``kind`` says in words what it is."""
        dialog = QFileDialog(parent, tr("Export"), str(suggested.parent))
        dialog.setNameFilters([f"{kind} (*{suggested.suffix})", tr("All files (*)")])
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(suggested.suffix.removeprefix("."))
        dialog.selectFile(suggested.name)
        _open(dialog, on_chosen)

    def choose_folder(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask for the folder of recordings."""
        dialog = QFileDialog(parent, tr("Choose a folder for recordings"), str(folder))
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        _open(dialog, on_chosen)


def _open(dialog: QFileDialog, on_chosen: OnChosen) -> None:
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
    dialog.open()
