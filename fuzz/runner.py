"""Starts a child for each target, watches it, and keeps the inputs that break something."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil

from fuzz.target import FOUND, Target
from fuzz.watched import BOARD_BYTES, ROOT, Board, smaller, waited_by_all_s

HANGS_S = 10.0
"""An input that is fed for so long hangs: its child is ended. Others' turns do not count."""
HELD_TIMES = 6.0
"""So many times as long, and it hangs however busy the machine is."""
BEFORE = 300
"""An input that hangs not by itself is tried again behind so many of those before it."""
START_S = 90.0
"""A child may load libraries and open its door for so long. Others' turns do not count."""
MOST_FINDINGS = 30
"""Of one target and one run: then something is wrong that is mended first."""
MOST_GROWN = 50_000_000
"""A child that has grown by more has kept something of each input."""
_LOOK_S = 0.1
_STACKS_S = 0.5
_DEATHS_TRIES = 8
_WORDS = 6000

Say = Callable[[str], None]


@dataclass(frozen=True)
class Finding:
    """What breaks something: raises, slow, large, hangs or ends; the words tell how.

    ``stops`` is of no input: the target could not be tried any further.
    """

    target: str
    kind: str
    signature: str
    words: str
    data: bytes
    number: int = -1
    path: Path | None = None


@dataclass
class Tally:
    """How a target was tried: inputs, seconds of the child's work, the worst that was normal.

    ``processor_s`` tells how fast it is on a machine that others use, too.
    """

    target: str
    done: int = 0
    seconds: float = 0.0
    processor_s: float = 0.0
    slowest_s: float = 0.0
    slowest: int = -1
    largest_bytes: int = 0
    counts: dict[str, int] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    grown_bytes: int = 0
    held_up: int = 0

    def add(self, told: dict[str, Any]) -> None:
        """Take in what a child tells when it has done its work."""
        self.done += told["done"]
        self.seconds += told["seconds"]
        self.processor_s += told["processor_s"]
        if told["slowest_s"] > self.slowest_s:
            self.slowest_s, self.slowest = told["slowest_s"], told["slowest"]
        self.largest_bytes = max(self.largest_bytes, told["largest_bytes"])
        self.grown_bytes = max(self.grown_bytes, told["grown_bytes"])
        for which, count in told["counts"].items():
            self.counts[which] = self.counts.get(which, 0) + count

    @property
    def words(self) -> str:
        """In one line."""
        speed = self.done / self.seconds if self.seconds else 0.0
        return (
            f"{self.target}: {self.done:,} inputs in {self.seconds:.0f} s ({speed:.0f}/s; "
            f"{self.processor_s:.0f} s of a processor), "
            f"{len(self.findings)} found, slowest {self.slowest_s * 1000:.0f} ms "
            f"(number {self.slowest}), at most {self.largest_bytes / 1e6:.0f} MB more, grown by "
            f"{self.grown_bytes / 1e6:.0f} MB" + f", {self.held_up} held up" * bool(self.held_up)
        )


class Child:
    """One watched process; ``told`` gives what it tells, None when it has ended."""

    def __init__(self, target: Target, module: str, *arguments: str) -> None:
        self.folder = tempfile.TemporaryDirectory(
            prefix="nep-fuzz-", dir=_in_memory(), ignore_cleanup_errors=True
        )
        place = Path(self.folder.name)
        board = place / "board"
        board.write_bytes(bytes(BOARD_BYTES))
        self.board = Board(board)
        self.board.write(-1, time.monotonic(), 0)
        self._errors = (place / "errors").open("w+b")
        (place / "work").mkdir()
        command = [sys.executable, "-m", "fuzz.watched", target.name, "--module", module]
        command += ["--board", str(board), "--folder", str(place / "work"), *arguments]
        self._process = subprocess.Popen(
            command,
            cwd=ROOT,
            env=_own_places(place / "home"),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=self._errors,
        )
        self.held_up_at = -1
        """The input that was fed for too long, when TimeoutError was raised."""
        self._fed: tuple[float, float] = (0.0, 0.0)
        self._lines: queue.Queue[bytes] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def told(self, hangs_s: float) -> Iterator[dict[str, Any]]:
        """What the child tells until it has ended; TimeoutError when it hangs for so long.

        The error says where its threads are, and how long they waited for a processor.
        """
        while True:
            try:
                line = self._lines.get(timeout=_LOOK_S)
            except queue.Empty:
                number, began_s, _ = self.board.read()
                passed_s, others_s = time.monotonic() - began_s, self._others_s(began_s)
                most_s = hangs_s if number >= 0 else START_S
                if passed_s - others_s > most_s or passed_s > most_s * HELD_TIMES:
                    if number < 0:
                        raise ChildProcessError(f"it does not start: {self.last_words}") from None
                    self.held_up_at = number
                    raise TimeoutError(self._stacks(passed_s, others_s)) from None
                yield {}
                continue
            if not line:
                return
            with contextlib.suppress(ValueError):
                yield json.loads(line)

    def _others_s(self, began_s: float) -> float:
        """How long the child's threads together waited for a processor, since this input."""
        waited_s = waited_by_all_s(self._process.pid)
        if began_s != self._fed[0]:
            self._fed = began_s, waited_s
        return max(0.0, waited_s - self._fed[1])

    def _stacks(self, passed_s: float, others_s: float) -> str:
        """Where the threads of a child are that hangs."""
        if hasattr(signal, "SIGUSR1"):
            self._process.send_signal(signal.SIGUSR1)
            time.sleep(_STACKS_S)
        took_s = sum(psutil.Process(self._process.pid).cpu_times()[:2])
        return (
            f"{passed_s:.1f} s, of which its threads waited {others_s:.1f} s for a processor; it "
            f"has had {took_s:.1f} s of one since its start\n{self.last_words}"
        )

    @property
    def number(self) -> int:
        """The input that is being fed; -1: none yet, or no more."""
        return self.board.read()[0]

    @property
    def done(self) -> int:
        """How many were fed."""
        return self.board.read()[2]

    @property
    def last_words(self) -> str:
        """The end of what it wrote as errors."""
        self._errors.seek(0)
        return self._errors.read()[-_WORDS:].decode(errors="replace")

    def wait(self) -> int:
        """Its exit code."""
        return self._process.wait()

    def close(self) -> None:
        """End it."""
        self._process.kill()
        self._process.wait()
        self.board.close()
        self._errors.close()
        self.folder.cleanup()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                self._lines.put(line)
        self._lines.put(b"")


def _in_memory() -> str | None:
    """Where a file is written in no time: a slow disk would be most of what is measured."""
    shared = Path("/dev/shm")
    return str(shared) if shared.is_dir() and os.access(shared, os.W_OK) else None


def _own_places(home: Path) -> dict[str, str]:
    """The environment of a child: nothing of the person's own is read or written."""
    home.mkdir()
    names = ("HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME")
    own = dict.fromkeys((*names, "APPDATA", "LOCALAPPDATA", "USERPROFILE"), str(home))
    left = {k: v for k, v in os.environ.items() if not k.startswith(("NEP_", "COV_"))}
    more = {"NEP_STUDIO_FOLDER": str(home), "QT_QPA_PLATFORM": "offscreen", "PYTHONUTF8": "1"}
    return {**left, **own, **more}


class Run:
    """Tries one target; ``module`` is where the child finds it by its name."""

    def __init__(
        self,
        target: Target,
        *,
        seed: int,
        module: str = "fuzz.targets",
        found: Path = FOUND,
        hangs_s: float = HANGS_S,
        makes_smaller: bool = True,
        say: Say = lambda words: None,
    ) -> None:
        self.tally = Tally(target.name)
        self._target, self._seed, self._module = target, seed, module
        self._found, self._say, self._hangs_s = found, say, hangs_s
        self._makes_smaller = makes_smaller
        self._child: Child | None = None
        self._said_s = 0.0
        self._first = 0
        self._is_stopped = False

    def random(self, *, count: int = 0, seconds: float = 0.0) -> Tally:
        """Feed so many inputs, or as many as there is time for; the kept ones are the first.

        What ends it before that is a finding, so that nobody takes it for tried.
        """
        until_s = time.monotonic() + seconds if seconds else 0.0
        first = 0
        while (not count or first < count) and len(self.tally.findings) < MOST_FINDINGS:
            left = ["--count", str(count - first)] if count else []
            left += ["--until", str(until_s)] if until_s else []
            self._first = first
            try:
                following = self._turn("--seed", str(self._seed), "--first", str(first), *left)
            except (ChildProcessError, OSError, ValueError) as error:
                if not self._is_stopped:
                    stops = Finding(self._target.name, "stops", "stops", str(error), b"")
                    self.tally.findings.append(stops)
                break
            if following is None or (until_s and time.monotonic() >= until_s):
                break
            first = following
        if self.tally.grown_bytes > MOST_GROWN:
            words = f"grown by {self.tally.grown_bytes / 1e6:.0f} MB in {self.tally.done:,} inputs"
            self.tally.findings.append(Finding(self._target.name, "grows", "grows", words, b""))
        return self.tally

    def files(self, paths: Sequence[Path]) -> Tally:
        """Feed what is in these files."""
        left = list(paths)
        while left:
            following = self._turn(*(word for path in left for word in ("--file", str(path))))
            if following is None:
                break
            left = left[following:]
        return self.tally

    def stop(self) -> None:
        """End the child, if there is one, and try no more."""
        self._is_stopped = True
        if self._child is not None:
            self._child.close()

    def _turn(self, *arguments: str) -> int | None:
        """One child's work; after a hang or a death, the number to go on from; None: all done."""
        self._child = child = Child(self._target, self._module, *arguments)
        began_s = time.monotonic()
        try:
            for told in child.told(self._hangs_s):
                self._progress(child)
                if "fault" in told:
                    self._keep(told["fault"], told, bytes.fromhex(told["data"]))
                elif "done" in told:
                    self.tally.add(told)
                    return None
            code, number = child.wait(), child.number
            kind, words = "ends", f"exit code {code}\n{child.last_words}"
        except TimeoutError as error:
            number, kind, words = child.held_up_at, "hangs", str(error)
        finally:
            child.close()
            self._child = None
        if number < 0:
            raise ChildProcessError(f"{self._target.name} cannot be tried: {words}")
        self.tally.seconds += time.monotonic() - began_s
        self.tally.done += number + 1 if "--file" in arguments else number + 1 - self._first
        data = self._input(arguments, number)
        if kind == "hangs" and self._makes_smaller and not self._again(kind, [data]):
            before = range(max(0, number - BEFORE), number + 1)
            if not self._again(kind, [self._input(arguments, one) for one in before]):
                self.tally.held_up += 1
                self._say(f"{self._target.name}: number {number} was held up once: {words}")
                return number + 1
            words = f"only behind those from number {before[0]} on; {words}"
        else:
            data = self._smaller(kind, data)
        self._keep(kind, {"signature": kind, "words": words, "number": number}, data)
        return number + 1

    def _input(self, arguments: Sequence[str], number: int) -> bytes:
        if "--file" in arguments:
            return Path(arguments[2 * number + 1]).read_bytes()
        return self._target.input(self._seed, number)

    def _smaller(self, kind: str, data: bytes) -> bytes:
        """A smaller input that ends or holds up a child as this one does, by a few children."""
        if not self._makes_smaller:
            return data

        return smaller(data, lambda less: self._again(kind, [less]), tries=_DEATHS_TRIES)

    def _again(self, kind: str, inputs: Sequence[bytes]) -> bool:
        """Whether inputs break a child of their own in the same way."""
        with tempfile.TemporaryDirectory() as folder:
            paths = [Path(folder) / f"{number}" for number in range(len(inputs))]
            for path, data in zip(paths, inputs, strict=True):
                path.write_bytes(data)
            again = Run(
                self._target,
                seed=self._seed,
                module=self._module,
                found=Path(folder),
                hangs_s=self._hangs_s,
                makes_smaller=False,
            )
            return any(one.kind == kind for one in again.files(paths).findings)

    def _progress(self, child: Child) -> None:
        now_s = time.monotonic()
        if now_s - self._said_s > 10.0:
            self._said_s = now_s
            self._say(f"{self._target.name}: {self.tally.done + child.done:,} inputs")

    def _keep(self, kind: str, told: dict[str, Any], data: bytes) -> None:
        """Write a finding to its folder, unless the same was found in this run."""
        which = told["signature"]
        if kind == "raises" and any(one.signature == which for one in self.tally.findings):
            return
        name = "".join(c if c.isalnum() else "_" for c in which)[:60]
        path = self._found / self._target.name / f"{name}_{hashlib.sha256(data).hexdigest()[:8]}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        words = told["words"]
        told_text = f"{kind}: {which}\n{words}\n".encode(errors="backslashreplace")
        path.with_suffix(".txt").write_bytes(told_text)
        finding = Finding(self._target.name, kind, which, words, data, told.get("number", -1), path)
        self.tally.findings.append(finding)
        self._say(f"{self._target.name}: FOUND, {kind}: {which}; the input is {path}")
