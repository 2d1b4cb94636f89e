"""A master in a process of its own, which tests kill and start again; and raw requests to one."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from typing import Self

import psutil
import zmq

from nep_core.networks import master_messages as says
from nep_core.networks.master_messages import ask_master

TIMEOUT_S = 10.0


class MasterProcess:
    """Starts at once; ``endpoint`` stays the same when it starts again."""

    def __init__(self) -> None:
        self.endpoint = "tcp://127.0.0.1:*"
        self.start()

    def start(self) -> None:
        command = [sys.executable, "-m", "benchmarks._master_child", self.endpoint]
        pipe = subprocess.PIPE
        self._child = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
        assert self._child.stdout is not None
        self.endpoint = self._child.stdout.readline().strip()

    def kill(self) -> None:
        self._child.kill()
        self._child.communicate()

    def rss_mb(self) -> float:
        return psutil.Process(self._child.pid).memory_info().rss / 1e6

    def nodes(self) -> set[str]:
        return nodes_of(self.endpoint)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.kill()


class RawProgram:
    """A program in another language: it says what the test wants, word for word."""

    def __init__(self, endpoint: str, *, answers_kept: int = 1000) -> None:
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.rcvhwm = answers_kept
        self._socket.sndtimeo = round(TIMEOUT_S * 1000)  # without a master: not for ever
        self._socket.connect(endpoint)

    def say(self, request: says.Request | bytes | list[bytes]) -> None:
        if isinstance(request, list):
            self._socket.send_multipart(request)
        else:
            self._socket.send(request if isinstance(request, bytes) else says.encode(request))

    def hear(self, timeout_s: float = TIMEOUT_S) -> says.Answer | None:
        if not self._socket.poll(int(timeout_s * 1000)):
            return None
        return says.decode_answer(self._socket.recv())

    def ask(self, request: says.Request | bytes | list[bytes]) -> says.Answer | None:
        self.say(request)
        return self.hear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._context.destroy(linger=0)


def registration(node: str, instance: str = "", **more: object) -> says.Registration:
    """What a program on another computer would tell."""
    told = {"endpoint": "tcp://127.0.0.1:9", "pid": 1, "host": "elsewhere"} | more
    return says.Registration(node=node, instance=instance or f"instance of {node}", **told)


def nodes_of(endpoint: str, timeout_s: float = 0.5) -> set[str]:
    listing = ask_master(endpoint, timeout_s=timeout_s)
    return {told.node for told in listing.registrations} if listing else set()


def until(condition: Callable[[], bool], timeout_s: float = TIMEOUT_S) -> bool:
    """Wait for something; whether it came."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.005)
    return True
