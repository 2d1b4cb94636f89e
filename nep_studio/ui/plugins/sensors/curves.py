"""Which curves there are: one for each number of each stream, in rows that share an axis."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFontMetricsF, QIcon, QPainter, QPen, QPixmap

from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.widgets.curves import line_width
from nep_studio.ui.words import tr

from .streams import ACCELERATION, MAGNITUDE, ROTATION, ImuStream, Stream, StreamKey

# How curves look: each has a colour and a kind of line, so that colour never speaks alone.

COLOURS = 6
_PATTERNS: tuple[tuple[float, ...], ...] = (
    (),
    (8, 4),
    (2, 3),
    (10, 3, 2, 3),
    (14, 6),
    (6, 2, 1, 2, 1, 2),
)
"""Lengths of dashes and of what is between them, in widths of the line."""
_DASHES_IN_ICON = 3.2
"""How long the icon of a line is, in lines of text: every pattern can be told from the others."""


@dataclass(frozen=True)
class CurveLook:
    """A colour of the theme's table and a pattern, by number; the seventh is like the first."""

    number: int

    def pen(self, theme: Theme, metrics: QFontMetricsF) -> QPen:
        """The pen that draws the curve."""
        colour = theme.colour(f"plot_{self.number % COLOURS + 1}")
        pen = QPen(colour, line_width(theme, metrics))
        pen.setCosmetic(True)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        pattern = _PATTERNS[self.number % len(_PATTERNS)]
        if pattern:
            pen.setDashPattern(list(pattern))
        return pen

    def icon(self, theme: Theme, metrics: QFontMetricsF, ratio: float) -> QIcon:
        """A piece of the line."""
        size = icon_size(metrics)
        pixmap = QPixmap(size * ratio)
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        painter = QPainter(pixmap)
        pen = self.pen(theme, metrics)
        pen.setWidthF(pen.widthF() * 1.5)
        painter.setPen(pen)
        painter.drawLine(0, size.height() // 2, size.width(), size.height() // 2)
        painter.end()
        return QIcon(pixmap)


def icon_size(metrics: QFontMetricsF) -> QSize:
    """How large the piece of a line in a list is."""
    height = round(metrics.height())
    return QSize(round(height * _DASHES_IN_ICON), height)


@dataclass(frozen=True)
class CurveKey:
    """Which curve: a stream, and a channel of it by its place."""

    stream: StreamKey
    channel: int


@dataclass(frozen=True)
class Curve:
    """A curve: its name in words, its unit, how it looks."""

    key: CurveKey
    name: str
    unit: str
    look: CurveLook


@dataclass(frozen=True)
class Row:
    """Curves that share a plot; ``title`` names what they have in common."""

    title: str
    source: str
    unit: str
    curves: tuple[Curve, ...]

    @property
    def heading(self) -> str:
        """What it shows, with the unit."""
        return f"{self.title} ({self.unit})" if self.unit else self.title

    @property
    def key(self) -> tuple[CurveKey, ...]:
        """What tells it from other rows."""
        return tuple(curve.key for curve in self.curves)


def rows_of(streams: Mapping[StreamKey, Stream]) -> list[Row]:
    """The rows for these streams, sensors first."""
    groups: dict[tuple[str, str, str], list[tuple[Stream, int]]] = {}
    for stream in sorted(
        streams.values(), key=lambda one: isinstance(one, ImuStream), reverse=True
    ):
        for at, channel in enumerate(stream.channels):
            if _is_there(stream, channel.group):
                place = (stream.key.topic, stream.key.sender, channel.group)
                groups.setdefault(place, []).append((stream, at))
    return [_row(source, group, members) for (_, source, group), members in groups.items()]


def curves_of(rows: Iterable[Row]) -> dict[CurveKey, Curve]:
    """All curves of the rows, by what they show."""
    return {curve.key: curve for row in rows for curve in row.curves}


def _is_there(stream: Stream, group: str) -> bool:
    """A watch without a gyroscope has no row for it."""
    return not (isinstance(stream, ImuStream) and group == ROTATION and not stream.has_rotation)


def _row(source: str, group: str, members: list[tuple[Stream, int]]) -> Row:
    unit = members[0][0].channels[members[0][1]].unit
    titles = {ACCELERATION: tr("Acceleration"), ROTATION: tr("Gyroscope")}
    curves = tuple(
        Curve(CurveKey(stream.key, at), _name(stream, at), unit, CurveLook(number))
        for number, (stream, at) in enumerate(members)
    )
    return Row(titles.get(group, group), source, unit, curves)


def _name(stream: Stream, at: int) -> str:
    name = stream.channels[at].name
    return tr("magnitude") if name == MAGNITUDE else name


# Which values a plot shows: all that are there, without trembling with every sample.

_ROOM = 0.08
"""Above and below the curves, as a part of their height."""
_EMPTY = 0.45
"""When curves need less than this part of the height, the range becomes narrower."""
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


@dataclass(frozen=True)
class ValueRange:
    """The values from ``low`` to ``high``, which is greater."""

    low: float = -1.0
    high: float = 1.0

    @property
    def height(self) -> float:
        """How far it reaches."""
        return self.high - self.low

    def zoomed(self, factor: float, share: float) -> ValueRange:
        """Fewer values (``factor`` below 1) or more; the one at ``share`` from below stays."""
        held = self.low + share * self.height
        height = min(max(self.height * factor, 1e-9), 1e12)
        return ValueRange(held - share * height, held + (1 - share) * height)

    def moved(self, by: float) -> ValueRange:
        """Higher or lower values."""
        return ValueRange(self.low + by, self.high + by)

    def fitted(self, low: float, high: float) -> ValueRange:
        """A range for values from ``low`` to ``high``: this one while it serves them well."""
        if not (math.isfinite(low) and math.isfinite(high)):
            return self
        # A curve that does not change is a line in the middle, not noise of its last digit
        middle, height = (low + high) / 2, max(high - low, abs(low) * 1e-3, abs(high) * 1e-3, 1e-9)
        is_inside = self.low <= low and high <= self.high
        if is_inside and height >= _EMPTY * self.height:
            return self
        step = _round_step(height / 8)
        first = math.floor((middle - height * (0.5 + _ROOM)) / step) * step
        last = math.ceil((middle + height * (0.5 + _ROOM)) / step) * step
        return ValueRange(first, last)


def _round_step(height: float) -> float:
    power: float = 10.0 ** math.floor(math.log10(height))
    return next(step * power for step in _STEPS if step * power >= height * 0.999)
