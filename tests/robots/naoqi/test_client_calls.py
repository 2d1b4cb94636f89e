"""Calls of our client at our server, over loopback."""

import threading

import pytest
from naoqi_lamp import Lamp, until

from robots.naoqi.client.session import Session
from robots.naoqi.server.server import Server
from robots.naoqi.wire.errors import (
    CallCancelled,
    CallFailed,
    ConnectionLost,
    NaoqiError,
    NoAnswer,
    NoSuchMethod,
    NoSuchService,
    WrongArguments,
)
from robots.naoqi.wire.remote import RemoteObject


def test_overloads_are_told_apart(lamp_remote: RemoteObject) -> None:
    answers = [
        lamp_remote.call("say", "a"),
        lamp_remote.call("say", "a", "b"),
        lamp_remote.call("say", "a", {}),
    ]

    assert answers == ["s a", "ss a b", "s{sm} a []"]


def test_the_methods_of_a_service_are_learnt_from_it(lamp_remote: RemoteObject) -> None:
    assert {str(it) for it in lamp_remote.methods["say"]} == {
        "say::(s)",
        "say::(ss)",
        "say::(s{sm})",
    }
    assert lamp_remote.methods["goToPosture"][0].returns == "b"


def test_joints_are_set_and_read(lamp_remote: RemoteObject, lamp: Lamp) -> None:
    lamp_remote.call("setAngles", ["HeadYaw", "HeadPitch"], [0.5, 0.25], 0.125)

    assert lamp.angles == (["HeadYaw", "HeadPitch"], [0.5, 0.25], 0.125)
    assert lamp_remote.call("getAngles", ["HeadYaw", "HeadPitch"], True) == [0.25, 0.25]


def test_structures_maps_and_raw_bytes_go_both_ways(lamp_remote: RemoteObject) -> None:
    assert lamp_remote.call("pair", (1, "a")) == (2, "a!")
    assert lamp_remote.call("pair", {"number": 1, "word": "a"}).word == "a!"
    assert lamp_remote.call("counts", {"a": [1.0, 2.0]}) == {"a": [1, 2]}
    assert lamp_remote.call("raw", b"abc") == b"cba"


def test_a_call_that_takes_its_time_does_not_hold_up_another(lamp_remote: RemoteObject) -> None:
    slow = lamp_remote.begin("waits", 0.3)

    assert lamp_remote.call("say", "a") == "s a"
    assert not slow.done
    assert slow.result(2.0) == 7


def test_two_hundred_posture_calls_wait_at_once_without_threads(
    lamp_remote: RemoteObject, lamp: Lamp
) -> None:
    going = [lamp_remote.begin("goToPosture", "Sit", 0.5) for _ in range(200)]
    until(lambda: len(lamp.going) == 200)
    before = threading.active_count()

    for promise in lamp.going:
        promise.set(True)

    assert all(it.result(2.0) for it in going)
    assert before < 40


def test_a_call_is_cancelled(lamp_remote: RemoteObject, lamp: Lamp) -> None:
    going = lamp_remote.begin("goToPosture", "Sit", 0.5)

    going.cancel()

    with pytest.raises(CallCancelled):
        going.result(2.0)
    assert lamp.going[0].is_cancelled


def test_a_cancel_after_the_end_changes_nothing(lamp_remote: RemoteObject) -> None:
    going = lamp_remote.begin("goToPosture", "Now", 0.5)
    assert going.result(2.0) is True

    going.cancel()

    assert going.result(0.0) is True


def test_whoever_waits_for_a_call_is_told_in_a_thread_that_may_call_again(
    lamp_remote: RemoteObject,
) -> None:
    answers: list[object] = []
    going = lamp_remote.begin("goToPosture", "Now", 0.5)

    going.on_done = lambda done: answers.append((done.value, lamp_remote.call("say", "again")))

    until(lambda: answers)
    assert answers == [(True, "s again")]


def test_whoever_waits_for_a_call_is_told_too_when_the_robot_is_gone(
    lamp_serving: tuple[Lamp, Server], lamp_remote: RemoteObject
) -> None:
    ends: list[object] = []
    for _ in range(5):
        going = lamp_remote.begin("goToPosture", "Sit", 0.5)
        going.when_done(lambda done: ends.append(type(done.failure)))

    lamp_serving[1].stop()

    until(lambda: ends == [ConnectionLost] * 5)


def test_a_call_without_an_answer_in_time_says_so(lamp_remote: RemoteObject) -> None:
    with pytest.raises(NoAnswer, match=r"goToPosture within 0\.1 s"):
        lamp_remote.call("goToPosture", "Sit", 0.5, timeout_s=0.1)


def test_a_failure_is_told_in_the_words_of_the_service(lamp_remote: RemoteObject) -> None:
    with pytest.raises(CallFailed, match=r"^The lamp is too hot\.$"):
        lamp_remote.call("fails")


def test_a_fault_of_a_service_does_not_end_the_connection(lamp_remote: RemoteObject) -> None:
    with pytest.raises(CallFailed, match="inner"):
        lamp_remote.call("breaks")

    assert lamp_remote.call("say", "a") == "s a"


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (("nothing",), NoSuchMethod),
        (("say",), WrongArguments),
        (("say", 1, 2, 3), WrongArguments),
        (("getAngles", "Body", "yes"), WrongArguments),
        (("echo", object()), WrongArguments),
    ],
)
def test_a_wrong_call_is_refused_before_it_is_sent(
    lamp_remote: RemoteObject, call: tuple, error: type[NaoqiError]
) -> None:
    with pytest.raises(error):
        lamp_remote.call(*call)


def test_a_service_that_is_not_there_is_named(lamp_session: Session) -> None:
    with pytest.raises(NoSuchService, match="NAO has no service ALTracker"):
        lamp_session.service("ALTracker")


def test_every_module_has_what_old_programs_expect(lamp_remote: RemoteObject) -> None:
    task = lamp_remote.call("pCall", ["goToPosture", "Sit", 0.5])

    assert lamp_remote.call("ping") and lamp_remote.call("version").startswith("2.")
    assert lamp_remote.call("isRunning", task)
    assert lamp_remote.call("wait", task, 50)  # NAOqi's wait is True when the task still runs
    lamp_remote.call("stop", task)
    until(lambda: not lamp_remote.call("isRunning", task))
    assert "goToPosture" in lamp_remote.call("getMethodList")
    assert lamp_remote.call("getMethodHelp", "say")[0] == "say"


def test_the_numbers_of_a_module_are_those_of_the_robot(lamp_remote: RemoteObject) -> None:
    uids = {
        name: lamp_remote.methods[name][0].uid for name in ("exit", "version", "ping", "getUsage")
    }

    assert uids == {"exit": 100, "version": 103, "ping": 104, "getUsage": 112}
