"""ALFaceDetection and ALAudioPlayer: faces are learnt, files are played, on the robot itself."""

from __future__ import annotations

import wave
from pathlib import Path

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.wire.errors import CallFailed


@pytest.fixture
def sound(tmp_path: Path) -> str:
    path = tmp_path / "hello.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(8000)
        file.writeframes(bytes(5 * 16000))
    return str(path)


def test_a_face_is_learnt_listed_and_forgotten(theatre: NaoqiTheatre) -> None:
    theatre.feel("face")

    learnt = theatre.call("ALFaceDetection", "learnFace", "Anna")
    listed = theatre.call("ALFaceDetection", "getLearnedFacesList")
    seen = set(theatre.state().sees)
    forgotten = theatre.call("ALFaceDetection", "forgetPerson", "Anna")

    assert (learnt, listed, forgotten) == (True, ["Anna"], True)
    assert seen == {"face", "face_anna"}
    assert theatre.call("ALFaceDetection", "getLearnedFacesList") == []
    assert set(theatre.state().sees) == {"face"}


def test_all_faces_are_forgotten_at_once(theatre: NaoqiTheatre) -> None:
    theatre.feel("face")
    theatre.call("ALFaceDetection", "learnFace", "Anna")

    theatre.call("ALFaceDetection", "clearDatabase")

    assert theatre.call("ALFaceDetection", "getLearnedFacesList") == []
    assert set(theatre.state().sees) == {"face"}
    with pytest.raises(CallFailed, match="no face called"):
        theatre.call("ALFaceDetection", "forgetPerson", "Anna")


def test_a_file_is_played_to_its_end(theatre: NaoqiTheatre, sound: str) -> None:
    playing = theatre.service("ALAudioPlayer").begin("playFile", sound)
    theatre.until(lambda: theatre.state().settings["playing"] == sound)

    playing.result(20)

    assert theatre.state().settings["playing"] == ""


def test_a_file_is_played_again_and_again_until_all_are_stopped(
    theatre: NaoqiTheatre, sound: str
) -> None:
    playing = theatre.service("ALAudioPlayer").begin("playFileInLoop", sound)
    theatre.until(lambda: theatre.state().settings["playing"] == sound)

    theatre.call("ALAudioPlayer", "stopAll")

    playing.result(20)
    assert theatre.state().settings["playing"] == ""
