"""``nep echo`` and ``nep hz``: every kind of message, names that are near, rates, losses."""

from __future__ import annotations

import threading
from collections.abc import Callable

import msgspec
import pytest

from nep_core.cli.console import seconds
from nep_core.cli.listen import Pace
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.recordings.raw import RawMessage
from nep_core.wire.frames import Encoding
from nep_core.wire.pubsub import Publisher
from tests.nep_core.cli.conftest import Answer, Call


@pytest.fixture
def echo(join: Callable[[str], PeerNetwork], call: Call) -> Callable[..., Answer]:
    """What ``nep echo /x`` shows of messages that are sent once it listens."""

    def run(*messages: object, options: str = "", encoding: Encoding | None = None) -> Answer:
        publisher = Publisher("/x", network=join("talker"), encoding=encoding)

        def talk() -> None:
            publisher.wait_for_subscribers(1, 10)
            for message in messages:
                publisher.send(message)  # type: ignore[arg-type]

        talker = threading.Thread(target=talk)
        talker.start()
        answer = call(f"nep echo /x --count {len(messages)} {options}")
        talker.join()
        return answer

    return run


@pytest.mark.parametrize("text", ["nan", "inf", "1e9", "-1", "soon"])
@pytest.mark.parametrize("command", ["echo", "hz"])
def test_a_time_that_nobody_can_wait_is_told(call: Call, command: str, text: str) -> None:
    answer = call(f"nep {command} /imu --seconds={text}")

    assert answer.code == 2
    assert f'"{text}" is not a number from 0 to 1000000' in answer.err


@pytest.mark.parametrize(("text", "time_s"), [("0", 0.0), ("0.5", 0.5), ("1e6", 1e6)])
def test_a_time_to_wait_is_a_number(text: str, time_s: float) -> None:
    assert seconds(text) == time_s


@pytest.mark.parametrize(
    ("message", "encoding", "shown"),
    [
        ({"a": [1, 2]}, None, '{"a":[1,2]}'),
        ("Grüße, 日本", None, "Grüße, 日本"),
        (b"\x89PNG" + bytes(40), None, "44 bytes: 89 50 4e 47" + " 00" * 28 + " ..."),
        ({"a": b"\x01"}, "msgpack", '{"a":"AQ=="}'),
        ({"a": 1.5, "ü": None}, "msgpack", '{"a":1.5,"ü":null}'),
        ("a text as JSON", "json", "a text as JSON"),
    ],
)
def test_every_kind_of_message_is_shown_readably(
    echo: Callable[..., Answer], message: object, encoding: Encoding | None, shown: str
) -> None:
    answer = echo(message, encoding=encoding)

    assert answer.out == f"{shown}\n"
    assert answer.code == 0


def test_one_field_is_shown_and_a_missing_one_is_told_once(echo: Callable[..., Answer]) -> None:
    answer = echo({"a": [{"b": 1}]}, {"a": []}, {"a": []}, options="--field a.0.b")

    assert answer.out == "1\n"
    assert answer.err.count("There is no field") == 1
    assert "a list of 0, counted from 0" in answer.err


def test_sender_time_and_many_lines_are_shown_when_wanted(echo: Callable[..., Answer]) -> None:
    answer = echo({"a": 1}, options="--times --pretty")

    assert answer.out.endswith(' talker  {\n  "a": 1\n}\n')


def test_a_machine_gets_the_header_too(echo: Callable[..., Answer]) -> None:
    answer = echo({"a": 1}, {"a": 2}, options="--json")

    first, second = map(msgspec.json.decode, answer.out.splitlines())
    assert second["message"] == {"a": 2}
    assert second["node"] == "talker"
    assert second["sequence"] == first["sequence"] + 1
    assert second["arrived_ns"] >= second["sent_ns"]


def test_only_one_sender_is_heard_when_asked_for(busy: PeerNetwork, call: Call) -> None:
    answer = call("nep echo /imu --sender nobody --seconds 0.2")

    assert (answer.code, answer.out) == (1, "")


def test_a_topic_that_nobody_publishes_is_waited_for_with_near_names(
    busy: PeerNetwork, call: Call
) -> None:
    answer = call("nep echo imuu --seconds 0")

    assert answer.code == 1
    assert "Nobody publishes imuu yet; it is waited for." in answer.err
    assert "Did you mean /imu?" in answer.err
    assert "Nothing came on imuu." in answer.err


def test_hz_tells_the_pace_to_people_and_to_machines(busy: PeerNetwork, call: Call) -> None:
    people = call("nep hz /imu --count 5")
    machines = call("nep hz /imu --count 5 --json")

    assert "messages a second   gaps" in people.out
    told = msgspec.json.decode(machines.out)
    assert told["messages"] == 5
    assert told["shortest_ms"] <= 1000 / told["rate_hz"] <= told["longest_ms"]


def test_a_pace_is_measured_from_the_gaps() -> None:
    pace = Pace()
    for at_ms in (0, 100, 300):
        pace.add(RawMessage("/x", "n", 1, 0, at_ms * 1_000_000, "bytes", bytes(30)))

    told = pace.measures(lost=2)

    assert told == {
        "messages": 3,
        "lost": 2,
        "rate_hz": 6.667,
        "shortest_ms": 100.0,
        "longest_ms": 200.0,
        "jitter_ms": 50.0,
        "bytes_s": 200,
    }


def test_a_pace_forgets_what_is_older_than_its_window() -> None:
    pace = Pace()
    for at_s in (0, 1, 20, 21):
        pace.add(RawMessage("/x", "n", 1, 0, at_s * 1_000_000_000, "bytes", b""))

    assert pace.measures(0)["messages"] == 2


def test_lost_messages_are_told(
    master: Master, join: Callable[[str], PeerNetwork], call: Call
) -> None:
    publisher = Publisher("/x", network=join("talker"))

    def talk() -> None:
        publisher.wait_for_subscribers(1, 10)
        way_out = publisher.network.outbox.stream("/x", None)
        for number in range(5):
            way_out.sent += 1 if number == 2 else 0  # as if one had found no room
            publisher.send({"n": number})

    talker = threading.Thread(target=talk)
    talker.start()
    answer = call("nep echo /x --count 5")
    talker.join()

    assert len(answer.out.splitlines()) == 5
    assert answer.err == "1 message lost.\n"
