"""How certain a recogniser was in the last half minute, and what it would have recognised."""

from __future__ import annotations

import logging
import tempfile
import threading
from base64 import b64decode
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.errors import RecordingError
from nep_studio.ui.plugins.gestures.live import Samples
from nep_studio.ui.ring import Floats
from nodes.perceptual.recognition.features import Detection, Gesture, PeakPicker
from nodes.perceptual.recognition.model import TRIGGER, Model, read_model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.streams import mirrored

log = logging.getLogger(__name__)


KEPT_S = 30.0
_GAP_S = 0.5
"""After so long without a look the movement has ended."""


@dataclass(frozen=True)
class Certainties:
    """One look: when it was, and for each gesture the certainty and the length of its window."""

    end_s: float
    certainties: Floats
    lengths_s: Floats


class CertaintyHistory:
    """The looks of the last half minute of one stream, and the triggers among them.

    ``triggers`` are what would have been recognised with the ``points``, the oldest first.
    """

    def __init__(self, gestures: Sequence[Gesture] = ()) -> None:
        self.gestures = tuple(gestures)
        self.kept: deque[Certainties] = deque()
        self._points: dict[str, float] = {}
        self._begin()

    @property
    def names(self) -> tuple[str, ...]:
        """The gestures that are looked for."""
        return tuple(gesture.name for gesture in self.gestures)

    @property
    def now_s(self) -> float:
        """When the last look was; 0 before the first."""
        return self.kept[-1].end_s if self.kept else 0.0

    def set_points(self, points: Mapping[str, float]) -> None:
        """Look again at what is kept, with these recognition points."""
        self._points = dict(points)
        self._begin()
        for look in self.kept:
            self._pick(look)

    def add(self, look: Certainties) -> None:
        """Keep a look, and forget those that are too old."""
        if self.kept and look.end_s < self.kept[-1].end_s:
            self.kept.clear()  # another stream, or a clock that begins anew
            self._begin()
        self.kept.append(look)
        self._pick(look)
        oldest_s = look.end_s - KEPT_S
        while self.kept[0].end_s < oldest_s:
            self.kept.popleft()
        while self.triggers and self.triggers[0].t_end < oldest_s:
            del self.triggers[0]

    def certainties(self) -> dict[str, float]:
        """How certain it is of each gesture now."""
        if not self.kept:
            return {}
        return dict(zip(self.names, self.kept[-1].certainties.tolist(), strict=True))

    def _begin(self) -> None:
        wanted = {name: self._points.get(name, TRIGGER) for name in self.names}
        self._picker, self._last_s = PeakPicker(self.gestures, wanted), -np.inf
        self.triggers: list[Detection] = []

    def _pick(self, look: Certainties) -> None:
        found = []
        if look.end_s - self._last_s > _GAP_S:
            found.append(self._picker.flush())
        found.append(self._picker.look(look.end_s, look.certainties, look.lengths_s))
        self._last_s = look.end_s
        self.triggers += [one for one in found if one is not None]

    def best(self, name: str, since_s: float) -> Detection | None:
        """Where a gesture was most certain since a time; None when it was not looked for."""
        if name not in self.names:
            return None
        column = self.names.index(name)
        recent = [look for look in self.kept if look.end_s >= since_s]
        if not recent:
            return None
        look = max(recent, key=lambda one: float(one.certainties[column]))
        certainty, length_s = float(look.certainties[column]), float(look.lengths_s[column])
        return Detection(name, certainty, look.end_s - length_s, look.end_s)

    def most_certain(self, since_s: float) -> Detection | None:
        """The gesture that was most certain since a time."""
        found = [one for name in self.names if (one := self.best(name, since_s)) is not None]
        return max(found, key=lambda one: one.certainty, default=None)


# Looks for the project's gestures in what the sensor measures, in a thread of its own.

NEWS_MS = 40
MOST_WAITING = 100
"""A computer that cannot follow leaves batches out, rather than being late for ever."""


@dataclass(frozen=True)
class Wanted:
    """What to listen for: a model in base64, by which method, on what kind of sensor.

    ``wrist`` is where the sensor is worn now.
    """

    file: str
    method: str
    gravity_included: bool
    wrist: str = ""


class Listening(QObject):
    """``model_read`` gives the Model, ``looked`` a list of Certainties, ``failed`` an error."""

    model_read = Signal(object)
    looked = Signal(object)
    failed = Signal(object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._wanted: Wanted | None = None
        self._talk: _Talk | None = None
        self._take_soon = QTimer(self, interval=NEWS_MS)
        self._take_soon.timeout.connect(self._take_news)
        parent.destroyed.connect(self.stop)

    @property
    def is_listening(self) -> bool:
        """Whether there is a thread that listens."""
        return self._talk is not None

    def listen_for(self, wanted: Wanted) -> None:
        """Listen for this from now on."""
        if wanted == self._wanted:
            return
        self.stop()  # the old thread may be busy with what nobody wants to know any more
        self._wanted, self._talk = wanted, _Talk()
        self._talk.orders.put(wanted)
        threading.Thread(target=_listen, args=(self._talk,), daemon=True).start()
        self._take_soon.start()

    def hear(self, samples: Samples) -> None:
        """Look into these samples, if it can follow."""
        if self._talk is not None and self._talk.orders.qsize() < MOST_WAITING:
            self._talk.orders.put(samples)

    def stop(self) -> None:
        """Listen no more; nothing is told any more."""
        talk, self._talk = self._talk, None
        self._wanted = None
        self._take_soon.stop()
        if talk is not None:
            talk.has_ended.set()
            talk.orders.put(None)

    def _take_news(self) -> None:
        looks: list[Certainties] = []
        talk = self._talk
        while talk is not None and talk is self._talk and not talk.news.empty():
            told = talk.news.get()
            if isinstance(told, Certainties):
                looks.append(told)
                continue
            looks.clear()  # they were by another model
            (self.failed if isinstance(told, RecordingError) else self.model_read).emit(told)
        if looks and talk is self._talk:
            self.looked.emit(looks)


class _Talk:
    """What one thread is told, and what it tells."""

    def __init__(self) -> None:
        self.orders: SimpleQueue[Wanted | Samples | None] = SimpleQueue()
        self.news: SimpleQueue[object] = SimpleQueue()
        self.has_ended = threading.Event()


def _listen(talk: _Talk) -> None:
    """What the thread does."""
    listener: _Listener | None = None
    while (order := talk.orders.get()) is not None and not talk.has_ended.is_set():
        try:
            if isinstance(order, Wanted):
                listener = _Listener(order, talk.news)
            elif listener is not None:
                listener.push(order)
        except RecordingError as error:
            listener = None
            talk.news.put(error)
        except Exception as error:  # the try-out must not fall silent without a word
            log.exception("listening for gestures")
            listener = None
            talk.news.put(
                RecordingError(
                    "The gestures cannot be tried out.",
                    checklist=("Train the gestures again.",),
                    details=str(error),
                )
            )


class _Listener:
    """A spotter whose looks are told; RecordingError when the sensor does not fit the model."""

    def __init__(self, wanted: Wanted, news: SimpleQueue[object]) -> None:
        model = _read(wanted.file)
        self._spotter = Spotter(
            model, method=wanted.method, gravity_included=wanted.gravity_included
        )
        self._spotter.looked = lambda end_s, certainties, lengths_s: news.put(
            Certainties(end_s, certainties.copy(), lengths_s)
        )
        self._mirrors = is_mirrored(wanted.wrist, model)
        news.put(model)

    def push(self, samples: Samples) -> None:
        """Look into samples, as the wrist of the recordings would have felt them."""
        acc, gyr = samples.acc, samples.gyr
        if self._mirrors:
            acc, gyr = mirrored(acc, gyr)
        self._spotter.push(samples.t, acc, gyr)


def is_mirrored(wrist: str, model: Model) -> bool:
    """Whether a sensor is worn on the other wrist than those of the recordings."""
    return {wrist, model.wrist} == {"left", "right"}


def _read(text: str) -> Model:
    """The model in a text; read_model takes it from a file."""
    with tempfile.TemporaryDirectory(prefix="nep-gestures-") as folder:
        path = Path(folder) / "recogniser.gestures"
        try:
            path.write_bytes(b64decode(text, validate=True))
        except ValueError as error:
            raise RecordingError(
                "What was learned is damaged.", checklist=("Train the gestures again.",)
            ) from error
        except OSError as error:
            raise RecordingError(
                "The recogniser cannot be written to a temporary file.",
                checklist=("Is there room on the disk?",),
                details=str(error),
            ) from error
        return read_model(path)
