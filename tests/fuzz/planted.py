"""Targets that break at one input, each in a way of its own: the runner must see each."""

from __future__ import annotations

import ctypes
import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from faults import FaultError
from fuzz.target import Feed, Target

BAD = b"bad"


def raise_it() -> None:
    raise KeyError("planted")


def log_it() -> None:
    try:
        raise_it()
    except KeyError:
        logging.getLogger("planted").exception("the server goes on after an error")


def end_thread() -> None:
    thread = threading.Thread(target=raise_it)
    thread.start()
    thread.join()


def take_memory() -> None:
    bytearray(b"x") * 90_000_000


def refuse() -> None:
    raise FaultError("This cannot be read.")


def refuse_without_words() -> None:
    raise FaultError("{name} cannot be read.", name="\ud800")


WAYS: dict[str, Callable[[], object]] = {
    "raises": raise_it,
    "logs": log_it,
    "thread": end_thread,
    "slow": lambda: time.sleep(1.1),
    "hangs": lambda: time.sleep(60),
    "large": take_memory,
    "ends": lambda: ctypes.string_at(0),
    "wordless": refuse_without_words,
    "sound": refuse,
}


def target(name: str) -> Target:
    """The target that breaks in this way, with no kept inputs."""

    @contextmanager
    def door(folder: Path) -> Iterator[Feed]:
        def feed(data: bytes) -> None:
            if BAD in data:
                WAYS[name]()

        yield feed

    def mutate(data: bytes, chance: object, seeds: object) -> bytes:
        return data

    return Target(name, door, mutate, seeds_folder=Path("nowhere"))
