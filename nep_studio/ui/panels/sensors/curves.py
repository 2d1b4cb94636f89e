"""Which curves there are: one for each number of each stream, in rows that share an axis."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from nep_studio.ui.panels.sensors.imu_stream import (
    ACCELERATION,
    MAGNITUDE,
    ROTATION,
    ImuStream,
)
from nep_studio.ui.panels.sensors.looks import CurveLook
from nep_studio.ui.panels.sensors.streams import Stream, StreamKey
from nep_studio.ui.words import tr


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
