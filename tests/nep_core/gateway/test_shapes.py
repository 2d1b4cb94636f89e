"""Frames of every version of the original are read, and written for it."""

from __future__ import annotations

import base64
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as some

from nep_core.errors import BadMessage
from nep_core.networks.gateway.doors import Kind, Shape, read, shape_of, write

PICTURE = b"\xff\xd8 a picture"


@pytest.mark.parametrize(
    ("frame", "kind", "value"),
    [
        (b'/t {"x": 1}', "json", {"x": 1}),
        (b'{"x": 1}', "json", {"x": 1}),
        (b'"{\\"x\\": 1}"', "json", {"x": 1}),  # 0.5.4.7
        (b'"{x"', "json", "{x"),
        (b"/t hello world", "text", "hello world"),
        (b"hello world", "text", "hello world"),
        (b"\x81\xa1x\x01", "msgpack", {"x": 1}),
        (b"/t \0", "bytes", b"/t \0"),
        (base64.b64encode(PICTURE), "image", PICTURE),
        (b"/t " + base64.b64encode(PICTURE), "image", PICTURE),
    ],
)
def test_a_frame_is_read_with_and_without_its_topic(frame: bytes, kind: Kind, value: Any) -> None:
    assert read(frame, "/t", kind) == value


def test_numbers_that_json_does_not_have_are_read_all_the_same() -> None:
    value = read(b"/t [NaN, 1]", "/t", "json")

    assert write(value, "/t", "json", prefixed=False) == b"[null,1]"


@pytest.mark.parametrize("kind", ["json", "text", "msgpack", "image"])
def test_a_frame_that_cannot_be_read_is_told(kind: Kind) -> None:
    with pytest.raises(BadMessage, match=f"A message on /t is not {kind}"):
        read(b"\xc1", "/t", kind)


@given(frame=some.binary(), kind=some.sampled_from(["json", "text", "msgpack", "bytes", "image"]))
@example(frame=b"\x81\x80\x01", kind="msgpack")  # a key that is a dictionary
@example(frame=b"[" * 100_000, kind="json")
@example(frame=b"\x91" * 100_000, kind="msgpack")
@example(frame=b'"\\ud800"', kind="json")
def test_no_frame_is_too_strange(frame: bytes, kind: Kind) -> None:
    with suppress(BadMessage):
        value = read(frame, "/t", kind)
        for wanted in ("json", "text", "msgpack", "bytes", "image"):
            with suppress(BadMessage):
                assert isinstance(write(value, "/t", wanted, prefixed=True), bytes)


@pytest.mark.parametrize(
    ("value", "kind", "payload"),
    [
        ({"x": 1}, "json", b'{"x":1}'),
        ({"x": 1}, "text", b'{"x":1}'),
        ({"x": 1}, "bytes", b'{"x":1}'),
        ("hello", "text", b"hello"),
        ("hello", "json", b'"hello"'),
        ("hello", "bytes", b"hello"),
        ({"x": 1}, "msgpack", b"\x81\xa1x\x01"),
        (b"\0", "bytes", b"\0"),
        (PICTURE, "image", base64.b64encode(PICTURE)),
    ],
)
def test_a_value_is_written_in_the_reader_s_kind(value: Any, kind: Kind, payload: bytes) -> None:
    assert write(value, "/t", kind, prefixed=False) == payload
    assert write(value, "/t", kind, prefixed=True) == b"/t " + payload


@pytest.mark.parametrize(
    ("value", "kind"), [(b"\0", "json"), (b"\0", "text"), ({}, "image"), (object(), "json")]
)
def test_a_value_that_a_kind_cannot_hold_is_told(value: Any, kind: Kind) -> None:
    with pytest.raises(BadMessage, match=f"cannot be sent as {kind}"):
        write(value, "/t", kind, prefixed=False)


def test_the_topic_stands_once_in_a_frame_because_nep_js_splits_there() -> None:
    frame = write({"/t": "see /t/t"}, "/t", "json", prefixed=True)

    assert frame.count(b"/t") == 1
    assert read(frame, "/t", "json") == {"/t": "see /t/t"}


def test_a_message_type_means_another_frame_in_each_generation() -> None:
    assert shape_of("json", old=True) == shape_of("dictionary", old=False) == Shape(True, "json")
    assert shape_of("json", old=False) == Shape(False, "json")
    assert shape_of("string", old=True) == Shape(True, "text")
    assert shape_of("string", old=False) == Shape(False, "text")
    assert shape_of("bytes", old=True) == shape_of("bytes", old=False) == Shape(False, "bytes")
    assert shape_of("anything", old=True) == Shape(True, "json")
