"""The faces that a virtual NAO learns and forgets, and the sound files that it plays."""

from __future__ import annotations

import struct
import wave
from pathlib import Path

import pytest
from nao_stage import Stage

from robots.body.driver import SenseRequest, Thing
from robots.body.sense_tasks import length_s

NOBODY = [Thing(id="b", kind="ball", place=(5.0, 0.0, 0.0), size=(0.1, 0.1, 0.1))]


def person(name: str = "", id: str = "p1", ahead: float = 1.0) -> Thing:
    return Thing(id=id, kind="person", place=(ahead, 0.0, 0.0), heading=3.14, name=name)


def face(stage: Stage, name: str = "", value: float = 1.0) -> list[str]:
    request = SenseRequest(robot="NAO", sense="face", name=name, value=value)
    return stage.actor.sense(request)


def place(stage: Stage, *things: Thing) -> list[str]:
    """Let these be around, and return the human states that follow."""
    stage.driver.noticed()
    stage.driver.surroundings(things)
    stage.pass_time(1.5)
    return stage.driver.noticed()


def sees(stage: Stage) -> set[str]:
    return set(stage.driver.state().sees)


def sound(folder: Path, name: str = "hello.wav", seconds: float = 0.5) -> Path:
    path = folder / name
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(8000)
        file.writeframes(bytes(round(16000 * seconds)))
    return path


def test_a_placed_person_who_was_learnt_is_known_again_when_coming_back() -> None:
    stage = Stage()
    place(stage, person())
    before = sees(stage)

    learnt = stage.do("learn_face", name="Anna B.")
    place(stage, *NOBODY)
    gone = sees(stage)
    told = place(stage, person())

    assert learnt.state == "done"
    assert before == {"face"} and gone == set()
    assert sees(stage) == {"face", "face_anna_b"}
    assert {"seen_face", "seen_face_anna_b"} <= set(told)


def test_it_learns_the_nearest_person_and_nobody_else() -> None:
    stage = Stage()
    place(stage, person(id="near", ahead=0.8), person(id="far", ahead=2.0))

    stage.do("learn_face", name="Anna")

    assert sees(stage) >= {"face_anna"}
    place(stage, person(id="far"))
    assert sees(stage) == {"face"}


def test_a_face_that_it_is_told_to_see_is_learnt() -> None:
    stage = Stage()
    face(stage)

    stage.do("learn_face", name="Anna")
    now = sees(stage)
    face(stage, value=0.0)
    gone = sees(stage)

    assert now == {"face", "face_anna"} and gone == set()
    assert face(stage)[:2] == ["seen_face_anna", "seen_face"]


def test_a_person_has_one_name_the_last_that_was_learnt() -> None:
    stage = Stage()
    face(stage, "Bob")
    stage.do("learn_face", name="Anna")
    stage.do("learn_face", name="Eve")
    told = sees(stage)
    face(stage, "Bob", 0.0)
    place(stage, person("Bob"))

    stage.do("learn_face", name="Eve")
    stage.pass_time(0.2)

    assert told == {"face", "face_eve"}
    assert sees(stage) == {"face", "face_eve"}


@pytest.mark.parametrize("is_placed", [True, False])
def test_a_forgotten_name_is_a_plain_face_until_it_is_learnt_again(is_placed: bool) -> None:
    stage = Stage()
    if is_placed:
        place(stage, person("Anna"))
    else:
        face(stage, "Anna")

    stage.do("forget_face", name="Anna")
    stage.pass_time(0.2)
    forgotten = sees(stage)
    stage.do("learn_face", name="anna")
    stage.pass_time(0.2)

    assert forgotten == {"face"}
    assert sees(stage) == {"face", "face_anna"}


def test_nobody_in_sight_cannot_be_learnt() -> None:
    result = Stage().do("learn_face", name="Anna")

    assert result.state == "failed"
    assert "sees nobody" in result.description and "place a person" in result.description


def test_a_name_needs_letters() -> None:
    stage = Stage()
    face(stage)

    assert stage.do("learn_face", name="?!").state == "failed"
    assert sees(stage) == {"face"}


def test_a_name_that_it_does_not_know_is_not_forgotten() -> None:
    stage = Stage()
    face(stage, "Anna")

    unknown = stage.do("forget_face", name="Bob")
    stage.do("forget_face", name="Anna")
    again = stage.do("forget_face", name="Anna")

    assert unknown.description == 'NAO has learnt no face called "Bob".'
    assert again.state == "failed"


def test_a_sound_is_played_for_as_long_as_it_lasts(tmp_path: Path) -> None:
    stage, path = Stage(), sound(tmp_path, seconds=0.5)

    stage.ask("1", "play_sound", file=str(path))
    stage.ask("2", "say", text="Hello", gesture="no_gesture")
    stage.pass_time(0.48)
    playing, saying = stage.driver.state().settings["playing"], stage.driver.state().saying
    stage.pass_time(0.1)

    assert (playing, saying) == (str(path), "")
    assert "1 done" in stage.told
    assert stage.driver.state().settings["playing"] == ""
    assert stage.driver.state().saying == "Hello"


def test_a_sound_can_be_stopped_also_one_without_an_end(tmp_path: Path) -> None:
    stage, path = Stage(), sound(tmp_path, seconds=0.1)
    stage.ask("1", "play_sound", file=str(path), again=True)
    stage.pass_time(1.0)
    playing = stage.driver.state().settings["playing"]

    stage.ask("2", "stop")
    stage.pass_time(0.02)

    assert playing == str(path)
    assert "1 cancelled" in stage.told
    assert stage.driver.state().settings["playing"] == ""


@pytest.mark.parametrize("file", ["hello.wav", "/home/nao/hello.wav", "~/Music/hello.wav"])
def test_sounds_are_found_in_the_home_folder_and_in_its_music(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    (tmp_path / "Music").mkdir()
    sound(tmp_path / "Music")

    assert Stage().do("play_sound", file=file).state == "done"


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    result = Stage().do("play_sound", file=str(tmp_path / "no.wav"))

    assert result.state == "failed"
    assert result.description.startswith("NAO finds no sound file “")
    assert "whole path" in result.description


@pytest.mark.parametrize("content", [b"", b"hello, I am a text", b"RIFF....WAVE", b"OggS"])
def test_what_is_no_sound_is_told(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.wav").write_bytes(content)

    result = Stage().do("play_sound", file=str(tmp_path / "a.wav"))

    assert result.state == "failed"
    assert "cannot play “a.wav”" in result.description
    assert result.description.endswith("Possible: wav, mp3, ogg.")


def test_the_length_of_an_mp3_follows_from_its_first_frame(tmp_path: Path) -> None:
    tag = b"ID3\x04\x00\x00\x00\x00\x01\x00" + bytes(128)
    (tmp_path / "a.mp3").write_bytes(tag + b"\xff\xfb\x90\x00" + bytes(16000 * 3 - 4))

    assert length_s(tmp_path / "a.mp3") == pytest.approx(3.0)


def test_the_length_of_an_ogg_is_in_its_last_page(tmp_path: Path) -> None:
    head = b"\x01vorbis" + struct.pack("<IBI", 0, 2, 44100)
    first = b"OggS\x00\x02" + struct.pack("<q", 0) + bytes(13) + head
    last = b"OggS\x00\x04" + struct.pack("<q", 88200) + bytes(13)
    (tmp_path / "a.ogg").write_bytes(first + bytes(500) + last)

    assert length_s(tmp_path / "a.ogg") == pytest.approx(2.0)
