"""Every message that the program can show is listed, says what to try, and can be translated."""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path

import pytest
from message_listing import Said, messages
from message_sources import FROM_NAOQI, LEFT_OUT, NO_SENTENCES, NOT_SHOWN, templates
from test_translation_tables import window_words

from faults import fault_of
from nep_core.errors import NepError
from nep_core.processes.process import Outcome
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.errors import BlocksError
from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.plugins.nodes.notices import Circumstances, notice_of
from nodes.cognitive.failures import OTHER, SENTENCES

pytestmark = pytest.mark.long

NO_HAND = "an edit checks itself; no gesture of the window asks for what is refused here"
PASSED_ON = "the reason of another message; that one tells what to try"
OF_A_ROBOT = "told as “NAO could not ...” by nep_core/program/actions.py, which adds what to try"
OF_A_PROGRAM = "told by the master to a program that somebody wrote with the page docs/wire.md"
FOR_AUTHORS = "told to those who write descriptions of blocks; the sentence names the place"
OF_ITS_CLASS = "its class has its sentence and its checklist, wherever it is raised"
SAYS_WHY = "why a place refuses blocks that are dragged or typed; the program stays as it was"
ALL_IS_WELL = "it tells that something is well again, or done as it was asked"

WITHOUT_IN = {
    "nep_studio/blocks/arithmetic.py": SAYS_WHY,
    "nep_studio/blocks/code_text.py": SAYS_WHY,
    "nep_studio/blocks/edits/": NO_HAND,
    "nep_studio/blocks/files.py": PASSED_ON,
    "nep_studio/blocks/definition_files.py": FOR_AUTHORS,
    "robots/body/": OF_A_ROBOT,
    "robots/naoqi/": OF_A_ROBOT,
}
"""Where messages need no checklist, and why."""

WITHOUT = {
    "ready_s is {ready_s}, but 0 to {most_ready_s} s can be": PASSED_ON,
    "stop_s is {stop_s}, but 0 to {most_stop_s} s can be": PASSED_ON,
    "its command has an empty word": PASSED_ON,
    'the topic "{topic}" does not begin with /': PASSED_ON,
    '"{name}" cannot name a setting: use letters, digits and _': PASSED_ON,
    'the setting "{name}" has limits, but is no number': PASSED_ON,
    'the setting "{name}" has a minimum above its maximum': PASSED_ON,
    'the setting "{name}" has no choices': PASSED_ON,
    "A registration names its instance and its node.": OF_A_PROGRAM,
    "reason": SAYS_WHY,
    "reason or 'A letter or a digit is needed.'": SAYS_WHY,
    "There is no block for this.": NO_HAND,
    "This block is not there any more.": NO_HAND,
    "There is no such part in this block.": NO_HAND,
    "This block has no such part.": NO_HAND,
    "This block has no place for blocks inside it.": NO_HAND,
    "There is no kind of field called “{name}”.": FOR_AUTHORS,
    "error": PASSED_ON,
    "()": OF_ITS_CLASS,
    "left": OF_ITS_CLASS,
    "title | problem.sentence": ALL_IS_WELL,
    "title": ALL_IS_WELL,
    "message.title | message.sentence": ALL_IS_WELL,
}
"""Which messages need none elsewhere, by their words, and why."""


def why_without(said: Said) -> str:
    """Why a message has no checklist; nothing where it should have one."""
    if said.is_question:
        return "a question: its answers are what can be done"
    if said.is_calm:
        return "nothing is wrong"
    of_place = (why for place, why in WITHOUT_IN.items() if said.place.startswith(place))
    return next(of_place, WITHOUT.get(said.words, ""))


def test_the_messages_of_all_rooms_are_listed() -> None:
    found = {(said.made_by, said.words) for said in messages()}

    assert len(messages()) > 250
    assert {
        ("RobotNotAnswering", "{robot} does not answer: no running action node plays it."),
        ("EditRefused", "There is something on this page: empty it first."),
        ("Problem", "“{name}” does not answer | _silent(name)"),
        ("refuse", "There is no project to run."),
        ("Explanation", "A number was divided by zero."),
        ("confirm", "The program has ended."),
    } <= found


def test_every_message_has_a_checklist_or_a_reason_for_none() -> None:
    lacking = [str(said) for said in messages() if not said.has_checklist and not why_without(said)]

    assert lacking == []


def test_no_reason_is_given_for_messages_that_are_gone() -> None:
    without = [said for said in messages() if not said.has_checklist]
    words = {said.words for said in without}

    assert [said for said in WITHOUT if said not in words] == []
    assert [p for p in WITHOUT_IN if not any(said.place.startswith(p) for said in without)] == []


def test_every_text_of_a_message_is_among_those_that_are_translated() -> None:
    known = templates() | window_words()
    unknown = [
        f"{said}: {text}"
        for said in messages()
        for text in said.texts
        if not said.place.startswith((*LEFT_OUT, *NOT_SHOWN))
        if text not in known | FROM_NAOQI and not NO_SENTENCES.search(text)
    ]

    assert unknown == []


def test_no_message_has_an_exclamation_mark_or_blames() -> None:
    rude = [
        text
        for said in messages()
        for text in said.texts
        if re.search(r"!|\b(wrongly|invalid|illegal|forbidden|you must|fatal)\b", text, re.I)
    ]

    assert rude == []


def test_every_step_of_a_checklist_is_a_whole_sentence() -> None:
    steps = {step for told in (*SENTENCES, OTHER) for step in told.steps}

    assert [step for step in steps if not step.endswith((".", "?"))] == []
    assert all(told.steps for told in (*SENTENCES, OTHER))


@pytest.mark.parametrize("root", [NepError, BlocksError])
def test_every_error_has_a_title_of_its_own_or_of_its_family(root: type) -> None:
    for place in ("nep_studio.blocks.from_python.learning", "nodes.cognitive.failures"):
        importlib.import_module(place)
    titles = {one.__name__: one.title for one in _family(root)}

    assert [name for name, title in titles.items() if not title or title.endswith(".")] == []
    assert set(titles.values()) <= templates() | window_words() | _terminal_titles()


def _family(root: type) -> list[type]:
    return [root, *(below for one in root.__subclasses__() for below in _family(one))]


def _terminal_titles() -> set[str]:
    """Titles of errors of tests and of commands, which no window shows."""
    found = [*_family(NepError), *_family(BlocksError)]
    rooms = ("nep_core", "nep_studio.", "nodes")
    return {
        one.title
        for one in found
        if not one.__module__.startswith(rooms) or ".commands." in one.__module__
    }


@pytest.mark.parametrize(
    ("event", "health"),
    [
        ("connection_failed", "crashed"),
        ("disconnected", "warning"),
        ("warning", "warning"),
        ("crashed", "crashed"),
        ("ready", "frozen"),
    ],
)
@pytest.mark.parametrize("is_ours", [True, False])
def test_every_notice_of_a_node_in_trouble_has_a_checklist(event, health, is_ours) -> None:
    told = fault_of("NAO does not answer.", checklist=("Is it on?",))
    if event != "connection_failed":
        told = Outcome("karate", -9).fault()
    status = NodeStatus("karate", "perceptual", event=event, health=health, fault=told)
    before = NodeStatus("karate", "perceptual", event="ready", health="ready")

    notice = notice_of(before, status, Circumstances(is_ours=is_ours, was_ready=True))

    assert notice is not None
    assert notice.problem.checklist
    assert notice.problem.title


def test_the_list_knows_how_messages_are_made() -> None:
    """Where an argument moves, the list would look for checklists in the wrong place."""
    names = list(inspect.signature(Diagnostic).parameters)

    assert names[4:6] == ["sentence", "checklist"]
    assert Path(inspect.getfile(NepError)).name == "errors.py"
