"""The child: feeds inputs to a target, and tells of each that breaks it.

What it tells is a line of JSON on its standard output. What it cannot tell, because it hangs or
died, its parent sees: the board, a small file that both share, says which input is being fed, and
since when.
"""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import faulthandler
import gc
import itertools
import json
import logging
import mmap
import signal
import struct
import sys
import threading
import time
import traceback
import zlib
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any

import psutil

from faults import FaultError, told
from fuzz.target import Feed, Target

LONGEST_S = 1.0
"""An input takes longer: it is found, if it does so three times running."""
MOST_BYTES = 50_000_000
"""More memory than this for one input, while it is fed, is found."""
_ROOM_BYTES = 1_500_000_000
"""So much more address space a child may have, so that it does not eat the machine."""
_TRIES = 3
_SCHEDULED = Path("/proc/thread-self/schedstat")
_BOARD, _SUM = struct.Struct("<qdq"), struct.Struct("<I")
BOARD_BYTES = _BOARD.size + _SUM.size
_LOOKS = 500
ROOT = Path(__file__).parent.parent


class Board:
    """Which input is fed, since when (time.monotonic()), and how many were; in a file.

    It has a check sum: who reads while the other side writes would else read of an input 0 that
    is fed since the computer was started, and call that a hang.
    """

    def __init__(self, path: Path) -> None:
        with path.open("r+b") as file:
            self._shared = mmap.mmap(file.fileno(), BOARD_BYTES)
        self._last = (-1, time.monotonic(), 0)

    def write(self, number: int, began_s: float, done: int) -> None:
        """Tell the other side."""
        told = _BOARD.pack(number, began_s, done)
        self._shared[:] = told + _SUM.pack(zlib.crc32(told))

    def read(self) -> tuple[int, float, int]:
        """What was told last; of a side that died while it wrote, what was read before."""
        for _ in range(_LOOKS):
            told = self._shared[:]
            if _SUM.unpack_from(told, _BOARD.size)[0] == zlib.crc32(told[: _BOARD.size]):
                self._last = _BOARD.unpack_from(told)
                break
            time.sleep(0.001)
        return self._last

    def close(self) -> None:
        """Let the file go."""
        self._shared.close()


class Memory:
    """How much memory the process takes at most from one moment to another."""

    _RESET, _STATUS = Path("/proc/self/clear_refs"), Path("/proc/self/status")

    def __init__(self) -> None:
        self._process = psutil.Process()
        self._before = 0
        self._forgets = True
        self.begin()

    def begin(self) -> None:
        """What comes from now on counts."""
        if self._forgets:
            try:
                self._RESET.write_bytes(b"5")  # the peak is as much as is taken now
            except OSError:  # no Linux: there the peak since the start is known, if anything
                self._forgets = False
        self._before = self._taken() if self._forgets else max(self._before, self._taken())

    @property
    def more(self) -> int:
        """Bytes more than at the beginning, at the worst moment."""
        return self._peak() - self._before

    def _taken(self) -> int:
        return self._of(b"VmRSS:") if self._forgets else self._peak()

    def _peak(self) -> int:
        if self._forgets:
            return self._of(b"VmHWM:")
        told = self._process.memory_info()
        return int(getattr(told, "peak_wset", told.rss))

    def _of(self, name: bytes) -> int:
        status = self._STATUS.read_bytes()
        return int(status[status.index(name) + len(name) :].split(None, 1)[0]) * 1024


def kept_bytes() -> int:
    """The memory that the process takes, without what is free and only at hand for later.

    One input of many small parts leaves 20 MB at hand with glibc.
    """
    gc.collect()
    with contextlib.suppress(OSError, AttributeError, TypeError):  # another C library than glibc
        ctypes.CDLL("libc.so.6").malloc_trim(0)
    return int(psutil.Process().memory_info().rss)


class Troubles(logging.Handler):
    """What went wrong where no caller sees it: in threads, and what is logged with a traceback.

    A server that catches all, so as to live on, logs what it did not expect: that is found too.
    """

    def __init__(self, answered: Collection[str] = ()) -> None:
        super().__init__(logging.ERROR)
        self._answered = answered
        self.seen: list[BaseException] = []
        logging.getLogger().addHandler(self)
        logging.getLogger().setLevel(logging.ERROR)
        threading.excepthook = lambda told: self._see(told.exc_value)
        sys.unraisablehook = lambda told: self._see(told.exc_value)

    def emit(self, record: logging.LogRecord) -> None:
        """Take note of an error that was logged with its traceback."""
        if record.exc_info:
            self._see(record.exc_info[1])

    def _see(self, error: BaseException | None) -> None:
        names = {kind.__name__ for kind in type(error).__mro__}
        if error is not None and names.isdisjoint(("FaultError", "SystemExit", *self._answered)):
            self.seen.append(error)

    def take(self) -> BaseException | None:
        """The first that was seen since the last time."""
        first = next(iter(self.seen), None)
        self.seen.clear()
        return first


class Watched:
    """Feeds inputs to an open door and says what each of them did."""

    def __init__(self, feed: Feed, answered: Collection[str] = ()) -> None:
        self._feed = feed
        self._troubles = Troubles(answered)
        self._memory = Memory()
        self.took_s, self.more_bytes = 0.0, 0

    def fault(self, data: bytes) -> tuple[str, str, str] | None:
        """What is wrong with how this input was taken: kind, signature, words; None if nothing."""
        for _ in range(_TRIES):
            error = self._fed(data)
            if error is not None:
                return "raises", signature(error), _words(error)
            if self.took_s <= LONGEST_S and self.more_bytes <= MOST_BYTES:
                return None  # also where it was the first that needed a library, or a busy moment
        if self.more_bytes > MOST_BYTES:
            return "large", "large", f"{self.more_bytes / 1e6:.0f} MB more"
        return "slow", "slow", f"{self.took_s:.1f} s"

    def _fed(self, data: bytes) -> BaseException | None:
        self._memory.begin()
        error: BaseException | None = None
        began_s = time.perf_counter() - _waited_s()
        try:
            self._feed(data)
        except FaultError as fault:
            error = _unspeakable(fault)
        except Exception as raised:
            error = raised
        self.took_s = time.perf_counter() - _waited_s() - began_s
        self.more_bytes = self._memory.more
        return error or self._troubles.take()


def _waited_s() -> float:
    """How long this thread could have run, but others did: a busy machine is no fault of ours."""
    try:
        return int(_SCHEDULED.read_bytes().split()[1]) / 1e9
    except (OSError, IndexError, ValueError):  # no Linux
        return 0.0


def waited_by_all_s(process: int) -> float:
    """The same for all threads of a process together."""
    waited_ns = 0
    for one in Path(f"/proc/{process}/task").glob("*/schedstat"):
        with contextlib.suppress(OSError, IndexError, ValueError):  # one that has just ended
            waited_ns += int(one.read_bytes().split()[1])
    return waited_ns / 1e9


def _unspeakable(fault: FaultError) -> BaseException | None:
    """Why a fault cannot be told as data and in words; None when it can."""
    try:
        import msgspec

        told(fault.fault.sentence).encode()
        msgspec.json.encode(fault.fault)
    except Exception as error:
        return error
    return None


def signature(error: BaseException) -> str:
    """What tells this fault from others: its kind, and the innermost place of ours."""
    steps = traceback.extract_tb(error.__traceback__)
    ours = [step for step in steps if _is_ours(step.filename)]
    place = ours[-1] if ours else steps[-1] if steps else None
    where = f"{Path(place.filename).name}:{place.name}" if place else "?"
    return f"{type(error).__name__} in {where}"


def _is_ours(name: str) -> bool:
    path = Path(name)
    return path.is_relative_to(ROOT) and ".venv" not in path.parts and path.parent.name != "fuzz"


def _words(error: BaseException) -> str:
    return "".join(traceback.format_exception(error, limit=-12))[-4000:]


def smaller(data: bytes, still: Callable[[bytes], bool], *, tries: int) -> bytes:
    """A smaller input for which ``still`` holds, found by leaving parts out."""
    part = len(data) // 2
    while part and tries > 0:
        at = 0
        while at < len(data) and tries > 0:
            less = data[:at] + data[at + part :]
            tries -= 1
            if still(less):
                data = less
            else:
                at += part
        part = min(part // 2, len(data))
    return data


# The child's work.


def watch(target: Target, inputs: Iterator[tuple[int, bytes]], board: Board, folder: Path) -> None:
    """Feed the inputs by their numbers; tell each fault once, and at the end how it went."""
    began_s, done, slowest, largest = time.monotonic(), 0, (0.0, -1), 0
    counts: dict[str, int] = {}
    with target.open(folder) as feed:
        watched = Watched(feed, target.answered)
        first_bytes = kept_bytes()
        for number, data in inputs:
            if done == len(target.seeds):  # what is loaded at the first use stays, and is no growth
                first_bytes = kept_bytes()
            board.write(number, time.monotonic(), done)
            found = watched.fault(data)
            done += 1
            board.write(-1, time.monotonic(), done)  # to make the next one takes time, too
            slowest = max(slowest, (watched.took_s, number))
            largest = max(largest, watched.more_bytes)
            if found is None:
                continue
            kind, which, words = found
            counts[which] = counts.get(which, 0) + 1
            if counts[which] > 1:
                continue
            if kind == "raises":
                data = smaller(data, _same(watched, which), tries=60)
            _tell(fault=kind, number=number, signature=which, words=words, data=data.hex())
        grown = kept_bytes() - first_bytes
    seconds = time.monotonic() - began_s
    _tell(
        done=done,
        seconds=seconds,
        processor_s=time.process_time(),
        slowest_s=slowest[0],
        slowest=slowest[1],
        largest_bytes=largest,
        grown_bytes=grown,
        counts=counts,
    )


def _same(watched: Watched, which: str) -> Callable[[bytes], bool]:
    def still(data: bytes) -> bool:
        found = watched.fault(data)
        return found is not None and found[1] == which

    return still


def _tell(**what: Any) -> None:
    print(json.dumps(what), flush=True)


def _limit_room() -> None:
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        room = psutil.Process().memory_info().vms + _ROOM_BYTES
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        if sys.platform == "linux":
            resource.setrlimit(resource.RLIMIT_AS, (room, hard))


def main(arguments: list[str]) -> None:
    """Feed what the command line says; see runner.py."""
    parser = argparse.ArgumentParser(prog="fuzz.watched")
    parser.add_argument("target")
    parser.add_argument("--module", default="fuzz.targets")
    parser.add_argument("--board", type=Path, required=True)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--until", type=float, default=0.0, help="time.monotonic()")
    parser.add_argument("--file", type=Path, action="append", default=[])
    given = parser.parse_args(arguments)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends us
    faulthandler.enable()
    if hasattr(signal, "SIGUSR1"):
        faulthandler.register(signal.SIGUSR1)  # the parent asks where we are, if we hang
    module: Any = __import__(given.module, fromlist=["target"])
    target: Target = module.target(given.target)
    _limit_room()
    inputs: Iterator[tuple[int, bytes]]
    if given.file:
        inputs = ((number, path.read_bytes()) for number, path in enumerate(given.file))
    else:
        numbers = (
            range(given.first, given.first + given.count)
            if given.count
            else itertools.count(given.first)
        )
        timely = itertools.takewhile(
            lambda _: not given.until or time.monotonic() < given.until, numbers
        )
        inputs = ((number, target.input(given.seed, number)) for number in timely)
    watch(target, inputs, Board(given.board), given.folder)


if __name__ == "__main__":
    main(sys.argv[1:])
