"""A folder of people's gestures for the benchmark, and what of it is learned from and tested on."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from pathlib import Path

import numpy as np

from nep_core.errors import RecordingError
from nodes.recordings import Recording, read_recording

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
SHORTEST_S, LONGEST_S = 0.2, 8.0
SLOWEST_HZ = 10.0
SOMEBODY = "somebody"
_EVERYDAY = "everyday"
_SESSION = re.compile(r"(?:[_\- ]*session|[_\- ]s)?[_\- (]*\d+\)?$", re.IGNORECASE)
_NOT_KNOWN = "?"

Sessions = tuple[Recording, ...]


@dataclass(frozen=True)
class Folder:
    """People and their sessions in the order of their names; ``notes`` tell what was left out."""

    name: str
    people: Mapping[str, Sessions]
    everyday: Sessions
    notes: tuple[str, ...]

    @property
    def gestures(self) -> tuple[str, ...]:
        """All gestures that somebody makes."""
        every = (one for sessions in self.people.values() for one in sessions)
        return tuple(sorted({name for one in every for name, _, _ in _spans(one) if name}))

    @property
    def is_simulated(self) -> bool:
        """Whether nobody of these people is real."""
        return all(one.simulated for sessions in self.people.values() for one in sessions)


@dataclass(frozen=True)
class Split:
    """The first takes of each gesture to learn from, the ``rest`` to be tested on, and notes."""

    training: Sessions
    rest: Sessions
    notes: tuple[str, ...]


def read_gesture_folder(folder: Path, everyday: Path | None = None) -> Folder:
    """Read a folder and everyday movement; RecordingError when there is nothing to measure.

    A file that cannot be used is left out with a note. Everyday movement is looked for in
    the folder, beside it, and in the shared data, if no folder is named.
    """
    notes: list[str] = []
    folder = _with_files(folder)
    sessions = [
        cleaned for one in _readable(_files(folder), notes) for cleaned in _cleaned(one, notes)
    ]
    if not sessions:
        raise RecordingError(
            f"No file in {folder} marks a gesture.",
            checklist=(
                "Name the files person_gesture.csv, such as ann_wave.csv.",
                "The columns are t_s, ax, ay, az, if there is a gyroscope gx, gy, gz, and gesture.",
                "The column gesture is 1 while the gesture is made, and 0 else.",
                *notes,
            ),
        )
    people = _by_person(_with_plain_names(sessions, notes))
    idle_folder = everyday or _everyday_of(folder)
    idle: Sessions = ()
    if idle_folder is None:
        notes.append("no everyday movement of people: false triggers a minute are left out")
    else:
        found = _readable(_files(idle_folder), notes)
        idle = tuple(replace(one, labels=None) for one in found if _is_fast_enough(one, notes))
    return Folder(folder.resolve().name, people, idle, tuple(notes))


def split_sessions(sessions: Sessions, takes: int) -> Split:
    """The first so many takes of each gesture, and the rest; cut in the middle of the pauses.

    A gesture that was not made at least once more is left out of both.
    """
    made = Counter(name for one in sessions for name, _, _ in _spans(one) if name)
    few = {name: count for name, count in made.items() if count <= takes}
    notes = tuple(f"{name} was made {_times(count)}: left out" for name, count in few.items())
    seen: Counter[str] = Counter()
    training: list[Recording] = []
    rest: list[Recording] = []
    for one in sessions:
        for name, piece in _pieces(one):
            seen[name] += 1
            if name not in few:
                (training if seen[name] <= takes else rest).append(piece)
    return Split(tuple(_joined(training)), tuple(_joined(rest)), notes)


def _times(count: int) -> str:
    return "only once" if count == 1 else f"only {count} times"


def _files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise RecordingError(
            f"{folder} is not a folder.",
            checklist=("Give a folder with recordings as CSV files, person_gesture.csv.",),
        )
    paths = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".csv")
    if not paths:
        raise RecordingError(
            f"There is no CSV file in {folder}.",
            checklist=("Give a folder with recordings as CSV files, person_gesture.csv.",),
        )
    return paths


def _readable(paths: Sequence[Path], notes: list[str]) -> Iterator[Recording]:
    for path in paths:
        try:
            yield read_recording(path)
        except RecordingError as error:
            notes.append(f"{path.name} is left out: {error.sentence}")


def _is_fast_enough(one: Recording, notes: list[str]) -> bool:
    is_fast = one.rate_hz >= SLOWEST_HZ
    if not is_fast:
        notes.append(f"{one.source} is left out: {one.rate_hz:.1f} samples a second are too few")
    return is_fast


def _cleaned(one: Recording, notes: list[str]) -> Iterator[Recording]:
    """The recording if it has gestures, what is too short or too long for one marked unknown."""
    if not any(one.labels or ()):
        notes.append(f"{one.source} is left out: no gesture is marked in it")
        return
    if not _is_fast_enough(one, notes):
        return
    labels: list[str] = []
    for name, run in groupby(one.labels or ()):
        count = len(list(run))
        end = len(labels) + count - 1
        lasts_s = float(one.t[end] - one.t[len(labels)])
        is_odd = bool(name) and not SHORTEST_S <= lasts_s <= LONGEST_S
        if is_odd and name != _NOT_KNOWN:
            notes.append(f"{one.source}: a take of {lasts_s:.1f} s is left out")
        labels += [_NOT_KNOWN if is_odd else name] * count
    yield replace(one, labels=labels)


def _with_plain_names(sessions: list[Recording], notes: list[str]) -> Iterator[Recording]:
    """Gestures named without the number of the session: ``wave_2`` or ``wave_session2`` is wave.

    A number alone counts as a session's where the same person has the name without it, or has
    several names with several numbers each: ``wave_1``, ``wave_2``, ``clap_1``, ``clap_2``.
    """
    names = {(one.person, name) for one in sessions for name, _, _ in _spans(one)}
    numbers = Counter((person, _SESSION.sub("", name)) for person, name in names)
    several = Counter(person for (person, _), count in numbers.items() if count > 1)
    plain: dict[tuple[str, str], str] = {}
    for person, name in names:
        bare = _SESSION.sub("", name)
        is_alone = (person, bare) not in names and "session" not in name.lower()
        is_session = numbers[person, bare] > 1 and (not is_alone or several[person] > 1)
        plain[person, name] = bare if bare and is_session else name
    for old, new in sorted({(old, new) for (_, old), new in plain.items() if old != new}):
        notes.append(f"{old} is taken for another session of {new}")
    for one in sessions:
        labels = [plain.get((one.person, name), name) for name in one.labels or ()]
        yield replace(one, labels=labels)


def _by_person(sessions: Iterator[Recording]) -> dict[str, Sessions]:
    people: dict[str, list[Recording]] = {}
    for one in sessions:
        people.setdefault(one.person or SOMEBODY, []).append(one)
    return {person: tuple(people[person]) for person in sorted(people)}


def _everyday_of(folder: Path) -> Path | None:
    """A folder with a name such as everyday_watch: in this one, beside it, or the shared one."""
    around = (folder, folder.resolve().parent, DATA)
    places = (place for one in around for place in sorted(one.glob(f"{_EVERYDAY}*")))
    return next((place for place in places if _has_files(place)), None)


def _has_files(folder: Path) -> bool:
    return folder.is_dir() and any(folder.glob("*.[cC][sS][vV]"))


def _with_files(folder: Path) -> Path:
    """The folder, or the only one in it, besides everyday movement, that has CSV files."""
    if not folder.is_dir() or _has_files(folder):
        return folder
    inside = [one for one in folder.iterdir() if not one.name.startswith(_EVERYDAY)]
    inside = [one for one in inside if _has_files(one)]
    return inside[0] if len(inside) == 1 else folder


def _spans(one: Recording) -> Iterator[tuple[str, int, int]]:
    """Name, first and last sample of each gesture; what nobody knows has no name."""
    at = 0
    for name, run in groupby(one.labels or ()):
        count = len(list(run))
        if name:
            yield ("" if name == _NOT_KNOWN else name), at, at + count - 1
        at += count


def _pieces(one: Recording) -> Iterator[tuple[str, Recording]]:
    """The recording cut in the middle of each pause: every gesture with what is around it."""
    spans = list(_spans(one))
    middles = [(before[2] + after[1]) // 2 + 1 for before, after in pairwise(spans)]
    for (name, _, _), begin, end in zip(spans, [0, *middles], [*middles, len(one.t)], strict=True):
        if name:
            yield name, _part(one, slice(begin, end))


def _joined(pieces: Sequence[Recording]) -> Iterator[Recording]:
    """The pieces of a recording that follow each other, as one again; t from 0."""
    group: list[Recording] = []
    for piece in pieces:
        if group and not _follows(group[-1], piece):
            yield _one_of(group)
            group = []
        group.append(piece)
    if group:
        yield _one_of(group)


def _follows(before: Recording, after: Recording) -> bool:
    step_s = 1.5 / before.rate_hz if before.rate_hz else 0.0
    is_next = 0 < float(after.t[0] - before.t[-1]) <= max(step_s, 0.5)
    return before.source == after.source and is_next


def _one_of(group: Sequence[Recording]) -> Recording:
    t = np.concatenate([one.t for one in group])
    return replace(
        group[0],
        t=t - t[0],
        acc=np.concatenate([one.acc for one in group]),
        gyr=None if group[0].gyr is None else np.concatenate([one.gyr for one in group]),
        labels=[label for one in group for label in one.labels or ()],
    )


def _part(one: Recording, chosen: slice) -> Recording:
    labels = one.labels
    return replace(
        one,
        t=one.t[chosen],
        acc=one.acc[chosen],
        gyr=None if one.gyr is None else one.gyr[chosen],
        labels=labels[chosen] if labels else None,
    )
