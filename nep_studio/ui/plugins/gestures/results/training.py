"""Learning the gestures of a project in a process of its own; the project keeps the result."""

from __future__ import annotations

import errno
import shutil
import tempfile
import weakref
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from PySide6.QtCore import QCoreApplication, QObject, QTimer, Signal

from faults import Fault, Words
from nep_core.errors import RecordingError
from nep_studio.blocks.own_gestures import OwnRecogniser, OwnRecording, keep_recogniser
from nep_studio.problems import Problem
from nep_studio.project.kept_files import EVERYDAY, Gestures, Span, labels_of, spans_of
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.live import unpacked
from nep_studio.ui.words import tr
from nodes.recordings import Recording, write_recording

from .findings import Tuning
from .worker import Done, Ended, Failed, Progress, Worker, order

# What can go wrong while gestures are learned, as problems with a checklist.

_KILLED = (9, 137)
"""How a process ends that the system ends for its memory: by a signal, also within a shell."""
_OF_MEMORY = ("MemoryError", "Cannot allocate memory", "bad_alloc")
"""What Python, the system and C++ print then; they tell it in no other way."""


def not_enough_room(error: OSError | RecordingError) -> Problem:
    """Files could not be written or read."""
    if isinstance(error, RecordingError):
        return _problem(error.sentence, error.checklist, error.details)
    if error.errno == errno.ENOSPC:
        return _problem(
            "The disk is full: there is no room for the recordings.",
            (
                "Delete files that you do not need, and empty the trash.",
                "Then train again: your recordings are still in the project.",
            ),
            str(error),
        )
    return _problem(
        "Files for the training could not be written.",
        (
            "May programs write into the folder for temporary files?",
            "Is there room on the disk?",
            "Start the studio again, then train again.",
        ),
        str(error),
    )


def worker_ended(how: Ended) -> Problem:
    """The process that learns is gone."""
    details = f"{how.words}\n({how.code})".strip()
    if how.code in _KILLED or any(sign in how.words for sign in _OF_MEMORY):
        return _problem(
            "The computer has too little memory for the training.",
            (
                "Close other programs, then train again.",
                "Delete recordings that are very long, such as hours of everyday movement.",
            ),
            details,
        )
    return _problem(
        "The training ended in the middle.",
        (
            "Train again: your recordings are still in the project.",
            "Leave the newest takes out, one after the other, to see whether one is the reason.",
            "Start the studio again.",
        ),
        details,
    )


def _of_fault(fault: Fault, how: Ended | None = None) -> Problem:
    """What the process told, and what it wrote when it ended then."""
    return _problem(fault.sentence, fault.checklist, fault.details or (how.words if how else ""))


def _problem(sentence: Words, checklist: tuple[Words, ...], details: str) -> Problem:
    return Problem("The gestures were not learned", sentence, checklist, details)


# The recordings of a project as a folder of CSV files, for the process that learns from them.

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
                folder = self.recordings / EVERYDAY if recording.everyday else self.recordings
                write_recording(folder / f"{key}.csv", labelled(key, *content))
                self._written[key] = content
            yield (number + 1) / len(recordings)

    def close(self) -> None:
        """Delete it; that is done at the end too if nobody asks for it."""
        self._delete()

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


SOON_MS = 1200
"""So long after the last change it trains by itself."""
QUICK_S = 3.0
"""What takes longer is only done when it is asked for."""
_WRITING = 0.1
"""The part of the progress that writing the recordings is."""


def worker_command() -> Sequence[str]:
    """What starts the process; its module is loaded when it is needed."""
    from nodes.perceptual.recognition.worker import command_line

    command: Sequence[str] = command_line()
    return command


class Training(QObject):
    """Trains when it is asked to, or by itself after each change.

    ``changed``: something is different in what it does. ``trained``: the project has a new
    recogniser. ``failed`` gives the Problem.
    """

    changed = Signal()
    trained = Signal()
    failed = Signal(object)

    def __init__(
        self,
        controller: GestureController,
        parent: QObject | None = None,
        *,
        command: Callable[[], Sequence[str]] = worker_command,
    ) -> None:
        super().__init__(parent or controller)
        self.controller = controller
        self.problem: Problem | None = None
        self.progress = 0.0
        self.step = ""
        self.seconds = 0.0
        """How long the last training took."""
        self.remarks: tuple[Fault, ...] = ()
        """What is amiss with the recordings, in English sentences."""
        self.trains_by_itself = True
        self.tuning = Tuning(controller, self)
        self._worker = Worker(command, self)
        self._worker.told.connect(self._on_told)
        self._worker.ended.connect(self._on_ended)
        self._folder: TrainingFolder | None = None
        self._writing: Iterator[float] | None = None
        self._digest = ""
        """What is being learned from; empty while nothing is."""
        self._editor: object = None
        """Whose project it is: another may be opened meanwhile."""
        self._last_fault: Fault | None = None
        """What the process told last, if it told why it does not go."""
        self._tried = ""
        self._is_asked = False
        self._next_file = QTimer(self, interval=0)
        self._next_file.timeout.connect(self._write_on)
        self._soon = QTimer(self, singleShot=True, interval=SOON_MS)
        self._soon.timeout.connect(self._train_by_itself)
        controller.changed.connect(self._on_project_changed)
        app = QCoreApplication.instance()
        if app is not None:
            app.aboutToQuit.connect(self.close)

    # What may be asked

    @property
    def is_training(self) -> bool:
        """Whether it learns at the moment."""
        return bool(self._digest)

    @property
    def is_stale(self) -> bool:
        """Whether there is a recogniser that was trained on something else than there is now."""
        return self.controller.recogniser is not None and not self.controller.is_up_to_date

    @property
    def is_quick(self) -> bool:
        """Whether training takes so little time that it can be done after each change."""
        return self.seconds < QUICK_S

    @property
    def why_not(self) -> str:
        """What is missing before it can train; empty when nothing is."""
        if not self.controller.gestures:
            return tr("Add a gesture, and record it a few times.")
        gestures = self.controller.gestures.values()
        if not sum(not take.left_out for gesture in gestures for take in gesture.takes):
            return tr("Record the gesture a few times: five are better than three.")
        return ""

    # What can be asked for

    def warm(self) -> None:
        """Start the process, so that it is ready when it is needed."""
        self._worker.start()

    def train(self) -> None:
        """Learn from what the project has now; a training that goes on is given up."""
        if self.why_not:
            return
        if self.is_training:
            self.cancel()
        self._soon.stop()
        self.problem, self.progress, self.step = None, 0.0, ""
        self._digest = self._tried = self.controller.digest()
        self._editor = self.controller.editor
        self._worker.start()
        try:
            folder = self._folder or TrainingFolder()
        except OSError as error:
            self._fail(not_enough_room(error))
            return
        self._folder = folder
        self._writing = folder.update(self.controller.gestures, self.controller.recordings)
        self._next_file.start()
        self.changed.emit()

    def cancel(self) -> None:
        """Stop learning: the process is ended, and a new one gets warm."""
        if not self.is_training:
            return
        self._end()
        self._worker.stop()
        self.warm()
        self.changed.emit()

    def set_by_itself(self, is_wanted: bool) -> None:
        """Train after each change, or only when it is asked for."""
        if is_wanted != self.trains_by_itself:
            self.trains_by_itself = is_wanted
            self._tried = ""
            self._on_project_changed()

    def close(self) -> None:
        """End the process, and delete what was written for it."""
        self._soon.stop()
        self._end()
        self._worker.stop()
        if self._folder is not None:
            self._folder.close()
            self._folder = None

    # How it goes on

    def _write_on(self) -> None:
        """Write one file more; after the last one the process is asked."""
        if self._writing is None:
            self._next_file.stop()
            return
        try:
            share = next(self._writing, None)
        except (OSError, RecordingError) as error:
            self._fail(not_enough_room(error))
            return
        if share is not None:
            self._show(_WRITING * share, tr("Writing the recordings…"))
            return
        self._writing = None
        self._next_file.stop()
        self._ask()

    def _ask(self) -> None:
        """Ask the process once it is warm and the recordings are there."""
        is_waiting = self.is_training and self._writing is None and not self._is_asked
        if not is_waiting or self._folder is None:
            return
        if not self._worker.is_ready:
            self._show(_WRITING, tr("Getting ready to learn…"))
            return
        self._is_asked = True
        self._show(_WRITING, tr("Learning…"))
        self._worker.write(order(self._folder.recordings, self._folder.model, everyday=True))

    def _show(self, progress: float, step: str) -> None:
        self.progress, self.step = progress, step
        self.changed.emit()

    def _end(self) -> None:
        self._digest, self._writing, self._is_asked = "", None, False
        self._next_file.stop()

    def _fail(self, problem: Problem) -> None:
        self._end()
        self.problem = problem
        self.failed.emit(problem)
        self.changed.emit()

    def _on_told(self, said: object) -> None:
        self._last_fault = said.fault if isinstance(said, Failed) else None
        self._ask()
        if not self._is_asked:
            return
        match said:
            case Progress(progress, step):
                share = min(max(progress, 0.0), 1.0)
                self._show(_WRITING + (1 - _WRITING) * share, tr(step) or self.step)
            case Done():
                self._keep(said)
            case Failed(fault):
                self._fail(_of_fault(fault))

    def _keep(self, done: Done) -> None:
        """Let the project have what was learned."""
        digest = self._digest
        try:
            text = b64encode(Path(done.done).read_bytes()).decode("ascii")
        except OSError as error:
            self._fail(not_enough_room(error))
            return
        self._end()
        self.seconds, self.remarks = done.seconds, done.remarks
        figures: dict[str, Any] = next(iter(done.report.values()), {})
        gestures = tuple(figures.get("takes", ()))
        recogniser = OwnRecogniser(digest, gestures, text, done.report)
        if self.controller.change("train the gestures", [keep_recogniser(recogniser)]):
            self.trained.emit()
        self.changed.emit()
        self._on_project_changed()  # it may have changed meanwhile

    def _on_ended(self, how: Ended) -> None:
        fault, self._last_fault = self._last_fault, None
        problem = worker_ended(how) if fault is None else _of_fault(fault, how)
        if self.is_training:
            self._fail(problem)
        elif not self._worker.was_ready:  # else the next training starts another one
            self.problem = problem
            self.changed.emit()

    def _on_project_changed(self) -> None:
        if self.is_training and self._is_in_vain():
            self.cancel()
        if self._wants_to_train():
            self._soon.start()
        self.changed.emit()

    def _is_in_vain(self) -> bool:
        """Whether nobody wants what it learns: of another project, or of a step that was undone.

        To keep the latter would be a new step, and take the way forward through the others away.
        """
        editor = self.controller.editor
        if editor is None or editor is not self._editor:
            return True
        return bool(editor.history.redo_label) and self.controller.digest() != self._digest

    def _wants_to_train(self) -> bool:
        """Whether to train by itself: not on a way back through the steps of undo."""
        editor = self.controller.editor
        if editor is None or not (self.trains_by_itself and self.is_quick):
            return False
        counts = [
            len(gesture.takes) for gesture in self.controller.gestures.values() if gesture.takes
        ]
        is_enough = bool(counts) and min(counts) > 1
        is_new = not self.controller.is_up_to_date and self.controller.digest() != self._tried
        return is_enough and is_new and not editor.history.redo_label

    def _train_by_itself(self) -> None:
        if self._wants_to_train() and not self.is_training:
            self.train()
