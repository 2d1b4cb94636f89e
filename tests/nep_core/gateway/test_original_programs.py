"""Programs with the original's real packages, unchanged, talk with our nodes."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from nep_core.networks.gateway.gateway import Gateway
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.gateway.originals import (
    OriginalProgram,
    javascript_package,
    javascript_program,
    python_package,
    python_program,
)
from tests.nep_core.gateway.own_network import own_network

pytestmark = pytest.mark.long

Parts = list[dict[str, Any]]

MANY, FROM_ONE, TO_ONE = "many2many", "one2many", "many2one"
DOG = {"human_state": "drømmer", "x": 1.5}
JPEG = b"\xff\xd8 a picture"
OLD, NEW = "0.5.4.5", "0.5.4.8"
SAYS: dict[str, object] = {
    "json": DOG,
    "string": "hello wörld",
    "msgpack": DOG,
    "bytes": "raw \0 bytes",
    "images": "",
}
ARRIVES: dict[str, object] = SAYS | {"bytes": b"raw \0 bytes", "images": JPEG}
HEARD_THERE: dict[str, object] = SAYS | {
    "bytes": {"bytes": "raw \0 bytes"},
    "images": {"bytes": base64.b64encode(JPEG).decode()},
}


class Meeting:
    """The original's programs and one of ours, in a network with the original's own ports."""

    def __init__(self, ours: PeerNetwork, ending: ExitStack) -> None:
        self.ours = ours
        self._ending = ending

    def start(self, program: OriginalProgram) -> OriginalProgram:
        self._ending.callback(program.close)
        return program

    def hear(self, topic: str) -> Subscriber[Any]:
        return Subscriber(topic, network=self.ours)

    def speak(self, says: dict[str, object]) -> Callable[[], None]:
        """A function that says everything once more."""
        speakers = [(Publisher(topic, network=self.ours), value) for topic, value in says.items()]

        def say_all() -> None:
            for speaker, value in speakers:
                speaker.send(value)  # type: ignore[arg-type]

        return say_all


@pytest.fixture
def nep_js() -> Path:
    return javascript_package()


@pytest.fixture
def meeting() -> Iterator[Meeting]:
    python_package(OLD), python_package(NEW)  # from the network that everybody has
    with ExitStack() as ending:
        ending.enter_context(own_network())
        master = Master("tcp://127.0.0.1:*")
        ending.callback(master.close)
        ending.callback(Gateway(master.endpoint).close)
        ours = ending.enter_context(PeerNetwork("ours", master=master.endpoint))
        yield Meeting(ours, ending)


@pytest.mark.parametrize("version", [OLD, NEW])
def test_a_program_of_the_original_talks_with_ours_in_all_its_ways(
    meeting: Meeting, version: str
) -> None:
    kinds = [(kind, MANY) for kind in SAYS] + [("json", FROM_ONE), ("json", TO_ONE)]
    if version == NEW:
        kinds += [("dictionary", MANY), ("dictionary", TO_ONE)]
    theirs = {f"/theirs_{kind}_{mode}": (kind, mode) for kind, mode in kinds}
    to_them = {f"/ours_{kind}_{mode}": (kind, mode) for kind, mode in kinds}
    parts: Parts = [
        {"topic": topic, "kind": kind, "mode": mode, "says": SAYS.get(kind, DOG)}
        for topic, (kind, mode) in theirs.items()
    ]
    parts += [{"topic": t, "kind": kind, "mode": mode} for t, (kind, mode) in to_them.items()]
    parts += [{"topic": "sums", "kind": kind} for kind in ("server", "client")]
    hearing = {topic: meeting.hear(topic) for topic in theirs}
    say_all = meeting.speak({t: ARRIVES.get(kind, DOG) for t, (kind, _) in to_them.items()})

    program = meeting.start(python_program(version, parts))
    program.hears({"sums", *to_them}, meanwhile=say_all)
    arrived = {topic: subscriber.receive(10.0) for topic, subscriber in hearing.items()}

    assert arrived == {t: ARRIVES.get(kind, DOG) for t, (kind, _) in theirs.items()}
    expected = {t: [HEARD_THERE.get(kind, DOG)] for t, (kind, _) in to_them.items()}
    assert program.heard == expected | {"sums": [{"sum": 6}]}


def test_both_generations_understand_each_other(meeting: Meeting) -> None:
    old = meeting.start(
        python_program(
            OLD,
            [
                {"topic": "/old", "kind": "json", "mode": FROM_ONE, "says": {"from": "old"}},
                {"topic": "/new", "kind": "json", "mode": FROM_ONE},
            ],
        )
    )
    new = meeting.start(
        python_program(
            NEW,
            [
                {"topic": "/new", "kind": "json", "mode": MANY, "says": {"from": "new"}},
                {"topic": "/old", "kind": "dictionary", "mode": TO_ONE},
            ],
        )
    )

    old.hears({"/new"})
    new.hears({"/old"})

    assert old.heard == {"/new": [{"from": "new"}]}
    assert new.heard == {"/old": [{"from": "old"}]}


def test_a_program_with_nep_js_talks_with_ours(nep_js: Path, meeting: Meeting) -> None:
    # its other way to hear, new_callback(), fails in every network
    parts: Parts = [
        {"topic": "/js_5", "kind": "json", "style": 5, "says": DOG},
        {"topic": "/js_6", "kind": "json", "style": 6, "says": DOG},
        {"topic": "/ours", "kind": "json", "style": 5},
    ]
    message = {"topic": "/ours", "x": 1}
    hearing = [meeting.hear("/js_5"), meeting.hear("/js_6")]
    say_all = meeting.speak({"/ours": message})

    program = meeting.start(javascript_program(nep_js, parts))
    program.hears({"/ours"}, meanwhile=say_all)

    assert [subscriber.receive(10.0) for subscriber in hearing] == [DOG, DOG]
    assert program.heard["/ours"][0] == message
