"""How soon a person hears that a NAO is not as it should be, and how soon Stop reaches it.

Our driver at a virtual NAO behind NAOqi (``nep-studio naoqi``, in a process of its own), and at
programs that are no robots. Measured from the fault to the sentence, by the clock.
"""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import psutil

from nodes.resources import model_folder
from robots.body.actor import Actor
from robots.body.animations import load_animations
from robots.body.body import load_body
from robots.body.driver import ActionRequest, ActionResult
from robots.body.pose import VirtualRobot
from robots.naoqi.driver.driver import NaoqiDriver

GOAL_S, STOP_GOAL_S = 3.0, 0.2
WAIT_S = 20.0
ROUNDS = 3
STILL_S = 0.5
MAGIC = 0x42ADDE42
LONG = "I could go on like this for a very long time. " * 5

STRANGERS = {
    "garbage bytes": b"HTTP/1.1 400 Bad Request\r\n\r\n" * 20,
    "half a frame": struct.pack("<IIIHBB", MAGIC, 1, 40, 0, 2, 0),
    "1 GB announced": struct.pack("<IIIHBBIII", MAGIC, 1, 1 << 30, 0, 2, 0, 0, 0, 8) + b"x" * 64,
    "silence": b"",
}


class Pilot:
    """Our driver, and what it tells."""

    def __init__(self, port: int) -> None:
        folder = model_folder("nao")
        body = load_body(folder)
        robot = VirtualRobot("NAO", body, load_animations(folder / "animations", body))
        self.driver = NaoqiDriver(robot, f"127.0.0.1:{port}")
        self.actor = Actor("NAO", self.driver)
        self.results: list[ActionResult] = []
        self._asked = 0
        self.driver.connect()

    def ask(self, action: str, **args: Any) -> None:
        """Ask the robot for something."""
        self._asked += 1
        request = ActionRequest(id=str(self._asked), robots=["NAO"], action=action, args=args)
        self.results += self.actor.request(request)

    def until(self, is_so: Callable[[], bool]) -> float:
        """Go on until something is so; the seconds that took. Raises TimeoutError."""
        start_s = time.monotonic()
        while not is_so():
            if time.monotonic() - start_s > WAIT_S:
                raise TimeoutError(str(self.driver.connection))
            self.results += self.actor.step(time.monotonic())
            time.sleep(0.002)
        return time.monotonic() - start_s

    def is_told(self, *events: str) -> bool:
        """Whether the link is like that."""
        return self.driver.connection.event in events

    def base(self) -> tuple[float, ...]:
        """Where the robot is, as it last told; nowhere before it has."""
        state = self.driver.state()
        return (0.0,) if state is None else tuple(state.base)


def run() -> list[dict[str, Any]]:
    """A row for each fault (goal: told within 3 s), and for Stop (goal: 0.2 s); the worst round."""
    faults: dict[str, Callable[[], float]] = {
        "nobody at the port": _nobody,
        **{name: lambda said=said: _stranger(said) for name, said in STRANGERS.items()},  # type: ignore[misc]
        "a wrong password": _wrong_password,
        "killed in mid-motion": lambda: _vanishes(signal.SIGKILL),
        "frozen in mid-motion": lambda: _vanishes(signal.SIGSTOP),
    }
    rows = [_row(f"{name}: told", _worst(fault), GOAL_S) for name, fault in faults.items()]
    stops = [_stop_s() for _ in range(ROUNDS)]
    rows.append(_row("Stop: until the robot does not move", max(stops), STOP_GOAL_S))
    return rows


def _worst(fault: Callable[[], float]) -> float:
    return max(fault() for _ in range(ROUNDS))


def _nobody() -> float:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    return _told_s(port)


def _stranger(said: bytes) -> float:
    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=_answer, args=(server, said), daemon=True).start()
        return _told_s(server.getsockname()[1])


def _answer(server: socket.socket, said: bytes) -> None:
    kept = []
    with contextlib.suppress(OSError):
        while True:
            one, _ = server.accept()
            kept.append(one)
            one.recv(4096)
            one.sendall(said)


def _told_s(port: int) -> float:
    pilot = Pilot(port)
    seconds = pilot.until(lambda: pilot.is_told("connection_failed"))
    pilot.driver.disconnect()
    return seconds


def _wrong_password() -> float:
    with virtual_nao("--login", "nao:right") as (port, _):
        return _told_s(port)


def _vanishes(how: signal.Signals) -> float:
    with virtual_nao() as (port, pid):
        pilot = _walking(port)
        os.kill(pid, how)
        seconds = pilot.until(lambda: pilot.is_told("disconnected", "connection_failed"))
        pilot.driver.disconnect()
    return seconds


def _stop_s() -> float:
    """From Stop to the last movement that the robot itself tells of."""
    with virtual_nao() as (port, _):
        pilot = _walking(port)
        start_s = time.monotonic()
        pilot.ask("stop")
        seconds = _last_change(pilot) - start_s
        pilot.driver.disconnect()
    return max(seconds, 0.0)


def _last_change(pilot: Pilot) -> float:
    """When the robot moved for the last time, by the clock of this process."""
    place, changed_s = pilot.base(), time.monotonic()
    while time.monotonic() - changed_s < STILL_S:
        pilot.results += pilot.actor.step(time.monotonic())
        time.sleep(0.002)
        if pilot.base() != place:
            place, changed_s = pilot.base(), time.monotonic()
    return changed_s


def _walking(port: int) -> Pilot:
    pilot = Pilot(port)
    pilot.until(lambda: pilot.is_told("connected") and pilot.driver.state() is not None)
    pilot.ask("walk", forward_m=3)
    pilot.ask("say", text=LONG)
    pilot.until(lambda: pilot.base()[0] > 0.05)
    return pilot


@contextlib.contextmanager
def virtual_nao(*words: str) -> Iterator[tuple[int, int]]:
    """A virtual NAO behind NAOqi; gives its port, and the process that has the port."""
    port = free_port()
    command = [sys.executable, "-m", "nep_studio", "naoqi", "--port", str(port), *words]
    environment = os.environ | {"NEP_MASTER": f"tcp://127.0.0.1:{free_port()}"}
    child = subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    family = psutil.Process(child.pid)
    try:
        yield port, _owner(family, port)
    finally:
        everyone = [*family.children(recursive=True), family]
        for one in everyone:
            with contextlib.suppress(psutil.NoSuchProcess):
                one.kill()
        child.wait()


def _owner(family: psutil.Process, port: int) -> int:
    """The process of the family that listens at a port; waits for it. Raises TimeoutError."""
    until_s = time.monotonic() + WAIT_S
    while time.monotonic() < until_s:
        for one in family.children(recursive=True):
            with contextlib.suppress(psutil.Error):
                if any(at.laddr.port == port for at in one.net_connections() if at.laddr):
                    return int(one.pid)
        time.sleep(0.1)
    raise TimeoutError("the robot does not come up")


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        return int(taken.getsockname()[1])


def _row(name: str, seconds: float, goal_s: float) -> dict[str, Any]:
    return {
        "name": name,
        "value": round(seconds, 3),
        "unit": "s",
        "goal": f"under {goal_s:g} s",
        "ok": seconds < goal_s,
    }
