"""The recordings of a project as a folder of CSV files, for the process that learns from them."""

from __future__ import annotations

import shutil
import tempfile
import weakref
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from nep_studio.blocks.own_gestures import OwnRecording
from nep_studio.gesture_files import EVERYDAY, Gestures, Span, labels_of, spans_of
from nep_studio.ui.trainer.kept_samples import unpacked
from nodes.recordings import Recording, write_recording

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


def labelled(key: str, recording: OwnRecording, spans: Sequence[Span]) -> Recording:
    """A recording as a file has it: each sample says what is made at that time."""
    samples = unpacked(recording)
    has_labels = bool(spans) or not recording.everyday
    return Recording(
        source=key,
        t=samples.t,
        acc=samples.acc,
        gyr=samples.gyr,
        labels=labels_of(samples.t.tolist(), spans) if has_labels else None,
        gravity_included=recording.gravity_included,
        person=recording.person,
        simulated=recording.simulated,
        wrist=recording.wrist,
        device=recording.source,
    )
