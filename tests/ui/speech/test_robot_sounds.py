"""Sound files that robots play are heard: by a program, which a small script stands in for."""

from __future__ import annotations

import os
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.ui.speech.robot_voices import RobotSounds, find_player
from nep_studio.ui.speech.voices import Utterance

PLAYER = """
    #!{python}
    import sys, time
    with open({heard!r}, "a") as file:
        file.write(sys.argv[-1] + "\\n")
    time.sleep(60)
"""


@pytest.fixture
def heard(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The files that the program of this computer was told to play, line by line."""
    if sys.platform in ("win32", "darwin"):
        pytest.skip("the player of this system is another program")
    folder, heard = tmp_path / "bin", tmp_path / "heard"
    folder.mkdir()
    script = textwrap.dedent(PLAYER).lstrip().format(python=sys.executable, heard=str(heard))
    (folder / "pw-play").write_text(script)
    (folder / "pw-play").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    heard.touch()
    return heard


@pytest.fixture
def sounds(qapp: QObject, heard: Path) -> Iterator[RobotSounds]:
    owner = QObject()
    made = RobotSounds(owner)
    yield made
    made.stop_speaking()
    owner.deleteLater()


def state(file: str = "", robot: str = "NAO") -> m.RobotState:
    return m.RobotState(robot=robot, joints={}, settings={"playing": file})


def test_a_file_is_heard_once_and_ends_with_the_robot(
    qtbot: QtBot, sounds: RobotSounds, heard: Path, tmp_path: Path
) -> None:
    file = tmp_path / "hello.wav"
    file.touch()

    sounds.hear_state(state(str(file)))
    sounds.hear_state(state(str(file)))
    qtbot.waitUntil(lambda: heard.read_text() == f"{file}\n", timeout=10_000)
    playing = sounds.playing
    sounds.hear_state(state())

    assert playing == ["NAO"]
    assert sounds.playing == []
    assert heard.read_text() == f"{file}\n"


def test_a_file_that_is_on_another_computer_is_not_heard(
    sounds: RobotSounds, tmp_path: Path
) -> None:
    sounds.hear_state(state(str(tmp_path / "elsewhere.wav")))

    assert sounds.playing == []


def test_two_robots_are_heard_at_once_and_hushed_together(
    sounds: RobotSounds, tmp_path: Path
) -> None:
    file = tmp_path / "hello.wav"
    file.touch()
    for robot in ("NAO", "Pepper"):
        sounds.hear_state(state(str(file), robot))
    playing = sounds.playing

    sounds.stop_speaking()

    assert playing == ["NAO", "Pepper"]
    assert sounds.playing == []


@pytest.mark.parametrize(
    ("platform", "programs", "name"),
    [
        ("linux", {"aplay", "paplay"}, "paplay"),
        ("linux", {"aplay"}, "aplay"),
        ("linux", set(), ""),
        ("darwin", {"afplay", "aplay"}, "afplay"),
        ("win32", {"powershell"}, "powershell"),
        ("win32", set(), ""),
    ],
)
def test_each_system_has_its_player(platform: str, programs: set[str], name: str) -> None:
    player = find_player(platform, lambda one: one if one in programs else None)

    assert (player.name if player else "") == name
    if player is not None:
        command = player.command(Utterance("/a file.wav"))
        assert "/a file.wav" in (*command.words, command.text)
