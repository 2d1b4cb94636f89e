"""The app Sensor Logger, which pushes its sensors by HTTP to any address of this computer.

It waits for the answer 200; its button "Tap to Test Pushing" sends a message without readings.
"""

from __future__ import annotations

import socket
import time
from typing import TYPE_CHECKING

from nodes.sensory.ways.background import Background
from nodes.sensory.ways.doors import missing_words, open_tcp, own_addresses
from nodes.sensory.ways.http_server import body_of, serve
from nodes.sensory.ways.ordering import Ordering
from nodes.sensory.ways.sensor_logger_format import (
    Message,
    Pushed,
    read_message,
    readings_of,
)
from nodes.sensory.ways.way import Arrived, Settings

if TYPE_CHECKING:
    from aiohttp import web

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


class SensorLoggerWay:
    """A web server that takes what the app pushes, at every path."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._door: socket.socket | None = None
        self._devices: dict[tuple[str, str], _Device] = {}
        self._background = Background(self._serve)

    @property
    def where(self) -> str:
        """What the node is ready for."""
        port, who = self._settings.port, self._settings.who
        return f"waits for Sensor Logger on HTTP port {port} ({who})"

    @property
    def missing(self) -> str:
        """What to check when nothing has arrived."""
        if self._settings.listen_on == "this computer":
            return missing_words(self._settings, "Sensor Logger")
        url = f"http://{own_addresses(self._settings)[0]}:{self._settings.port}/data"
        return (
            f"Nothing has arrived for 10 seconds. Is the push URL in Sensor Logger {url} (with "
            "http, not https), is it recording, and does this computer's firewall let it in?"
        )

    def open(self) -> None:
        """Open the port and serve; raises PortTaken."""
        self._door = open_tcp(self._settings)
        self._background.start()

    def readings(self, until_s: float) -> list[Arrived]:
        """What was pushed until then."""
        return self._background.take(until_s)

    def close(self) -> None:
        """Stop serving."""
        self._background.stop()
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
            self._complain(sender, f"{sender} pushes more than can be taken in at once.")
            return web.Response(status=413, text=_TOO_LARGE)
        message = read_message(body)
        if message is None or len(message.payload) > _MOST_READINGS:
            self._complain(
                sender, f"{sender} pushes what is no message of Sensor Logger, or too large a one."
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
        self._background.put(Arrived(device.name, pushed.readings, now_s, trouble, told, number))

    def _complain(self, sender: str, trouble: str) -> None:
        self._background.put(Arrived(sender, arrived_s=time.monotonic(), trouble=trouble))


def _trouble(sender: str, pushed: Pushed, *, is_watch: bool) -> str:
    """What of a message cannot be used; a watch sends its own readings only now and then."""
    if pushed.broken:
        return f"{sender} sends values that are not numbers; they are left out."
    if pushed.readings or not pushed.sent or is_watch:
        return ""
    names = ", ".join(pushed.sent)
    return (
        f"{sender} sends no acceleration, only {names}. Switch on Accelerometer, Gravity and "
        "Gyroscope in Sensor Logger, or Wrist Motion of the watch."
    )
