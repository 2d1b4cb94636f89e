"""Takes as CSV files: the same that "nep-studio train" reads, one file for each recording."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from nep_core.errors import RecordingError
from nep_studio.blocks.own_gestures import OwnGesture, OwnRecording, Wrist
from nep_studio.gesture_files import EVERYDAY, NEITHER, spans_of
from nep_studio.ui.trainer.exchange_parts import Imported, ImportedTake
from nep_studio.ui.trainer.kept_samples import packed, thinned
from nep_studio.ui.trainer.live import Samples
from nep_studio.ui.trainer.results.training_folder import labelled
from nodes.recordings import Recording, read_recording, read_recordings, write_recording

_MAY_WRITE = (
    "Choose a folder that you may write into, such as one in your home folder.",
    "Is there room on the disk?",
)


def read_csv(path: Path) -> list[Imported]:
    """Read a CSV file, or all those of a folder and of its everyday folder.

    Raises RecordingError, which says which file and what to do.
    """
    if path.is_dir():
        read = [_imported(one, is_everyday=False) for one in read_recordings(path)]
        everyday = path / EVERYDAY
        if everyday.is_dir() and any(everyday.glob("*.csv")):
            read += [_imported(one, is_everyday=True) for one in read_recordings(everyday)]
        return read
    return [_imported(read_recording(path), is_everyday=path.parent.name == EVERYDAY)]


def write_csv(
    folder: Path, gestures: dict[str, OwnGesture], recordings: dict[str, OwnRecording]
) -> list[Path]:
    """Write each recording into a folder, everyday movement into one inside; gives the files.

    Raises RecordingError.
    """
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for number, (key, recording) in enumerate(recordings.items(), start=1):
            place = folder / EVERYDAY if recording.everyday else folder
            place.mkdir(exist_ok=True)
            stem = f"{_bare(recording.person)}{_made(key, gestures)}_{number}"
            made = labelled(key, recording, spans_of(key, recording, gestures))
            write_recording(place / f"{stem}.csv", made)
            written.append(place / f"{stem}.csv")
    except OSError as error:
        sentence = f"The recordings cannot be written to {folder}: {error.strerror}."
        raise RecordingError(sentence, checklist=_MAY_WRITE, details=str(error)) from error
    return written


def _imported(recording: Recording, *, is_everyday: bool) -> Imported:
    samples = Samples(recording.t, recording.acc, recording.gyr)
    takes = list(_takes(recording)) if not is_everyday else []
    wrist: Wrist = recording.wrist or "right"
    kept = thinned(samples)
    own = OwnRecording(
        seconds=round(kept.seconds, 4),
        rate_hz=round(kept.rate_hz, 2),
        samples=packed(kept),
        person=recording.person,
        wrist=wrist,
        source=recording.device or recording.source,
        gravity_included=recording.gravity_included,
        has_rotation=kept.gyr is not None,
        simulated=recording.simulated,
        everyday=is_everyday or not takes,
        forgotten=tuple((take.start_s, take.end_s) for take in takes if take.gesture == NEITHER),
    )
    return Imported(own, tuple(take for take in takes if take.gesture != NEITHER))


def _takes(recording: Recording) -> Iterator[ImportedTake]:
    """The runs of samples with the same label."""
    labels = recording.labels or []
    first = 0
    for at in range(1, len(labels) + 1):
        if at < len(labels) and labels[at] == labels[first]:
            continue
        start_s, end_s = float(recording.t[first]), float(recording.t[at - 1])
        if labels[first] and end_s > start_s:
            yield ImportedTake(labels[first], "", round(start_s, 4), round(end_s, 4))
        first = at


def _bare(person: str) -> str:
    letters = "".join(letter if letter.isalnum() else "_" for letter in person.strip())
    return f"{letters[:24]}_" if letters else ""


def _made(key: str, gestures: dict[str, OwnGesture]) -> str:
    """What is made in a recording, for the name of its file."""
    made = [name for name, one in gestures.items() if any(t.recording == key for t in one.takes)]
    return made[0] if len(made) == 1 else "session" if made else EVERYDAY
