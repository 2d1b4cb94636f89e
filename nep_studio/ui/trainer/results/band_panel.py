"""The expected curve of the gesture that fits best, or of a chosen one, in pictures and words."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.live import Samples
from nep_studio.ui.trainer.results.band import KINDS, Band, band_of, in_words, kind_words
from nep_studio.ui.trainer.results.band_view import BandView
from nep_studio.ui.trainer.results.labels import Words
from nep_studio.ui.trainer.results.listening import is_mirrored
from nep_studio.ui.trainer.results.looks import Looks
from nep_studio.ui.words import tr
from nodes.perceptual.recognition.model import Model
from nodes.perceptual.recognition.peaks import Detection
from nodes.perceptual.recognition.wrist import mirrored

LOOKED_BACK_S = 4.0
AROUND_S = 0.5
"""The curve may fit best a little earlier or later than where the gesture was recognised."""
_LEAST = 0.25
"""A movement of which it is less certain is none of the gestures: the last one stays."""


class BandPanel(QWidget):
    """Follows what is tried out."""

    def __init__(
        self, desk: TrainerDesk, title: Callable[[str], str], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._desk, self._title = desk, title
        self._model: Model | None = None
        self._shown: Detection | None = None
        self.band: Band | None = None
        self.gesture = QComboBox()
        self.gesture.setAccessibleName(tr("Gesture of the curve"))
        self.kind = QComboBox()
        self.kind.setAccessibleName(tr("What is drawn"))
        self.view = BandView(desk.look)
        self.sentence = Words()
        self._lay_out()
        self.gesture.currentIndexChanged.connect(self._on_chosen)
        self.kind.currentIndexChanged.connect(self._show)
        self.use_model(None)

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        for box in (self.gesture, self.kind):
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
            row.addWidget(box, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addLayout(row)
        column.addWidget(self.view)
        column.addWidget(self.sentence)

    def use_model(self, model: Model | None) -> None:
        """Show the curves of this model."""
        self._model, self._shown = model, None
        chosen = self.gesture.currentData()
        with QSignalBlocker(self.gesture):
            self.gesture.clear()
            self.gesture.addItem(tr("Best fit"), "")
            for name in model.names if model is not None else ():
                self.gesture.addItem(self._title(name), name)
            self.gesture.setCurrentIndex(max(0, self.gesture.findData(chosen)))
        self._on_chosen()

    def follow(self, looks: Looks) -> None:
        """Show the last movement, if it is another one and may be a gesture."""
        since_s, name = looks.now_s - LOOKED_BACK_S, str(self.gesture.currentData() or "")
        found = looks.best(name, since_s) if name else looks.most_certain(since_s)
        if found is not None and found.certainty >= _LEAST and found != self._shown:
            self._shown = found
            self._compute(found.gesture)

    def _on_chosen(self) -> None:
        name = str(self.gesture.currentData() or "")
        if self._shown is not None and name not in ("", self._shown.gesture):
            self._shown = None
        shown = self._shown.gesture if self._shown is not None else name
        self._compute(shown or next(iter(self._model.names if self._model else ()), ""))

    def _compute(self, name: str) -> None:
        """Bring the movement and the curve together."""
        live, shown = self._desk.live, self._shown
        movement: Samples | None = None
        if live is not None and shown is not None:
            movement = live.between(shown.t_start - AROUND_S, shown.t_end + AROUND_S)
            if self._model is not None and is_mirrored(self._desk.wrist, self._model):
                movement = Samples(movement.t, *mirrored(movement.acc, movement.gyr))
        gravity = live.gravity_included if live is not None else True
        self.band = None
        if self._model is not None:
            self.band = band_of(self._model, name, movement, gravity_included=gravity)
        self._offer_kinds()
        self._show()

    def _offer_kinds(self) -> None:
        kinds = self.band.kinds if self.band is not None else KINDS[:1]
        if [self.kind.itemData(at) for at in range(self.kind.count())] == list(kinds):
            return
        chosen = self.kind.currentData()
        with QSignalBlocker(self.kind):
            self.kind.clear()
            for kind in kinds:
                self.kind.addItem(kind_words(kind), kind)
            self.kind.setCurrentIndex(max(0, self.kind.findData(chosen)))

    def _show(self) -> None:
        if self.band is None:
            words = tr("There is no expected curve for this sensor.") if self._model else ""
        else:
            words = in_words(self.band, self._title(self.band.gesture))
        self.view.show_band(self.band, str(self.kind.currentData()), words)
        self.sentence.setText(words)
