"""Computers of a network: network namespaces of Linux, else addresses of the loopback."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from tests.conftest import PROJECT

WAIT_FOR_THE_END = "echo $$; exec sleep 300"


@dataclass
class Host:
    """A computer by its address; ``entering`` is what a command on it begins with."""

    address: str
    entering: tuple[str, ...]
    running: ExitStack

    def start(
        self, *arguments: str, module: str, environment: Mapping[str, str]
    ) -> subprocess.Popen[str]:
        """Start a Python module there; it is ended with the hosts."""
        process = subprocess.Popen(
            [*self.entering, sys.executable, "-m", module, *arguments],
            cwd=PROJECT,
            env={**os.environ, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.running.callback(_end, process)
        return process


@contextmanager
def three_hosts() -> Iterator[list[Host]]:
    """Three computers that see each other: namespaces where that is allowed."""
    with ExitStack() as running:
        try:
            yield _namespaces(running)
            return
        except (OSError, subprocess.CalledProcessError):
            running.close()
    with ExitStack() as running:
        yield [Host(f"127.0.0.{n}", (), running) for n in (2, 3, 4)]


def are_apart(hosts: list[Host]) -> bool:
    """Whether they are more than addresses of this computer."""
    return bool(hosts[0].entering)


def _namespaces(running: ExitStack) -> list[Host]:
    if not all(shutil.which(program) for program in ("ip", "unshare", "nsenter")):
        raise FileNotFoundError("the programs for namespaces")
    switch = _namespace(running)
    _ip(switch, "link", "add", "switch", "type", "bridge")
    _ip(switch, "link", "set", "switch", "up")
    hosts = []
    for number in (1, 2, 3):
        inside, port = _namespace(running), f"port{number}"
        cable = ("link", "add", port, "type", "veth", "peer", "name", "eth0", "netns", inside)
        _ip(switch, *cable)
        _ip(switch, "link", "set", port, "master", "switch", "up")
        _ip(inside, "address", "add", f"10.77.0.{number}/24", "dev", "eth0")
        for device in ("lo", "eth0"):
            _ip(inside, "link", "set", device, "up")
        hosts.append(Host(f"10.77.0.{number}", ("nsenter", "-t", inside, "-n"), running))
    return hosts


def _namespace(running: ExitStack) -> str:
    """A new network namespace, by the process that keeps it."""
    keeper = subprocess.Popen(
        ["unshare", "--net", "sh", "-c", WAIT_FOR_THE_END], stdout=subprocess.PIPE, text=True
    )
    running.callback(_end, keeper)
    assert keeper.stdout is not None
    number = keeper.stdout.readline().strip()
    if not number:
        raise PermissionError("namespaces are not allowed here")
    return number


def _ip(namespace: str, *arguments: str) -> None:
    subprocess.run(
        ["nsenter", "-t", namespace, "-n", "ip", *arguments], check=True, capture_output=True
    )


def _end(process: subprocess.Popen[str]) -> None:
    process.kill()
    process.communicate()
