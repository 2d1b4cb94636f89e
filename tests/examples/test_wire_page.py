"""docs/wire.md: each block of JSON and bytes on it is what our programs speak."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import msgspec
import pytest

from nep_core.networks import master_messages as says
from nep_core.networks.master import Master
from nep_core.networks.master_messages import ask_to_stop
from nep_core.networks.network import TroubleKind
from nep_core.networks.security.curve import NOT_LET_IN
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes import handover
from nep_core.processes.manifest import read_manifest
from nep_core.wire import frames, outbox
from nep_core.wire.messages import (
    BY_TOPIC,
    LATCHED,
    PROCESS_ENDED,
    PROCESS_RESTARTS,
    PROCESS_STOPPED,
    NodeEvent,
    RobotState,
)
from nep_core.wire.pubsub import Publisher
from nodes.sensory.arm.gestures import MAKES_GESTURE

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "wire.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^ *```(\w+) ?(.*)\n((?:.*\n)*?) *```$", re.MULTILINE)
BLOCKS = [match.groups() for match in BLOCK.finditer(PAGE)]
HUMAN, IMU = "/human_behavior", "/imu"


def blocks(language: str, what: str = "") -> list[str]:
    """The blocks of the page that are marked so."""
    return [text for kind, words, text in BLOCKS if kind == language and words.startswith(what)]


def block(what: str) -> bytes:
    """The bytes of the one block of hex of this name: two digits each, up to the comment."""
    (text,) = blocks("hex", what)
    digits = re.findall(r"^ *((?:[0-9a-f]{2} ?)+)(?: .*)?$", text, re.MULTILINE)
    return bytes.fromhex(" ".join(digits))


def joined(topic: str, node: str, number: int, time_ns: int, payload: bytes, run: str) -> bytes:
    """A frame of JSON as our publishers send it."""
    return frames.join(frames.subscription(topic), node, number, time_ns, "json", payload, run)


def assert_has(whole: Any, part: Any) -> None:
    """That all that stands on the page was read, and means the same to us."""
    if isinstance(part, dict):
        for key, value in part.items():
            assert key in whole
            assert_has(whole[key], value)
    elif isinstance(part, list) and part and isinstance(part[0], dict):
        assert len(whole) == len(part)
        for one, other in zip(whole, part, strict=True):
            assert_has(one, other)
    else:
        assert whole == part


@pytest.mark.parametrize(
    ("what", "decode", "kinds"),
    [("request", says.decode_request, says.Request), ("answer", says.decode_answer, says.Answer)],
)
def test_every_request_and_answer_is_read_as_it_is_written(
    what: str, decode: Callable[[bytes], Any], kinds: Any
) -> None:
    shown = set()

    for text in blocks("json", what):
        read = decode(text.encode())
        assert_has(json.loads(says.encode(read)), json.loads(text))
        shown.add(type(read))

    only_inside = {"Computers"}  # docs/open_network.md has it
    assert {kind.__name__ for kind in set(get_args(kinds)) - shown} <= only_inside


def test_the_messages_of_topics_are_as_our_nodes_send_them() -> None:
    for kind, words, text in BLOCKS:
        if kind == "json" and words.startswith("message "):
            read = msgspec.json.decode(text, type=BY_TOPIC[words.removeprefix("message ")])
            assert_has(json.loads(msgspec.json.encode(read)), json.loads(text))


def test_the_fault_that_a_node_hands_over_is_read_with_its_values_and_steps(tmp_path: Path) -> None:
    (text,) = blocks("json", "fault")
    place = tmp_path / "fault.json"
    place.write_text(text, encoding="utf-8")

    fault = handover.take(place)

    assert fault is not None
    assert fault.code == "name_taken"
    assert str(fault) == 'A node named "shake" is already running (process 4711).'
    assert tuple(map(str, fault.checklist)) == (
        "Give the new node another name.",
        'Or stop the running "shake" first.',
    )
    assert not place.exists()


def test_the_page_names_every_code_that_means_the_same_from_every_node() -> None:
    codes = (
        *(PROCESS_ENDED, PROCESS_RESTARTS, PROCESS_STOPPED, NOT_LET_IN, MAKES_GESTURE),
        *get_args(TroubleKind),
    )

    assert [code for code in codes if f"| `{code}` |" not in PAGE] == []


def test_the_frame_is_byte_for_byte_ours() -> None:
    ours = joined(HUMAN, "shake", 7, 1767225600000000000, b'{"human_state":"shaken"}', "5f0c1a2b")

    assert block("frame") == ours
    assert frames.read_header(block("frame").split(frames.NUL)[1]).run == "5f0c1a2b"


def test_the_shared_frame_has_two_messages_with_the_numbers_that_the_page_says() -> None:
    payloads = frames.NUL.join([b'{"a":1}', b'{"a":2}'])

    ours = joined(IMU, "watch", 41, 1767225600000000000, payloads, "77aa0100")

    assert block("flood") == ours


def test_the_notices_are_byte_for_byte_ours() -> None:
    kept = joined(HUMAN, "shake", 6, 1767225599000000000, b'{"human_state":"calm"}', "5f0c1a2b")
    private = outbox.private_subscription(HUMAN, "9c41d7")

    seen = outbox.read_subscription(block("subscription"))

    assert block("notice") == frames.mark(IMU, "watch", "77aa0100", 42)
    assert block("subscription") == b"\1" + private
    assert seen == outbox.Seen(True, HUMAN, "9c41d7")
    assert block("welcome") == outbox.private_frame(
        HUMAN, "9c41d7", "5f0c1a2b", frames.notice(kept, 7)
    )


def test_the_page_names_every_event_encoding_and_latched_topic() -> None:
    for word in (*get_args(NodeEvent), *get_args(frames.Encoding), *LATCHED):
        assert f"`{word}`" in PAGE or f'`"{word}"`' in PAGE, word


def test_the_manifest_of_the_page_can_be_read(tmp_path: Path) -> None:
    (text,) = blocks("toml")
    path = tmp_path / "perceptual" / "shake.toml"
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")

    assert read_manifest(path).command == ["node", "{folder}/shake.mjs"]


def test_the_whole_program_of_the_page_hears_the_first_message_and_stops_when_asked(
    master: Master, network: PeerNetwork, tmp_path: Path
) -> None:
    (program,) = blocks("python", "ear.py")
    path = tmp_path / "ear.py"
    path.write_text(program, encoding="utf-8")
    ear = subprocess.Popen([sys.executable, str(path), "/steps"], stdout=subprocess.PIPE, text=True)

    try:
        Publisher("/steps", network=network, wait_for_subscribers=1, timeout_s=10).send({"n": 1})

        assert ear.stdout is not None
        assert ear.stdout.readline() == '{"n":1}\n'
        assert ask_to_stop(master.endpoint, "ear")
        assert ear.wait(10) == 71
    finally:
        ear.kill()
        ear.communicate()


def test_the_keys_of_a_robots_state_are_those_of_its_struct() -> None:
    _, _, table = PAGE.partition("| key of `/robot_state` |")
    keys = re.findall(r"^\| `(\w+)` \|", table.partition("\n\n")[0], re.MULTILINE)

    assert keys == list(RobotState.__struct_fields__)
    [shown] = blocks("json", "message /robot_state")
    assert list(json.loads(shown)) == keys
