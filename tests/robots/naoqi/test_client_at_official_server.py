"""Our client at a server of the official package."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from naoqi_lamp import child, needs_oracle, until

from robots.naoqi.client.session import Session
from robots.naoqi.wire.errors import (
    CallCancelled,
    CallFailed,
    ConnectionLost,
    NoSuchMethod,
    NoSuchService,
    NoTls,
    WrongArguments,
)
from robots.naoqi.wire.line import Login
from robots.naoqi.wire.remote import RemoteObject
from robots.naoqi.wire.service import method

pytestmark = needs_oracle


@pytest.fixture(scope="module")
def official() -> Iterator[tuple[Any, int]]:
    with child("naoqi_oracle_server.py") as running:
        yield running


@pytest.fixture
def session(official: tuple[Any, int]) -> Iterator[Session]:
    session = Session(("127.0.0.1", official[1]))
    session.connect()
    yield session
    session.close()


@pytest.fixture
def there(session: Session) -> RemoteObject:
    return session.service("Lamp")


def test_overloads_lists_and_maps_arrive(there: RemoteObject) -> None:
    said = [there.call("say", *values) for values in (("a",), ("a", "b"), ("a", {"speed": 90}))]
    there.call("setAngles", ["HeadYaw", "HeadPitch"], [0.5, -0.25], 0.125)

    assert said == ["s a", "ss a b", "s{sm} a ['speed']"]
    assert there.call("getAngles", "Body", True) == [0.25] * 26
    assert there.call("lastAngles") == (["HeadYaw", "HeadPitch"], [0.5, -0.25], 0.125)
    assert there.call("counts", {"a": [1.0, 2.0]}) == {"a": [1, 2]}


@pytest.mark.parametrize(
    "value",
    [True, -3, 2**40, 0.1, "é", [], [1, "a", [2.5]], {"a": [1], "b": None}, None, (1, "a")],
)
def test_a_dynamic_value_comes_back_as_it_was(there: RemoteObject, value: object) -> None:
    assert there.call("echo", value) == value


def test_failures_are_told_without_the_traceback_of_the_other_program(there: RemoteObject) -> None:
    with pytest.raises(CallFailed, match=r"^RuntimeError: The lamp is too hot\.$") as caught:
        there.call("fails")

    assert "At:" in caught.value.details


def test_what_is_not_there_is_named(session: Session, there: RemoteObject) -> None:
    with pytest.raises(NoSuchService):
        session.service("Nobody")
    with pytest.raises(NoSuchMethod):
        there.call("nothing")
    with pytest.raises(WrongArguments):
        there.call("say", 1, 2, 3)


def test_a_call_is_cancelled(there: RemoteObject) -> None:
    going = there.begin("goToPosture", "Sit", 0.5)
    there.call("say", "it has begun")

    going.cancel()

    with pytest.raises(CallCancelled):
        going.result(2.0)
    assert there.call("goToPosture", "Now", 0.5) is True


def test_events_of_a_returned_object_are_heard_until_they_end(there: RemoteObject) -> None:
    got: list[object] = []
    subscriber = there.call("subscriber", "Touch")
    end = subscriber.connect("signal", got.append)

    there.call("raiseEvent", "Touch", [1, "a"])
    there.call("raiseEvent", "Touch", 2)
    subscriber.post("signal", "mine")
    until(lambda: len(got) == 3)
    end()
    there.call("raiseEvent", "Touch", "late")
    there.call("say", "a")

    assert got == [[1, "a"], 2, "mine"]


def test_a_property_is_read_changed_and_heard(there: RemoteObject) -> None:
    got: list[object] = []
    there.connect("level", got.append)

    there.set_property("level", 0.75)

    until(lambda: got == [0.75])
    assert there.property("level") == 0.75
    assert there.properties() == ["level"]


class Counter:
    @method("count::i(i)")
    def count(self, number: int) -> int:
        return number + 1


class Caller:
    def __init__(self) -> None:
        self.got: list[tuple[object, ...]] = []

    @method("called::v(sms)")
    def called(self, *values: object) -> None:
        self.got.append(values)


def test_the_server_calls_an_object_of_ours(there: RemoteObject) -> None:
    assert there.call("asks", Counter()) == 42


def test_the_server_calls_a_service_of_ours_back(session: Session, there: RemoteObject) -> None:
    caller = Caller()
    number = session.register("Caller", caller)

    assert there.call("callBack", "Caller")
    assert "Caller" in session.services()
    session.unregister(number)

    assert caller.got == [("key", 1.5, "message")]
    assert "Caller" not in session.services()


def test_a_login_that_nobody_asked_for_does_no_harm(official: tuple[Any, int]) -> None:
    session = Session(("127.0.0.1", official[1]), login=Login("nao", "nao"))

    session.connect()

    assert session.service("Lamp").call("say", "a") == "s a"
    session.close()


def test_encryption_that_is_not_there_is_said_to_be_missing(official: tuple[Any, int]) -> None:
    with pytest.raises(NoTls):
        Session(("127.0.0.1", official[1]), tls=True).connect()


def test_a_killed_server_is_noticed_at_once() -> None:
    lost = threading.Event()
    with child("naoqi_oracle_server.py") as (process, port):
        session = Session(("127.0.0.1", port))
        session.on_lost = lambda _: lost.set()
        session.connect()
        going = session.service("Lamp").begin("goToPosture", "Sit", 0.5)

        process.kill()

        with pytest.raises(ConnectionLost):
            going.result(2.0)
        assert lost.wait(2.0)
