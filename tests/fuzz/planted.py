"""Targets that break at one input, each in a way of its own: the runner must see each."""

from __future__ import annotations

import ctypes
import logging
import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from faults import FaultError
from fuzz.target import Feed, Target

BAD = b"bad"
ONCE = "FUZZ_PLANTED_ONCE"
"""Names a file; as long as it is there, the target "once" hangs, and takes it away."""
SHUT = "shut"
"""A target that cannot be tried at all."""
_fed = 0


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


def tire() -> None:
    """Hang at the third input of this child, whatever that is."""
    time.sleep(60 if _fed > 2 else 0)


def hang_once() -> None:
    try:
        os.unlink(os.environ[ONCE])
    except OSError:
        return
    time.sleep(60)


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
    "tires": tire,
    "once": hang_once,
    "large": take_memory,
    "ends": lambda: ctypes.string_at(0),
    "wordless": refuse_without_words,
    "sound": refuse,
}


def target(name: str) -> Target:
    """The target that breaks in this way, with no kept inputs."""

    @contextmanager
    def door(folder: Path) -> Iterator[Feed]:
        if name == SHUT:
            raise OSError("the door does not open")

        def feed(data: bytes) -> None:
            global _fed
            _fed += 1
            if BAD in data:
                WAYS[name]()

        yield feed

    def mutate(data: bytes, chance: object, seeds: object) -> bytes:
        return data

    return Target(name, door, mutate, seeds_folder=Path("nowhere"))
