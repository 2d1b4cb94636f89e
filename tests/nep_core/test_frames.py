"""Frames: what is sent is what is read, and rubbish is refused."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import BadMessage, NetworkError
from nep_core.networks.zmq_networks import DirectNetwork
from nep_core.wire.frames import (
    NUL,
    Header,
    check_topic,
    decoders,
    encode,
    join,
    natural_encoding,
    read_header,
    subscription,
)
from nep_core.wire.messages import HumanBehavior
from nep_core.wire.pubsub import Subscriber

pytestmark = pytest.mark.long

json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**53), 2**53)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)
messages = st.dictionaries(st.text(), json_values) | st.text() | st.binary()


def taken_apart(frame: bytes) -> tuple[Header, bytes]:
    """The header of a frame, and its payload or payloads."""
    _, head, payload = frame.split(NUL, 2)
    return read_header(head), payload


@given(messages)
def test_what_is_sent_is_what_is_read(message: object) -> None:
    encoding = natural_encoding(message)

    frame = join(subscription("/t"), "näme", 7, 15, encoding, encode(message, encoding))

    header, payload = taken_apart(frame)
    assert header == Header("näme", 7, 15, encoding)
    assert decoders(None)[encoding](payload) == message


@given(st.dictionaries(st.text(), json_values))
def test_msgpack_carries_the_same(message: dict[str, object]) -> None:
    assert decoders(None)["msgpack"](encode(message, "msgpack")) == message


@given(st.dictionaries(st.text(), json_values))
def test_json_holds_no_nul_so_that_messages_can_share_a_frame(message: dict[str, object]) -> None:
    assert NUL not in encode(message, "json")


@given(st.binary())
def test_any_header_is_read_or_refused(data: bytes) -> None:
    try:
        read_header(data)
    except BadMessage as error:
        assert str(error.sentence).endswith(".")


class Frames:
    """An inbox with these frames."""

    def __init__(self, *frames: bytes) -> None:
        self._frames = list(frames)

    def take(self, timeout_s: float | None) -> bytes | None:
        return self._frames.pop(0) if self._frames else None


@pytest.fixture(scope="module")
def subscriber() -> Iterator[Subscriber[object]]:
    with DirectNetwork("tcp://127.0.0.1:1", node="reader") as network:
        yield Subscriber("/t", network=network)


@given(frame=st.binary() | st.lists(st.binary()).map(NUL.join))
def test_a_subscriber_reads_or_skips_any_frame(
    subscriber: Subscriber[object], frame: bytes
) -> None:
    good = join(subscription("/t"), "n", 1, 0, "json", b'"the end"')
    subscriber._inbox = Frames(frame, good)  # type: ignore[assignment]

    received = [subscriber.receive() for _ in range(frame.count(NUL) + 2)]

    assert "the end" in received


@given(st.lists(st.dictionaries(st.text(), json_values), min_size=1, max_size=5))
def test_a_subscriber_reads_all_messages_of_a_frame(
    subscriber: Subscriber[object], several: list[dict[str, object]]
) -> None:
    payloads = NUL.join(encode(message, "json") for message in several)
    frame = join(subscription("/t"), "n", 1, 0, "json", payloads)
    subscriber._inbox = Frames(frame)  # type: ignore[assignment]

    assert subscriber.pending() == several


def test_a_topic_is_no_prefix_of_another() -> None:
    assert not subscription("/gesture_debug").startswith(subscription("/gesture"))


@pytest.mark.parametrize("topic", ["", "a\0b", "\ud800", "a\nb", "\x1b[2J", "a\x9b", "a\u2029b"])
def test_a_topic_that_cannot_travel_is_refused(topic: str) -> None:
    with pytest.raises(NetworkError):
        check_topic(topic)


def test_a_message_that_is_no_json_is_refused() -> None:
    with pytest.raises(BadMessage, match="cannot be sent as json"):
        encode({"x": object()}, "json")


def test_a_missing_key_is_named() -> None:
    with pytest.raises(msgspec.ValidationError, match="human_state"):
        decoders(HumanBehavior)["json"](b'{"certainty": 0.5}')
