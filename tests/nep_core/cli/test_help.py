"""The help teaches: every example of it runs, typos are understood, the page is up to date."""

from __future__ import annotations

import io
import os
import shlex
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from nep_core.cli import COMMANDS, explain, overview, parser_of
from nep_core.cli.lessons import LESSONS
from nep_core.errors import NepError
from nep_core.networks.endpoints import BROKER_VARIABLE, MASTER_VARIABLE
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.places import NODES_VARIABLE
from nep_core.recordings.recorder import Recorder
from nep_core.wire.messages import HUMAN_BEHAVIOR
from nep_core.wire.pubsub import Subscriber
from tests.conftest import PROJECT
from tests.nep_core.cli.conftest import Call, nep, until
from tests.nep_core.node_making import write_node
from tools.command_line_page import END

SERVICES = ("master", "broker")
EXAMPLES = [
    line for name, lesson in LESSONS.items() for line, _ in lesson.examples if name not in SERVICES
]
ENDS = {"echo": "--count 1", "hz": "--count 5", "record": "--seconds 0.2"}
"""What is added to an example that would run until Ctrl-C."""
PAGE = PROJECT / "docs" / "command_line.md"


@pytest.fixture
def there(
    busy: PeerNetwork,
    join: Callable[[str], PeerNetwork],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What the examples need: nodes, a recording, a node that can be started."""
    hearer = join("hearer")  # else sending would wait for somebody
    for topic in (HUMAN_BEHAVIOR, "/speed"):
        Subscriber(topic, network=hearer)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))
    monkeypatch.setattr("nep_core.cli.look.RATES_S", 0.1)
    monkeypatch.setattr("sys.stdin", io.StringIO('{"m_s": 0.5}\n\n{"m_s": 0.6}\n'))
    parameter = '[parameters.rate_hz]\ntype = "number"\ndefault = 1.0\nhelp = "H"\n'
    write_node(tmp_path, "virtual_watch", 'node.ready("")', manifest=parameter)


@pytest.mark.parametrize("line", EXAMPLES)
def test_every_example_of_the_help_works(
    there: None, call: Call, join: Callable[[str], PeerNetwork], tmp_path: Path, line: str
) -> None:
    command = line.split()[1]
    if command == "kill":
        asked = join("virtual_watch")
        asked.on_stop = threading.Thread(target=asked.close).start
        asked.join()
    if command == "play":
        with Recorder("walk.mcap", network=join("recorder")) as recorder:
            recorder.add(["/imu"])
            until(lambda: recorder.totals.messages >= 20)
    if command in ENDS and "--count" not in line and "--seconds" not in line:
        line = f"{line} {ENDS[command]}"
    if command == "doctor":
        os.environ.pop(NODES_VARIABLE)

    answer = call(line)

    assert answer.code in ((0, 1) if "--robot" in line else (0,)), answer.err


@pytest.mark.parametrize("command", SERVICES)
def test_the_examples_of_the_services_serve_until_they_are_stopped(
    command: str, free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    for variable in (MASTER_VARIABLE, BROKER_VARIABLE):
        monkeypatch.setenv(variable, f"tcp://127.0.0.1:{free_port}")
    [(line, _)] = LESSONS[command].examples
    words = shlex.split(line)[1:]
    if "--no-original" in parser_of(command).format_help():
        words.append("--no-original")

    with nep(*words, stdout=subprocess.PIPE) as service:
        assert service.stdout is not None
        first = service.stdout.readline()
        service.terminate()
        code = service.wait(30)

    assert f"serves at tcp://127.0.0.1:{free_port}" in first
    assert code == 0


def test_nep_alone_shows_every_command_and_first_steps(call: Call) -> None:
    answer = call("nep")

    assert answer.code == 0
    assert all(f"\n  {name} " in answer.out for name in COMMANDS)
    assert "First steps" in answer.out


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_its_exit_codes(call: Call, command: str) -> None:
    answer = call(f"nep {command} --help")

    assert answer.code == 0
    assert "Exit code: 0" in answer.out
    assert max(map(len, answer.out.splitlines())) <= 100


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("nep ecoh /imu", "Did you mean: nep echo?"),
        ("nep xyz", 'There is no command "xyz".'),
        ("nep echo /imu --cuont 1", "--count"),
        ("nep echo", "Help: nep echo --help"),
        ("nep hz /imu --count 0", '"0" is not a number from 1'),
        ("nep play x.mcap --speed 0", "is not a number from 0.001 to 1000"),
        ("nep record x.mcap /imu /speed --secnods 1", "--seconds"),
    ],
)
def test_wrong_words_are_told_with_what_was_meant(call: Call, line: str, hint: str) -> None:
    answer = call(line)

    assert answer.code == 2
    assert hint in answer.err
    assert answer.out == ""


def test_no_master_is_told_with_what_to_do(call: Call, free_port: int) -> None:
    answer = call(f"nep topics --master tcp://127.0.0.1:{free_port}")

    assert answer.code == 1
    assert "No NEP master answers" in answer.err
    assert "[ ] Start one in another terminal: nep master" in answer.err


def test_a_mistake_of_ours_is_a_sentence_and_its_details_are_kept(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.cli.log_folder", lambda: tmp_path)
    monkeypatch.setattr("nep_core.cli.look.registrations", lambda _options: 1 / 0)

    answer = call("nep topics")

    assert answer.code == 1
    assert "Traceback" not in answer.err
    assert "ZeroDivisionError" in (tmp_path / "nep-command.log").read_text(encoding="utf-8")


def test_an_error_is_shown_with_its_checklist() -> None:
    error = NepError("The lamp broke.", checklist=("Change it.",))

    assert explain(error) == "Something went wrong\nThe lamp broke.\n  [ ] Change it."


@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="others lay the help out differently")
@pytest.mark.parametrize("command", COMMANDS)
def test_the_page_of_the_command_line_has_the_help_of_every_command(
    command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    page = PAGE.read_text(encoding="utf-8")

    told = parser_of(command).format_help()

    assert f"## nep {command}\n\n```\n{told}```\n" in page, "run: python -m tools.command_line_page"
    assert overview() in page
    assert page.endswith(END)


def test_the_version_is_told(call: Call) -> None:
    answer = call("nep --version")

    assert answer.code == 0
    assert answer.out.startswith("nep 0.")
