"""``nep-studio show`` as a process: it plays by itself, survives nothing badly, ends on purpose."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

from nep_studio.settings import ShowOptions
from nep_studio.ui.shell.show_command import parser, show_options
from tests.blocks.block_building import B, build

pytestmark = pytest.mark.long

WAIT_S = 40.0
SHOW = "import sys; from nep_studio.ui.shell.show_command import main; sys.exit(main(sys.argv[1:]))"


def until(is_so: Callable[[], bool]) -> None:
    end_s = time.monotonic() + WAIT_S
    while not is_so():
        assert time.monotonic() < end_s, "it did not happen"
        time.sleep(0.05)


@pytest.fixture
def begin(tmp_path: Path) -> Iterator[Callable[..., psutil.Process]]:
    """Starts a show as the system does when somebody logs in."""
    environment = {**os.environ, "NEP_STUDIO_FOLDER": str(tmp_path / "home")}
    started: list[subprocess.Popen[bytes]] = []

    def start(*words: str) -> psutil.Process:
        command = [sys.executable, "-c", SHOW, *words]
        started.append(subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL))
        return psutil.Process(started[-1].pid)

    yield start
    for process in started:
        process.kill()
        process.wait()


@pytest.fixture
def project(tmp_path: Path) -> Path:
    from nep_studio.blocks.files import save
    from nep_studio.run.installation import studio_language

    language = studio_language()
    editor = build(language, [B("event.gesture", {"gesture": "karate"})], name="Waiting")
    build(language, [B("robots.robot")], page="robots", editor=editor)
    save(editor.project, tmp_path / "waiting.nep")
    return tmp_path / "waiting.nep"


def runs_program(show: psutil.Process) -> bool:
    """Whether a process below the show runs the program."""
    for child in show.children(recursive=True):
        try:
            if any(
                "cognitive/program" in word or "program.toml" in word for word in child.cmdline()
            ):
                return True
        except psutil.Error:
            continue
    return False


def test_a_killed_show_leaves_nothing_behind_and_plays_again_when_it_is_started_again(
    begin: Callable[..., psutil.Process], project: Path
) -> None:
    first = begin(str(project), "--run")
    until(lambda: runs_program(first))
    children = first.children(recursive=True)

    first.send_signal(signal.SIGKILL)

    _, left = psutil.wait_procs(children, timeout=WAIT_S)
    assert left == []
    second = begin(str(project), "--run")
    until(lambda: runs_program(second))


def test_a_show_that_the_system_ends_does_not_count_as_ended_on_purpose(
    begin: Callable[..., psutil.Process], project: Path
) -> None:
    show = begin(str(project), "--run")
    until(lambda: runs_program(show))
    children = show.children(recursive=True)

    show.terminate()

    assert show.wait(WAIT_S) != 0
    assert psutil.wait_procs(children, timeout=WAIT_S)[1] == []


def test_words_of_the_command_add_to_the_settings() -> None:
    kept = ShowOptions(again=True, restarts=7)

    given = parser().parse_args(["play.nep", "--run", "--cues"])

    assert show_options(given, kept) == ShowOptions(True, True, True, 7)
    fewer = parser().parse_args(["play.nep", "--restarts", "0"])
    assert show_options(fewer, kept).restarts == 0


@pytest.mark.parametrize("number", ["-1", "1001", "many"])
def test_a_number_of_restarts_that_makes_no_sense_is_refused(number: str) -> None:
    with pytest.raises(SystemExit):
        parser().parse_args(["play.nep", "--restarts", number])
