"""The app phyphox with its remote access: the phone is the server, and is asked what is new."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from faults import Text, text_of
from nep_core.processes.manifest import finite_number
from nep_core.wire.frames import CANNOT_DECODE
from nodes.sensory.reading import Reading, scaled, vector

from .connector import Arrived, Timed, nearest
from .servers import OutboundConnector

if TYPE_CHECKING:
    from aiohttp import ClientSession


# What phyphox on a phone tells: which buffers its sensors fill, and what is new in them.
#
# Source: phyphox/phyphox-android, RemoteServer.java, and the phyphox wiki, "Remote-interface
# communication". ``/config`` has ``inputs``: ``{"source": "accelerometer", "outputs": [{"x":
# "accX"}, ..., {"t": "acc_time"}]}``; the names differ by experiment. ``/get?acc_time=T&accX=T|
# acc_time`` has the values where ``acc_time`` is above T: ``{"buffer": {"accX": {"updateMode":
# "partial", "buffer": [...]}}, "status": {"session": ..., "measuring": true}}``, null for no value.
# Times are s since the start, accelerations m/s², rotations rad/s.

_WITHIN_S = 0.1
_SOURCES = ("accelerometer", "linear_acceleration", "gyroscope")
_USUAL = {
    "accelerometer": ("acc_time", "accX", "accY", "accZ"),
    "gyroscope": ("gyr_time", "gyrX", "gyrY", "gyrZ"),
    "linear_acceleration": ("lin_acc_time", "lin_accX", "lin_accY", "lin_accZ"),
}


@dataclass(frozen=True)
class Sensor:
    """The buffers that one sensor fills: its times, and three axes."""

    source: str
    time: str
    axes: tuple[str, str, str]


@dataclass
class Experiment:
    """What is open in phyphox, and up to which time each sensor was read."""

    title: str
    acc: Sensor | None
    gyr: Sensor | None
    session: str = ""
    measuring: bool = True
    read_to: dict[str, float | None] = field(default_factory=dict)

    @property
    def sensors(self) -> list[Sensor]:
        """Those that are read."""
        return [one for one in (self.acc, self.gyr) if one is not None]

    def query(self) -> list[tuple[str, str]]:
        """What to ask ``/get`` for: all that is new; at first, only the last times."""
        asked: list[tuple[str, str]] = []
        for sensor in self.sensors:
            last = self.read_to.get(sensor.time)
            if last is None:
                asked.append((sensor.time, ""))
                continue
            asked.append((sensor.time, repr(last)))
            asked += [(axis, f"{last!r}|{sensor.time}") for axis in sensor.axes]
        return asked

    def take(self, answer: Mapping[str, object], *, is_apple: bool) -> list[Reading]:
        """The new readings of an answer of ``/get``."""
        buffers, status = answer.get("buffer"), answer.get("status")
        if isinstance(status, dict):
            self.session = str(status.get("session", ""))
            self.measuring = status.get("measuring") is True
        if not isinstance(buffers, dict):
            return []
        found = {sensor: self._new(sensor, buffers) for sensor in self.sensors}
        if self.acc is None:
            return []
        turning = found[self.gyr] if self.gyr else []
        has_gravity = self.acc.source == "accelerometer"
        sign = -1.0 if is_apple else 1.0
        return [
            Reading(scaled(acc, sign), nearest(turning, t, _WITHIN_S), t, 1.0, has_gravity)
            for t, acc in found[self.acc]
        ]

    def _new(self, sensor: Sensor, buffers: Mapping[str, object]) -> list[Timed]:
        """The new values of a sensor; a buffer that was cleared begins anew."""
        before = self.read_to.get(sensor.time)
        mode, times = _buffer(buffers, sensor.time)
        numbers = [one for time in times if (one := finite_number(time)) is not None]
        if before is None:
            self.read_to[sensor.time] = numbers[-1] if numbers else -1.0
            return []
        if mode == "full" or numbers:
            self.read_to[sensor.time] = numbers[-1] if numbers else -1.0
        axes = [_buffer(buffers, name)[1] for name in sensor.axes]
        rows = zip(times, *axes, strict=False)
        return [
            (time, values)
            for t, *axis in rows
            if (time := finite_number(t)) is not None and (values := vector(axis)) is not None
        ]


def read_config(body: bytes) -> Experiment | None:
    """The experiment of an answer of ``/config``; None when it is none."""
    config = _object(body)
    if config is None:
        return None
    found = {one.source: one for one in _inputs(config)} or _by_name(config)
    title = str(config.get("localTitle") or config.get("title") or "")[:60]
    acc = found.get("accelerometer") or found.get("linear_acceleration")
    return Experiment(title, acc, found.get("gyroscope"))


def read_answer(body: bytes) -> Mapping[str, object] | None:
    """An answer of ``/get``; None when it is none."""
    answer = _object(body)
    return answer if answer is not None and "buffer" in answer else None


def _object(body: bytes) -> dict[str, object] | None:
    try:
        found = msgspec.json.decode(body)
    except CANNOT_DECODE:
        return None
    return found if isinstance(found, dict) else None


def _inputs(config: Mapping[str, object]) -> list[Sensor]:
    inputs = config.get("inputs")
    sensors = []
    for one in inputs if isinstance(inputs, list) else ():
        if not isinstance(one, dict) or one.get("source") not in _SOURCES:
            continue
        outputs = one.get("outputs")
        names: dict[str, str] = {}
        for output in outputs if isinstance(outputs, list) else ():
            if isinstance(output, dict):
                names |= {str(part): str(name) for part, name in output.items()}
        if all(part in names for part in "xyzt"):
            sensors.append(Sensor(one["source"], names["t"], (names["x"], names["y"], names["z"])))
    return sensors


def _by_name(config: Mapping[str, object]) -> dict[str, Sensor]:
    """Where ``inputs`` say nothing: by the names that phyphox's own experiments use."""
    buffers = config.get("buffers")
    there = {
        str(one.get("name"))
        for one in (buffers if isinstance(buffers, list) else ())
        if isinstance(one, dict)
    }
    return {
        source: Sensor(source, time, (x, y, z))
        for source, (time, x, y, z) in _USUAL.items()
        if {time, x, y, z} <= there
    }


def _buffer(buffers: Mapping[str, object], name: str) -> tuple[str, Sequence[object]]:
    part = buffers.get(name)
    if not isinstance(part, dict) or not isinstance(part.get("buffer"), list):
        return "", []
    return str(part.get("updateMode")), part["buffer"]


_ASK_EVERY_S = 0.05
_TRY_AGAIN_S = (0.5, 1.0, 2.0, 5.0)
_ANSWER_S = 5.0
_MOST_BYTES = 4_000_000
_LOST_S = 2.0  # so long without anything new, and its times are asked for anew
_MOST_READINGS = 2_000  # of one answer: the last ones, after a pause


class PhyphoxConnector(OutboundConnector):
    """Asks a phone some twenty times a second, and again when it was away."""

    app = "phyphox"

    @property
    def where(self) -> Text:
        """What the node is ready for."""
        return text_of("asks phyphox at {host}, port {port}", **self._place)

    @property
    def missing(self) -> Text:
        """What to check when nothing has arrived."""
        return text_of(
            "Nothing has arrived for 10 seconds. Does phyphox show the address {host} and the port "
            "{port} under “Allow remote access”, and is its experiment running?",
            **self._place,
        )

    async def _serve(self) -> None:
        from aiohttp import ClientError, ClientSession, ClientTimeout

        failures = 0
        while True:
            try:
                timeout = ClientTimeout(total=_ANSWER_S)
                base = f"http://{self._host}:{self._port}"
                async with ClientSession(base, timeout=timeout) as session:
                    await self._follow(session)
                failures = 0
            except (ClientError, OSError, TimeoutError, ValueError):
                self._say(
                    "phyphox at {host}, port {port} does not answer. Is “Allow remote access” "
                    "on, and the phone in the same network?"
                )
            await asyncio.sleep(_TRY_AGAIN_S[min(failures, len(_TRY_AGAIN_S) - 1)])
            failures += 1

    async def _follow(self, session: ClientSession) -> None:
        """Read one experiment until another is opened."""
        experiment = read_config(await _body(session, "/config"))
        if experiment is None:
            self._say("What answers at {host}, port {port} is not phyphox.")
            return
        if experiment.acc is None:
            self._say(
                "phyphox shows “{title}”, which has no accelerometer. Open an experiment with "
                "an accelerometer, such as “Acceleration with g”.",
                title=experiment.title,
            )
            return
        await self._read(session, experiment)

    async def _read(self, session: ClientSession, experiment: Experiment) -> None:
        first, started = "", False
        news_s = ran_s = time.monotonic()
        while True:
            answer = read_answer(await _body(session, "/get", experiment.query()))
            if answer is None:
                self._say("What answers at {host}, port {port} is not phyphox.")
                return
            readings = experiment.take(answer, is_apple=self._settings.units == "apple")
            first = first or experiment.session
            if experiment.session != first:
                return
            now_s = time.monotonic()
            if experiment.measuring:
                ran_s = now_s
            elif not started:
                await _body(session, "/control", [("cmd", "start")])
            elif now_s - ran_s > _LOST_S:
                self._say("The experiment in phyphox is paused. Press the play button in the app.")
            started = True
            if readings:
                news_s = now_s
                sources = " + ".join(sensor.source for sensor in experiment.sensors)
                self.put(Arrived(self._host, readings[-_MOST_READINGS:], now_s, columns=sources))
            elif now_s - news_s > _LOST_S:
                news_s = now_s
                experiment.read_to.clear()
            await asyncio.sleep(_ASK_EVERY_S)


async def _body(session: ClientSession, path: str, query: Sequence[tuple[str, str]] = ()) -> bytes:
    """The body of an answer; ValueError when it is no good one."""
    async with session.get(path, params=list(query)) as response:
        if response.status != 200:
            raise ValueError(response.status)
        body = b""
        async for chunk in response.content.iter_any():
            body += chunk
            if len(body) > _MOST_BYTES:
                raise ValueError("too large")
        return body
