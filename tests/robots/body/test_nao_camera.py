"""What the virtual NAO's cameras see, and the files of its pictures and videos."""

from __future__ import annotations

import math
import struct
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nao_stage import Stage

from robots.body import sense_tasks
from robots.body.camera import SIZE, Picture, frames_in, picture, safe_name, write_picture
from robots.body.driver import Thing

BALL = Thing(id="b", kind="ball", place=(0.7, 0.0, 0.3), size=(0.12, 0.12, 0.12))
WALL = Thing(id="w", kind="wall", place=(0.5, 0.0, 0.0), heading=math.pi, size=(2.0, 0.1, 2.0))
MARK = Thing(id="m", kind="mark", place=(0.7, 0.0, 0.0), heading=math.pi, size=(0.2, 0.02, 0.5))
CHILD = Thing(id="a", kind="person", place=(0.9, 0.0, 0.0), heading=math.pi, size=(0.3, 0.2, 0.7))
WIDTH, HEIGHT = SIZE


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("NEP_ROBOT_FILES", str(tmp_path))
    return tmp_path / "NAO"


@pytest.fixture
def at_leisure(monkeypatch: pytest.MonkeyPatch) -> None:
    """The robot has time for every frame, however fast the test lets it live."""
    monkeypatch.setattr(sense_tasks, "RESTING", 0.0)


def stage_with(*things: Thing) -> Stage:
    stage = Stage("StandInit")
    stage.driver.surroundings(things)
    return stage


def seen(*things: Thing, camera: int = 0) -> Picture:
    robot = stage_with(*things).robot
    return picture(robot, robot.body.cameras[camera])


def red(picture: Picture) -> np.ndarray:
    r, g, b = np.moveaxis(picture.astype(int), -1, 0)
    return (r > 100) & (g < r // 2) & (b < r // 2)


def read_png(content: bytes) -> tuple[list[tuple[bytes, bytes]], Picture]:
    """The chunks of a PNG file, and its (first) picture."""
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = [], 8
    while at < len(content):
        size, kind = struct.unpack_from(">I4s", content, at)
        body = content[at + 8 : at + 8 + size]
        assert struct.unpack_from(">I", content, at + 8 + size)[0] == zlib.crc32(kind + body)
        chunks.append((kind, body))
        at += size + 12
    width, height = struct.unpack_from(">2I", chunks[0][1])
    packed = b"".join(body for kind, body in chunks if kind == b"IDAT")
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    assert set(rows[:, 0]) == {2}  # each row is told by how it differs from the one above
    return chunks, np.cumsum(rows[:, 1:], axis=0, dtype=np.uint8).reshape(height, width, 3)


def test_a_ball_ahead_is_a_red_disc_in_the_middle_as_large_as_it_is_far() -> None:
    rows, columns = np.nonzero(red(seen(BALL)))

    assert columns.mean() == pytest.approx(WIDTH / 2, abs=2)
    eye_to_ball_m = math.dist((0.087, 0.504), (0.7, 0.36))
    wide = 0.12 / eye_to_ball_m / math.tan(math.radians(60.97 / 2)) * WIDTH / 2
    assert np.ptp(columns) + 1 == pytest.approx(wide, abs=3)
    assert np.ptp(rows) == pytest.approx(np.ptp(columns), abs=6)


def test_a_ball_to_the_left_is_on_the_left() -> None:
    left = Thing(id="b", kind="ball", place=(0.7, 0.2, 0.3), size=(0.12, 0.12, 0.12))

    assert np.nonzero(red(seen(left)))[1].mean() < WIDTH / 3


def test_a_ball_on_the_floor_is_seen_by_the_lower_camera_only() -> None:
    near = Thing(id="b", kind="ball", place=(0.35, 0.0, 0.0), size=(0.12, 0.12, 0.12))

    assert not red(seen(near)).any() and red(seen(near, camera=1)).any()


def test_a_turned_head_sees_elsewhere() -> None:
    stage = stage_with(BALL)

    stage.do("look", yaw_deg=60)

    assert not red(picture(stage.robot, stage.robot.body.cameras[0])).any()


def test_what_is_behind_a_wall_is_not_in_the_picture() -> None:
    assert not red(seen(BALL, WALL)).any() and not red(seen(WALL, BALL)).any()


def test_what_is_behind_the_robot_is_not_in_the_picture() -> None:
    behind = Thing(id="b", kind="ball", place=(-0.5, 0.0, 0.3), size=(0.12, 0.12, 0.12))

    assert np.array_equal(seen(behind), seen())


def test_an_empty_room_is_a_floor_with_lines_under_a_bluish_sky() -> None:
    empty = seen().astype(int)

    assert (empty[0, :, 2] > empty[0, :, 0] + 5).all()
    floor = empty[-60:].reshape(-1, 3)
    assert (floor[:, 0] >= floor[:, 2]).all() and np.ptp(floor[:, 0]) > 20


def test_a_mark_is_white_and_black_and_a_person_has_a_face_with_eyes() -> None:
    mark, child = seen(MARK).astype(int), seen(CHILD).astype(int)

    assert (mark.max(axis=-1) < 25).sum() > 50
    r, g, b = np.moveaxis(child, -1, 0)
    assert ((r > g + 20) & (g > b + 10)).sum() > 200
    assert (child.max(axis=-1) < 25).sum() > 10


def test_a_picture_takes_little_time() -> None:
    many = [
        Thing(id=str(i), kind=kind, place=(1.0 + i / 10, 0.3 * side, 0.0), heading=math.pi)
        for i, kind in enumerate(("person", "ball", "wall", "mark"))
        for side in (-1, 1)
    ]
    robot = stage_with(*many).robot
    took = []

    for _ in range(5):
        start_s = time.perf_counter()
        picture(robot, robot.body.cameras[0])
        took.append(time.perf_counter() - start_s)

    assert min(took) < 2.0


def test_a_picture_is_taken_into_a_file_of_the_robot(files: Path) -> None:
    stage = stage_with(BALL)

    result = stage.do("take_picture", file="me", camera="top")

    path = files / "pictures" / "me.png"
    assert (result.state, result.description) == ("done", f"NAO keeps it in {path}")
    assert np.array_equal(read_png(path.read_bytes())[1], seen(BALL))
    assert [one.name for one in path.parent.iterdir()] == ["me.png"]


def test_a_new_picture_replaces_an_older_one(files: Path) -> None:
    stage = stage_with()
    stage.do("take_picture", file="me")
    stage.driver.surroundings([BALL])

    stage.do("take_picture", file="me.jpg")

    (path,) = (files / "pictures").iterdir()
    assert red(read_png(path.read_bytes())[1]).any()


def test_a_video_has_five_frames_a_second_and_lasts_as_long_as_it_is_asked(
    files: Path, at_leisure: None
) -> None:
    stage = stage_with(BALL)
    stage.ask("1", "record_video", file="film", seconds=2)

    took_s = stage.finish()

    assert stage.told[-1] == "1 done" and took_s == pytest.approx(2.0, abs=0.1)
    path = files / "videos" / "film.png"
    chunks, first = read_png(path.read_bytes())
    assert red(first).any()
    frames = [struct.unpack(">5I2H2B", body) for kind, body in chunks if kind == b"fcTL"]
    assert len(frames) == frames_in(path) == 10
    assert sum(frame[5] / frame[6] for frame in frames) == pytest.approx(2.0, abs=0.01)
    later = [body[:4] for kind, body in chunks if kind == b"fdAT"]
    numbers = [frame[0] for frame in frames] + [int.from_bytes(one, "big") for one in later]
    assert sorted(numbers) == list(range(len(numbers)))


def test_a_video_shows_what_moves_meanwhile(files: Path, at_leisure: None) -> None:
    stage = stage_with()
    stage.ask("1", "record_video", file="film", seconds=3)
    stage.pass_time(0.5)
    stage.driver.surroundings([BALL])

    stage.finish()

    chunks, first = read_png((files / "videos" / "film.png").read_bytes())
    last = [body[4:] for kind, body in chunks if kind == b"fdAT"][-1]
    rows = np.frombuffer(zlib.decompress(last), np.uint8).reshape(HEIGHT, -1)[:, 1:]
    shown = np.cumsum(rows, axis=0, dtype=np.uint8).reshape(HEIGHT, WIDTH, 3)
    assert not red(first).any() and red(shown).any()


def test_a_stopped_video_keeps_what_it_has(files: Path) -> None:
    stage = stage_with(BALL)
    stage.ask("1", "record_video", file="film", seconds=600)
    stage.pass_time(1.0)

    stage.ask("2", "stop")
    stage.finish()

    chunks, _ = read_png((files / "videos" / "film.png").read_bytes())
    frames = [struct.unpack(">5I2H2B", body) for kind, body in chunks if kind == b"fcTL"]
    assert "1 cancelled" in stage.told
    assert sum(frame[5] / frame[6] for frame in frames) == pytest.approx(1.0, abs=0.1)


def test_it_walks_on_while_it_films() -> None:
    stage = stage_with()
    stage.ask("1", "record_video", file="film", seconds=4)
    stage.ask("2", "walk", forward_m=0.1)

    stage.finish()

    assert stage.told[-2:] == ["1 done", "2 done"] or stage.told[-2:] == ["2 done", "1 done"]
    assert stage.robot.base[0] == pytest.approx(0.1, abs=0.03)


@pytest.mark.parametrize("action", ["take_picture", "record_video"])
def test_a_place_that_cannot_be_written_to_is_told(action: str, files: Path) -> None:
    files.parent.mkdir(exist_ok=True)
    files.write_text("a file where a folder should be")
    more = {"seconds": 1} if action == "record_video" else {}

    result = stage_with().do(action, file="me", **more)

    assert result.state == "failed"
    assert result.description.startswith(f"NAO cannot keep me.png in {files}")
    assert result.description.endswith("Is there room on the disk, and may files be written there?")


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("me", "me"),
        ("me.PNG", "me"),
        ("v1.2", "v1.2"),
        ("../../etc/passwd", "passwd"),
        ("C:\\Windows\\me.jpg", "me"),
        ("..", "picture"),
        ("/", "picture"),
        ("  ", "picture"),
        ("a:b*c\n", "a_b_c"),
        ("con", "_con"),
        ("写真", "写真"),
    ],
)
def test_a_name_becomes_a_safe_file(name: str, file: str) -> None:
    assert safe_name(name, "picture") == file


@given(name=st.text(max_size=100))
def test_no_name_leaves_the_folder(name: str) -> None:
    file = safe_name(name, "picture")

    assert file and not set(file) & set('/\\:*?"<>|\0') and file not in (".", "..")
    assert not file.startswith(".") and len(file.encode()) <= 160


def test_nothing_is_left_of_a_picture_that_could_not_be_written(tmp_path: Path) -> None:
    (tmp_path / "me.png").mkdir()

    with pytest.raises(OSError):
        write_picture(tmp_path / "me.png", np.zeros((2, 2, 3), np.uint8))

    assert [one.name for one in tmp_path.iterdir()] == ["me.png"]
