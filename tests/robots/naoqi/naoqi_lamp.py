"""A service with every kind of method, and servers that offer it: ours and the official one's."""

import contextlib
import importlib.util
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robots.naoqi.server.module import Module
from robots.naoqi.server.server import Server
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.promise import Pending, Promise
from robots.naoqi.wire.service import Property, method, signal

HERE = Path(__file__).parent
CERTIFICATE, KEY = HERE / "loopback_certificate.pem", HERE / "loopback_key.pem"
HAS_ORACLE = importlib.util.find_spec("qi") is not None
needs_oracle = pytest.mark.skipif(not HAS_ORACLE, reason="the official package qi is not here")


class Subscriber:
    signal = signal("signal::(m)")


class Lamp(Module):
    """A lamp that talks."""

    touched = signal("touched::(m)")
    level = Property("level::f", 0.5)

    def __init__(self) -> None:
        self.subscribers: dict[str, Subscriber] = {}
        self.said: list[str] = []
        self.angles: Any = None
        self.going: list[Promise] = []

    @method("goToPosture::b(sf)")
    def go(self, name: str, speed: float) -> Pending:
        promise = Promise()
        promise.on_cancel = promise.cancelled
        self.going.append(promise)
        if name == "Now":
            promise.set(True)
        return promise.future

    @method("say::s(s)")
    def say(self, text: str) -> str:
        self.said.append(text)
        return f"s {text}"

    @method("say::s(ss)")
    def say_in(self, text: str, language: str) -> str:
        return f"ss {text} {language}"

    @method("say::s(s{sm})")
    def say_with(self, text: str, settings: dict[str, Any]) -> str:
        return f"s{{sm}} {text} {sorted(settings)}"

    @method("getAngles::[f](mb)")
    def angles_of(self, names: Any, uses_sensors: bool) -> list[float]:
        return [0.25] * (26 if names == "Body" else len(names))

    @method("setAngles::v(mmf)")
    def set_angles(self, names: Any, angles: Any, speed: float) -> None:
        self.angles = (names, angles, speed)

    @method("echo::m(m)")
    def echo(self, value: Any) -> Any:
        return value

    @method("counts::{s[i]}({s[f]})")
    def counts(self, values: dict[str, list[float]]) -> dict[str, list[float]]:
        return values

    @method("pair::(is)<Pair,number,word>((is)<Pair,number,word>)")
    def pair(self, pair: Any) -> Any:
        return (pair.number + 1, pair.word + "!")

    @method("raw::r(r)")
    def raw(self, data: bytes) -> bytes:
        return data[::-1]

    @method("subscriber::o(s)")
    def subscriber(self, key: str) -> Subscriber:
        return self.subscribers.setdefault(key, Subscriber())

    @method("raiseEvent::v(sm)")
    def raise_event(self, key: str, value: Any) -> None:
        if key in self.subscribers:
            self.subscribers[key].signal.emit(value)
        self.touched.emit([key, value])

    @method("fails::v()")
    def fails(self) -> None:
        raise CallFailed("The lamp is too hot.")

    @method("breaks::v()")
    def breaks(self) -> None:
        raise KeyError("inner")

    @method("waits::i(f)", blocks=True)
    def waits(self, seconds: float) -> int:
        time.sleep(seconds)
        return 7

    @method("asks::i(o)")
    def asks(self, counter: Any) -> Pending:
        promise = Promise()
        counter.begin("count", 41).when_done(lambda done: promise.set(done.value))
        return promise.future


class CallingLamp(Lamp):
    """A lamp that calls services of its clients back."""

    def __init__(self) -> None:
        super().__init__()
        self.server: Server | None = None

    @method("callBack::b(s)")
    def call_back(self, name: str) -> bool:
        assert self.server is not None
        return self.server.tell(name, "called", "key", 1.5, "message")


def until(is_so: Callable[[], Any], seconds: float = 20.0) -> None:
    """Wait until something is so."""
    end_s = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end_s, "it did not happen in time"
        threading.Event().wait(0.002)


@contextlib.contextmanager
def lamp_server(**settings: Any) -> Iterator[tuple[CallingLamp, Server]]:
    """Our server in this process, with a lamp."""
    lamp = CallingLamp()
    server = Server({"Lamp": lamp}, port=0, **settings)
    lamp.server = server
    server.start()
    try:
        yield lamp, server
    finally:
        server.stop()


@contextlib.contextmanager
def child(script: str, *arguments: object) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """A server in a process of its own, and its port."""
    command = [sys.executable, str(HERE / script), *map(str, arguments)]
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=Path.cwd()
    )
    assert process.stdin is not None and process.stdout is not None
    try:
        line = process.stdout.readline()
        assert line.strip().isdigit(), f"{script} did not start: {line!r}"
        yield process, int(line)
    finally:
        process.kill()
        process.wait()
        process.stdin.close()
        process.stdout.close()


if __name__ == "__main__":
    with lamp_server() as (_, running):
        print(running.port, flush=True)
        sys.stdin.read()
