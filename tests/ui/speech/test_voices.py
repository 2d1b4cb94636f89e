"""Robots are heard: by a real program of the system, which a small script stands in for."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.run.plan import PlannedNode
from nep_studio.settings import Settings
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.speech import Sound
from nep_studio.ui.speech.robot_voices import RobotVoices
from nep_studio.ui.speech.voices import (
    MOST_FAILURES,
    ChildVoice,
    Utterance,
    find_system_voice,
    find_voice,
    installed,
    own_pitch,
    pyttsx3_command,
    utterance_of,
)

NODE_START_MS = 30_000
SPEAKER = """
    #!{python}
    import json, os, sys, time
    text = sys.stdin.read()
    with open({heard!r}, "a") as file:
        file.write(json.dumps([os.getpid(), sys.argv[1:], text]) + "\\n")
    time.sleep(60 if "long" in text else 0)
    sys.exit(3 if "broken" in text else 0)
"""


class Ears:
    """What the program that speaks was told."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def told(self) -> list[tuple[int, list[str], str]]:
        lines = self.file.read_text().splitlines() if self.file.exists() else []
        return [tuple(json.loads(line)) for line in lines]

    def texts(self) -> list[str]:
        return [text for _, _, text in self.told()]


@pytest.fixture
def ears(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Ears:
    """A computer that has espeak-ng and no other voice."""
    if sys.platform in ("win32", "darwin"):
        pytest.skip("the voice of this system is another program")
    folder, heard = tmp_path / "bin", tmp_path / "heard"
    folder.mkdir()
    script = textwrap.dedent(SPEAKER).lstrip().format(python=sys.executable, heard=str(heard))
    (folder / "espeak-ng").write_text(script)
    (folder / "espeak-ng").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr("nep_studio.ui.speech.voices.qt_voice", lambda parent: None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    return Ears(heard)


@pytest.fixture
def owner(qapp: QObject) -> Iterator[QObject]:
    made = QObject()
    yield made
    made.deleteLater()


@pytest.fixture
def voice(ears: Ears, owner: QObject) -> Iterator[ChildVoice]:
    made = find_voice(owner)
    assert isinstance(made, ChildVoice)
    yield made
    made.stop()


@pytest.fixture
def voices(ears: Ears, owner: QObject) -> Iterator[RobotVoices]:
    made = RobotVoices(find_voice, owner)
    yield made
    made.stop_speaking()


def state(saying: str, robot: str = "NAO", **settings: bool | float | str) -> m.RobotState:
    return m.RobotState(robot=robot, joints={}, saying=saying, settings=settings)


def test_a_text_is_spoken_by_a_program_of_the_system(
    voice: ChildVoice, ears: Ears, qtbot: QtBot
) -> None:
    with qtbot.waitSignal(voice.fell_silent):
        voice.say(Utterance("--help me, Ünal", "de", 0.5, 1.2))

    [(_, words, text)] = ears.told()
    assert text == "--help me, Ünal"
    assert words[:6] == ["-v", "de", "-a", "50", "-p", "60"]
    assert not voice.is_speaking


def test_to_stop_ends_the_program_at_once(voice: ChildVoice, ears: Ears, qtbot: QtBot) -> None:
    voice.say(Utterance("a long story"))
    qtbot.waitUntil(lambda: bool(ears.told()))

    voice.stop()

    assert not voice.is_speaking
    with pytest.raises(ProcessLookupError):
        os.kill(ears.told()[0][0], 0)


def test_a_program_that_cannot_speak_is_given_up(
    voice: ChildVoice, ears: Ears, qtbot: QtBot
) -> None:
    for _ in range(MOST_FAILURES):
        with qtbot.waitSignal(voice.fell_silent):
            voice.say(Utterance("broken"))

    voice.say(Utterance("Hello"))

    assert voice.is_broken
    assert not voice.is_speaking
    assert "Hello" not in ears.texts()


def test_a_computer_without_a_voice_is_silent(owner: QObject) -> None:
    voices = RobotVoices(lambda parent: None, owner)

    voices.hear_state(state("Hello"))
    voices.stop_speaking()

    assert voices.speaking == []
    assert find_system_voice("linux", lambda name: None) is None


@pytest.mark.parametrize(
    ("platform", "program"),
    [("darwin", "say"), ("win32", "powershell"), ("linux", "spd-say"), ("linux", "espeak")],
)
def test_each_system_is_told_the_text_the_language_and_how_loud(
    platform: str, program: str
) -> None:
    found = find_system_voice(platform, lambda name: f"/bin/{name}" if name == program else None)

    assert found is not None
    command = found.command(Utterance("Tom & <Jerry>", "pt_br", 0.25, 1.3))
    everything = " ".join([*command.words, command.text])
    assert command.words[0] == f"/bin/{program}"
    assert "Tom" in everything and "Jerry" in everything
    assert any(word in everything for word in ("pt-br", "Luciana"))
    assert any(word in everything for word in ("25", "-50"))


@pytest.mark.skipif(sys.platform == "win32", reason="it takes other programs to be tried there")
def test_nothing_in_the_folder_that_we_are_started_in_speaks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be a stranger's, and after a double click on Windows it is."""
    monkeypatch.chdir(tmp_path)
    Path("pyttsx3.py").write_text("open('marker', 'w').close()")
    Path("espeak-ng").write_text("#!/bin/sh")
    Path("espeak-ng").chmod(0o755)
    monkeypatch.setenv("PATH", os.curdir)

    assert installed("espeak-ng") is None
    words = pyttsx3_command(Utterance("Hi", "en")).words
    subprocess.run(words, input=b"", capture_output=True, check=False)
    assert not Path("marker").exists()


def test_a_robot_speaks_as_it_is_set_and_robots_sound_different() -> None:
    nao, other = utterance_of(state("Hi", volume=40.0, language="fr")), own_pitch("NAO2")

    assert (nao.language, nao.volume, nao.pitch) == ("fr", 0.4, 1.0)
    assert other != own_pitch("NAO")
    assert own_pitch("NAO2") == other
    assert utterance_of(state("Hi", volume=float("nan"))).volume == 1.0


def test_how_a_text_was_asked_to_be_said_is_how_it_is_spoken(
    voices: RobotVoices, ears: Ears, qtbot: QtBot
) -> None:
    args = {"text": "Bonjour", "language": "fr", "pitch": 150.0, "speed": 200.0}
    voices.hear(m.ActionRequest(id="1", robots=["NAO"], action="say", args=args))

    voices.hear_state(state("Bonjour", language="en"))

    qtbot.waitUntil(lambda: bool(ears.told()))
    [(_, words, _)] = ears.told()
    assert words[:2] == ["-v", "fr"]
    assert (words[words.index("-p") + 1], words[words.index("-s") + 1]) == ("75", "330")


def test_a_program_in_german_is_heard_in_german(
    voices: RobotVoices, ears: Ears, qtbot: QtBot
) -> None:
    args = {"text": "Hallo", "language": "", "usual_language": "de"}
    voices.hear(m.ActionRequest(id="1", robots=["NAO"], action="say", args=args))

    voices.hear_state(state("Hallo", language="en"))

    qtbot.waitUntil(lambda: bool(ears.told()))
    [(_, words, _)] = ears.told()
    assert words[:2] == ["-v", "de"]


def test_what_a_robot_says_is_spoken_once_however_often_it_is_told(
    voices: RobotVoices, ears: Ears, qtbot: QtBot
) -> None:
    for saying in ("Hello", "Hello", "", "Hello", "", "Bye"):
        voices.hear_state(state(saying))
        qtbot.waitUntil(lambda: not voices.speaking)

    assert ears.texts() == ["Hello", "Hello", "Bye"]


def test_a_slow_voice_ends_its_sentence_before_the_next(
    voices: RobotVoices, ears: Ears, qtbot: QtBot
) -> None:
    for saying in ("One", "Two"):
        voices.hear_state(state(saying))

    qtbot.waitUntil(lambda: ears.texts() == ["One", "Two"])


def test_a_speech_that_is_cancelled_is_cut_off(
    voices: RobotVoices, ears: Ears, qtbot: QtBot
) -> None:
    request = m.ActionRequest(id="1", robots=["NAO"], action="say", args={"text": "a long story"})
    voices.hear(request)
    for robot in ("NAO", "NAO2"):
        voices.hear_state(state("a long story", robot))
    qtbot.waitUntil(lambda: len(ears.told()) == 2)

    voices.hear(m.ActionResult(id="1", robot="NAO", state="cancelled"))

    assert voices.speaking == ["NAO2"]


def test_to_stop_all_robots_silences_all(voices: RobotVoices, ears: Ears, qtbot: QtBot) -> None:
    for robot in ("NAO", "NAO2"):
        voices.hear_state(state("a long story", robot))
    qtbot.waitUntil(lambda: len(ears.told()) == 2)

    voices.hear(m.ActionRequest(id="2", robots=[], action="stop"))

    assert voices.speaking == []


@pytest.fixture
def runner(owner: QObject, tmp_path: Path) -> Iterator[Runner]:
    made = Runner(list, owner, logs=tmp_path)
    yield made
    made.close()


@pytest.fixture
def sound(ears: Ears, runner: Runner, tmp_path: Path) -> Iterator[Sound]:
    made = Sound(runner, Settings(tmp_path / "home"), runner)
    yield made
    made.voices.stop_speaking()


@pytest.fixture
def ask(runner: Runner, qtbot: QtBot) -> Callable[[str], None]:
    """A real virtual robot, which is asked to say something."""
    runner.start_node(PlannedNode("action/nao", "NAO", {"robot": "NAO", "driver": "virtual"}))
    nodes = runner.board.nodes
    qtbot.waitUntil(
        lambda: "NAO" in nodes and nodes["NAO"].health == "ready", timeout=NODE_START_MS
    )

    def say(text: str) -> None:
        request = m.ActionRequest(id=text, robots=["NAO"], action="say", args={"text": text})
        assert runner.send(m.ACTION_REQUEST, request)

    return say


def test_a_running_robot_is_heard_and_falls_silent_when_it_is_stopped(
    sound: Sound, ask: Callable[[str], None], ears: Ears, runner: Runner, qtbot: QtBot
) -> None:
    ask("a long story " * 10)
    qtbot.waitUntil(lambda: bool(ears.told()), timeout=NODE_START_MS)
    runner.send(m.ACTION_REQUEST, m.ActionRequest(id="stop", robots=[], action="stop"))

    qtbot.waitUntil(lambda: not sound.voices.speaking)
    with pytest.raises(ProcessLookupError):
        os.kill(ears.told()[0][0], 0)


def test_sound_that_is_off_listens_to_nothing_and_is_remembered(
    sound: Sound, runner: Runner, ask: Callable[[str], None], qtbot: QtBot, tmp_path: Path
) -> None:
    assert sound._tap is not None

    with qtbot.waitSignal(sound.switched):
        sound.switch(False)

    assert sound._tap is None
    assert not Settings(tmp_path / "home").has_sound
