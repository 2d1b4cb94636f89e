"""The command line: what it prints, how it exits, and what it says of unusable input."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from nep_studio import paths
from nep_studio.__main__ import main
from nep_studio.blocks.files import load
from nep_studio.commands import run as run_command
from nep_studio.run.controller import Subject
from nep_studio.run.installation import studio_language

pytestmark = pytest.mark.long

KARATE = paths.examples() / "karate_greeting.nep"
EXAMPLES = sorted(paths.examples().glob("*.nep"))


ZERO = {
    "format": "nep-studio-project",
    "version": 2,
    "name": "Zero",
    "variables": [{"id": "v1", "name": "times"}],
    "blocks": [
        {"id": "b1", "type": "event.started"},
        {
            "id": "b2",
            "type": "variable.change",
            "fields": {"variable": "v1", "amount": 1},
            "inputs": {"amount": "b3"},
        },
        {
            "id": "b3",
            "type": "math.arithmetic",
            "fields": {"a": 1, "b": 0, "operation": "divide"},
        },
    ],
    "pages": {
        "behaviour": [{"id": "s1", "x": 0, "y": 0, "body": ["b1", "b2"]}],
        "robots": [],
        "nodes": [],
    },
}


def run(*words: str | Path, timeout_s: float = 60) -> subprocess.CompletedProcess[str]:
    """``nep-studio`` in a process of its own, where no window can be shown."""
    command = [sys.executable, "-m", "nep_studio", *map(str, words)]
    shown = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    environment = {name: value for name, value in os.environ.items() if name not in shown}
    return subprocess.run(
        command, capture_output=True, text=True, timeout=timeout_s, env=environment
    )


def changed(tmp_path: Path, **places: object) -> Path:
    """The karate example with other values at the top of its JSON."""
    project = json.loads(KARATE.read_text(encoding="utf-8"))
    project.update(places)
    file = tmp_path / "changed.nep"
    file.write_text(json.dumps(project), encoding="utf-8")
    return file


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_has_nothing_to_correct_and_makes_python(
    example: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(example)]) == 0
    assert capsys.readouterr().out == "Nothing to correct.\n"
    assert main(["code", str(example)]) == 0
    compile(capsys.readouterr().out, example.name, "exec")
    assert main(["code", "--nodes", str(example)]) == 0
    compile(capsys.readouterr().out, example.name, "exec")


@pytest.mark.skipif(sys.platform != "linux", reason="only there can a display be lacking")
def test_without_a_display_the_first_words_name_the_example_to_run() -> None:
    result = run()

    assert result.returncode == 2
    assert "needs a display" in result.stderr
    assert "karate_greeting.nep" in result.stderr


def test_a_word_that_is_no_job_is_told_with_those_that_are(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["fly"]) == 2

    told = capsys.readouterr().err
    assert '"fly" is not something that nep-studio can do' in told
    assert "nep-studio run FILE.nep" in told


BAD_FILES = {
    "truncated": KARATE.read_bytes()[:700],
    "empty": b"",
    "not JSON": b"Dear NAO, please say hello.",
    "a picture": b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR",
    "another JSON": b'{"hello": "world"}',
    "deeply nested": b"[" * 200_000,
    "too large": b" " * 21_000_000,
    "a number too large": KARATE.read_bytes().replace(b"0.2", b"1e999", 1),
}


@pytest.mark.parametrize("kind", BAD_FILES)
@pytest.mark.parametrize("job", ["run", "code", "check"])
def test_an_unusable_project_is_told_without_a_traceback(
    tmp_path: Path, kind: str, job: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.nep"
    file.write_bytes(BAD_FILES[kind])

    assert main([job, str(file)]) == 2

    told = capsys.readouterr().err
    assert "mine.nep" in told
    assert "[ ]" in told
    assert "Traceback" not in told
    assert file.read_bytes() == BAD_FILES[kind]


def test_a_project_that_is_not_there_is_told(tmp_path: Path) -> None:
    result = run("run", tmp_path / "nothing.nep")

    assert result.returncode == 2
    assert "nothing.nep" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_project_of_a_newer_version_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(changed(tmp_path, version=999))]) == 2

    assert "newer" in capsys.readouterr().err


def test_an_unknown_block_is_an_error_of_the_check_and_keeps_the_program_from_running(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "unknown.nep"
    file.write_text(KARATE.read_text().replace('"robot.walk"', '"robot.fly"'), encoding="utf-8")

    for job in ("check", "run"):
        assert main([job, str(file)]) == (1 if job == "check" else 2)
        told = capsys.readouterr()
        assert "robot.fly" in told.out + told.err
        assert "Traceback" not in told.err


def test_a_wrong_robot_address_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(KARATE), "--robot", "192.168.1.10"]) == 2

    assert "--robot NAO=192.168.1.10" in capsys.readouterr().err


def test_a_recording_that_cannot_be_used_is_told(tmp_path: Path) -> None:
    recording = tmp_path / "mine.csv"
    recording.write_text("a,b\n1,2\n", encoding="utf-8")

    result = run("run", KARATE, "--recording", recording)

    assert result.returncode == 1
    assert "mine.csv" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_robot_that_does_not_answer_is_told_with_its_block(tmp_path: Path) -> None:
    result = run("run", KARATE, "--robot", "NAO=127.0.0.1:9", "--seconds", "15")

    assert result.returncode == 1
    assert "127.0.0.1:9" in result.stderr
    assert "NAO takes the posture" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_program_that_divides_by_zero_fails_with_its_line_and_block(tmp_path: Path) -> None:
    file = tmp_path / "zero.nep"
    file.write_text(json.dumps(ZERO), encoding="utf-8")

    result = run("run", file)

    assert result.returncode == 1
    assert "A number was divided by zero." in result.stderr
    assert "change times by 1 ÷ 0" in result.stderr
    assert "(line " in result.stderr


def test_stopping_after_some_seconds_is_no_failure() -> None:
    result = run("run", paths.examples() / "dance.nep", "--seconds", "1")

    assert result.returncode == 0
    assert "Everything is stopped" in result.stdout


def test_exec_runs_a_program_made_by_hand(tmp_path: Path, master: object, network: object) -> None:
    program = tmp_path / "mine.py"
    program.write_text("from nep_core import wait\nwait(0.01)\nprint('done')\n", encoding="utf-8")

    result = run("exec", program)

    assert (result.returncode, result.stdout) == (0, "done\n")


@pytest.mark.parametrize(
    ("text", "words"),
    [("1 / 0", "divided by zero"), ("x = (", "not Python"), ("print(nothing)", '"nothing"')],
)
def test_exec_tells_in_words_what_went_wrong(
    tmp_path: Path, master: object, text: str, words: str
) -> None:
    program = tmp_path / "mine.py"
    program.write_text(text, encoding="utf-8")

    result = run("exec", program)

    assert result.returncode == 1
    assert words in result.stderr


def test_who_stops_a_run_that_is_still_being_prepared_ends_it(monkeypatch) -> None:
    language = studio_language()
    subject = Subject(load(KARATE, language), language, KARATE.parent)
    monkeypatch.setattr(run_command.signal, "signal", lambda *_: None)
    play = run_command._Play(subject, run_command.Printer(language, as_json=True), None)
    play._turns.put(play._controller.stop)

    thread = threading.Thread(target=play.play, daemon=True)
    thread.start()
    thread.join(10)

    assert not thread.is_alive()
    assert not play._network.is_open


def test_a_rule_that_failed_while_others_went_on_is_in_the_exit_code(tmp_path: Path) -> None:
    started = [
        {"id": "b4", "type": "event.started"},
        {"id": "b5", "type": "control.wait", "fields": {"seconds": 1}},
        {"id": "b6", "type": "variable.change", "fields": {"variable": "v1", "amount": 5}},
        {"id": "b7", "type": "event.human_state", "fields": {"state": "wave"}},
    ]
    behaviour = [
        *ZERO["pages"]["behaviour"],
        {"id": "s2", "x": 0, "y": 300, "body": ["b4", "b5", "b6"]},
        {"id": "s3", "x": 0, "y": 600, "body": ["b7"]},
    ]
    project = {
        **ZERO,
        "blocks": [*ZERO["blocks"], *started],
        "pages": {**ZERO["pages"], "behaviour": behaviour},
    }
    file = tmp_path / "fails.nep"
    file.write_text(json.dumps(project), encoding="utf-8")

    played = run("run", file, "--seconds", "3")

    assert played.returncode == 1, played.stderr
    assert "failed in line" in played.stdout and "divided by zero" in played.stdout
    assert "A rule failed" in played.stderr and "change times by" in played.stderr
    project["on_error"] = "end"
    file.write_text(json.dumps(project), encoding="utf-8")
    assert run("run", file).returncode == 1  # it ends by itself
