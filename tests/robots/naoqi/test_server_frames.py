"""Frame by frame: what our server answers to a client that knows nothing of our code."""

import socket
from collections.abc import Iterator
from typing import Any

import pytest
from naoqi_lamp import CallingLamp, lamp_server

from robots.naoqi.server.server import Server
from robots.naoqi.wire.codec import decode, encode
from robots.naoqi.wire.line import Frame, FrameReader, Kind, Login
from robots.naoqi.wire.service import description_of

LAMP = 2
UIDS = {str(it): uid for uid, it in description_of(CallingLamp).meta.methods.items()}


class Talk:
    """A bare connection."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), 3.0)
        self._reader = FrameReader()
        self._got: list[Frame] = []

    def say(self, kind: Kind, service: int, uid: int, payload: bytes = b"", flags: int = 0) -> None:
        number = 0 if service == 0 else 1
        self._socket.sendall(Frame(kind, 7, service, number, uid, payload, flags).encoded())

    def hear(self) -> Frame | None:
        """Return the next frame, None at the end of the connection."""
        while not self._got:
            data = self._socket.recv(65536)
            if not data:
                return None
            self._got += self._reader.take(data)
        return self._got.pop(0)

    def answer(self, *said: Any, **more: Any) -> tuple[int, int, bytes]:
        """Say something that is answered."""
        self.say(*said, **more)
        frame = self.hear()
        assert frame is not None and frame.number == 7
        return frame.kind, frame.flags, frame.payload

    def close(self) -> None:
        self._socket.close()


@pytest.fixture
def talk(lamp_serving: tuple[CallingLamp, Server]) -> Iterator[Talk]:
    talk = Talk(lamp_serving[1].port)
    kind, _, payload = talk.answer(Kind.CALL, 0, 8, encode("{sm}", {"MessageFlags": True}))
    assert kind == Kind.REPLY
    assert decode("{sm}", payload)["__qi_auth_state"] == 3
    yield talk
    talk.close()


def test_a_call_is_answered_with_its_own_number(talk: Talk) -> None:
    answer = talk.answer(Kind.CALL, LAMP, UIDS["say::(s)"], encode("(s)", ("a",)))

    assert answer == (Kind.REPLY, 0, encode("s", "s a"))


def test_values_may_come_as_one_dynamic_value(talk: Talk) -> None:
    payload = encode("m", ("a",))

    answer = talk.answer(Kind.CALL, LAMP, UIDS["say::(s)"], payload, flags=1)

    assert answer == (Kind.REPLY, 0, encode("s", "s a"))


def test_a_caller_that_wants_another_type_gets_a_dynamic_value(talk: Talk) -> None:
    payload = encode("(s)", ("a",)) + encode("s", "m")

    answer = talk.answer(Kind.CALL, LAMP, UIDS["say::(s)"], payload, flags=2)

    assert answer == (Kind.REPLY, 1, encode("m", "s a"))


@pytest.mark.parametrize(
    ("service", "uid", "payload", "text"),
    [
        (99, 100, b"", "can't find service, address: {99.1.100, id:7}"),
        (LAMP, 999, b"", "No such method {2.1.999, id:7}"),
        (LAMP, UIDS["say::(s)"], b"\x05", "A message ends within a value."),
        (1, 100, encode("(s)", ("Nobody",)), "Cannot find service 'Nobody' in index"),
        (LAMP, 0, encode("(IIL)", (1, 999, 1)), "No such signal"),
        (LAMP, 1, encode("(IIL)", (1, 999, 1)), "Unregister request failed for 1 1"),
        (LAMP, 5, encode("(m)", ("nothing",)), "Unknown property: nothing"),
        (LAMP, 6, encode("(mm)", ("level", "high")), None),
        (1, 104, encode("(I)", (5,)), "Can't find pending service #5"),
        (1, 103, encode("(I)", (LAMP,)), "Unregister Service: Can't find service #2"),
    ],
)
def test_a_wrong_call_is_answered_with_why(
    talk: Talk, service: int, uid: int, payload: bytes, text: str | None
) -> None:
    kind, _, answer = talk.answer(Kind.CALL, service, uid, payload)

    assert kind == Kind.ERROR
    assert text in (None, decode("m", answer))


def test_what_is_posted_is_done_and_never_answered(talk: Talk, lamp: CallingLamp) -> None:
    talk.say(Kind.POST, LAMP, UIDS["say::(s)"], encode("(s)", ("posted",)))
    talk.say(Kind.POST, LAMP, UIDS["fails::()"])

    assert talk.answer(Kind.CALL, LAMP, UIDS["ping::()"])[0] == Kind.REPLY
    assert lamp.said == ["posted"]


def test_who_must_log_in_and_does_not_hears_nothing_more() -> None:
    with lamp_server(login=Login("nao", "secret")) as (lamp, server):
        talk = Talk(server.port)

        kind, _, text = talk.answer(Kind.CALL, LAMP, UIDS["say::(s)"], encode("(s)", ("a",)))

        assert (kind, decode("m", text)) == (Kind.ERROR, "Expected authentication.")
        assert talk.hear() is None
        talk.close()
        assert lamp.said == []


def test_who_does_not_authenticate_is_told_what_the_server_can_do_first() -> None:
    with lamp_server() as (_, server):
        talk = Talk(server.port)
        talk.say(Kind.CALL, LAMP, UIDS["ping::()"])

        first, second = talk.hear(), talk.hear()

        assert first is not None and first.kind == Kind.CAPABILITY
        assert decode("{sm}", first.payload)["RemoteCancelableCalls"] is True
        assert second is not None and second.payload == encode("b", True)
        talk.close()


def test_a_robot_of_2013_does_not_know_how_to_authenticate() -> None:
    with lamp_server(knows_authenticate=False) as (_, server):
        talk = Talk(server.port)

        kind, _, text = talk.answer(Kind.CALL, 0, 8, encode("{sm}", {}))

        assert kind == Kind.ERROR
        assert decode("m", text).startswith("can't find service")
        talk.close()
