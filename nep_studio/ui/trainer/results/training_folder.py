"""The recordings of a project as a folder of CSV files, for the process that learns from them."""

from __future__ import annotations

import shutil
import tempfile
import weakref
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from nep_studio.blocks.own_gestures import OwnGesture, OwnRecording
from nep_studio.ui.trainer.kept_samples import unpacked
from nep_studio.ui.trainer.live import Samples
from nodes.recordings import Recording, write_recording

EVERYDAY = "everyday"
NEITHER = "?"
"""The label of what is neither a gesture nor its absence."""

Gestures = Mapping[str, OwnGesture]
Recordings = Mapping[str, OwnRecording]


class TrainingFolder:
    """A temporary folder that is kept up to date: only what is different is written again."""

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix="nep-gestures-"))
        self.recordings = self.path / "recordings"
        self.model = self.path / "model.gestures"
        self._written: dict[str, object] = {}
        self._delete = weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)

    def update(self, gestures: Gestures, recordings: Recordings) -> Iterator[float]:
        """Write file after file; gives the part that is done. Raises RecordingError, OSError."""
        (self.recordings / EVERYDAY).mkdir(parents=True, exist_ok=True)
        for gone in [key for key in self._written if key not in recordings]:
            self._forget(gone)
        for number, (key, recording) in enumerate(recordings.items()):
            content = (recording, spans_of(key, recording, gestures))
            if self._written.get(key) != content:
                self._forget(key)
                write_recording(self._place(key, recording), labelled(key, *content))
                self._written[key] = content
            yield (number + 1) / len(recordings)

    def close(self) -> None:
        """Delete it; that is done at the end too if nobody asks for it."""
        self._delete()

    def _place(self, key: str, recording: OwnRecording) -> Path:
        folder = self.recordings / EVERYDAY if recording.everyday else self.recordings
        return folder / f"{key}.csv"

    def _forget(self, key: str) -> None:
        self._written.pop(key, None)
        for folder in (self.recordings, self.recordings / EVERYDAY):
            (folder / f"{key}.csv").unlink(missing_ok=True)


Spans = tuple[tuple[float, float, str], ...]


def spans_of(key: str, recording: OwnRecording, gestures: Gestures) -> Spans:
    """From when to when something else than nothing is made; what counts more comes later."""
    takes = [
        (take.start_s, take.end_s, NEITHER if take.left_out else name)
        for name, gesture in gestures.items()
        for take in gesture.takes
        if take.recording == key
    ]
    unknown = [(start_s, end_s, NEITHER) for start_s, end_s in recording.forgotten]
    return (*unknown, *sorted(takes, key=lambda span: (span[2] != NEITHER, span)))


def labelled(key: str, recording: OwnRecording, spans: Spans) -> Recording:
    """A recording as a file has it: each sample says what is made at that time."""
    samples = unpacked(recording)
    has_labels = bool(spans) or not recording.everyday
    return Recording(
        source=key,
        t=samples.t,
        acc=samples.acc,
        gyr=samples.gyr,
        labels=_labels(samples, spans) if has_labels else None,
        gravity_included=recording.gravity_included,
        person=recording.person,
        simulated=recording.simulated,
        wrist=recording.wrist,
        device=recording.source,
    )


def _labels(samples: Samples, spans: Spans) -> list[str]:
    labels = [""] * len(samples)
    for start_s, end_s, name in spans:
        first = int(np.searchsorted(samples.t, start_s - 1e-6))
        last = int(np.searchsorted(samples.t, end_s + 1e-6))
        labels[first:last] = [name] * (last - first)
        if first and labels[first - 1] == name != NEITHER:
            labels[first - 1] = ""  # two takes of a gesture that touch stay two
    return labels
