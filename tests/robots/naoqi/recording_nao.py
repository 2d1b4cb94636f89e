"""A virtual NAO behind a line that writes down each call, and can stop passing anything on.

The robot is our own NAOqi server in a process of its own; the line speaks nothing, it reads along.
So a test sees what the real driver sends, in order and time, and what the robot answers.
"""

from __future__ import annotations

import contextlib
import socket
import struct
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from driver_stage import ServedNao

from robots.naoqi.client.session import Session
from robots.naoqi.wire.codec import Reader, read_value, reader_of
from robots.naoqi.wire.line import DYNAMIC_PAYLOAD, Kind
from robots.naoqi.wire.metaobject import Signature

HEAD = struct.Struct("<IIIHBBIII")
QUERIES = ("get", "is", "moveIsActive", "robotIsWakeUp", "robotName", "systemVersion")
"""The beginnings of what asks a robot, and changes nothing."""


@dataclass
class Call:
    """One call of the driver: "ALMotion.moveTo", its values, when it passed, and the answer."""

    name: str
    values: tuple[Any, ...]
    at_s: float
    answer: Any = None
    answered_s: float = float("inf")

    @property
    def is_query(self) -> bool:
        return self.name.partition(".")[2].startswith(QUERIES)


@dataclass
class RecordingNao:
    """The robot and the line to it; ``calls`` is what has passed, the first first.

    ``freezes_after``: the next call of that name is the last that the line passes on.
    """

    speed: float = 1.0
    calls: list[Call] = field(default_factory=list)
    is_frozen: bool = False
    freezes_after: str = ""

    def __post_init__(self) -> None:
        self.served = ServedNao(speed=self.speed)
        self.session = Session(("127.0.0.1", self.served.port))
        self.session.connect()
        self._signatures: dict[tuple[int, int], tuple[str, Signature]] = {}
        for name, number, *_ in self.session.service("ServiceDirectory").call("services"):
            for overloads in self.session.service(name).methods.values():
                for one in overloads:
                    self._signatures[number, one.uid] = (f"{name}.{one.name}", one)
        self._server = socket.create_server(("127.0.0.1", 0))
        self._open: list[socket.socket] = []
        self._is_last = False
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def address(self) -> str:
        return f"127.0.0.1:{self._server.getsockname()[1]}"

    def tell(self, key: str, value: Any) -> None:
        """Let the robot's memory hold a value, as its own sensors would."""
        self.session.service("ALMemory").call("insertData", key, value)

    def ask(self, service: str, method: str, *values: Any) -> Any:
        """Ask the robot beside the driver, which is not written down."""
        return self.session.service(service).call(method, *values)

    def heat(self, joint: str, celsius: float) -> None:
        self.tell(f"Device/SubDeviceList/{joint}/Temperature/Sensor/Value", celsius)

    @property
    def walks(self) -> bool:
        return bool(self.ask("ALMotion", "moveIsActive"))

    def named(self, *names: str) -> list[Call]:
        """The calls of some methods."""
        return [call for call in list(self.calls) if call.name in names]

    def orders(self, since_s: float = 0.0) -> list[str]:
        """The names of the calls that change something, without the lease."""
        return [
            call.name
            for call in list(self.calls)
            if not call.is_query and call.at_s >= since_s and call.name != "ALMemory.insertData"
        ]

    def close(self) -> None:
        with contextlib.suppress(OSError):  # a thread waits there: closing alone would not end it
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        self.session.close()
        for one in self._open:
            one.close()
        self.served.close()

    def _accept(self) -> None:
        with contextlib.suppress(OSError), self._server:
            while True:
                driver, _ = self._server.accept()
                self._open.append(driver)
                robot = socket.create_connection(("127.0.0.1", self.served.port))
                self._open.append(robot)
                waiting: dict[int, tuple[Call, Signature]] = {}
                for one, other, read in (
                    (driver, robot, self._on_call),
                    (robot, driver, self._on_answer),
                ):
                    passing = (one, other, read, waiting)
                    threading.Thread(target=self._pass_on, args=passing, daemon=True).start()

    def _pass_on(
        self,
        one: socket.socket,
        other: socket.socket,
        read: Callable[..., None],
        waiting: dict[int, tuple[Call, Signature]],
    ) -> None:
        rest = b""
        with contextlib.suppress(OSError):
            while words := one.recv(65536):
                while self.is_frozen:
                    time.sleep(0.005)
                rest += words
                while len(rest) >= HEAD.size:
                    _, number, size, _, kind, flags, service, _, action = HEAD.unpack_from(rest)
                    if len(rest) < HEAD.size + size:
                        break
                    payload, rest = rest[HEAD.size : HEAD.size + size], rest[HEAD.size + size :]
                    with contextlib.suppress(Exception):  # what is not read along is passed on
                        read(waiting, number, kind, flags, (service, action), payload)
                other.sendall(words)
                if self._is_last:
                    self.is_frozen = True
        for end in (one, other):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def _on_call(
        self,
        waiting: dict[int, tuple[Call, Signature]],
        number: int,
        kind: int,
        flags: int,
        what: tuple[int, int],
        payload: bytes,
    ) -> None:
        if kind not in (Kind.CALL, Kind.POST) or what not in self._signatures:
            return
        name, signature = self._signatures[what]
        values = read_value(reader_of(signature.parameters), Reader(payload))
        call = Call(name, tuple(values), time.monotonic())
        waiting[number] = (call, signature)
        self.calls.append(call)
        self._is_last = self._is_last or name == self.freezes_after

    def _on_answer(
        self,
        waiting: dict[int, tuple[Call, Signature]],
        number: int,
        kind: int,
        flags: int,
        _what: tuple[int, int],
        payload: bytes,
    ) -> None:
        if kind not in (Kind.REPLY, Kind.ERROR, Kind.CANCELLED) or number not in waiting:
            return
        call, signature = waiting.pop(number)
        call.answered_s = time.monotonic()
        is_dynamic = kind == Kind.ERROR or flags & DYNAMIC_PAYLOAD
        call.answer = read_value(
            reader_of("m" if is_dynamic else signature.returns), Reader(payload)
        )
