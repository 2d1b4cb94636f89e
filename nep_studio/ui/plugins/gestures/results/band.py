"""A movement beside the curve that the paper's recogniser expects, and the band around it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_core.errors import RecordingError
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.live import Samples
from nep_studio.ui.ring import Floats
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.layouts import InLines, in_column, in_row
from nep_studio.ui.words import tr
from nodes.perceptual.recognition.features import POINTS, Detection, Integers, Singles, cut_windows
from nodes.perceptual.recognition.gmr import Gmr
from nodes.perceptual.recognition.model import Model, Recogniser
from nodes.perceptual.recognition.streams import EvenStream, mirrored

from .certainties import CertaintyHistory, is_mirrored
from .labels import Words, curve_pen, paint_legend

WIDE = 2.0
"""The band is so many standard deviations wide, to each side."""
KINDS = ("body", "rotation", "gravity")
_INSIDE, _MOSTLY = 0.9, 0.7
_PARTS = 3
_STEP = 2
"""Of so many samples, one is tried as the end of the movement."""
_LEAST_SAMPLES = 6


@dataclass(frozen=True)
class Band:
    """n signals over 32 points; ``mean`` and ``spread`` (32, n) are expected, ``live`` was made.

    ``names`` are such as "body x". ``live`` is None while nothing was made.
    """

    gesture: str
    names: tuple[str, ...]
    mean: Floats
    spread: Floats
    live: Floats | None

    @property
    def kinds(self) -> tuple[str, ...]:
        """Which kinds of signals there are."""
        return tuple(kind for kind in KINDS if any(name.startswith(kind) for name in self.names))

    def columns(self, kind: str) -> list[int]:
        """The signals of a kind along x, y and z."""
        wanted = [f"{kind} {axis}" for axis in "xyz"]
        return [self.names.index(name) for name in wanted if name in self.names]

    @property
    def is_inside(self) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
        """Where what was made is within the band; (32, n)."""
        if self.live is None:
            return np.ones(self.mean.shape, bool)
        inside: np.ndarray[tuple[int, int], np.dtype[np.bool_]] = (
            np.abs(self.live - self.mean) <= WIDE * self.spread
        )
        return inside

    @property
    def share_inside(self) -> float:
        """Which part of the movement is within the band."""
        return float(self.is_inside.mean())

    def worst(self) -> tuple[str, int]:
        """The kind of signal that leaves the band most, and the part of the movement (0 to 2)."""
        outside = ~self.is_inside
        parts = np.array_split(outside, _PARTS)
        amounts = {
            (kind, part): float(rows[:, self.columns(kind)].mean())
            for kind in self.kinds
            for part, rows in enumerate(parts)
        }
        return max(amounts, key=lambda key: amounts[key])


def band_of(
    model: Model, gesture: str, movement: Samples | None, *, gravity_included: bool
) -> Band | None:
    """What is expected of a gesture, and the movement in the same signals; None without a curve.

    Of the movement that part is taken that is most like the gesture.
    """
    has_rotation = movement is None or movement.gyr is not None
    try:
        recogniser = model.recogniser("gmr", gravity_included, has_rotation)
    except RecordingError:
        return None
    if gesture not in model.names or not isinstance(recogniser.scorer, Gmr):
        return None
    number, curves = model.names.index(gesture), recogniser.scorer.curves
    mean, spread = curves.expected(number)
    live = None
    if movement is not None:
        signals = _windows(movement, recogniser, model.lengths[model.fits[:, number]])
        if len(signals):
            live = signals[curves.distances(signals)[:, number].argmin()].astype(float)
    return Band(gesture, recogniser.channels.signal_names, mean, spread, live)


def _windows(movement: Samples, recogniser: Recogniser, lengths: Integers) -> Singles:
    """All windows of a movement as the recogniser sees them; (n, 32, signals)."""
    channels = recogniser.channels
    parts = [movement.acc] if movement.gyr is None else [movement.acc, movement.gyr]
    values = np.hstack(parts)[:, : channels.columns]
    stretches = list(EvenStream().push(movement.t, values))
    rows = max((one.values for one in stretches), key=len, default=values[:0])
    if len(rows) < _LEAST_SAMPLES:
        return np.empty((0, POINTS, channels.signals), np.float32)
    usable = lengths[lengths <= len(rows)]
    sizes = usable if len(usable) else np.array([len(rows)])
    pairs = [(last, size) for size in sizes.tolist() for last in range(size - 1, len(rows), _STEP)]
    last, length = np.array(pairs, np.intp).T
    return recogniser.windows(cut_windows(rows, last, length), length).signals


def kind_words(kind: str) -> str:
    """What the signals of a kind are called."""
    return {
        "body": tr("Movement"),
        "rotation": tr("Rotation"),
        "gravity": tr("How the watch is held"),
    }[kind]


def in_words(band: Band, title: str) -> str:
    """What the picture shows."""
    if band.live is None:
        return tr(
            "The line is how “{gesture}” is expected, the band how far takes stray from it."
            " Make the gesture to see yours over it.",
            gesture=title,
        )
    share, percent = band.share_inside, round(band.share_inside * 100)
    if share >= _INSIDE:
        return tr(
            "Your movement follows “{gesture}”: {percent} % of it is within the band.",
            gesture=title,
            percent=percent,
        )
    kind, part = band.worst()
    where = (tr("at the beginning"), tr("in the middle"), tr("at the end"))[part]
    if share >= _MOSTLY:
        return tr(
            "Your movement is near “{gesture}”: {percent} % of it is within the band."
            " It strays most {where} ({signal}).",
            gesture=title,
            percent=percent,
            where=where,
            signal=kind_words(kind),
        )
    return tr(
        "Your movement is not “{gesture}”: only {percent} % of it is within the band."
        " It strays most {where} ({signal}).",
        gesture=title,
        percent=percent,
        where=where,
        signal=kind_words(kind),
    )


# Draws the expected curve of a gesture with its band, and the last movement over it.

LINES_HIGH = 3.6
"""How high the strip of one axis is."""
_AXES = "xyz"


class BandView(InLines):
    """Three strips, one for each axis, over the duration of the movement."""

    usual_lines = (16, LINES_HIGH * len(_AXES) + 1.5)
    least_lines = (9, LINES_HIGH * len(_AXES) + 1.5)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.band: Band | None = None
        self.kind = "body"
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        labelled(self, name="Expected curve")
        look.theme_changed.connect(self.update)

    def show_band(self, band: Band | None, kind: str, words: str) -> None:
        """Show the signals of a kind; ``words`` say what is to be seen."""
        self.band, self.kind = band, kind
        self.setAccessibleDescription(words)
        self.update()

    def strip(self, number: int) -> QRectF:
        """Where the strip of an axis is."""
        line = self.fontMetrics().height()
        top = line * (1.5 + number * LINES_HIGH)
        return QRectF(line * 1.2, top, self.width() - line * 1.2 - 1, line * (LINES_HIGH - 0.4))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the strips."""
        theme = self._look.theme
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        columns = self.band.columns(self.kind) if self.band is not None else []
        for number, axis in enumerate(_AXES):
            strip = self.strip(number)
            painter.fillRect(strip, theme.colour("field"))
            if self.band is not None and number < len(columns):
                painter.setClipRect(strip)
                self._paint_strip(painter, theme, self.band, columns, number)
                painter.setClipping(False)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(theme.colour("line"), 1))
            painter.drawRect(strip)
            painter.setPen(theme.colour("muted"))
            room = QRectF(0, strip.top(), strip.left(), strip.height())
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter, axis)
        legend = {
            tr("expected"): self._pen(theme, "plot_1"),
            tr("yours"): self._pen(theme, "plot_2"),
        }
        paint_legend(painter, self.strip(0).left(), legend, theme.colour("text"))
        painter.end()

    def _paint_strip(
        self, painter: QPainter, theme: Theme, band: Band, columns: list[int], number: int
    ) -> None:
        column, strip = columns[number], self.strip(number)
        low, high = _range(band, columns)

        def line_of(values: Floats) -> list[QPointF]:
            xs = np.linspace(strip.left(), strip.right(), len(values))
            ys = strip.bottom() - (values - low) / (high - low) * strip.height()
            return [QPointF(float(x), float(y)) for x, y in zip(xs, ys, strict=True)]

        mean, wide = band.mean[:, column], WIDE * band.spread[:, column]
        pale = theme.colour("plot_1")
        pale.setAlphaF(0.25)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(pale)
        painter.drawPolygon(QPolygonF([*line_of(mean + wide), *reversed(line_of(mean - wide))]))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(self._pen(theme, "plot_1"))
        painter.drawPolyline(QPolygonF(line_of(mean)))
        if band.live is not None:
            painter.setPen(self._pen(theme, "plot_2"))
            painter.drawPolyline(QPolygonF(line_of(band.live[:, column])))

    def _pen(self, theme: Theme, colour: str) -> QPen:
        return curve_pen(theme, colour, max(2.0, self.fontMetrics().height() / 9))


def _range(band: Band, columns: list[int]) -> tuple[float, float]:
    """The values that the strips have room for, the same for all three."""
    mean, wide = band.mean[:, columns], WIDE * band.spread[:, columns]
    parts = [mean - wide, mean + wide] + ([] if band.live is None else [band.live[:, columns]])
    low, high = min(float(one.min()) for one in parts), max(float(one.max()) for one in parts)
    margin = max(high - low, 0.1) * 0.05
    return low - margin, high + margin


# The expected curve of the gesture that fits best, or of a chosen one, in pictures and words.

LOOKED_BACK_S = 4.0
AROUND_S = 0.5
"""The curve may fit best a little earlier or later than where the gesture was recognised."""
_LEAST = 0.25
"""A movement of which it is less certain is none of the gestures: the last one stays."""


class BandPanel(QWidget):
    """Follows what is tried out."""

    def __init__(self, controller: GestureController, title: Callable[[str], str]) -> None:
        super().__init__()
        self._controller, self._title = controller, title
        self._model: Model | None = None
        self._shown: Detection | None = None
        self.band: Band | None = None
        self.gesture = labelled(Choices(self._gestures), name="Gesture of the curve")
        self.kind = labelled(Choices(self._kinds), name="What is drawn")
        self.view = BandView(controller.look)
        self.sentence = Words()
        for box in (self.gesture, self.kind):
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        row = in_row((self.gesture, 1), (self.kind, 1))
        in_column(row, self.view, self.sentence, of=self, margins=0)
        self.gesture.currentIndexChanged.connect(self._on_chosen)
        self.kind.currentIndexChanged.connect(self._show)
        self.use_model(None)
        follow_words(self, self._show)

    def _gestures(self) -> dict[str, str]:
        names = self._model.names if self._model is not None else ()
        return {"": tr("Best fit")} | {name: self._title(name) for name in names}

    def _kinds(self) -> dict[str, str]:
        kinds = self.band.kinds if self.band is not None else KINDS[:1]
        return {kind: kind_words(kind) for kind in kinds}

    def use_model(self, model: Model | None) -> None:
        """Show the curves of this model."""
        self._model, self._shown = model, None
        self.gesture.refill()
        self._on_chosen()

    def follow(self, history: CertaintyHistory) -> None:
        """Show the last movement, if it is another one and may be a gesture."""
        since_s, name = history.now_s - LOOKED_BACK_S, str(self.gesture.currentData() or "")
        found = history.best(name, since_s) if name else history.most_certain(since_s)
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
        live, shown = self._controller.live, self._shown
        movement: Samples | None = None
        if live is not None and shown is not None:
            movement = live.between(shown.t_start - AROUND_S, shown.t_end + AROUND_S)
            if self._model is not None and is_mirrored(self._controller.wrist, self._model):
                movement = Samples(movement.t, *mirrored(movement.acc, movement.gyr))
        gravity = live is None or live.gravity_included
        self.band = None
        if self._model is not None:
            self.band = band_of(self._model, name, movement, gravity_included=gravity)
        self.kind.refill()
        self._show()

    def _show(self) -> None:
        if self.band is None:
            words = tr("There is no expected curve for this sensor.") if self._model else ""
        else:
            words = in_words(self.band, self._title(self.band.gesture))
        self.view.show_band(self.band, str(self.kind.currentData()), words)
        self.sentence.setText(words)
