"""What another program tells in another language: nothing changes in what the studio does."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from faults import Fault, Text, fault_of
from nep_core.networks.security.curve import Refusals
from nep_core.processes import handover
from nep_core.processes.launcher import LaunchedNode
from nep_core.processes.process import Outcome
from nep_core.wire import messages as m
from nep_studio.blocks.language import Language
from nep_studio.run.installation import studio_language
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.node_board import NodeBoard, NodeStatus
from nep_studio.run.plan import PROGRAM
from nep_studio.run.session import Session
from nep_studio.run.timeline import Timeline
from nep_studio.sharing import refusals_in
from nep_studio.ui.plugins.nodes.notices import Circumstances, Notice, notice_of
from nodes.sensory.arm.gestures import MAKES_GESTURE

OURS = Circumstances(is_ours=True, was_ready=True)
READY = NodeStatus("karate", "perceptual", event="ready", pid=1, health="ready")

HOW = {
    "stays": Outcome("karate", -9).fault(),
    "again": Outcome("karate", -9).fault(again=True),
    "refuses": Outcome("karate", 1, refusal=fault_of("There is no model.")).fault(),
    "own words": fault_of("There is no model.", code="recording_error"),
}
"""How a crashed node is told of: by who started it, and by itself."""


def in_german(fault: Fault) -> Fault:
    """The same fault, as a program of somebody who writes German would tell it."""
    values = {name: _in_german(value) for name, value in fault.values.items()}
    steps = tuple(Text(f"Schritt {number}.") for number, _ in enumerate(fault.checklist))
    return Fault(fault.code, Text("Da ging etwas schief; er ist weg.", values), steps)


def _in_german(value: object) -> object:
    return Text("auf Deutsch", value.values) if isinstance(value, Text) else value


def heard(fault: Fault, **keys: object) -> m.NodeState:
    """A state of a node, over the wire and back."""
    sent = m.NodeState(node="karate", type="perceptual", pid=1, **m.described(fault), **keys)
    return msgspec.json.decode(msgspec.json.encode(sent), type=m.NodeState)


def crashed(fault: Fault) -> NodeStatus:
    board = NodeBoard()
    board.nodes["karate"] = READY
    board.update(heard(fault, event="crashed"))
    return board.nodes["karate"]


def what_is_done(notice: Notice | None) -> object:
    """All of a notice but its sentence and its steps."""
    return notice and (notice.key, notice.kind, notice.fixes, notice.passes, notice.problem.title)


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


@pytest.mark.parametrize("how", HOW)
def test_a_crashed_node_has_the_same_notice(how: str) -> None:
    english = notice_of(READY, crashed(HOW[how]), OURS)
    german = notice_of(READY, crashed(in_german(HOW[how])), OURS)

    assert what_is_done(german) == what_is_done(english)
    assert (german is None) == (how == "own words")


@pytest.mark.parametrize("how", HOW)
def test_a_killed_program_has_the_same_notice(how: str) -> None:
    at = Circumstances(is_program=True)

    english, german = (
        notice_of(READY, crashed(fault), at) for fault in (HOW[how], in_german(HOW[how]))
    )

    assert what_is_done(german) == what_is_done(english)


@pytest.mark.parametrize("how", HOW)
def test_the_time_line_has_a_line_for_the_same_crashes(language: Language, how: str) -> None:
    english = Timeline(language).lines(heard(HOW[how], event="crashed"))
    german = Timeline(language).lines(heard(in_german(HOW[how]), event="crashed"))

    assert len(german) == len(english) == (how != "own words")


def test_a_failed_action_has_its_line_and_its_own_words(language: Language) -> None:
    line = Timeline(language)
    line.lines(m.ActionRequest(id="1", robots=["NAO"], action="say"))
    fault = fault_of("{robot} ist {state}.", code="resting", robot="NAO", state="müde")

    told = line.lines(m.ActionResult(id="1", robot="NAO", state="failed", **m.described(fault)))

    assert told == [("NAO", "failed to say: NAO ist müde.")]


def test_a_failed_program_ends_at_its_line(tmp_path: Path) -> None:
    session = Session([], LocalNetwork(logs=tmp_path))
    fault = fault_of("{robot} antwortet nicht.", checklist=("Ist er an?",), robot="NAO")
    told = m.described(fault)
    told["text_values"] = told.pop("values")
    session._on_message(
        m.PROGRAM_STATE, m.ProgramState(program=PROGRAM, event="failed", line=7, **told)
    )

    ending = session._program_ending(Outcome(PROGRAM, 1, refusal=fault))

    assert ending.line == 7
    assert ending.problem is not None
    assert ending.problem.title == "The program stopped with an error"
    assert str(ending.problem.sentence) == "NAO antwortet nicht."
    assert tuple(map(str, ending.problem.checklist)) == ("Ist er an?",)


@pytest.mark.parametrize("words", ["There is no model.", "Es gibt kein Modell.", "[ ] 模型がない"])
def test_what_a_process_hands_over_says_nothing_about_whether_it_is_started_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: str
) -> None:
    place = tmp_path / "fault.json"
    monkeypatch.setenv(handover.VARIABLE, str(place))
    handover.hand_over(fault_of(words, code="recording_error", checklist=(words,), path="m.json"))

    outcome = Outcome("karate", 1, refusal=handover.take(place))
    launched = LaunchedNode("karate", None, [])

    assert outcome.refusal is not None
    assert (outcome.refusal.code, outcome.refusal.values) == ("recording_error", {"path": "m.json"})
    assert tuple(map(str, outcome.checklist)) == (words,)
    assert outcome.fault().code == m.PROCESS_ENDED
    assert not launched.deserves_another(outcome)


@pytest.mark.parametrize("junk", [b"", b"{", b"7", b"[]", b"{}", b'{"sentence": ""}', b"\xff"])
def test_what_is_no_fault_is_as_if_it_were_not_there(tmp_path: Path, junk: bytes) -> None:
    place = tmp_path / "fault.json"
    place.write_bytes(junk)

    assert handover.take(place) is None


def test_who_was_refused_is_known_in_any_language() -> None:
    refusals = Refusals("own.keys")
    refusals.refuse("192.0.2.7")
    refusals.refuse("127.0.0.1")
    refusals.cannot_join("tcp://192.0.2.8:5000")
    fault = refusals.take()
    assert fault is not None

    found = [(one.kind, one.address) for one in refusals_in(in_german(fault))]

    assert found == [
        ("stranger", "192.0.2.7"),
        ("own_program", ""),
        ("unable", "tcp://192.0.2.8:5000"),
    ]
    assert list(refusals_in(fault_of(str(fault)))) == []


def test_what_the_simulated_person_makes_is_a_value() -> None:
    told = heard(fault_of("macht {gesture}", code=MAKES_GESTURE, gesture="karate"), event="running")

    assert told.fault.code == MAKES_GESTURE
    assert told.fault.values["gesture"] == "karate"


def test_an_old_node_that_tells_only_a_description_is_heard() -> None:
    board = NodeBoard()

    for event in ("ready", "warning"):
        board.update(m.NodeState(node="ear", type="sensory", event=event, description="hört {x}."))

    status = board.nodes["ear"]
    notice = notice_of(None, status, Circumstances())
    assert notice is not None
    assert str(notice.problem.sentence) == str(status.fault) == "hört {x}."
    assert notice.problem.checklist


@pytest.mark.parametrize("text", [7, None, [], {"text": 1}, "x" * 5000])
def test_keys_of_a_wrong_kind_do_no_harm(text: object) -> None:
    state = m.NodeState(
        node="ear",
        type="sensory",
        event="warning",
        description="hört",
        code=text,
        text=text,
        values=text,
        checklist=text,
    )
    again = msgspec.json.decode(msgspec.json.encode(state), type=m.NodeState)

    assert str(again.fault)
    assert all(isinstance(step, Text) for step in again.fault.checklist)
