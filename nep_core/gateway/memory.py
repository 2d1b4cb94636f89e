"""Which program was sent to which port, in a file: programs of the original ask only once.

A gateway that is started anew opens the same ports again, and they go on as if nothing was.
"""

from __future__ import annotations

import logging
import os
from pathlib import Path

import msgspec

from nep_core.gateway.requests import Request

log = logging.getLogger(__name__)


class KeptProgram(msgspec.Struct, array_like=True, frozen=True):
    """One that asked for a line: ``born`` is when its process began, 0 when nobody knows."""

    node: str
    pid: int
    socket: str
    born: float


class KeptLine(msgspec.Struct, frozen=True):
    """A line as it is kept."""

    port: int
    request: Request
    programs: list[KeptProgram]


def remember(file: Path, lines: list[KeptLine]) -> None:
    """Write the file anew; a failure is no reason to serve nobody."""
    unfinished = file.with_suffix(f".{os.getpid()}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        unfinished.write_bytes(msgspec.json.encode(lines))
        unfinished.replace(file)
    except OSError as error:
        log.info("the ports of the original's programs are not kept: %s", error)


def recall(file: Path) -> list[KeptLine]:
    """What the file holds; nothing when it cannot be read."""
    try:
        return msgspec.json.decode(file.read_bytes(), type=list[KeptLine])
    except (OSError, msgspec.MsgspecError) as error:
        log.info("no ports of the original's programs are known: %s", error)
        return []
