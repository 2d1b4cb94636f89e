"""The app Sensor Logger, which pushes its sensors by HTTP to any address of this computer.

It waits for the answer 200; its button "Tap to Test Pushing" sends a message without readings.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from faults import Text, text_of
from nep_core.processes.manifest import finite_number
from nep_core.wire.frames import CANNOT_DECODE
from nodes.sensory.reading import G_M_S2, NS, Reading, Vector, added, scaled, vector

from .connector import Arrived, Ordering, Settings, Timed, nearest
from .servers import Background, body_of, missing_words, open_tcp, own_addresses, serve

if TYPE_CHECKING:
    from aiohttp import web


# What the app Sensor Logger pushes, turned into readings.
#
# Source: tszheichoi/awesome-sensor-logger, PUSHING.md (the schema of messages), UNITS.md,
# COORDINATES.md and CROSSPLATFORM.md. A message is ``{"messageId", "sessionId", "deviceId",
# "payload": [{"name", "time": nanoseconds since 1970, "values": {...}}, ...]}``; readings of
# different sensors come in any order. ``accelerometer`` has no gravity, which is a sensor of its
# own; ``totalacceleration`` (Android) and ``accelerometeruncalibrated`` have it. ``wrist motion``
# is the watch. All count in m/s² and rad/s as Android does, if "Standardise Units & Frames" is on;
# else iPhones turn all axes of accelerations round, and count the uncalibrated one and those of
# the watch in g.

_WITHIN_NS = 50e6
_G_SIZES = (0.3, 3.0)  # a gravity of such a size is counted in g
_WRIST = "wristmotion"
_MOST_NAMES, _LONGEST_NAME = 8, 30
_PARTS = ("rotationRate", "gravity", "acceleration")
_USED = (*"xyz", *(f"{part}{axis}" for part in _PARTS for axis in "XYZ"))


class Message(msgspec.Struct):
    """A pushed message, as far as it is used."""

    payload: list[dict[str, object]]
    messageId: int | None = None  # noqa: N815 - the app's own names
    sessionId: str = ""  # noqa: N815
    deviceId: str = ""  # noqa: N815


@dataclass(frozen=True)
class Pushed:
    """A message's readings in the order of their times; ``used`` names their sensors.

    ``sent`` names all sensors of the message; ``broken`` counts values that are no numbers.
    """

    readings: list[Reading]
    used: str = ""
    has_wrist: bool = False
    sent: tuple[str, ...] = ()
    broken: int = 0


@dataclass
class _Sensors:
    """The sensors of a message by name, each in the order of its times."""

    by_name: dict[str, list[Timed]] = field(default_factory=dict)
    broken: int = 0

    def add(self, name: str, time: float | None, values: Vector | None) -> None:
        if time is None or values is None:
            self.broken += 1
        else:
            self.by_name.setdefault(name, []).append((time, values))

    def of(self, name: str) -> list[Timed]:
        return sorted(self.by_name.get(name, ()))


def read_message(body: bytes) -> Message | None:
    """A pushed body; None when it is none."""
    try:
        message = msgspec.json.decode(body, type=Message)
    except CANNOT_DECODE:
        return None
    message.payload = [_needed(one) for one in message.payload]
    return message


def _needed(one: Mapping[str, object]) -> dict[str, object]:
    """What is used of one sensor: messages may be held back, so what else it says must go."""
    values, time = one.get("values"), one.get("time")
    kept: dict[str, object] = {"name": str(one.get("name"))[:_LONGEST_NAME]}
    if _is_short(time):
        kept["time"] = time
    if isinstance(values, dict):
        kept["values"] = {name: values[name] for name in _USED if _is_short(values.get(name))}
    return kept


def _is_short(value: object) -> bool:
    return isinstance(value, (int, float)) or (isinstance(value, str) and len(value) < 40)


def readings_of(message: Message, units: str, *, follows_wrist: bool = False) -> Pushed:
    """The readings of a message; those of the phone only, where no watch sends.

    ``units`` is "guess", "standard" or "apple", as set by the user.
    """
    sensors = _sensors(message.payload)
    has_wrist = f"{_WRIST}.rotationrate" in sensors.by_name
    uses_wrist = has_wrist or follows_wrist
    readings, used = _wrist(sensors, units) if uses_wrist else _phone(sensors, units)
    sent = dict.fromkeys(str(one.get("name"))[:_LONGEST_NAME] for one in message.payload)
    return Pushed(readings, used, has_wrist, tuple(sent)[:_MOST_NAMES], sensors.broken)


def _sensors(payload: Iterable[Mapping[str, object]]) -> _Sensors:
    found = _Sensors()
    for one in payload:
        name = str(one.get("name")).lower().replace(" ", "").replace("_", "")
        values, time = one.get("values"), finite_number(one.get("time"))
        if not isinstance(values, dict):
            continue
        if name == _WRIST:
            for part in _PARTS:
                three = vector([values.get(f"{part}{axis}") for axis in "XYZ"])
                found.add(f"{name}.{part.lower()}", time, three)
        elif "x" in values:
            found.add(name, time, vector(values))
    return found


def _wrist(sensors: _Sensors, units: str) -> tuple[list[Reading], str]:
    """Those of the watch: acceleration and gravity apart, in one time."""
    moving = sensors.of(f"{_WRIST}.acceleration")
    gravity = sensors.of(f"{_WRIST}.gravity")
    turning = sensors.of(f"{_WRIST}.rotationrate")
    is_in_g = units == "apple" or (units == "guess" and _is_in_g(gravity))
    scale = -G_M_S2 if is_in_g else 1.0
    return _joined(_sum(moving, gravity), turning, scale), "wrist motion"


def _phone(sensors: _Sensors, units: str) -> tuple[list[Reading], str]:
    """Those of the phone: the best acceleration that it sends."""
    turning = sensors.of("gyroscope") or sensors.of("gyroscopeuncalibrated")
    gravity, raw = sensors.of("gravity"), sensors.of("accelerometeruncalibrated")
    is_apple = units == "apple" or (units == "guess" and _is_in_g(raw))
    sign = -1.0 if is_apple else 1.0
    total, moving = sensors.of("totalacceleration"), sensors.of("accelerometer")
    gyroscope = " + gyroscope" if turning else ""
    if total:
        return _joined(total, turning, 1.0), f"total acceleration{gyroscope}"
    if moving and gravity:
        return _joined(_sum(moving, gravity), turning, sign), f"accelerometer + gravity{gyroscope}"
    if raw:
        scale = -G_M_S2 if is_apple else 1.0
        return _joined(raw, turning, scale), f"accelerometer uncalibrated{gyroscope}"
    return _joined(moving, turning, sign, has_gravity=False), f"accelerometer{gyroscope}"


def _is_in_g(gravity: list[Timed]) -> bool:
    """Whether the usual size is that of gravity in g."""
    sizes = sorted(sum(one * one for one in values) ** 0.5 for _, values in gravity)
    return bool(sizes) and _G_SIZES[0] < sizes[len(sizes) // 2] < _G_SIZES[1]


def _sum(moving: list[Timed], gravity: list[Timed]) -> list[Timed]:
    found = []
    for time_ns, values in moving:
        other = nearest(gravity, time_ns, _WITHIN_NS)
        if other is not None:
            found.append((time_ns, added(values, other)))
    return found


def _joined(
    acc: list[Timed], turning: list[Timed], scale: float, *, has_gravity: bool = True
) -> list[Reading]:
    return [
        Reading(scaled(values, scale), nearest(turning, time, _WITHIN_NS), time, NS, has_gravity)
        for time, values in acc
    ]


_GREETING = "NEP Studio hears Sensor Logger here. Give the app this address as its push URL."
_NO_MESSAGE = "This is no message of Sensor Logger: it is a JSON object with a payload."
_TOO_LARGE = "This is larger or slower than can be taken in. Choose a shorter batch period."
_MOST_DEVICES = 16
_LONGEST_ID = 64
_MOST_READINGS = 4_000  # in a message; a second of a watch has 100


class _Device:
    """One device that pushes: its messages in their order, and what users call it."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.session = ""
        self.order: Ordering[Message] = Ordering()
        self.wears_watch = False


class SensorLoggerConnector(Background):
    """A web server that takes what the app pushes, at every path."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        self._door: socket.socket | None = None
        self._devices: dict[tuple[str, str], _Device] = {}

    @property
    def where(self) -> Text:
        """What the node is ready for."""
        return text_of(
            "waits for Sensor Logger on HTTP port {port} ({where})",
            port=self._settings.port,
            where=self._settings.where,
        )

    @property
    def missing(self) -> Text:
        """What to check when nothing has arrived."""
        if self._settings.listen_on == "this computer":
            return missing_words(self._settings, "Sensor Logger")
        url = f"http://{own_addresses(self._settings)[0]}:{self._settings.port}/data"
        return text_of(
            "Nothing has arrived for 10 seconds. Is the push URL in Sensor Logger {url} (with "
            "http, not https), is it recording, and does this computer's firewall let it in?",
            url=url,
        )

    def open(self) -> None:
        """Open the port and serve; raises PortTaken."""
        self._door = open_tcp(self._settings)
        self.start()

    def close(self) -> None:
        """Stop serving."""
        super().close()
        if self._door is not None:
            self._door.close()
            self._door = None

    async def _serve(self) -> None:
        if self._door is not None:
            await serve(self._door, self._answer)

    async def _answer(self, request: web.Request) -> web.Response:
        from aiohttp import web

        sender = request.remote or "?"
        if request.method != "POST":
            return web.Response(text=_GREETING)
        body = await body_of(request)
        if body is None:
            self._complain(sender, "{sender} pushes more than can be taken in at once.")
            return web.Response(status=413, text=_TOO_LARGE)
        message = read_message(body)
        if message is None or len(message.payload) > _MOST_READINGS:
            self._complain(
                sender, "{sender} pushes what is no message of Sensor Logger, or too large a one."
            )
            return web.Response(status=400, text=_NO_MESSAGE)
        self._take(sender, message)
        return web.Response(text="OK")

    def _take(self, address: str, message: Message) -> None:
        """Hand over what is in its order now."""
        now_s = time.monotonic()
        device = self._device(address, message.deviceId[:_LONGEST_ID])
        session = message.sessionId[:_LONGEST_ID]
        if device.session != session:
            device.session, device.order, device.wears_watch = session, Ordering(), False
        if message.messageId is None:
            self._hand_over(device, None, message, now_s)
            return
        for number, one in device.order.put(message.messageId, message, now_s):
            self._hand_over(device, number, one, now_s)

    def _device(self, address: str, identity: str) -> _Device:
        """A device by its address, and by its identity where two have one address."""
        key = (address, identity)
        device = self._devices.pop(key, None)
        if device is None:
            has_namesake = any(one.name == address for one in self._devices.values())
            device = _Device(f"{address} ({identity[:6]})" if has_namesake else address)
        self._devices[key] = device
        if len(self._devices) > _MOST_DEVICES:
            del self._devices[next(iter(self._devices))]
        return device

    def _hand_over(
        self, device: _Device, number: int | None, message: Message, now_s: float
    ) -> None:
        pushed = readings_of(message, self._settings.units, follows_wrist=device.wears_watch)
        device.wears_watch = device.wears_watch or pushed.has_wrist
        trouble = _trouble(device.name, pushed, is_watch=device.wears_watch)
        told = pushed.used if pushed.readings else ""
        self.put(Arrived(device.name, pushed.readings, now_s, trouble, told, number))

    def _complain(self, sender: str, template: str) -> None:
        trouble = text_of(template, sender=sender)
        self.put(Arrived(sender, arrived_s=time.monotonic(), trouble=trouble))


def _trouble(sender: str, pushed: Pushed, *, is_watch: bool) -> Text:
    """What of a message cannot be used; a watch sends its own readings only now and then."""
    if pushed.broken:
        return text_of(
            "{sender} sends values that are not numbers; they are left out.", sender=sender
        )
    if pushed.readings or not pushed.sent or is_watch:
        return Text("")
    names = ", ".join(pushed.sent)
    return text_of(
        "{sender} sends no acceleration, only {names}. Switch on Accelerometer, Gravity and "
        "Gyroscope in Sensor Logger, or Wrist Motion of the watch.",
        sender=sender,
        names=names,
    )
