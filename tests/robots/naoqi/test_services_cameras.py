"""Programs of NAOqi take pictures and videos with the robot on the screen."""

from __future__ import annotations

from pathlib import Path

import pytest
from naoqi_theatre import NaoqiTheatre

from robots.body.camera import frames_in
from robots.naoqi.wire.errors import CallFailed


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("NEP_ROBOT_FILES", str(tmp_path))
    return tmp_path / "NAO"


def test_a_picture_is_in_the_file_that_is_told(theatre: NaoqiTheatre, files: Path) -> None:
    made = theatre.call("ALPhotoCapture", "takePicture", "/home/nao/recordings/cameras", "me")

    assert made == [str(files / "pictures" / "me.png")]
    assert Path(made[0]).read_bytes().startswith(b"\x89PNG")


def test_several_pictures_are_in_files_with_numbers(theatre: NaoqiTheatre) -> None:
    made = theatre.call("ALPhotoCapture", "takePictures", 3, "/home/nao", "me")

    assert [Path(one).name for one in made] == ["me_0.png", "me_1.png", "me_2.png"]
    assert all(Path(one).is_file() for one in made)


def test_a_video_is_recorded_until_it_is_stopped(theatre: NaoqiTheatre, files: Path) -> None:
    theatre.call("ALVideoRecorder", "startRecording", "/home/nao/recordings/cameras", "film")
    during = theatre.call("ALVideoRecorder", "isRecording")
    theatre.call("ALTextToSpeech", "say", "Hello")

    frames, path = theatre.call("ALVideoRecorder", "stopRecording")

    assert during and not theatre.call("ALVideoRecorder", "isRecording")
    assert path == str(files / "videos" / "film.png")
    assert frames == frames_in(Path(path)) >= 1


def test_two_videos_at_once_are_refused(theatre: NaoqiTheatre) -> None:
    theatre.call("ALVideoRecorder", "startRecording", "/home/nao", "film")

    with pytest.raises(CallFailed) as refused:
        theatre.call("ALVideoRecorder", "startRecording", "/home/nao", "more")

    assert "video already" in str(refused.value.sentence)
