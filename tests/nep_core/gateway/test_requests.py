"""What the gateway answers: each generation in its own words, and everything else politely."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
import zmq
from hypothesis import example, given
from hypothesis import strategies as some

from nep_core.networks.gateway.gateway import Gateway
from tests.nep_core.gateway.raw_programs import RawPrograms, free_ports

JSON = some.recursive(
    some.none() | some.booleans() | some.integers() | some.floats() | some.text(),
    lambda inner: some.lists(inner) | some.dictionaries(some.text(), inner),
    max_leaves=5,
)
KEYS = ("node", "node_name", "topic", "mode", "socket", "pid", "msg_type")
REQUESTS = some.fixed_dictionaries({}, optional={key: JSON for key in KEYS})


@pytest.fixture(scope="module")
def busy() -> Iterator[RawPrograms]:
    """One gateway for many strange requests; its master is not needed."""
    gateway = Gateway("tcp://127.0.0.1:1", free_ports())
    programs = RawPrograms(gateway.ports)
    yield programs
    programs.close()
    gateway.close()


def test_old_and_new_programs_get_the_answers_of_their_own_master(raw: RawPrograms) -> None:
    ask = {"node": "a", "topic": "/t", "mode": "many2many", "socket": "publisher"}
    new = json.dumps(ask | {"pid": 1, "msg_type": "json"}).encode()
    old = json.dumps(ask).encode()
    papers = json.dumps({"node_name": "a", "topic": "/t"}).encode()
    service = json.dumps({"node": "a", "topic": "s", "socket": "client", "pid": 1}).encode()

    answers = [raw.ask(new), raw.ask(old, old=True), raw.ask(papers, old=True), raw.ask(service)]

    ports = [answer.pop("port") for answer in answers]
    told = {"topic": "/t", "mode": "many2many", "ip": "127.0.0.1", "socket": "publisher"}
    assert answers[:2] == [told | {"state": "success"}] * 2
    assert answers[2] == {"topic": "/t"}
    assert answers[3] == {"topic": "s", "ip": "127.0.0.1", "socket": "client", "state": "success"}
    assert len(set(ports)) == 4


def test_programs_that_may_share_a_port_get_the_same(raw: RawPrograms) -> None:
    ports = [
        raw.register("/t", "publisher", node="a"),
        raw.register("/t", "subscriber", node="b", pid="none"),
        raw.register("/s", "server"),
        raw.register("/s", "client", old=True),
    ]

    assert ports[0] == ports[1] != ports[2] == ports[3]


def test_requests_that_no_client_makes_keep_nobody_waiting(raw: RawPrograms) -> None:
    with zmq.Context() as context, context.socket(zmq.DEALER) as strange:
        strange.linger = 0
        strange.connect(raw.at(raw.ports.new))
        for frames in ([b"no head"], [b"", b"{}", b"more"], [b""], [b"", b"", b""]):
            strange.send_multipart(frames)
        strange.recv_multipart()

        assert raw.register("/alive", "publisher")


@pytest.mark.parametrize(
    "request_",
    [
        *({}, [], 7, {"topic": 5}, {"topic": ""}, {"topic": "a\0b"}, {"topic": "a" * 5000}),
        {"topic": "/t", "mode": "all"},
    ],
)
def test_a_request_that_cannot_be_gets_the_answer_that_clients_give_up_at(
    busy: RawPrograms, request_: object
) -> None:
    answer = busy.ask(json.dumps(request_).encode())

    told = request_.get("topic", "") if isinstance(request_, dict) else ""
    assert (answer["state"], answer["topic"], answer["port"]) == ("failure", told, 0)
    assert answer["error"]


@given(frame=some.binary() | REQUESTS.map(lambda told: json.dumps(told).encode()))
@example(frame=b"[" * 100_000)
@example(frame=b'{"topic": "\\ud800", "node": "\\ud800"}')
@example(frame=b'{"topic": "/t", "node": "\\ud800", "pid": 1e400, "socket": "\\udfff"}')
@example(frame=b'{"topic": ' + b"9" * 5000 + b"}")
@example(frame=b"")
def test_every_request_is_answered(busy: RawPrograms, frame: bytes) -> None:
    answer = busy.ask(frame, old=len(frame) % 2 == 0)

    assert "topic" in answer
