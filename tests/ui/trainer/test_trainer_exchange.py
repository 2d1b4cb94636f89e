"""Takes to files and back: CSV as the trainer of the command line reads it, and MCAP."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fuzz.target import SEEDS
from nep_core.errors import RecordingError
from nep_studio.ui.messages import Message
from nep_studio.ui.plugins.gestures.exchange import (
    add_imported,
    read_csv,
    read_mcap,
    write_csv,
    write_mcap,
)
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.live import unpacked
from nep_studio.ui.plugins.gestures.menus import Exchange
from nep_studio.ui.plugins.gestures.project_gestures import Keeping
from nodes.recordings import read_recordings
from tests.ui.trainer.test_gesture_controller import samples


class Told:
    """Keeps the messages."""

    def __init__(self) -> None:
        self.messages: list[Message] = []

    def show_message(self, message: Message) -> None:
        self.messages.append(message)


@pytest.fixture
def told(desk: GestureController) -> list[Message]:
    place = Told()
    desk.messages.show_in(place)
    return place.messages


@pytest.fixture
def filled(desk: GestureController) -> GestureController:
    """Two gestures of two people, a deleted and a left out take, and everyday movement."""
    keeping = Keeping(desk)
    wave, blow = keeping.new_gesture("Big wave"), keeping.new_gesture("Blow")
    desk.set_wearer("Ana", "left")
    ids = keeping.keep_session(wave, samples(8.0), [(1, 2), (3, 4), (5, 6)])
    keeping.delete_takes(ids[:1])
    keeping.leave_out(ids[1:2], True)
    desk.set_wearer("Bo", "hand")
    keeping.keep_session(blow, samples(6.0), [(1, 2), (3, 4)])
    keeping.keep_everyday(samples(3.0))
    return desk


def takes_of(desk: GestureController) -> dict[str, list[tuple[float, float, bool, str, str]]]:
    """All that is known of the takes but their ids."""
    return {
        gesture.title: [
            (
                round(take.start_s, 6),
                round(take.end_s, 6),
                take.left_out,
                desk.recordings[take.recording].person,
                desk.recordings[take.recording].wrist,
            )
            for take in gesture.takes
        ]
        for gesture in desk.gestures.values()
    }


def emptied(desk: GestureController) -> None:
    for name in list(desk.gestures):
        Keeping(desk).delete_gesture(name)
    for key in list(desk.recordings):
        Keeping(desk).delete_recording(key)
    assert not desk.gestures
    assert not desk.recordings


def test_mcap_brings_back_exactly_what_was_written(
    filled: GestureController, tmp_path: Path
) -> None:
    before, kept = takes_of(filled), sorted(map(repr, filled.recordings.values()))
    measured = [unpacked(one) for one in filled.recordings.values()]
    path = tmp_path / "mine.mcap"

    write_mcap(path, filled.gestures, filled.recordings)
    emptied(filled)
    imported, is_whole = read_mcap(path)
    assert add_imported(filled, imported)

    assert is_whole
    assert takes_of(filled) == before
    assert sorted(map(repr, filled.recordings.values())) == kept
    back = {one.seconds: unpacked(one) for one in filled.recordings.values()}
    for one in measured:
        other = next(b for s, b in back.items() if abs(s - one.seconds) < 1e-3)
        assert np.allclose(other.t, one.t, atol=1e-6)
        assert np.allclose(other.acc, one.acc, atol=1e-6)
        assert np.allclose(other.gyr, one.gyr, atol=1e-6)


def test_an_mcap_file_is_one_that_other_programs_read(
    filled: GestureController, tmp_path: Path
) -> None:
    from mcap.reader import make_reader

    path = tmp_path / "mine.mcap"

    write_mcap(path, filled.gestures, filled.recordings)

    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    topics = [channel.topic for channel in summary.channels.values()]
    assert sorted(topics) == ["/gesture_takes", "/imu", "/imu", "/imu"]
    assert {schema.encoding for schema in summary.schemas.values()} == {"jsonschema"}


@pytest.mark.parametrize("share", [0.98, 0.6, 0.3])
def test_a_cut_mcap_file_gives_what_is_there_or_a_sentence(
    share: float, filled: GestureController, tmp_path: Path, told: list[Message]
) -> None:
    path = tmp_path / "mine.mcap"
    keeping = Keeping(filled)
    for _ in range(8):
        keeping.keep_session("blow", samples(60.0), [(1, 2)])
    write_mcap(path, filled.gestures, filled.recordings)
    count = len(filled.recordings)
    data = path.read_bytes()
    emptied(filled)

    path.write_bytes(data[: round(len(data) * share)])
    Exchange(filled, None).import_from(path)

    assert 0 < len(filled.recordings) <= count
    assert told[-1].title == "The file ends in the middle"


@pytest.mark.parametrize(
    "data", [b"", b"hello", b"\x89MCAP0\r\n", b"\x89MCAP0\r\n" + b"\x01" * 500, b"\0" * 5000]
)
def test_what_is_no_mcap_file_is_told_in_a_sentence(
    data: bytes, desk: GestureController, tmp_path: Path, told: list[Message]
) -> None:
    path = tmp_path / "bad.mcap"
    path.write_bytes(data)

    Exchange(desk, None).import_from(path)

    assert told[-1].title == "A file cannot be used"
    assert told[-1].checklist
    assert not desk.recordings


def test_csv_files_bring_takes_back_and_train_on_the_command_line(
    filled: GestureController, tmp_path: Path
) -> None:
    before = takes_of(filled)

    written = write_csv(tmp_path / "out", filled.gestures, filled.recordings)
    read = read_recordings(tmp_path / "out")
    emptied(filled)
    add_imported(filled, read_csv(tmp_path / "out"))

    assert len(written) == 3
    assert {label for one in read for label in one.labels} == {"", "?", "big_wave", "blow"}
    after = takes_of(filled)
    assert list(after) == ["big wave", "blow"]
    assert [t[3:] for t in after["blow"]] == [t[3:] for t in before["Blow"]]
    assert np.allclose([t[:2] for t in after["blow"]], [t[:2] for t in before["Blow"]], atol=0.021)
    assert sum(one.everyday for one in filled.recordings.values()) == 1
    assert sum(len(one.forgotten) for one in filled.recordings.values()) == 2


def test_a_known_gesture_gets_the_takes_of_a_file(
    filled: GestureController, tmp_path: Path
) -> None:
    write_csv(tmp_path, filled.gestures, filled.recordings)

    Exchange(filled, None).import_from(tmp_path)

    assert list(filled.gestures) == ["big_wave", "blow"]
    assert len(filled.gestures["blow"].takes) == 4
    assert filled.editor.history.undo_label == "import takes"


def test_real_csv_files_are_imported(
    desk: GestureController, shared_data: Path, told: list[Message]
) -> None:
    Exchange(desk, None).import_from(shared_data / "uhh_gestures" / "j_left.csv")

    assert list(desk.gestures) == ["left"]
    assert len(desk.gestures["left"].takes) == 10
    assert desk.people == ["j", "Me"]
    assert told[-1].title == "10 takes were imported."


@pytest.mark.parametrize("words", ["hello", "t,ax\n1,2\n", "t_s,ax,ay,az,gesture\n0,1,1,x,0\n"])
def test_a_bad_csv_file_is_told_in_a_sentence(
    words: str, desk: GestureController, tmp_path: Path, told: list[Message]
) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(words, encoding="utf-8")

    Exchange(desk, None).import_from(path)
    Exchange(desk, None).import_from(tmp_path / "gone.csv")

    assert [one.kind for one in told] == ["error", "error"]
    assert not desk.recordings


def test_a_place_that_cannot_be_written_is_told(
    filled: GestureController, tmp_path: Path, told: list[Message]
) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")

    Exchange(filled, None).export_csv(tmp_path / "file" / "inside")
    Exchange(filled, None).export_mcap(tmp_path / "gone" / "mine.mcap")
    Exchange(filled, None).export_csv(tmp_path / "out")

    assert [one.kind for one in told] == ["error", "error", "success"]


@pytest.mark.parametrize("kept", ["bomb_zstd.mcap", "bomb_lz4.mcap", "bomb_lies.mcap"])
def test_an_mcap_file_that_unpacks_to_far_more_is_not_unpacked(kept: str) -> None:
    with pytest.raises(RecordingError, match="not a whole"):
        read_mcap(SEEDS / "mcap" / kept)


def test_an_mcap_file_with_more_samples_than_can_be_shown_is_refused(
    filled: GestureController, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_studio.ui.plugins.gestures.exchange.MAX_SAMPLES", 100, raising=False)
    write_mcap(tmp_path / "many.mcap", filled.gestures, filled.recordings)

    with pytest.raises(RecordingError, match="too large"):
        read_mcap(tmp_path / "many.mcap")


def test_a_huge_mcap_file_is_refused(
    tmp_path: Path, desk: GestureController, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_studio.ui.plugins.gestures.exchange.LARGEST_BYTES", 10)
    path = tmp_path / "huge.mcap"
    path.write_bytes(b"\0" * 11)

    with pytest.raises(RecordingError, match="too large"):
        read_mcap(path)
