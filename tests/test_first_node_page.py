"""docs/first_node.md is followed to the letter: its files are written, its commands are run."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.master_messages import ask_master
from nep_core.places import NODES_VARIABLE
from tests.conftest import PROJECT

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="its commands are for a shell"),
    pytest.mark.long,
]

PAGE = (PROJECT / "docs" / "first_node.md").read_text(encoding="utf-8")
EXAMPLES = PROJECT / "examples" / "python"
LONG_S = 30.0

FENCE = re.compile(
    r"(?:^`(?P<file>[\w/.]+)`:\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.M | re.S
)
RECORD, ECHO = "nep record letters.mcap /letterbox", "nep echo /human_behavior --count 1"
PROGRAM = "nep-studio run letters.nep --trust"
GOES_ON = {
    "nep master": "The NEP master serves",
    "nep launch sensory letterbox": "letterbox is ready",
    "nep launch perceptual post": "post is ready",
    RECORD: "Recording",
    ECHO: "",
    PROGRAM: "letterbox",
}
"""The commands that have a terminal of their own, with what each says when it is at work."""


@dataclass(frozen=True)
class Piece:
    """A fenced block of the page; ``file``: the name above it."""

    file: str
    language: str
    text: str


PIECES = [
    Piece(found["file"] or "", found["language"], found["text"]) for found in FENCE.finditer(PAGE)
]


class Terminals:
    """What somebody does who follows the page: a shell in a folder, and commands that go on."""

    def __init__(self, folder: Path, endpoint: str) -> None:
        self.folder = folder
        programs = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        self._environment = {
            **os.environ,
            "PATH": programs,
            "NEP_ORIGINAL": "0",  # the ports of the original are those of this computer
            "HOME": str(folder),
            MASTER_VARIABLE: endpoint,
        }
        self.going_on: dict[str, tuple[subprocess.Popen[bytes], Path]] = {}

    def follow(self, line: str) -> str:
        """Do what a line of a shell says; what it printed."""
        self._be_as_slow_as_a_person(line)
        if line.startswith("cd "):
            self.folder = self.folder / line.removeprefix("cd ")
        elif line == "export NEP_NODES=$PWD":
            self._environment[NODES_VARIABLE] = str(self.folder)
        elif line in GOES_ON:
            self._start(line)
        else:
            return self._run(line)
        return ""

    def said(self, line: str, words: str) -> bool:
        """Whether a command that goes on has printed these words."""
        return words in self.going_on[line][1].read_text(encoding="utf-8", errors="replace")

    def press_ctrl_c(self, line: str) -> None:
        """End a command that goes on."""
        child = self.going_on[line][0]
        if child.poll() is None:
            child.send_signal(signal.SIGINT)
        child.wait(LONG_S)

    def _be_as_slow_as_a_person(self, line: str) -> None:
        """See two more measurements before and after a letter; play when somebody listens."""
        if line.endswith("letters/two.txt"):
            self._run("nep echo /letterbox --count 2")
        elif line == "nep kill letterbox":
            self._run("nep echo /letterbox --count 2")
            self.press_ctrl_c(RECORD)
        elif line.startswith("nep play"):
            wait_until(self._is_heard, "somebody hears /human_behavior")

    def _is_heard(self) -> bool:
        listing = ask_master(self._environment[MASTER_VARIABLE])
        assert listing is not None
        return any("/human_behavior" in one.subscribes.values() for one in listing.registrations)

    def _start(self, line: str) -> None:
        output = self.folder.parent / f"{len(self.going_on)}.txt"
        with output.open("w") as file:
            child = subprocess.Popen(
                line.split(), cwd=self.folder, env=self._environment, stdout=file, stderr=file
            )
        self.going_on[line] = child, output
        wait_until(lambda: self.said(line, GOES_ON[line]), f"{line}: {GOES_ON[line]}")

    def _run(self, line: str) -> str:
        done = subprocess.run(
            line,
            shell=True,
            cwd=self.folder,
            env=self._environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=LONG_S,
        )
        assert done.returncode == int("rate_hz=fast" in line), f"{line}: {done.stdout}"
        return done.stdout


def wait_until(is_so: Callable[[], bool], what: str) -> None:
    until_s = time.monotonic() + LONG_S
    while not is_so():
        assert time.monotonic() < until_s, what
        time.sleep(0.02)


@pytest.fixture
def terminals(tmp_path: Path, free_port: int) -> Iterator[Terminals]:
    opened = Terminals(tmp_path, f"tcp://127.0.0.1:{free_port}")
    yield opened
    for line in reversed(opened.going_on):
        opened.press_ctrl_c(line)


def test_whoever_follows_the_page_has_a_node_that_a_robot_answers(terminals: Terminals) -> None:
    printed = ""

    for piece in PIECES:
        if piece.file:
            (terminals.folder / piece.file).write_text(piece.text, encoding="utf-8")
        elif piece.language == "text":
            assert piece.text.strip() in printed
        else:
            printed = "".join(map(terminals.follow, piece.text.splitlines()))

    wait_until(lambda: terminals.said(ECHO, "letter_came"), "post tells of the recorded letter")
    wait_until(lambda: terminals.said(PROGRAM, "You have got mail."), "NAO answers")
    assert set(terminals.going_on) == set(GOES_ON)


def test_the_finished_files_are_those_of_the_page() -> None:
    shown = {piece.file: piece.text for piece in PIECES if piece.file}

    kept = {
        path.relative_to(EXAMPLES).as_posix(): path.read_text(encoding="utf-8")
        for path in EXAMPLES.rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    assert shown == kept


def test_what_the_page_links_to_is_there() -> None:
    links = re.findall(r"\]\(([^)#]+)\)", PAGE)

    assert links
    assert not [link for link in links if not (PROJECT / "docs" / link).exists()]
