"""What the training process says, line by line, as data."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec


class Ready(msgspec.Struct, frozen=True):
    """It has loaded what it needs."""

    ready: bool


class Progress(msgspec.Struct, frozen=True):
    """How much is done, from 0 to 1, and what it does, in an English sentence."""

    progress: float
    step: str = ""


class Done(msgspec.Struct, frozen=True):
    """The model is in the file ``done``; ``remarks`` are English sentences on the recordings."""

    done: str
    seconds: float = 0.0
    report: dict[str, Any] = {}
    remarks: tuple[str, ...] = ()


class Failed(msgspec.Struct, frozen=True):
    """It did not go: one sentence, and what to try in order."""

    error: str
    checklist: tuple[str, ...] = ()
    details: str = ""


Line = Ready | Progress | Done | Failed
_KINDS: tuple[tuple[str, type[Line]], ...] = (
    ("ready", Ready),
    ("progress", Progress),
    ("done", Done),
    ("error", Failed),
)


def read_line(line: bytes) -> Line | None:
    """What a line says; None for one that says nothing known, such as a library's warning."""
    try:
        told = msgspec.json.decode(line)
        kind = next((kind for key, kind in _KINDS if key in told), None)
        return None if kind is None else msgspec.convert(told, kind)
    except (msgspec.DecodeError, TypeError):
        return None


def order(recordings: Path, model: Path, *, everyday: bool) -> bytes:
    """The line that asks for a training; ``everyday``: simulated everyday movement is added."""
    asked = {
        "train": str(recordings),
        "output": str(model),
        "methods": ["trees", "gmr"],
        "everyday": everyday,
    }
    return msgspec.json.encode(asked) + b"\n"
