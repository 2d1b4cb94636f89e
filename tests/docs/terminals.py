"""Follows the commands of a page as somebody with several terminals does."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent

LONG_S = 60.0
_FENCE = re.compile(
    r"(?:^[ ]*(?P<mark><!-- not run here: [^\n]+ -->)\n)?"
    r"^(?P<margin>[ ]*)```(?P<language>\w*)[^\n]*\n(?P<text>.*?)^(?P=margin)```$",
    re.M | re.S,
)
_REMARK = re.compile(r"\s+# .*$")


@dataclass(frozen=True)
class Fence:
    """Lines in a fence; ``is_run`` unless the page says that they cannot be run here."""

    language: str
    lines: tuple[str, ...]
    is_run: bool


def fences_of(page: Path) -> list[Fence]:
    """The fenced parts of a page, each line without the remark behind it."""
    found = _FENCE.finditer(page.read_text(encoding="utf-8"))
    return [
        Fence(each["language"], _lines(dedent(each["text"])), each["mark"] is None)
        for each in found
    ]


def _lines(text: str) -> tuple[str, ...]:
    """What a shell would do: only what stands behind # is a remark."""
    return tuple(line for each in text.splitlines() if (line := _REMARK.sub("", each).rstrip()))


class Terminals:
    """Runs lines of a shell in a folder, which is the home too.

    ``goes_on`` has what a line says that never ends, also with a port of its own behind it.
    """

    def __init__(
        self, folder: Path, variables: Mapping[str, str], goes_on: Mapping[str, str]
    ) -> None:
        self._folder, self._goes_on = folder, goes_on
        programs = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        own = {"PATH": programs, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
        self._environment = {**os.environ, "NEP_ORIGINAL": "0", **own, **variables}
        self._going_on: dict[str, tuple[subprocess.Popen[bytes], Path]] = {}

    def follow(self, line: str) -> str:
        """Do what a line says; what it printed."""
        words = self._goes_on.get(line.partition(" --port ")[0])
        if words is None:
            said = self._run(line)
            self._see_end_of(line)
            return said
        output = self._folder / f"{len(self._going_on)}.txt"
        with output.open("w") as file:
            child = subprocess.Popen(
                f"exec env {line}",
                shell=True,
                cwd=self._folder,
                env=self._environment,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=file,
            )
        self._going_on[line] = child, output
        wait_until(
            lambda: words in self.said(line) or child.poll() is not None,
            lambda: f"{line}: {self.said(line)}",
        )
        assert words in self.said(line), f"{line}: {self.said(line)}"
        return self.said(line)

    def said(self, line: str) -> str:
        """What a command that goes on has printed."""
        return self._going_on[line][1].read_text(encoding="utf-8", errors="replace")

    def close(self) -> None:
        """End what goes on, the last one first."""
        stuck = [line for line in reversed(self._going_on) if not self._ends(line)]
        assert not stuck, {line: self.said(line) for line in stuck}

    def _ends(self, line: str) -> bool:
        child, _ = self._going_on[line]
        if child.poll() is None:
            child.send_signal(signal.SIGINT)
        try:
            child.wait(LONG_S)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
            return False
        return True

    def _see_end_of(self, line: str) -> None:
        """A node that is asked to stop ends in its terminal, too."""
        command, _, name = line.rpartition(" ")
        for told, (child, _) in self._going_on.items():
            if command == "nep kill" and told.endswith(f" {name}"):
                wait_until(lambda c=child: c.poll() is not None, lambda t=told: self.said(t))

    def _run(self, line: str) -> str:
        done = subprocess.run(
            line,
            shell=True,
            cwd=self._folder,
            env=self._environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=LONG_S,
        )
        assert done.returncode == 0, f"{line}: {done.stdout}"
        return done.stdout


def wait_until(is_so: Callable[[], bool], what: Callable[[], str]) -> None:
    until_s = time.monotonic() + LONG_S
    while not is_so():
        assert time.monotonic() < until_s, what()
        time.sleep(0.02)
