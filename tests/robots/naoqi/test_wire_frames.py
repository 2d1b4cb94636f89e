"""Bytes cut into frames, however they arrive."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.naoqi.wire.errors import BadFrame
from robots.naoqi.wire.line import HEADER, MAGIC, Frame, FrameReader, Kind

NUMBERS = st.integers(0, 2**32 - 1)
FRAMES = st.builds(
    Frame,
    st.integers(0, 255),
    NUMBERS,
    NUMBERS,
    NUMBERS,
    NUMBERS,
    st.binary(max_size=100),
    st.integers(0, 255),
)


@given(st.lists(FRAMES, max_size=5), st.integers(1, 50))
def test_frames_arrive_whole_in_whatever_pieces_they_come(frames: list[Frame], size: int) -> None:
    data = b"".join(frame.encoded() for frame in frames)
    reader = FrameReader()

    got = [it for at in range(0, len(data), size) for it in reader.take(data[at : at + size])]

    assert got == frames


@given(st.lists(st.binary(max_size=80), max_size=10))
def test_any_bytes_are_frames_or_refused(pieces: list[bytes]) -> None:
    reader = FrameReader()

    try:
        for piece in pieces:
            reader.take(piece)
    except BadFrame:
        pass


@pytest.mark.parametrize("data", [b"HTTP", b"\x16\x03\x01", b"S", bytes(28)])
def test_what_is_not_naoqi_is_refused_at_its_first_bytes(data: bytes) -> None:
    with pytest.raises(BadFrame):
        FrameReader().take(data)


def test_a_frame_that_announces_a_gigabyte_is_refused_before_it_arrives() -> None:
    head = HEADER.pack(MAGIC, 1, 2**30, 0, Kind.CALL, 0, 1, 1, 2)

    with pytest.raises(BadFrame, match="1024 MB was announced; 64 MB is the most"):
        FrameReader().take(head)


def test_a_later_version_of_the_protocol_is_refused() -> None:
    head = HEADER.pack(MAGIC, 1, 0, 1, Kind.CALL, 0, 1, 1, 2)

    with pytest.raises(BadFrame, match="version 1"):
        FrameReader().take(head)
