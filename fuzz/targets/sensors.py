"""What watches, phones and people send of movement: lines, pushes, the page, files, models."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import itertools
import os
import random
import socket
import struct
import sys
import threading
from collections.abc import Coroutine, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fuzz.formats import csv_changed, model_changed
from fuzz.mutations import flipped, json_changed, lines_changed
from fuzz.target import Feed, Target

HOST = "127.0.0.1"
ANSWER_S = 5.0


@contextmanager
def lines(folder: Path) -> Iterator[Feed]:
    """Lines by TCP, UDP or Bluetooth, cut anywhere, and the stream of samples made of them."""
    from nodes.sensory.connectors.connector import Arrived, Settings
    from nodes.sensory.connectors.lines import Client
    from nodes.sensory.connectors.sensor_server import SensorServerConnector
    from nodes.sensory.line_reader import LineSenders
    from nodes.sensory.sample_stream import SampleStream

    def feed(data: bytes) -> None:
        senders, client, stream = LineSenders(), Client("watch"), SampleStream()
        now_s = 1000.0
        for at in range(0, len(data) + 1, 1000):
            now_s += 0.02
            arrived = senders.arrived("watch", client.lines(data[at : at + 1000]), now_s)
            _told(arrived.trouble)
            stream.samples(arrived.readings, now_s)
        packet: Arrived = senders.arrived("other", data.splitlines(), now_s)
        stream.samples(packet.readings, now_s)
        phone = SensorServerConnector(Settings(1, HOST))
        phone._host = HOST
        text = data.decode(errors="replace")  # as the library of its connection gives it
        for line in text.split("\n"):
            phone._take(line, "android.sensor.accelerometer")
        for one in phone.readings(0.0):
            _told(one.trouble)
            stream.samples(one.readings, now_s)

    yield feed


def _told(words: Any) -> None:
    from faults import told

    told(words).encode()


def raw_answer(address: tuple[str, int], data: bytes, own: str = "", *, ends: bool = True) -> bytes:
    """What a server says to these bytes until it closes; ``ends``: it sees that no more come."""
    with socket.create_connection(address, ANSWER_S, (own, 0) if own else None) as caller:
        with contextlib.suppress(OSError):
            caller.sendall(data)
            if ends:
                caller.shutdown(socket.SHUT_WR)
        answer = b""
        with contextlib.suppress(OSError):
            while part := caller.recv(65536):
                answer += part
    return answer


@contextmanager
def push(folder: Path) -> Iterator[Feed]:
    """What Sensor Logger pushes to its server, and what phyphox answers when it is asked."""
    from nodes.sensory.connectors.connector import Settings
    from nodes.sensory.connectors.phyphox import read_answer, read_config
    from nodes.sensory.connectors.sensor_logger import SensorLoggerConnector
    from nodes.sensory.sample_stream import SampleStream

    server = SensorLoggerConnector(Settings(0))
    server.open()
    assert server._door is not None
    address = (HOST, server._door.getsockname()[1])
    usual = read_config(_PHYPHOX)

    def feed(data: bytes) -> None:
        is_raw = data[:5] in (b"POST ", b"GET /")
        head = b"POST /data HTTP/1.1\r\nHost: a\r\nConnection: close\r\nContent-Length: %d\r\n\r\n"
        answer = raw_answer(address, data if is_raw else head % len(data) + data, ends=is_raw)
        assert is_raw or answer.startswith(b"HTTP/1.1 "), answer[:80]
        assert not answer.startswith(b"HTTP/1.1 500"), answer[:80]
        stream = SampleStream()
        for one in server.readings(0.0):
            _told(one.trouble)
            stream.samples(one.readings, one.arrived_s)
        for experiment in (usual, read_config(data)):
            said = read_answer(data)
            if experiment is not None and said is not None:
                experiment.query()
                stream.samples(experiment.take(said, is_apple=True), 1.0)
                experiment.query()

    try:
        yield feed
    finally:
        server.close()


_PHYPHOX = (
    b'{"title": "a", "inputs": [{"source": "accelerometer", "outputs": [{"x": "accX"}, '
    b'{"y": "accY"}, {"z": "accZ"}, {"t": "acc_time"}]}]}'
)


class Serving:
    """A loop of asyncio in a thread, for servers that live in one."""

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()

    def do(self, work: Coroutine[Any, Any, Any]) -> Any:
        """The result of some work."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(ANSWER_S)

    def close(self) -> None:
        """End the loop."""
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(ANSWER_S)
        self._loop.close()


TOKEN = "AbCdEfGhIjKl"


@contextmanager
def page(folder: Path) -> Iterator[Feed]:
    """The phone page's server: requests as they are, batches by POST, and talks by WebSocket.

    Without TLS, which is not ours, and would be most of the time.
    """
    from aiohttp import web

    from nodes.sensory.phone_page.site import Receiving, Site, page_files
    from nodes.sensory.sample_stream import SampleStream

    stream, clock, serving = SampleStream(), itertools.count(), Serving()
    arrived: list[Any] = []
    receiving = Receiving(arrived.append, clock=lambda: float(next(clock)))

    async def serve() -> tuple[web.AppRunner, int]:
        app = Site(TOKEN, page_files(), receiving).app()
        runner = web.AppRunner(app, handle_signals=False, access_log=None, lingering_time=0.0)
        await runner.setup()
        # any address of this computer: each phone may only ask so often
        site = web.TCPSite(runner, "0.0.0.0" if sys.platform == "linux" else HOST, 0)
        await site.start()
        return runner, runner.addresses[0][1]

    runner, port = serving.do(serve())
    phones = itertools.count(1)

    def feed(data: bytes) -> None:
        own = _address(next(phones)) if sys.platform == "linux" else HOST
        answer = raw_answer((own, port), page_request(data, f"{own}:{port}"), own)
        assert not answer.startswith(b"HTTP/1.1 500"), answer[:80]
        while arrived:
            one = arrived.pop()
            _told(one.trouble)
            stream.samples(one.readings, one.arrived_s)

    try:
        yield feed
    finally:
        serving.do(runner.cleanup())
        serving.close()


def _address(number: int) -> str:
    return f"127.{1 + number // 62500 % 250}.{1 + number // 250 % 250}.{1 + number % 250}"


def page_request(data: bytes, host: str) -> bytes:
    """The bytes of a request: as they are, a batch, or a talk (each line a message)."""
    where = host.encode()
    if data.startswith(b"{") or data[:1] not in b"GPWHO":
        head = b"POST /%b/batch HTTP/1.1\r\nHost: %b\r\nOrigin: https://%b\r\nConnection: close\r\n"
        length = b"Content-Length: %d\r\n\r\n" % len(data)
        return head % (TOKEN.encode(), where, where) + length + data
    if data.startswith(b"WS\n"):
        head = (
            b"GET /%b/motion HTTP/1.1\r\nHost: %b\r\nOrigin: https://%b\r\nUpgrade: websocket\r\n"
            b"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: %b\r\n\r\n"
        )
        key = base64.b64encode(b"0123456789abcdef")
        frames = b"".join(map(_text_frame, data.split(b"\n")[1:]))
        return head % (TOKEN.encode(), where, where, key) + frames + b"\x88\x80\0\0\0\0"
    return data.replace(b"{host}", where).replace(b"{token}", TOKEN.encode())


def _text_frame(text: bytes) -> bytes:
    size = len(text)
    if size < 126:
        return struct.pack(">BB4x", 0x81, 0x80 | size) + text
    if size < 65536:
        return struct.pack(">BBH4x", 0x81, 0x80 | 126, size) + text
    return struct.pack(">BBQ4x", 0x81, 0x80 | 127, size) + text


def _page_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    if data.startswith(b"{"):
        return json_changed(data, chance, seeds)
    return lines_changed(data, chance, seeds)


def _push_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    if data.startswith(b"{"):
        return json_changed(data, chance, seeds)
    return flipped(data, chance, seeds)


@contextmanager
def csv(folder: Path) -> Iterator[Feed]:
    """A movement in a file, read and written again."""
    from nodes.recordings import read_recording, read_recordings, write_recording

    path, again = folder / "ana_wave.csv", folder / "again.csv"

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        recording = read_recording(path)
        assert recording.rate_hz >= 0.0
        write_recording(again, recording)
        assert len(read_recording(again).t) == len(recording.t)
        os.unlink(again)
        read_recordings(folder)

    yield feed


@contextmanager
def models(folder: Path) -> Iterator[Feed]:
    """A gesture model from anybody: read, and asked about some movements."""
    import numpy as np

    from nodes.perceptual.recognition.model import read_model

    path = folder / "a.gestures"
    few = np.random.default_rng(0).normal(0, 5, (3, 32, 6))

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        model = read_model(path)
        lengths = model.lengths
        assert len(lengths) and model.fits.shape == (len(lengths), len(model.gestures))
        for recogniser in model.recognisers:
            raw = few[:, :, : recogniser.channels.columns]
            with np.errstate(all="ignore"):
                certainties = recogniser.certainties(
                    recogniser.windows(raw, np.array([20, 30, 40]))
                )
            assert certainties.shape == (3, len(model.gestures))
            assert not np.isnan(certainties).any(), "a certainty is no number"
            assert ((certainties >= 0) & (certainties <= 1)).all(), "a certainty is none"

    yield feed


ANSWERED = ("HttpProcessingError", "RequestPayloadError")
"""What is no HTTP: aiohttp answers that it is none."""

TARGETS = {
    one.name: one
    for one in (
        Target("lines", lines, lines_changed),
        Target("push", push, _push_changed, ANSWERED),
        Target("page", page, _page_changed, ANSWERED),
        Target("csv", csv, csv_changed),
        Target("models", models, model_changed),
    )
}
