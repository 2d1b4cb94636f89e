"""``nep send``: what is checked before it goes out, and how it goes out."""

from __future__ import annotations

import io
import time

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.wire.pubsub import Subscriber
from tests.nep_core.cli.conftest import Call


def test_a_message_is_sent_as_it_was_typed(network: PeerNetwork, call: Call) -> None:
    heard: Subscriber[HumanBehavior] = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)

    answer = call('nep send /human_behavior \'{"human_state": "happy"}\'')

    assert answer.out == "Sent 1 message to 1 subscriber.\n"
    message = heard.receive(5)
    assert message is not None
    assert message.human_state == "happy"


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        ("/human_behavior '{\"certainty\": 1}'", "missing required field `human_state`"),
        ("/human_behavior '{\"certainty\": 1}'", "It needs: human_state."),
        ('/imu \'{"source": 1, "rate_hz": 1, "t": [], "acc": []}\'', "$.source"),
        ("/imu '[1]'", "This is no Imu, which /imu carries"),
        ("/speed 'm_s=1'", "This is not JSON"),
        ("/speed '" + "[" * 50_000 + "'", "This is not JSON"),
    ],
)
def test_a_wrong_message_is_told_before_anything_is_sent(call: Call, words: str, hint: str) -> None:
    answer = call(f"nep send {words}")

    assert answer.code == 1
    assert hint in answer.err


def test_a_key_that_the_struct_does_not_have_is_told_and_sent(
    network: PeerNetwork, call: Call
) -> None:
    answer = call('nep send /human_behavior \'{"human_state": "a", "humanstate": 1}\' --wait 0')

    assert answer.code == 0
    assert "A HumanBehavior has no humanstate" in answer.err


def test_an_unchecked_message_goes_out_whatever_is_known(network: PeerNetwork, call: Call) -> None:
    heard = Subscriber(HUMAN_BEHAVIOR, network=network)

    call("nep send /human_behavior '{\"certainty\": 1}' --unchecked")

    assert heard.receive(5) == {"certainty": 1}


def test_a_text_goes_out_as_text_and_a_text_in_quotes_as_json(
    network: PeerNetwork, call: Call
) -> None:
    heard: Subscriber[str] = Subscriber("/chat", network=network)

    call("nep send /chat --text 'Grüße'")
    call("nep send /chat '\"Grüße\"'")

    assert heard.receive(5) == "Grüße"
    assert heard.header is not None and heard.header.encoding == "text"
    assert heard.receive(5) == "Grüße"
    assert heard.header is not None and heard.header.encoding == "json"


def test_messages_are_sent_again_at_a_rate(network: PeerNetwork, call: Call) -> None:
    heard = Subscriber("/speed", network=network)
    begin_s = time.monotonic()

    answer = call("nep send /speed '{\"m_s\": 1}' --rate 50 --count 6")

    assert answer.out == "Sent 6 messages to 1 subscriber.\n"
    assert time.monotonic() - begin_s >= 5 / 50
    assert [heard.receive(5) for _ in range(6)] == [{"m_s": 1}] * 6


def test_each_line_of_the_input_is_a_message(
    network: PeerNetwork, call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO('{"n": 1}\n\n{"n": 2}\nno JSON\n{"n": 4}\n'))
    heard = Subscriber("/numbers", network=network)

    answer = call("nep send /numbers -")

    assert answer.code == 1
    assert "This is not JSON" in answer.err
    assert [heard.receive(5) for _ in range(2)] == [{"n": 1}, {"n": 2}]


def test_an_empty_input_is_told(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO(""))

    answer = call("nep send /numbers -")

    assert answer.code == 1
    assert "There was no message to send." in answer.err


def test_a_message_in_another_terminals_letters_is_told(call: Call) -> None:
    answer = call("nep send /x '\"\udcff\"'")

    assert answer.code == 1
    assert "This is not JSON" in answer.err
