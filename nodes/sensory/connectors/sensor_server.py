"""The app SensorServer: the phone is a WebSocket server, which sends every sensor event.

Source: umer0586/SensorServer, README.md and SensorWebSocketServer.kt.
``/sensors/connect?types=["android.sensor.accelerometer","android.sensor.gyroscope"]`` sends both,
``/sensor/connect?type=...`` one of them; a message is ``{"values": [x, y, z], "timestamp": ns,
"accuracy": 3, "type": "android.sensor.accelerometer"}``, without ``type`` where only one was asked
for. It closes with 4001 where the phone has no such sensor, 4002 where it does not know the path
(older versions), 4004 when the server is stopped, 4005 when the user ends the connection.
"""

from __future__ import annotations

import asyncio
import json
import time
from typing import TYPE_CHECKING

from faults import Text, text_of
from nodes.sensory.reading import read_android, read_json

from .connector import Arrived
from .servers import OutboundConnector

if TYPE_CHECKING:
    from aiohttp import ClientSession

ACCELEROMETER, GYROSCOPE = "android.sensor.accelerometer", "android.sensor.gyroscope"
NOT_FOUND, UNSUPPORTED = 4001, 4002
_TRY_AGAIN_S = (0.5, 1.0, 2.0, 5.0)
_CONNECT_S = 5.0
_HEARTBEAT_S = 5.0
_MOST_BYTES = 8_192
_LONG_S = 3.0  # a connection that lasted so long was a good one


class SensorServerConnector(OutboundConnector):
    """Connects to a phone, and again when it was away."""

    app = "SensorServer"

    @property
    def where(self) -> Text:
        """What the node is ready for."""
        return text_of("connects to SensorServer at {host}, port {port}", **self._place)

    @property
    def missing(self) -> Text:
        """What to check when nothing has arrived."""
        return text_of(
            "Nothing has arrived for 10 seconds. Does SensorServer show the address {host} and the "
            "port {port}, and is its server started?",
            **self._place,
        )

    async def _serve(self) -> None:
        from aiohttp import ClientError, ClientSession, ClientTimeout

        failures = 0
        while True:
            began_s = time.monotonic()
            try:
                timeout = ClientTimeout(total=None, sock_connect=_CONNECT_S)
                async with ClientSession(timeout=timeout) as session:
                    await self._both(session)
            except (ClientError, OSError, TimeoutError, ValueError):  # the last: no name of a host
                self._say(
                    "SensorServer at {host}, port {port} does not answer. Is its server "
                    "started, and the phone in the same network?"
                )
            failures = 0 if time.monotonic() - began_s > _LONG_S else failures + 1
            await asyncio.sleep(_TRY_AGAIN_S[min(failures, len(_TRY_AGAIN_S) - 1)])

    async def _both(self, session: ClientSession) -> None:
        """Both sensors over one connection, or over one each, or the accelerometer alone."""
        types = json.dumps([ACCELEROMETER, GYROSCOPE], separators=(",", ":"))
        code = await self._connection(session, "/sensors/connect", {"types": types})
        if code not in (NOT_FOUND, UNSUPPORTED):
            self._say("SensorServer at {host} ended the connection. Is it still started?")
            return
        turning = asyncio.create_task(self._one(session, GYROSCOPE))
        try:
            code = await self._one(session, ACCELEROMETER)
        finally:
            turning.cancel()
            await asyncio.gather(turning, return_exceptions=True)
        if code == NOT_FOUND:
            self._say("The phone at {host} has no accelerometer. Use another one.")

    async def _one(self, session: ClientSession, kind: str) -> int:
        return await self._connection(session, "/sensor/connect", {"type": kind}, kind)

    async def _connection(
        self, session: ClientSession, path: str, query: dict[str, str], kind: str = ""
    ) -> int:
        """Hand over what one connection sends; why it was closed, 0 when that was not told."""
        from aiohttp import WSMsgType

        url = f"ws://{self._host}:{self._port}{path}"
        async with session.ws_connect(
            url, params=query, heartbeat=_HEARTBEAT_S, max_msg_size=_MOST_BYTES
        ) as socket:
            self.put(Arrived(self._host, arrived_s=time.monotonic()))
            async for message in socket:
                if message.type is WSMsgType.TEXT:
                    self._take(message.data, kind)
            return socket.close_code or 0

    def _take(self, text: str, kind: str) -> None:
        message = read_json(text)
        readings = None if message is None else read_android(message, kind)
        if readings:
            self.put(Arrived(self._host, readings, time.monotonic()))
        elif readings is None:
            self._say("{host} sends values that are not numbers; they are left out.")
