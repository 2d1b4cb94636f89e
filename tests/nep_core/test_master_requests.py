"""Requests to the master, right and wrong ones, as any program may send them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import closing

import msgspec
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from nep_core.networks import master_messages as says
from nep_core.networks.master import Master
from tests.nep_core.master_process import MasterProcess, RawProgram, registration, until

WORDS = ["register", "change", "alive", "bye", "list", "find", "watch", "stop", "sing"]
KEYS = ["version", "base", "instance", "node", "topic", "epoch", "number", "registration", "pid"]
TEXTS = st.text(st.characters(), max_size=8) | st.sampled_from(["\ud800", "\udfff\ud800", "\0"])
NUMBERS = st.integers() | st.floats() | st.sampled_from([10**400, -(2**64), 1e308])
VALUES = st.recursive(
    st.none() | st.booleans() | NUMBERS | TEXTS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3),
    max_leaves=8,
)
OBJECTS = st.builds(
    lambda word, rest: {"do": word} | rest,
    st.sampled_from(WORDS),
    st.dictionaries(st.sampled_from(KEYS) | TEXTS, VALUES, max_size=6),
)
JSON = st.builds(
    lambda value, is_raw: json.dumps(value, ensure_ascii=is_raw).encode("utf-8", "surrogatepass"),
    OBJECTS | VALUES,
    st.booleans(),
)
REQUESTS = st.lists(JSON | st.binary(max_size=60), min_size=1, max_size=4)


@pytest.fixture
def program(master: Master) -> Iterator[RawProgram]:
    with RawProgram(master.endpoint) as program:
        yield program


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(request=REQUESTS)
def test_any_request_is_answered_and_the_master_goes_on(
    program: RawProgram, request: list[bytes]
) -> None:
    try:
        read = says.decode_request(request[-1])
    except (msgspec.MsgspecError, RecursionError, UnicodeError):
        read = None

    program.say(request)
    program.say(says.Find(topic="/and now this"))

    answers = []
    while not (isinstance(answer := program.hear(), says.Found) and "now" in answer.topic):
        assert answer is not None, "the master does not answer any more"
        answers.append(answer)
    assert answers or isinstance(read, says.Bye)
    if read is None:
        assert isinstance(answers[0], says.Mistake)


@pytest.mark.parametrize(
    "request_",
    [
        b"",
        b"null",
        b'{"do":"register"}',
        b'{"do":"register","version":1,"registration":{"node":5}}',
        b'{"do":"register","version":1,"registration":{"instance":"i","node":"n","pid":-1,'
        b'"host":"h","endpoint":"e"}}',
        b"[" * 100_000,
        b'{"do":"find","topic":' + b"[" * 100_000,
        b'{"do":"stop","node":"\xed\xa0\x80"}',
        b'{"do":"stop","node":"\\ud800"}',
        b'{"do":"watch","number":1' + b"0" * 5000 + b"}",
        b'{"node":"a","topic":"/t1","mode":"many2many"}',
        [b"", b"", b""],
    ],
)
def test_a_wrong_request_is_answered_with_its_mistake(
    program: RawProgram, request_: bytes | list[bytes]
) -> None:
    answer = program.ask(request_)

    assert isinstance(answer, says.Mistake)
    assert "cannot be read" in str(answer.sentence)


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"endpoint": "tcp://nowhere", "publishes": ["/x"]}, "is not an endpoint"),
        ({"endpoint": "", "publishes": ["/x"]}, "is not an endpoint"),
        ({"publishes": ["/x", ""]}, "cannot be a topic"),
        ({"subscribes": {"id": "a\0b"}}, "cannot be a topic"),
        ({"node": ""}, "names its instance and its node"),
    ],
)
def test_what_would_hurt_the_others_is_not_registered(
    program: RawProgram, wrong: dict[str, object], reason: str
) -> None:
    told = msgspec.structs.replace(registration("n"), **wrong)

    answer = program.ask(says.Register(version=1, registration=told))
    listing = program.ask(says.List())

    assert isinstance(answer, says.Mistake)
    assert reason in str(answer.sentence)
    assert isinstance(listing, says.Listing)
    assert listing.registrations == []


def test_a_change_of_what_the_master_does_not_know_asks_for_all_again(
    program: RawProgram,
) -> None:
    change = says.Change(instance="i", version=3, base=2, publishes=["/x"])

    to_a_stranger = program.ask(change)
    program.ask(says.Register(version=1, registration=registration("n", "i")))
    to_another_version = program.ask(change)
    change.base = 1
    to_the_right_one = program.ask(change)

    assert isinstance(to_a_stranger, says.Heard) and not to_a_stranger.known
    assert isinstance(to_another_version, says.Heard) and not to_another_version.known
    assert isinstance(to_the_right_one, says.Registered)
    assert to_the_right_one.subscribers == {"/x": []}


def test_a_lookup_tells_who_is_at_a_topic(master: Master, program: RawProgram) -> None:
    told = registration("n", "i", publishes=["/x"], subscribes={"s": "/x", "t": "/y"})
    program.ask(says.Register(version=1, registration=told))

    with closing(says.MasterProbe(master.endpoint)) as probe:
        found = probe.ask(says.Find(topic="/x"), says.Found, 2.0)

    assert found == says.Found(topic="/x", publishers=[told.publishing], subscribers=["s"])


def test_a_name_is_kept_for_who_had_it_before_the_master_was_restarted(
    program: RawProgram, master: Master
) -> None:
    with RawProgram(master.endpoint) as other, RawProgram(master.endpoint) as newcomer:
        other.ask(says.Alive(instance="somebody whom the last master knew"))
        newcomer.say(says.Register(version=1, registration=registration("watch", "new")))
        assert isinstance(newcomer.ask(says.List()), says.Listing)  # so that it was heard

        mine = registration("watch", "old")
        answer = program.ask(says.Register(version=4, registration=mine, epoch="the last"))

        assert isinstance(answer, says.Registered)
        refused = newcomer.hear()
        assert isinstance(refused, says.Refused)
        assert '"watch" is already running' in str(refused.sentence)


def test_a_tool_that_never_reads_does_not_fill_the_masters_memory() -> None:
    with MasterProcess() as master, RawProgram(master.endpoint) as program:
        topics = [f"/topic/with/a/long/name/{i:04}" for i in range(3000)]
        told = registration("n", publishes=topics)
        program.ask(says.Register(version=1, registration=told))
        before_mb = master.rss_mb()

        with RawProgram(master.endpoint, answers_kept=1) as frozen:
            for _ in range(2000):  # 200 MB of answers
                frozen.say(says.List())
            last = registration("frozen", publishes=["/all served"])
            frozen.say(says.Register(version=1, registration=last))
            assert until(lambda: program.ask(says.Find(topic="/all served")).publishers)
            gained_mb = master.rss_mb() - before_mb

    assert gained_mb < 60
