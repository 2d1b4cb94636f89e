"""Frames: what is sent is what is read, and rubbish is refused."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import BadMessage, NetworkError
from nep_core.frames import (
    check_topic,
    decoders,
    encode,
    frame_start,
    join,
    natural_encoding,
    read_header,
    split,
    subscription,
)
from nep_core.messages import HumanBehavior

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


@given(messages)
def test_what_is_sent_is_what_is_read(message: object) -> None:
    encoding = natural_encoding(message)

    head, payloads = split(
        join(frame_start("/t", "näme"), 7, 15, encoding.encode(), encode(message, encoding))
    )

    header = read_header(head)
    assert header.node == "näme"
    assert header.sequence == 7
    assert header.time_ns == 15
    assert [decoders(None)[encoding](payload) for payload in payloads] == [message]


@given(st.dictionaries(st.text(), json_values))
def test_msgpack_carries_the_same(message: dict[str, object]) -> None:
    payload = encode(message, "msgpack")

    _, payloads = split(join(frame_start("/t", "n"), 1, 0, b"msgpack", payload))

    assert decoders(None)["msgpack"](payloads[0]) == message


@given(st.lists(st.dictionaries(st.text(), json_values), min_size=1, max_size=20))
def test_several_json_messages_share_a_frame(several: list[dict[str, object]]) -> None:
    encoded = [encode(message, "json") for message in several]

    _, payloads = split(join(frame_start("/t", "n"), 1, 0, b"json", b"\0".join(encoded)))

    assert [decoders(None)["json"](payload) for payload in payloads] == several


@given(st.binary())
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    try:
        read_header(split(data)[0])
    except BadMessage as error:
        assert error.sentence.endswith(".")


def test_a_topic_is_no_prefix_of_another() -> None:
    assert not subscription("/gesture_debug").startswith(subscription("/gesture"))


@pytest.mark.parametrize("topic", ["", "a\0b", "\ud800"])
def test_a_topic_that_cannot_travel_is_refused(topic: str) -> None:
    with pytest.raises(NetworkError):
        check_topic(topic)


def test_a_message_that_is_no_json_is_refused() -> None:
    with pytest.raises(BadMessage, match="cannot be sent as json"):
        encode({"x": object()}, "json")


def test_a_missing_key_is_named() -> None:
    with pytest.raises(msgspec.ValidationError, match="human_state"):
        decoders(HumanBehavior)["json"](b'{"certainty": 0.5}')
