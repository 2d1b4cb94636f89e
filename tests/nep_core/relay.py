"""A connection between two places that a test can cut and mend, or make long and bad."""

from __future__ import annotations

import contextlib
import queue
import random
import socket
import threading
import time
from dataclasses import dataclass

SEGMENT_BYTES = 1460
"""What a packet of TCP holds."""


@dataclass(frozen=True)
class Line:
    """A line of so many seconds each way, on which some packets of TCP are lost.

    TCP sends those again, after ``again_s``; what follows waits for them.
    """

    delay_s: float
    loss: float = 0.0
    again_s: float = 0.4


class Relay:
    """Passes bytes on from a port of its own to ``target``, another port of this computer."""

    def __init__(self, target: int, line: Line | None = None, seed: int = 0) -> None:
        self._target = target
        self._line = line
        self._chance = random.Random(seed)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        self.is_cut = False
        self._ends: list[socket.socket] = []
        self._threads = [threading.Thread(target=self._accept, daemon=True)]
        self._threads[0].start()

    def cut(self) -> None:
        """End what is connected, and let nobody through."""
        self.is_cut = True
        self._end()

    def mend(self) -> None:
        self.is_cut = False

    def close(self) -> None:
        self.is_cut = True
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)  # ends accept()
        self._listener.close()
        self._end()
        for thread in self._threads:
            thread.join(2)

    def _end(self) -> None:
        for end in self._ends:
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()
        self._ends.clear()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                if self.is_cut:
                    near.close()
                    continue
                far = socket.create_connection(("127.0.0.1", self._target))
                self._ends += [near, far]
                for one, other in ((near, far), (far, near)):
                    self._begin(one, other)

    def _begin(self, source: socket.socket, sink: socket.socket) -> None:
        if self._line is None:
            begun = [threading.Thread(target=_pass_on, args=(source, sink), daemon=True)]
        else:
            way: queue.SimpleQueue[tuple[float, bytes]] = queue.SimpleQueue()
            chance = random.Random(self._chance.random())
            setting_out = (source, way, self._line, chance)
            begun = [
                threading.Thread(target=_set_out, args=setting_out, daemon=True),
                threading.Thread(target=_arrive, args=(way, sink), daemon=True),
            ]
        self._threads += begun
        for thread in begun:
            thread.start()


def _pass_on(source: socket.socket, sink: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while piece := source.recv(65536):
            sink.sendall(piece)


def _set_out(
    source: socket.socket,
    way: queue.SimpleQueue[tuple[float, bytes]],
    line: Line,
    chance: random.Random,
) -> None:
    due_s = 0.0
    with contextlib.suppress(OSError):
        while piece := source.recv(SEGMENT_BYTES):
            lost_s = line.again_s if chance.random() < line.loss else 0.0
            due_s = max(due_s, time.monotonic() + line.delay_s + lost_s)
            way.put((due_s, piece))
    way.put((0.0, b""))


def _arrive(way: queue.SimpleQueue[tuple[float, bytes]], sink: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while True:
            due_s, piece = way.get()
            if not piece:
                sink.shutdown(socket.SHUT_WR)
                return
            time.sleep(max(0.0, due_s - time.monotonic()))
            sink.sendall(piece)
