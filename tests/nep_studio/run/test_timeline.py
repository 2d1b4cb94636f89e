"""The timeline: what is told, and that nothing of it is lost or forged."""

from __future__ import annotations

import io
from collections.abc import Iterator

import pytest

from faults import fault_of, plain
from nep_core.wire import messages as m
from nep_studio.blocks.language import Language
from nep_studio.commands.run import Printer
from nep_studio.problems import Problem
from nep_studio.run.installation import studio_language
from nep_studio.run.timeline import MOST_ACTIONS, Timeline


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


@pytest.fixture
def timeline(language: Language) -> Timeline:
    return Timeline(language)


def say(text: str = "Hello", action_id: str = "1") -> m.ActionRequest:
    return m.ActionRequest(id=action_id, robots=["NAO"], action="say", args={"text": text})


def result(state: m.ActionState, action_id: str = "1", robot: str = "NAO") -> m.ActionResult:
    return m.ActionResult(id=action_id, robot=robot, state=state)


def test_an_action_is_told_when_it_starts_and_only_once(timeline: Timeline) -> None:
    told = [timeline.lines(one) for one in (say(), result("started"), say(), result("started"))]

    assert told == [[], [("NAO", "says “Hello”")], [], []]


def test_results_that_are_quicker_than_their_request_are_told_with_it(timeline: Timeline) -> None:
    early = [timeline.lines(result("started")), timeline.lines(result("started", robot="NAO2"))]

    assert early == [[], []]
    assert timeline.lines(say()) == [("NAO", "says “Hello”"), ("NAO2", "says “Hello”")]


def test_results_whose_request_never_comes_are_forgotten(timeline: Timeline) -> None:
    for number in range(MOST_ACTIONS + 1):
        timeline.lines(result("started", str(number)))

    assert timeline.lines(say(action_id="0")) == []
    assert timeline.lines(say(action_id=str(MOST_ACTIONS))) == [("NAO", "says “Hello”")]


@pytest.mark.parametrize(
    ("state", "words"), [("failed", "failed to say: why"), ("cancelled", "no longer says “Hello”")]
)
def test_an_action_that_did_not_end_well_is_told(
    timeline: Timeline, state: m.ActionState, words: str
) -> None:
    timeline.lines(say())

    told = timeline.lines(m.ActionResult(id="1", robot="NAO", state=state, description="why"))

    assert told == [("NAO", words)]


FORGED = "Hi\n    0.10  NAO  says bye\x1b[2J\r\x9b\u2028\u202e\x07"


def messages() -> Iterator[tuple[str, object]]:
    yield m.ACTION_REQUEST, say(FORGED)
    yield m.ACTION_RESULT, result("started")
    state = m.NodeState(node=FORGED, type="action", event="ready", description=FORGED)
    yield m.NODE_STATE, state
    yield m.PROGRAM_STATE, m.ProgramState(program="program", event="failed", description=FORGED)


def test_no_text_reaches_the_terminal_as_a_command_or_another_line(
    language: Language, capsys: pytest.CaptureFixture[str]
) -> None:
    printer = Printer(language, as_json=False)

    for topic, message in messages():
        printer.hear(topic, message)  # type: ignore[arg-type]

    lines = capsys.readouterr().out.removesuffix("\n").split("\n")
    assert len(lines) == 3
    assert all(line.isprintable() for line in lines)


def test_a_problem_prints_each_part_on_one_line() -> None:
    problem = Problem("Title", FORGED, (FORGED,), "details are not printed", FORGED)

    lines = str(problem).split("\n")

    assert [line[:6] for line in lines] == ["Title", "Hi    ", "  at H", "  [ ] "]
    assert all(line.isprintable() for line in lines)


def test_letters_of_every_script_stay_as_they_are() -> None:
    words = "日本語 म\u200d 👩\u200d🚀 café"

    assert str(Problem(words)) == words


def test_json_lines_are_utf_8_whatever_the_terminal_writes(
    language: Language, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = io.BytesIO()
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(written, encoding="cp1252"))

    Printer(language, as_json=True).hear(m.ACTION_REQUEST, say("日本"))

    assert '"topic":"/action_request"' in written.getvalue().decode()
    assert "日本" in written.getvalue().decode()


def marked(text: str, /, **values: object) -> str:
    """A language in which every word that is translated is in brackets."""
    return f"[{plain(text, **values)}]"


@pytest.mark.parametrize(
    ("message", "line"),
    [
        (m.NodeState(node="NAO", type="action", event="busy"), ("NAO", "[busy]")),
        (
            m.NodeState(node="NAO", type="action", event="connecting", description="to it"),
            ("NAO", "[connecting]: [to it]"),
        ),
        (m.HumanBehavior(human_state="touched_head"), ("[human]", "[sees touched head]")),
        (
            m.ProgramState(program="p", event="failed", description="{why}"),
            ("[program]", "[stopped with an error: [{why}]]"),
        ),
    ],
)
def test_every_word_can_be_told_in_another_language(
    language: Language, message: m.NodeState, line: tuple[str, str]
) -> None:
    assert Timeline(language, marked).lines(message) == [line]


def test_actions_are_told_in_another_language_too(language: Language) -> None:
    timeline = Timeline(language, marked)
    walk = m.ActionRequest(id="1", robots=["NAO"], action="walk", args={"forward_m": 1})
    timeline.lines(walk)

    told = [timeline.lines(result(how)) for how in ("started", "cancelled", "failed")]

    walks = "[walks [1 m forward]]"
    assert told == [
        [("NAO", walks)],
        [("NAO", f"[no longer {walks}]")],
        [("NAO", "[failed to walk]")],
    ]


def test_the_end_of_a_node_is_told_once_in_each_of_its_lives(timeline: Timeline) -> None:
    def told(event: m.NodeEvent, description: str = "") -> int:
        state = m.NodeState(node="watch", type="sensory", event=event, description=description)
        return len(timeline.lines(state))

    assert [told("stopped"), told("alive"), told("stopped", "watch was stopped")] == [1, 0, 0]
    assert [told("ready"), told("stopped", "watch was stopped"), told("stopped")] == [1, 1, 0]


def test_who_takes_a_limb_from_an_action_is_told_by_name(timeline: Timeline) -> None:
    timeline.lines(say())
    timeline.lines(result("started"))
    made_way = m.ActionResult(
        id="1",
        robot="NAO",
        state="cancelled",
        code=m.DISPLACED,
        text="made way for “{by}”, which is more important",
        values={"by": "help"},
    )

    (told,) = timeline.lines(made_way)

    words = "no longer says “Hello”: it made way for “help”, which is more important"
    assert told == ("NAO", words)


def test_a_goal_that_cannot_be_reached_is_told(timeline: Timeline) -> None:
    failed = m.ProgramState(program="Test", event="goal_failed", rule="tour")

    assert [words for _, words in timeline.lines(failed)] == ["cannot reach the goal “tour”"]


def test_a_plan_is_told_with_its_steps(language: Language) -> None:
    plan = [m.PlannedStep("go_to", ["hall", 2]), m.PlannedStep("greet", ["Anna"])]
    failed = m.told(
        fault_of("The step “{step}” did not work: {reason}", step="greet", reason="No.")
    )
    told = [
        line
        for event, step, more in (
            ("plan_made", 0, {}),
            ("plan_step", 2, {}),
            ("plan_step", 9, {}),  # another program may tell of steps that are not there
            ("plan_step_failed", 2, failed),
            ("plan_done", 0, {}),
        )
        for line in Timeline(language).lines(
            m.ProgramState(program="p", event=event, rule="joy", plan=plan, step=step, **more)
        )
    ]
    empty = Timeline(language).lines(m.ProgramState(program="p", event="plan_made", rule="joy"))

    assert [words for _, words in told] == [
        "plans to reach “joy”: go to hall 2, greet Anna",
        "step 2 of 2: greet Anna",
        "step 2 of 2: greet Anna",
        "The step “greet” did not work: No.",
        "has followed its plan to “joy”",
    ]
    assert [words for _, words in empty] == ["need not plan: “joy” is true already"]
