"""What one program may ask for at once: who asks for more is told why, and nobody else waits."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator

import pytest
from naoqi_lamp import lamp_server
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.client.session import Session
from robots.naoqi.server import server as serving
from robots.naoqi.services.memory import MOST_KEYS
from robots.naoqi.serving import MOST_WAITING
from robots.naoqi.wire.codec import Reader, encode, read_value, reader_of
from robots.naoqi.wire.errors import CallFailed, NoRoom
from robots.naoqi.wire.line import AUTHENTICATE, Frame, FrameReader, Kind

pytestmark = pytest.mark.long


def test_moves_that_wait_are_counted_and_end_at_once(real_time: NaoqiTheatre) -> None:
    motion = real_time.service("ALMotion")
    nod = ("angleInterpolation", ["HeadPitch"], [[0.1]], [[1.0]], True)
    moves = [motion.begin(*nod) for _ in range(MOST_WAITING + 10)]
    real_time.until(lambda: moves[-1].done, 60.0)

    with pytest.raises(CallFailed) as refused:
        moves[-1].result(0.0)
    start_s = time.monotonic()
    motion.call("killAll")
    killed_s = time.monotonic() - start_s

    assert "killAll" in str(refused.value.sentence) and str(MOST_WAITING) in str(refused.value)
    assert killed_s < 2.0  # 0.04 s on a quiet computer
    real_time.until(lambda: all(move.done for move in moves))
    assert motion.call("getTaskList") == []
    assert motion.begin("angleInterpolation", ["HeadPitch"], [[0.0]], [[0.3]], True).wait(20.0)


def test_walks_that_go_elsewhere_and_waits_for_their_end_are_counted_too(
    real_time: NaoqiTheatre, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robots.naoqi.serving.MOST_WAITING", 200)
    motion = real_time.service("ALMotion")
    first = motion.begin("moveTo", 0.5, 0.0, 0.0)
    real_time.until(lambda: real_time.state().base[0] > 0.02)
    used_s = time.process_time()
    more = [motion.begin("moveTo", 0.3 + 1e-4 * number, 0.0, 0.0) for number in range(150)]
    more += [motion.begin("waitUntilMoveIsFinished") for _ in range(100)]
    real_time.until(lambda: more[-1].done, 60.0)
    used_s = time.process_time() - used_s

    with pytest.raises(CallFailed, match="200 requests wait already"):
        more[-1].result(0.0)
    motion.call("stopMove")
    real_time.until(lambda: all(one.done for one in (first, *more)))
    assert used_s < 3.0  # 0.3 s; 9 s when the steps of each walk were planned


def test_memory_has_room_for_so_many_names_of_programs(theatre: NaoqiTheatre) -> None:
    memory = theatre.service("ALMemory")
    memory.call("insertListData", [[f"mine/{number}", number] for number in range(MOST_KEYS)])

    for call in (
        ("insertData", "one more", 1),
        ("raiseEvent", "one more", 1),
        ("raiseMicroEvent", "one more", 1),
        ("declareEvent", "one more"),
        ("subscriber", "one more"),
        ("subscribeToEvent", "one more", "Me", "called"),
    ):
        with pytest.raises(CallFailed, match=r"has no room for “one more”.*removeData"):
            memory.call(*call)

    memory.call("insertData", "mine/7", "changed")
    memory.call("removeData", "mine/8")
    memory.call("insertData", "one more", 1)
    assert memory.call("getData", "mine/7") == "changed"
    theatre.feel("head_front")  # what the robot tells by itself is told as before
    theatre.until(lambda: memory.call("getData", "FrontTactilTouched") == 1.0)


def test_events_that_come_and_go_use_up_no_room(theatre: NaoqiTheatre) -> None:
    memory = theatre.offered._services.memory

    for number in range(MOST_KEYS + 100):
        memory.raise_event(f"passing/{number}", number)
        memory.remove_event(f"passing/{number}")

    memory.insert_data("one more", 1)
    assert len(memory._times) < 1000


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, int]]:
    """A robot that serves two programs."""
    monkeypatch.setattr(serving, "MOST_CLIENTS", 2)
    with lamp_server() as (_, server):
        yield "127.0.0.1", server.port


def test_a_program_too_many_is_told_why(few: tuple[str, int]) -> None:
    inside = [Session(few), Session(few)]
    for session in inside:
        session.connect()
    outside = Session(few)

    with pytest.raises(NoRoom) as told:
        outside.connect()

    assert "2 are connected" in told.value.details and told.value.checklist
    inside.pop().close()
    end_s = time.monotonic() + 20.0
    while not outside.is_connected:
        assert time.monotonic() < end_s
        try:
            outside.connect()
        except NoRoom:
            time.sleep(0.05)
    for session in (*inside, outside):
        session.close()


@pytest.mark.parametrize("is_let_in", [True, False])
def test_the_answer_to_its_first_wish_is_an_error_and_then_the_end(
    few: tuple[str, int], is_let_in: bool
) -> None:
    held = [socket.create_connection(few) for _ in range(2)]
    time.sleep(0.3)
    let_in = Frame(Kind.CALL, 6, 0, 0, AUTHENTICATE, encode("{sm}", {}))
    wish = Frame(Kind.CALL, 7, 1, 1, 100, encode("(s)", ("Lamp",)))

    with socket.create_connection(few, timeout=10.0) as outside:
        outside.sendall((let_in.encoded() if is_let_in else b"") + wish.encoded())
        data = b""
        while part := outside.recv(4096):
            data += part

    *first, answer = FrameReader().take(data)
    assert [one.kind for one in first] == [Kind.REPLY] * is_let_in
    assert (answer.kind, answer.number) == (Kind.ERROR, 7)
    said = read_value(reader_of("m"), Reader(answer.payload))
    assert said.startswith("There is no room for another program")
    for one in held:
        one.close()
