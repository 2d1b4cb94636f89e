"""Phones that are servers, as the apps phyphox and SensorServer make them."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qsl, urlsplit

from nodes.recordings import Recording
from tests.nodes.sensory.senders import Row, rows

NAMES = {
    "accelerometer": ("acc_time", "accX", "accY", "accZ"),
    "gyroscope": ("gyr_time", "gyrX", "gyrY", "gyrZ"),
}


class PhyphoxPhone:
    """Answers /config, /control and /get, as phyphox's RemoteServer.java does.

    Numbers have eight digits; a threshold is raised by a ten-millionth of itself.
    """

    def __init__(
        self, recording: Recording, *, names: dict[str, tuple[str, ...]] | None = None
    ) -> None:
        self._rows: list[Row] = list(rows(recording))
        self.names = NAMES if names is None else names
        self.title = "Acceleration with g"
        self.session = "1f2e3d"
        self._began_s: float | None = None
        self.asked: list[str] = []
        phone = self

        class Answers(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self) -> None:
                asked = urlsplit(self.path)
                phone.asked.append(asked.path)
                body = json.dumps(phone.answer(asked.path, parse_qsl(asked.query, True))).encode()
                self.send_response(200)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_args: object) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Answers)
        self._server.daemon_threads = True
        self.port = self._server.server_address[1]
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,))

    def pause(self) -> None:
        """As the pause button of the app does."""
        self._began_s = None

    def answer(self, path: str, query: list[tuple[str, str]]) -> object:
        if path == "/config":
            return self._config()
        if path == "/control":
            self._began_s = time.monotonic() if query == [("cmd", "start")] else None
            return {"result": True}
        passed_s = -1.0 if self._began_s is None else time.monotonic() - self._began_s
        buffers = {
            name: {"size": 0, **self._buffer(name, wanted, passed_s)}
            for name, wanted in query
            if name in {one for names in self.names.values() for one in names}
        }
        status = {
            "session": self.session,
            "measuring": self._began_s is not None,
            "timedRun": False,
            "countDown": 0,
        }
        return {"buffer": buffers, "status": status}

    def _config(self) -> dict[str, object]:
        return {
            "crc32": "0",
            "title": self.title,
            "localTitle": self.title,
            "buffers": [{"name": one, "size": 0} for names in self.names.values() for one in names],
            "inputs": [
                {
                    "source": source,
                    "outputs": [{part: name} for part, name in zip("txyz", names, strict=True)],
                }
                for source, names in self.names.items()
            ],
        }

    def _buffer(self, name: str, wanted: str, passed_s: float) -> dict[str, object]:
        """What a buffer holds at a moment, which is the same for all buffers of one answer."""
        source = next(one for one, names in self.names.items() if name in names)
        table = [
            (t, *(acc if source == "accelerometer" else gyr or (0.0, 0.0, 0.0)))
            for t, acc, gyr in self._rows
            if t <= passed_s
        ]
        at = self.names[source].index(name)
        if not wanted:
            return {"updateMode": "single", "buffer": [_digits(row[at]) for row in table[-1:]]}
        threshold = float(wanted.partition("|")[0])
        threshold += abs(threshold) * 1e-7
        values = [_digits(row[at]) for row in table if row[0] > threshold]
        return {"updateMode": "partial", "buffer": values}

    def __enter__(self) -> PhyphoxPhone:
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join(5)


class SensorServerPhone:
    """A WebSocket server that sends each sensor event, as SensorWebSocketServer.kt does.

    ``sensors`` are what the phone has; ``knows_many``: whether it knows /sensors/connect.
    """

    def __init__(
        self,
        recording: Recording,
        *,
        sensors: tuple[str, ...] = ("accelerometer", "gyroscope"),
        knows_many: bool = True,
    ) -> None:
        self._rows = list(rows(recording))
        self._sensors = {f"android.sensor.{one}" for one in sensors}
        self._knows_many = knows_many
        self._is_ready = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._serve()))
        self.port = 0
        self.paths: list[str] = []

    async def _serve(self) -> None:
        from aiohttp import web

        self._loop, self._stopped = asyncio.get_running_loop(), asyncio.Event()
        app = web.Application()
        app.router.add_get("/{path:.*}", self._connect)
        runner = web.AppRunner(app, shutdown_timeout=0.1)
        await runner.setup()
        site = web.TCPSite(runner, "127.0.0.1", 0)
        await site.start()
        self.port = runner.addresses[0][1]
        self._is_ready.set()
        await self._stopped.wait()
        await runner.cleanup()

    async def _connect(self, request):
        from aiohttp import web

        self.paths.append(request.path)
        connection = web.WebSocketResponse()
        await connection.prepare(request)
        many = request.path == "/sensors/connect"
        wanted = json.loads(request.query["types"]) if many else [request.query.get("type", "")]
        if many and not self._knows_many:
            await connection.close(code=4002, message=b"unsupported request")
        elif missing := [one for one in wanted if one not in self._sensors]:
            await connection.close(code=4001, message=f"{missing[0]} not found".encode())
        else:
            await self._send(connection, wanted, many=many)
        return connection

    async def _send(self, connection, wanted: list[str], *, many: bool) -> None:
        began_s = time.monotonic()
        for t, acc, gyr in self._rows:
            await asyncio.sleep(max(0.0, began_s + t - time.monotonic()))
            events = {"android.sensor.gyroscope": gyr, "android.sensor.accelerometer": acc}
            for kind, values in events.items():
                if kind in wanted and values is not None and not connection.closed:
                    event = {"values": values, "timestamp": round(t * 1e9) + 10**14, "accuracy": 3}
                    await connection.send_json(event | ({"type": kind} if many else {}))
            if connection.closed:
                return

    def __enter__(self) -> SensorServerPhone:
        self._thread.start()
        assert self._is_ready.wait(10)
        return self

    def __exit__(self, *_error: object) -> None:
        self._loop.call_soon_threadsafe(self._stopped.set)
        self._thread.join(5)


def _digits(value: float) -> float:
    return float(f"{value:.7e}")
