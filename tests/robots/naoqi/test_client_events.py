"""Events, properties and objects between our client and our server."""

import gc
from typing import Any

import pytest
from naoqi_lamp import CallingLamp, Lamp, until

from robots.naoqi.client.session import Session
from robots.naoqi.server.server import Server
from robots.naoqi.wire.errors import CallCancelled, CallFailed, NoSuchMethod, NoSuchService
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.remote import RemoteObject
from robots.naoqi.wire.service import method, signal


def test_events_of_an_object_arrive_in_their_order_until_they_end(
    lamp_remote: RemoteObject, lamp: Lamp
) -> None:
    got: list[object] = []
    end = lamp_remote.call("subscriber", "Touch").connect("signal", got.append)
    gc.collect()  # listening keeps the object

    for number in range(50):
        lamp_remote.call("raiseEvent", "Touch", number)
    until(lambda: len(got) == 50)
    end()
    lamp_remote.call("raiseEvent", "Touch", "late")
    lamp_remote.call("say", "a")

    assert got == list(range(50))
    until(lambda: not lamp.subscribers["Touch"].signal.is_heard)


def test_two_listeners_hear_each_event_once(lamp_remote: RemoteObject) -> None:
    first: list[object] = []
    second: list[object] = []
    end_first = lamp_remote.connect("touched", first.append)
    lamp_remote.connect("touched", second.append)

    lamp_remote.call("raiseEvent", "a", 1)
    until(lambda: first and second)
    end_first()
    lamp_remote.call("raiseEvent", "a", 2)
    until(lambda: len(second) == 2)

    assert (first, second) == ([["a", 1]], [["a", 1], ["a", 2]])


def test_a_listener_may_call_the_robot(lamp_remote: RemoteObject) -> None:
    answers: list[object] = []
    lamp_remote.connect("touched", lambda _: answers.append(lamp_remote.call("say", "heard")))

    lamp_remote.call("raiseEvent", "a", 1)

    until(lambda: answers == ["s heard"])


def test_a_listener_that_fails_does_not_deafen_the_others(lamp_remote: RemoteObject) -> None:
    got: list[object] = []
    lamp_remote.connect("touched", lambda: got.append("takes nothing"))
    lamp_remote.connect("touched", got.append)

    lamp_remote.call("raiseEvent", "a", 1)

    until(lambda: got == [["a", 1]])


def test_a_client_emits_a_signal_of_the_robot(lamp_remote: RemoteObject, lamp: Lamp) -> None:
    got: list[object] = []
    lamp.touched.listen(got.append)

    lamp_remote.post("touched", "by hand")

    until(lambda: got == ["by hand"])


def test_a_property_is_read_changed_and_heard(lamp_remote: RemoteObject, lamp: Lamp) -> None:
    got: list[object] = []
    lamp_remote.connect("level", got.append)

    lamp_remote.set_property("level", 0.75)

    until(lambda: got == [0.75])
    assert (lamp_remote.property("level"), lamp.level, lamp_remote.properties()) == (
        0.75,
        0.75,
        ["level"],
    )


def test_an_object_that_nobody_uses_is_let_go(
    lamp_remote: RemoteObject, lamp_serving: tuple[CallingLamp, Server]
) -> None:
    subscriber: RemoteObject | None = lamp_remote.call("subscriber", "Touch")
    [peer] = lamp_serving[1]._peers
    assert len(peer.objects) == 1 and subscriber is not None

    subscriber = None
    gc.collect()
    lamp_remote.call("say", "a")

    assert not peer.objects


class Counter:
    finished = signal("finished::(i)")

    @method("count::i(i)")
    def count(self, number: int) -> int:
        return number + 1


def test_the_robot_calls_an_object_of_the_client(lamp_remote: RemoteObject) -> None:
    assert lamp_remote.call("asks", Counter()) == 42


class Caller:
    rang = signal("rang::(i)")

    def __init__(self) -> None:
        self.got: list[tuple[object, ...]] = []

    @method("called::v(sms)")
    def called(self, *values: object) -> None:
        self.got.append(values)

    @method("double::i(i)")
    def double(self, number: int) -> int:
        return 2 * number

    @method("goes::b()")
    def goes(self) -> Any:
        self.promise = Promise()
        self.promise.on_cancel = self.promise.cancelled
        return self.promise.future


def test_the_robot_calls_a_service_of_the_client_back(
    lamp_session: Session, lamp_remote: RemoteObject
) -> None:
    caller = Caller()
    lamp_session.register("Caller", caller)

    assert lamp_remote.call("callBack", "Caller")

    until(lambda: caller.got == [("key", 1.5, "message")])


class Late(dict[int, Any]):
    """The services of a client that, as libqi's, are not there for the first who asks."""

    asked = 0

    def get(self, number: int, default: Any = None) -> Any:
        self.asked += 1
        return default if self.asked == 1 else super().get(number, default)


def test_a_client_whose_service_answers_a_moment_late_is_called_back_all_the_same(
    lamp_session: Session, lamp_remote: RemoteObject, monkeypatch: pytest.MonkeyPatch
) -> None:
    own, caller = Late(), Caller()
    monkeypatch.setattr(lamp_session, "_own", own)
    lamp_session.register("Caller", caller)
    until(lambda: own.asked == 1)

    assert lamp_remote.call("callBack", "Caller")

    until(lambda: caller.got == [("key", 1.5, "message")])


def test_a_client_uses_the_service_of_another_through_the_robot(
    lamp_session: Session, lamp_serving: tuple[CallingLamp, Server]
) -> None:
    caller = Caller()
    lamp_session.register("Caller", caller)
    other = Session(("127.0.0.1", lamp_serving[1].port))
    other.connect()
    lamp_remote = other.service("Caller")

    assert lamp_remote.call("double", 21) == 42
    going = lamp_remote.begin("goes")
    until(lambda: hasattr(caller, "promise"))
    going.cancel()
    with pytest.raises(CallCancelled):
        going.result(2.0)
    with pytest.raises(NoSuchMethod):
        lamp_remote.call("treble", 1)
    other.close()


def test_clients_hear_the_events_of_another_through_the_robot(
    lamp_session: Session, lamp_serving: tuple[CallingLamp, Server]
) -> None:
    caller = Caller()
    lamp_session.register("Caller", caller)
    others = [Session(("127.0.0.1", lamp_serving[1].port)) for _ in range(2)]
    got: list[list[object]] = [[], []]
    for other, heard in zip(others, got, strict=True):
        other.connect()
        other.service("Caller").connect("rang", heard.append)

    caller.rang.emit(1)
    until(lambda: got == [[1], [1]])
    others[0].close()
    until(lambda: lamp_serving[1].clients == 2)
    caller.rang.emit(2)
    until(lambda: got[1] == [1, 2])
    others[1].close()

    until(lambda: not caller.rang.is_heard)
    assert got == [[1], [1, 2]]


def test_services_of_a_client_come_and_go_with_it(
    lamp_session: Session, lamp_serving: tuple[CallingLamp, Server]
) -> None:
    news: list[tuple[str, str]] = []
    lamp_session.on_service(
        lambda _, name: news.append(("added", name)), lambda _, name: news.append(("gone", name))
    )
    other = Session(("127.0.0.1", lamp_serving[1].port))
    other.connect()
    number = other.register("Caller", Caller())
    other.unregister(number)
    other.register("Second", Caller())
    assert lamp_session.services() == ["ServiceDirectory", "Lamp", "Second"]

    other.close()

    until(lambda: len(news) == 4)
    assert news == [
        ("added", "Caller"),
        ("gone", "Caller"),
        ("added", "Second"),
        ("gone", "Second"),
    ]
    assert lamp_session.services() == ["ServiceDirectory", "Lamp"]


def test_a_service_that_was_taken_away_and_given_again_is_found_anew(
    lamp_session: Session, lamp_serving: tuple[CallingLamp, Server]
) -> None:
    server = lamp_serving[1]
    server.register("Caller", Caller())
    assert lamp_session.service("Caller").call("double", 1) == 2

    server.unregister("Caller")
    until(lambda: "Caller" not in lamp_session._services)
    with pytest.raises(NoSuchService):
        lamp_session.service("Caller")
    server.register("Caller", Caller())

    assert lamp_session.service("Caller").call("double", 2) == 4


def test_a_name_is_given_once(lamp_session: Session) -> None:
    with pytest.raises(CallFailed, match="already registered"):
        lamp_session.register("Lamp", Caller())
