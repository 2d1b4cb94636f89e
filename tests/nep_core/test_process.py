"""A child process: what it writes is kept within limits, and its end reaches its children."""

from __future__ import annotations

import os
import queue
import signal
import sys
from pathlib import Path

import psutil
import pytest

from nep_core.places import log_folder
from nep_core.processes import process as process_tree
from nep_core.processes.node_log import KEPT_FILES, SEPARATOR, NodeLog, log_file_name
from nep_core.processes.process import LINE_BYTES, ChildProcess, Outcome, program_command

Outcomes = queue.Queue[Outcome]


def start(code: str, log_file: Path, outcomes: Outcomes) -> ChildProcess:
    """A Python child."""
    return ChildProcess(
        "child",
        [sys.executable, "-c", code],
        environment=dict(os.environ),
        log_file=log_file,
        on_end=outcomes.put,
    )


def test_a_line_without_an_end_fills_neither_memory_nor_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.processes.node_log.LOG_BYTES", 100_000)
    outcomes: Outcomes = queue.Queue()

    child = start("print('x' * 1_000_000 + 'end')", tmp_path / "child.log", outcomes)
    outcomes.get(timeout=10)

    assert max(map(len, child.last_lines)) == LINE_BYTES
    assert (tmp_path / "child.log").read_bytes().endswith(b"xend\n")
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) <= KEPT_FILES * 100_000


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a disk that is always full")
def test_a_full_disk_does_not_hurt_the_child(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "child.log").symlink_to("/dev/full")
    outcomes: Outcomes = queue.Queue()
    code = "for _ in range(3): print('x' * 100_000, flush=True)\nprint('done')"

    child = start(code, tmp_path / "child.log", outcomes)

    assert outcomes.get(timeout=10).code == 0
    assert child.last_lines[-1] == "done"
    assert len([text for text in caplog.messages if "child.log cannot be kept" in text]) == 1


def test_stopping_a_child_that_has_ended_signals_nobody(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcomes: Outcomes = queue.Queue()
    child = start("pass", tmp_path / "child.log", outcomes)
    outcomes.get(timeout=10)

    def forbidden(*_words: object) -> None:
        pytest.fail("its number may be another process's by now")

    for function in ("kill", "killpg"):
        monkeypatch.setattr(os, function, forbidden)
    monkeypatch.setattr(process_tree, "kill", forbidden)
    child.stop()

    assert not child.last_lines


LEAVES_SLOWLY = """
import signal, time
asked = []
signal.signal(signal.SIGTERM, lambda *_: asked.append(1))
print("here", flush=True)
while not asked: time.sleep(0.01)
time.sleep(0.3)
print("asked", len(asked), flush=True)
"""


@pytest.mark.skipif(os.name != "posix", reason="needs SIGTERM")
def test_a_child_that_was_asked_to_stop_is_not_asked_again_while_it_leaves(tmp_path: Path) -> None:
    outcomes: Outcomes = queue.Queue()
    child = start(LEAVES_SLOWLY, tmp_path / "child.log", outcomes)
    while not child.last_lines:
        assert child.wait(0.02) is None

    for _ in range(2):  # as when a node is stopped and the window is closed
        child.ask_to_stop()
    child.stop()

    assert outcomes.get(timeout=5).code == 0
    assert child.last_lines[-1] == "asked 1"


def test_a_child_that_we_may_not_end_does_not_keep_stop_from_ending_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcomes: Outcomes = queue.Queue()
    code = "import subprocess\np = subprocess.Popen(['sleep', '60'])\nprint(p.pid, flush=True)\n"
    child = start(f"{code}p.wait()", tmp_path / "child.log", outcomes)
    while not child.last_lines:
        assert child.wait(0.02) is None

    def denied(process: psutil.Process) -> None:
        raise psutil.AccessDenied(process.pid)

    monkeypatch.setattr(psutil.Process, "kill", denied)
    child.stop()

    assert outcomes.get(timeout=5).asked


def test_what_went_into_the_background_ends_with_the_child_that_started_it(tmp_path: Path) -> None:
    outcomes: Outcomes = queue.Queue()
    code = "import os\nif os.fork(): os._exit(0)\nos.setsid()\nif os.fork(): os._exit(0)\n"
    code += "print(os.getpid(), flush=True)\nimport time; time.sleep(60)"
    parent = "import subprocess, sys\n"
    parent += f"subprocess.run([sys.executable, '-c', {code!r}])\nsys.stdin.read(1)"
    child = start(parent, tmp_path / "child.log", outcomes)
    while not child.last_lines:
        assert child.wait(0.02) is None
    daemon = psutil.Process(int(child.last_lines[0]))

    os.kill(child.pid, signal.SIGKILL)

    outcomes.get(timeout=5)
    assert not psutil.wait_procs([daemon], timeout=5)[1]


def test_a_frozen_program_starts_itself_for_another_job(monkeypatch: pytest.MonkeyPatch) -> None:
    from_source = program_command("guard", "true")
    monkeypatch.setattr(sys, "frozen", True, raising=False)

    assert from_source == [sys.executable, "-P", "-m", "nep_studio", "guard", "true"]
    assert program_command("guard", "true") == [sys.executable, "guard", "true"]


@pytest.mark.parametrize("name", ["watch", "a b", "a_b", "n" * 81, "n" * 100, "../a", "ü", ""])
def test_each_node_has_a_log_of_its_own(name: str) -> None:
    others = {"watch", "a b", "a_b", "n" * 81, "n" * 100, "../a", "ü", ""} - {name}

    file_name = log_file_name(name)

    assert file_name not in map(log_file_name, others)
    assert len(file_name) < 100
    assert Path(file_name).name == file_name


def test_a_log_without_a_usable_folder_is_given_up_once(caplog: pytest.LogCaptureFixture) -> None:
    with NodeLog(Path(os.devnull) / "child.log") as kept:
        kept.write(b"one\n")
        kept.write(b"two\n")

    assert len(caplog.messages) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="there, every user has a home")
def test_logs_of_a_user_without_a_home_have_a_place(monkeypatch: pytest.MonkeyPatch) -> None:
    import pwd

    def nobody(_number: int) -> None:
        raise KeyError("no such user")

    monkeypatch.delenv("HOME", raising=False)
    monkeypatch.delenv("XDG_STATE_HOME", raising=False)
    monkeypatch.setattr(pwd, "getpwuid", nobody)

    assert log_folder().is_absolute()


def test_a_log_begins_anew_and_the_one_before_is_kept_beside_it(tmp_path: Path) -> None:
    for words in (b"first\n", b"second\n"):
        with NodeLog(tmp_path / "child.log") as kept:
            kept.write(words)

    assert (tmp_path / "child.log").read_bytes() == b"second\n"
    assert (tmp_path / "child.1.log").read_bytes() == b"first\n"


def test_the_log_of_a_node_that_was_started_again_goes_on(tmp_path: Path) -> None:
    with NodeLog(tmp_path / "child.log") as kept:
        kept.write(b"why it crashed\n")

    with NodeLog(tmp_path / "child.log", goes_on=True) as kept:
        kept.write(b"well again\n")

    first, _, separator, last = (tmp_path / "child.log").read_text().splitlines()
    assert (first, last) == ("why it crashed", "well again")
    assert separator.startswith(SEPARATOR)


def test_of_a_flood_the_newest_words_are_kept_and_files_in_their_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.processes.node_log.LOG_BYTES", 100)

    with NodeLog(tmp_path / "child.log") as kept:
        for number in range(1000):
            kept.write(f"{number:9}\n".encode())

    files = [tmp_path / f"child{age}.log" for age in (".4", ".3", ".2", ".1", "")]
    words = [int(line) for file in files for line in file.read_text().splitlines()]
    assert words == list(range(1000))[-len(words) :]
    assert len(words) > 40
    assert set(tmp_path.iterdir()) == set(files)


def test_many_crashes_do_not_fill_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("nep_core.processes.node_log.LOG_BYTES", 1000)

    for _ in range(9):
        with NodeLog(tmp_path / "child.log", goes_on=True) as kept:
            kept.write(b"x" * 900)

    assert sum(file.stat().st_size for file in tmp_path.iterdir()) < 5000


def test_where_no_signal_can_be_sent_a_node_stops_because_its_life_line_is_let_go(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcomes: Outcomes = queue.Queue()
    code = (
        "import threading\nfrom nep_core.processes import lifeline\nstopped = threading.Event()\n"
        "lifeline.on_parent_end(stopped.set)\nstopped.wait()"
    )
    child = start(code, tmp_path / "child.log", outcomes)
    monkeypatch.setattr("nep_core.processes.process._can_send_signals", lambda: False)

    child.ask_to_stop()

    assert outcomes.get(timeout=10).asked is True
