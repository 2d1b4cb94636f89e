"""Recording and playing: the same bytes come back, whatever they are and whenever power fails."""

from __future__ import annotations

import itertools
import math
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as some
from mcap.reader import make_reader

from nep_core.errors import RecordingError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.recordings.file import Recording, overview, plain_schema, read_recording
from nep_core.recordings.raw import RawMessage, RawSubscriber
from nep_core.recordings.recorder import Player, Recorder
from nep_core.wire.messages import BY_TOPIC, HUMAN_BEHAVIOR, NODE_STATE, HumanBehavior
from nep_core.wire.pubsub import Publisher
from tests.nep_core.cli.conftest import until

Join = Callable[[str], PeerNetwork]
SENT = (
    ("/any", {"n": 1, "text": "Grüße"}, None),
    ("/text", "Grüße\0, 日本", None),
    ("/bytes", bytes(range(256)), None),
    ("/pack", {"n": b"\0\1"}, "msgpack"),
    (HUMAN_BEHAVIOR, HumanBehavior(human_state="happy"), None),
    (NODE_STATE, {"node": "lamp", "type": "action", "event": "ready"}, None),
)


@pytest.fixture
def recording(join: Join, tmp_path: Path) -> Path:
    """A recording of SENT, each message twice, and 20 ms apart."""
    path, talker = tmp_path / "all.mcap", join("talker")
    with Recorder(path, network=join("recorder")) as recorder:
        recorder.add(topic for topic, _, _ in SENT)
        publishers = [
            Publisher(topic, network=talker, encoding=encoding)  # type: ignore[arg-type]
            for topic, _, encoding in SENT
        ]
        for _ in range(2):
            for publisher, (_, message, _) in zip(publishers, SENT, strict=True):
                publisher.send(message)
            time.sleep(0.02)  # the pause that is recorded, and played again
        until(lambda: recorder.totals.messages == 2 * len(SENT))
    talker.close()  # else its latched message would come once more
    return path


def kept(messages: object) -> list[tuple[str, str, bytes]]:
    return sorted((one.topic, one.encoding, one.payload) for one in messages)  # type: ignore[attr-defined]


def test_what_is_played_is_what_was_recorded_byte_for_byte(
    recording: Path, join: Join, tmp_path: Path
) -> None:
    again = tmp_path / "again.mcap"
    with (
        Recorder(again, network=join("second")) as recorder,
        Player(recording, join=join, node_states=True) as player,
    ):
        recorder.add(topic for topic, _, _ in SENT)
        player.wait_for_subscribers(10)
        player.play()
        until(lambda: recorder.totals.messages == 2 * len(SENT))

    first, second = list(read_recording(recording)), list(read_recording(again))
    assert kept(second) == kept(first)
    assert {one.node for one in first} == {"talker"}
    assert [one.sequence for one in first if one.topic == "/text"] == [1, 2]


def test_other_programs_read_json_with_schemas_and_texts(recording: Path) -> None:
    with recording.open("rb") as file:
        found = {
            channel.topic: (channel.message_encoding, schema, message)
            for schema, channel, message in make_reader(file).iter_messages()
        }

    encoding, schema, message = found[HUMAN_BEHAVIOR]
    assert (encoding, schema.name, schema.encoding) == ("json", "nep.HumanBehavior", "jsonschema")
    assert msgspec.json.decode(schema.data)["properties"]["certainty"]["type"] == "number"
    assert msgspec.json.decode(message.data)["human_state"] == "happy"
    assert message.log_time >= message.publish_time > 0
    assert msgspec.json.decode(found["/text"][2].data) == {"text": "Grüße\0, 日本"}
    assert [found[topic][0] for topic in ("/any", "/pack", "/bytes")] == [
        "json",
        "msgpack",
        "x-nep-bytes",
    ]


@pytest.mark.parametrize("kind", BY_TOPIC.values())
def test_every_schema_is_one_that_foxglove_reads(kind: type[msgspec.Struct]) -> None:
    def look(schema: dict[str, object], at_top: bool = True) -> None:
        assert schema["type"] in ("object", "array", "string", "number", "integer", "boolean")
        assert schema["type"] == "object" or not at_top
        if schema["type"] == "object":
            for field in schema["properties"].values():  # type: ignore[attr-defined]
                look(field, at_top=False)
        if schema["type"] == "array":
            assert schema["items"]["type"] != "array"  # type: ignore[index]
            look(schema["items"], at_top=False)  # type: ignore[arg-type]

    look(msgspec.json.decode(plain_schema(kind)))


def test_nodes_that_do_not_run_tell_nothing_unless_it_is_wanted(
    recording: Path, join: Join
) -> None:
    with Player(recording, join=join, speed=math.inf) as player:
        assert NODE_STATE not in player.topics


def test_a_part_is_played_under_other_names_in_its_true_timing(recording: Path, join: Join) -> None:
    heard = RawSubscriber("/old/any", network=join("hearer"))
    with Player(recording, join=join, topics=["/any"], prefix="/old", speed=0.5) as player:
        player.wait_for_subscribers(10)
        player.play()
        first, second = heard.receive(5), heard.receive(5)
        assert player.sent == 2

    one, two = (m.arrived_ns for m in read_recording(recording) if m.topic == "/any")
    assert first is not None and second is not None
    assert (second.sent_ns - first.sent_ns) >= (two - one) * 2 * 0.9


def test_only_what_lies_between_two_times_is_played(recording: Path, join: Join) -> None:
    messages = list(read_recording(recording))
    _, second = (one for one in messages if one.topic == "/any")
    from_s = (second.arrived_ns - min(one.arrived_ns for one in messages)) / 1e9

    with Player(recording, join=join, from_s=from_s, to_s=from_s, speed=math.inf) as player:
        player.play()

        assert player.sent == 1


def test_a_loop_goes_on_until_it_is_stopped(recording: Path, join: Join) -> None:
    with Player(recording, join=join, topics=["/any"], speed=100) as player:
        heard = RawSubscriber("/any", network=join("hearer"))
        begin_s = time.monotonic()
        looping = threading.Thread(target=lambda: player.play(loop=True))
        looping.start()
        messages = [heard.receive(5) for _ in range(5)]
        player.stop()
        looping.join(5)

    assert None not in messages
    assert time.monotonic() - begin_s >= 0.1  # a short recording does not become a flood


def test_a_topic_with_texts_and_msgpack_is_played_by_two_publishers(
    join: Join, tmp_path: Path
) -> None:
    path = tmp_path / "mixed.mcap"
    with Recorder(path, network=join("recorder")) as recorder:
        recorder.add(["/x"])
        Publisher("/x", network=join("one"), encoding="msgpack").send({"n": 1})
        Publisher("/x", network=join("two")).send("text")
        until(lambda: recorder.totals.messages == 2)
    heard = RawSubscriber("/x", network=join("hearer"))

    with Player(path, join=join) as player:
        player.play()
        got = [heard.receive(5), heard.receive(5)]

    assert {one.encoding for one in got if one} == {"msgpack", "text"}


def test_a_text_that_cannot_be_played_is_told(
    recording: Path, join: Join, caplog: pytest.LogCaptureFixture
) -> None:
    latin = RawMessage("/text", "old", 1, 7, 7, "text", "Grüße".encode("latin-1"))

    with Player(recording, join=join) as player:
        player._send(latin)

    assert player.sent == 0
    assert caplog.messages == ["/text: a text that is not UTF-8 is not played"]


def test_topics_that_appear_later_are_recorded_too(join: Join, tmp_path: Path) -> None:
    network = join("recorder")
    with Recorder(tmp_path / "later.mcap", network=network) as recorder:
        recorder.follow(without=["/not"])
        talker = join("talker")
        publishers = [Publisher(topic, network=talker) for topic in ("/later", "/not")]
        publishers[0].wait_for_subscribers(1, 10)
        for publisher in publishers:
            publisher.send({"n": 1})
        until(lambda: recorder.totals.messages == 1)

    assert list(overview(recorder.path).topics) == ["/later"]


def test_an_existing_file_is_kept_unless_it_may_be_replaced(join: Join, tmp_path: Path) -> None:
    path = tmp_path / "there.mcap"
    path.write_bytes(b"mine")

    with pytest.raises(RecordingError, match="is there already, and it is kept"):
        Recorder(path, network=join("recorder"))
    Recorder(path, network=join("again"), replace=True).close()

    assert overview(path).messages == 0


@pytest.mark.parametrize("content", [b"", b"rubbish" * 10, None])
def test_what_is_no_recording_is_told(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "x.mcap"
    if content is not None:
        path.write_bytes(content)

    with pytest.raises(RecordingError):
        list(read_recording(path))


@pytest.mark.skipif(sys.platform == "win32", reason="limits the size of files")
def test_a_full_disk_ends_the_recording_and_keeps_what_was_there(
    join: Join, tmp_path: Path
) -> None:
    import resource

    path, most = tmp_path / "full.mcap", 60_000
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    publisher = Publisher("/noise", network=join("talker"))
    recorder = Recorder(path, network=join("recorder"))
    recorder.add(["/noise"])
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, hard))
        while not recorder.is_over:
            publisher.send(os.urandom(2000))
            time.sleep(0.02)  # a rate that a disk keeps up with until it is full
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))

    with pytest.raises(RecordingError, match="cannot grow: file too large"):
        recorder.close()
    told = overview(path)
    assert told.messages > 0
    assert path.stat().st_size == recorder.file_bytes <= most


@pytest.fixture(scope="module")
def long_recording(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A whole recording of 300 messages in many chunks."""
    from mcap.writer import Writer

    from nep_core.recordings.file import channel_of

    path = tmp_path_factory.mktemp("long") / "long.mcap"
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=500)
        writer.start("", "nep")
        message = RawMessage("/x", "n", 1, 1, 1, "json", b"{}")
        number = writer.register_channel("/x", "json", 0, channel_of(message)[0].metadata)
        for at in range(300):
            writer.add_message(number, at, msgspec.json.encode({"n": at}), at, at)
        writer.finish()
    return path.read_bytes()


@given(some.data())
def test_a_recording_cut_anywhere_opens_up_to_its_last_whole_chunk(
    long_recording: bytes, data: some.DataObject
) -> None:
    end = data.draw(some.integers(8, len(long_recording) - 1))
    path = Path(tempfile.gettempdir()) / f"cut-{os.getpid()}.mcap"
    path.write_bytes(long_recording[:end])

    recording = Recording(path)
    numbers = [msgspec.json.decode(one.payload)["n"] for one in recording]

    path.unlink()
    assert numbers == list(range(len(numbers)))
    assert not recording.is_whole
    assert len(numbers) >= 300 * (end / len(long_recording)) - 100


@given(some.data())
def test_a_damaged_recording_never_raises_anything_else(
    long_recording: bytes, data: some.DataObject
) -> None:
    damaged = bytearray(long_recording)
    for _ in range(data.draw(some.integers(1, 5))):
        at = data.draw(some.integers(8, len(damaged) - 1))
        damaged[at] = data.draw(some.integers(0, 255))
    path = Path(tempfile.gettempdir()) / f"damaged-{os.getpid()}.mcap"
    path.write_bytes(damaged)

    count = sum(1 for _ in itertools.islice(Recording(path), 5000))

    path.unlink()
    assert count <= 300
