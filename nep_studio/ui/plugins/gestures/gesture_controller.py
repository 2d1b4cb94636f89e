"""What the trainer works on: the project's gestures, the sensor that is heard, who wears it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from nep_core.wire.messages import IMU, Imu
from nep_studio.blocks.edits.content import GESTURE, RECOGNISER, RECORDING, SetExtra
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    OwnTake,
    Wrist,
    own_gestures,
    own_recogniser,
    own_recordings,
    training_digest,
)
from nep_studio.ui.edits import OpenProject
from nep_studio.ui.running.runner import Heard, Tap
from nep_studio.ui.words import tr

from .live import MOST_CACHED, LiveStream, Samples, unpacked

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.document_files import Files
    from nep_studio.ui.messages import Messages
    from nep_studio.ui.running.runner import Runner
    from nep_studio.ui.theme.look import Look

SILENT_S = 2.0
"""A sensor that was not heard for so long is not there any more."""
MOST_SOURCES = 8
_KEYS = (GESTURE, RECORDING)


class GestureController(QObject):
    """The model behind the panel; it asks the project's editor for every change.

    ``changed``: the project, its gestures or recordings are others. ``heard`` gives the Samples
    that just came from the sensor in use. ``wearer_changed``: another person or wrist.
    ``sources_changed``: a sensor came, or another one is in use. ``take_chosen`` gives the id of
    the take that is to be looked at, "" for none.
    """

    changed = Signal()
    heard = Signal(object)
    wearer_changed = Signal()
    sources_changed = Signal()
    take_chosen = Signal(str)

    def __init__(
        self,
        files: Files,
        runner: Runner,
        messages: Messages,
        look: Look,
        parent: QObject | None = None,
        *,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(parent)
        self.files, self.runner, self.messages, self.look = files, runner, messages, look
        self.now = now
        self.streams: dict[str, LiveStream] = {}
        self.wrist: Wrist = "right"
        self.chosen_take = ""
        self._person = ""
        self._source = ""
        self._unpacked = lru_cache(MOST_CACHED)(unpacked)
        self._tap: Tap | None = None
        self._seen: dict[str, Any] = {}
        self._digest = ""
        self._read()
        self._listener = OpenProject(files, self)
        self._listener.changed.connect(self.refresh)
        self.refresh()

    # The project

    @property
    def editor(self) -> Editor | None:
        """What edits the open project; None when there is none."""
        return self.files.document.editor if self.files.document is not None else None

    @property
    def is_up_to_date(self) -> bool:
        """Whether the recogniser was trained on what there is now."""
        return self.recogniser is not None and self.recogniser.trained_on == self.digest()

    def digest(self) -> str:
        """A short text that differs when there is something else to learn from."""
        if not self._digest and self.editor is not None:
            self._digest = training_digest(self.editor.project)
        return self._digest

    @property
    def people(self) -> list[str]:
        """Who has recorded, and who is about to: in the order of their names."""
        found = {one.person for one in self.recordings.values()} | {self.person}
        return sorted(found, key=str.casefold)

    def find_take(self, take_id: str) -> tuple[str, OwnTake] | None:
        """The gesture that a take is of, and the take."""
        for name, gesture in self.gestures.items():
            for take in gesture.takes:
                if take.id == take_id:
                    return name, take
        return None

    def samples(self, recording_id: str) -> Samples:
        """All samples of a recording; none when it is not there."""
        recording = self.recordings.get(recording_id)
        return Samples.none() if recording is None else self._unpacked(recording)

    def take_samples(self, take: OwnTake) -> Samples:
        """The samples of one take."""
        return self.samples(take.recording).between(take.start_s, take.end_s)

    def change(self, label: str, edits: Iterable[SetExtra]) -> bool:
        """Change what the project keeps, as one step of undo; False when it cannot be.

        ``label`` is English, as all names of steps are: the menu translates it.
        """
        editor = self.editor
        if editor is None:
            return False
        try:
            with editor.transaction(label):
                for edit in edits:
                    editor.apply(edit)
        except EditRefused as refusal:
            self.messages.refuse(refusal.sentence, refusal.checklist)
            return False
        self.refresh()
        return True

    def refresh(self) -> None:
        """Look at the project again, and tell when something that matters here is different."""
        seen = self._kept()
        if seen.keys() == self._seen.keys() and all(seen[k] is self._seen[k] for k in seen):
            return
        has_other_project = seen.get("") is not self._seen.get("")
        self._seen = seen
        self._read()
        if has_other_project:
            # Go on with who recorded last in it
            newest = max(self.recordings.values(), key=lambda one: one.recorded, default=None)
            self.set_wearer(newest.person if newest else "", newest.wrist if newest else None)
        self.changed.emit()

    def _kept(self) -> dict[str, Any]:
        """What the project keeps of gestures, as it is kept; the editor is under ""."""
        editor = self.editor
        if editor is None:
            return {}
        extra: Mapping[str, Any] = editor.project.extra
        kept = {k: v for k, v in extra.items() if k.startswith(_KEYS) or k == RECOGNISER}
        return {"": editor, **kept}

    def _read(self) -> None:
        project = self.editor.project if self.editor is not None else None
        self.gestures: dict[str, OwnGesture] = own_gestures(project) if project else {}
        self.recordings: dict[str, OwnRecording] = own_recordings(project) if project else {}
        self.recogniser: OwnRecogniser | None = own_recogniser(project) if project else None
        self._digest = ""
        if self.chosen_take and self.find_take(self.chosen_take) is None:
            self.choose_take("")

    # Who wears it

    @property
    def person(self) -> str:
        """Who records now."""
        return self._person or tr("Me")

    def set_wearer(self, person: str | None = None, wrist: Wrist | None = None) -> None:
        """Record for this person, or with the sensor at this wrist, from now on."""
        person = self._person if person is None else person.strip()
        wrist = wrist or self.wrist
        if (person, wrist) != (self._person, self.wrist):
            self._person, self.wrist = person, wrist
            self.wearer_changed.emit()

    # What is looked at

    def choose_take(self, take_id: str) -> None:
        """Look at a take: the strip shows it large; "" to look at what is measured now."""
        if take_id != self.chosen_take:
            self.chosen_take = take_id
            self.take_chosen.emit(take_id)

    # The sensor

    @property
    def live(self) -> LiveStream | None:
        """What the sensor in use measures; None while none was heard."""
        return self.streams.get(self._source)

    @property
    def is_hearing(self) -> bool:
        """Whether the sensor in use was heard a moment ago."""
        return self.live is not None and self.now() - self.live.heard_s < SILENT_S

    def use_source(self, source: str) -> None:
        """Use another of the sensors that are heard."""
        if source in self.streams and source != self._source:
            self._source = source
            self._take_wrist()
            self.sources_changed.emit()

    def listen(self, is_on: bool) -> None:
        """Hear the sensors, or not any more."""
        if is_on and self._tap is None:
            self._tap = self.runner.tap(IMU, kind=Imu, parent=self)
            self._tap.arrived.connect(self.hear)
        elif not is_on and self._tap is not None:
            self._tap.close()
            self._tap = None

    def hear(self, batch: list[Heard]) -> None:
        """Take what sensors have sent."""
        for heard in batch:
            source = heard.message.source or heard.sender
            stream = self._stream(source)
            wrist = stream.wrist
            samples = stream.hear(heard.message, self.now())
            if len(samples) and source == self._source_with(source):
                if stream.wrist != wrist:
                    self._take_wrist()
                self.heard.emit(samples)

    def _stream(self, source: str) -> LiveStream:
        if source not in self.streams:
            if len(self.streams) >= MOST_SOURCES:
                others = [key for key in self.streams if key != self._source]
                del self.streams[min(others, key=lambda key: self.streams[key].heard_s)]
            self.streams[source] = LiveStream(source)
            self.sources_changed.emit()
        return self.streams[source]

    def _source_with(self, heard: str) -> str:
        """The sensor in use; another that is heard takes the place of a silent one."""
        if heard != self._source and not self.is_hearing:
            self._source = heard
            self._take_wrist()
            self.sources_changed.emit()
        return self._source

    def _take_wrist(self) -> None:
        """A sensor that says where it is worn is believed."""
        if self.live is not None and self.live.wrist is not None:
            self.set_wearer(wrist=self.live.wrist)
