"""The command as a process: pipes, Ctrl-C, other locales, and SIGKILL in a recording."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.recordings.file import overview
from nep_core.recordings.recorder import Player, Recorder
from nep_core.wire.pubsub import Publisher
from tests.nep_core.cli.conftest import nep, until

pytestmark = [pytest.mark.skipif(sys.platform == "win32", reason="sends signals"), pytest.mark.long]


def test_a_reader_that_has_seen_enough_ends_the_command_quietly(busy: PeerNetwork) -> None:
    with nep("echo", "/imu", stdout=subprocess.PIPE, stderr=subprocess.PIPE) as echo:
        assert echo.stdout is not None and echo.stderr is not None
        first = echo.stdout.readline()
        echo.stdout.close()
        code = echo.wait(30)

        assert first.startswith("{")
        assert (code, echo.stderr.read()) == (0, "")


@pytest.mark.parametrize("words", [(), ("echo", "--help"), ("doctor",)])
def test_help_that_nobody_reads_to_its_end_is_quiet(words: tuple[str, ...]) -> None:
    reader, writer = os.pipe()
    os.close(reader)

    with nep(*words, stdout=writer, stderr=subprocess.PIPE) as command:
        os.close(writer)
        _, err = command.communicate(timeout=20)

    assert (command.returncode, err) == (0, "")


def test_ctrl_c_ends_a_command_quietly_and_output_comes_at_once(busy: PeerNetwork) -> None:
    with nep("hz", "/imu", stdout=subprocess.PIPE, stderr=subprocess.PIPE) as hz:
        assert hz.stdout is not None and hz.stderr is not None
        line = hz.stdout.readline()  # through a pipe, while it goes on
        hz.send_signal(signal.SIGINT)
        code = hz.wait(30)

        assert "messages a second" in line
        assert (code, hz.stderr.read()) == (0, "")


@pytest.mark.parametrize("locale", ["C", "de_DE.ISO-8859-1"])
def test_letters_of_all_languages_pass_on_any_locale(
    join: Callable[[str], PeerNetwork], locale: str
) -> None:
    environment = {**os.environ, "LC_ALL": locale, "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    words = ("echo", "/greeting", "--count", "1")
    publisher = Publisher("/greeting", network=join("talker"), latched=True)
    publisher.send("Grüße, 日本")

    with nep(*words, stdout=subprocess.PIPE, env=environment) as echo:
        out, _ = echo.communicate(timeout=30)

    assert out == "Grüße, 日本\n"


def test_a_recording_that_is_killed_keeps_all_but_the_last_second(
    busy: PeerNetwork, tmp_path: Path
) -> None:
    path = tmp_path / "killed.mcap"
    with nep("record", str(path), stderr=subprocess.DEVNULL) as recorder:
        until(lambda: path.exists() and overview_of(path) >= 50)
        recorder.kill()

    told = overview(path)
    assert not told.is_whole
    assert {"/imu", "/human_behavior", "/speed", "/node_state"} >= set(told.topics) >= {"/imu"}
    assert told.messages >= 50


def test_ctrl_c_finishes_a_recording(busy: PeerNetwork, tmp_path: Path) -> None:
    path = tmp_path / "whole.mcap"
    with nep(
        "record", str(path), "/imu", stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as recorder:
        assert recorder.stderr is not None
        assert "Recording to" in recorder.stderr.readline()
        until(lambda: overview_of(path) >= 1)
        recorder.send_signal(signal.SIGINT)
        out, err = recorder.communicate(timeout=30)

    told = overview(path)
    assert (recorder.returncode, err) == (0, "")
    assert told.is_whole
    assert out.startswith(f"Recorded {told.messages} messages of 1 topic to {path}")


def overview_of(path: Path) -> int:
    """How many messages a file holds that is still being written."""
    return overview(path).messages if path.stat().st_size > 8 else 0


@pytest.mark.parametrize(("stream", "code"), [("stdin", 1), ("stdout", 0), ("stderr", 0)])
def test_a_command_works_without_a_standard_stream(master: Master, stream: str, code: int) -> None:
    number = ("stdin", "stdout", "stderr").index(stream)
    words = ("send", "/x", "-") if stream == "stdin" else ("topics",)
    with nep(*words, stderr=subprocess.PIPE, preexec_fn=lambda: os.close(number)) as command:
        _, err = command.communicate(timeout=20)

    assert (command.returncode, err) == (code, "There was no message to send.\n" if code else "")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no disk is always full here")
@pytest.mark.parametrize("words", ["topics", "record /dev/full --force --seconds 0.1"])
def test_a_full_disk_is_told_in_a_sentence(master: Master, words: str) -> None:
    with (
        open("/dev/full", "w") as full,
        nep(*words.split(), stdout=full, stderr=subprocess.PIPE) as command,
    ):
        _, err = command.communicate(timeout=20)

    assert command.returncode == 1
    assert "no space left on device" in err
    assert "inside the command" not in err


def test_a_player_that_waits_for_subscribers_is_stopped_at_once(
    busy: PeerNetwork, tmp_path: Path
) -> None:
    path = tmp_path / "short.mcap"
    with Recorder(path, network=busy) as recorder:
        recorder.add(["/speed"])
        until(lambda: recorder.totals.messages)
    end_s = time.monotonic() + 20

    with Player(path, prefix="/old") as player:
        stopping = threading.Timer(0.05, player.stop)
        stopping.start()
        is_heard = player.wait_for_subscribers(20)
        stopping.join()

    assert not is_heard
    assert time.monotonic() < end_s
