"""What the commands do when output, signals or folders fail them."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import psutil
import pytest

from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_studio import __main__ as program
from nep_studio import paths
from tests.stories.playing import node_is, playing

pytestmark = pytest.mark.long

KARATE = paths.examples() / "karate_greeting.nep"
DANCE = paths.examples() / "dance.nep"
NOWHERE = Path("/dev/full")
WRITING = [
    ("check", KARATE),
    ("code", KARATE),
    ("run", KARATE),
    ("run", KARATE, "--json"),
    ("help",),
]


def run(*words: str | Path, **changes: object) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "nep_studio", *map(str, words)]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | changes
    return subprocess.run(command, timeout=60, **streams)  # type: ignore[call-overload,no-any-return]


@pytest.mark.skipif(not NOWHERE.exists(), reason="there is no disk that is always full here")
@pytest.mark.parametrize("words", WRITING, ids=lambda words: " ".join(map(str, words[::2])))
def test_output_that_cannot_be_written_is_told(words: tuple[str | Path, ...]) -> None:
    with NOWHERE.open("wb") as full:
        result = run(*words, stdout=full)

    told = result.stderr.decode()
    assert result.returncode == 1
    assert told.startswith("A file could not be read or written\nThe computer says: No space")
    assert told.count("\n") == 4


@pytest.mark.parametrize("words", WRITING, ids=lambda words: " ".join(map(str, words[::2])))
def test_a_reader_who_has_gone_ends_the_command_quietly(words: tuple[str | Path, ...]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    try:
        result = run(*words, stdout=writer)
    finally:
        os.close(writer)

    assert (result.returncode, result.stderr) == (1, b"")


def test_a_terminal_without_the_letters_of_a_name_shows_question_marks(tmp_path: Path) -> None:
    project = json.loads(KARATE.read_text(encoding="utf-8")) | {"name": "日本"}
    file = tmp_path / "日本.nep"
    file.write_text(json.dumps(project), encoding="utf-8")
    poor = os.environ | {"PYTHONIOENCODING": "cp1252"}

    played = run("run", file, "--seconds", "0", env=poor)
    code = run("code", file, env=poor)

    assert (played.returncode, played.stderr) == (0, b"")
    assert played.stdout.startswith(b"??. Ctrl-C")
    assert code.stdout.decode("utf-8").startswith('"""日本. ')


def test_no_folder_for_temporary_files_is_told() -> None:
    code = f"""
import sys, tempfile
from nep_studio.__main__ import main
tempfile.tempdir = "/there/is/no/such/folder"
sys.exit(main(["run", {str(KARATE)!r}]))
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)

    assert result.returncode == 1
    assert "Traceback" not in result.stderr
    assert "/there/is/no/such/folder" in result.stderr


def test_an_interrupted_command_ends_quietly(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_words: list[str]) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(program, "_load", lambda _place: interrupted)

    assert program.main(["check", str(KARATE)]) == 130


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT and SIGTERM")
@pytest.mark.parametrize("moment", ["NAO", "watch"])
def test_signals_in_a_row_stop_everything_once(moment: str) -> None:
    with playing(KARATE) as play:
        play.wait_for(node_is(moment, "ready"))
        children = psutil.Process(play.process.pid).children()

        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGINT):
            play.process.send_signal(number)

        assert play.finish() == 0
        assert play.errors() == ""
        assert [child for child in children if child.is_running()] == []
        assert [e for e in play.events if e.get("event") == "crashed"] == []


def test_three_runs_at_once_have_three_masters(
    free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(MASTER_VARIABLE, f"tcp://127.0.0.1:{free_port}")

    with ExitStack() as stack:
        plays = [stack.enter_context(playing(DANCE)) for _ in range(3)]
        for play in plays:
            play.wait_for(node_is("program", "ready"))
        masters = {word for play in plays for word in endpoints(play.process.pid)}

    assert len(masters) == 3


def endpoints(session: int) -> list[str]:
    """Where the masters among a session's children serve."""
    commands = [child.cmdline() for child in psutil.Process(session).children()]
    masters = [command for command in commands if "master" in command]
    return [command[command.index("--endpoint") + 1] for command in masters]


WRONG = [("--seconds", number) for number in ("nan", "inf", "1e12", "-1", "soon")] + [
    ("--speed", number) for number in ("nan", "0", "-1", "1000")
]


@pytest.mark.parametrize(("option", "number"), WRONG)
def test_a_number_out_of_range_is_refused_with_the_range(
    option: str, number: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        program.main(["run", str(KARATE), f"{option}={number}"])

    assert ended.value.code == 2
    assert f'{option}: "{number}" is not a number from 0' in capsys.readouterr().err
