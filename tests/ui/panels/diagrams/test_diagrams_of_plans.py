"""Plans as chains of own blocks: drawn when they are made, and how far they are."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from nep_core.wire import messages as m
from nep_core.wire.messages import PlannedStep, ProgramState
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.plugins.diagrams.panel import DiagramPage
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B, build
from tests.ui.panels.diagrams.conftest import GREET

STEPS = [PlannedStep("bring_cups", ["kitchen", 2]), PlannedStep("turn_on", [])]
GOAL = "at kitchen"

Tell = Callable[..., dict[str, str]]


@pytest.fixture
def page(draw: Callable[..., DiagramPage], window: MainWindow) -> DiagramPage:
    """The panel beside a program with the own blocks “bring … cups to …” and “turn on”."""
    page = draw(*GREET)
    editor = window.workbench.canvas.editor
    place, cups = editor.new_parameter("place", "text"), editor.new_parameter("cups", "number")
    bring = editor.add_procedure(["bring", place, cups, "cups"])
    turn_on = editor.add_procedure(["turn on"])
    build(editor.language, [B(f"my.define.{bring}")], [B(f"my.define.{turn_on}")], editor=editor)
    return page


@pytest.fixture
def tell(page: DiagramPage, window: MainWindow) -> Tell:
    """Tells of the plan as a program does, and gives what is shown of its steps."""
    editor, stage = window.workbench.canvas.editor, window.running.stage
    stage.begin(generate_program(editor.project, editor.language))

    def arrive(event: str, step: int = 0, steps: list[PlannedStep] = STEPS) -> dict[str, str]:
        told = ProgramState(program="x", event=event, rule=GOAL, plan=steps, step=step)
        window.running.runner.arrived.emit([(m.PROGRAM_STATE, told)])
        plan = page.choice.findText(f"Plan: {GOAL}")
        if plan >= 0 and page.choice.currentIndex() != plan:
            page.choice.setCurrentIndex(plan)
            page.choice.activated.emit(plan)
        return dict(page.view.statuses)

    return arrive


def test_a_plan_is_drawn_as_its_blocks_before_it_is_followed(
    page: DiagramPage, tell: Tell, window: MainWindow
) -> None:
    statuses = tell("plan_made")

    items = page.view.diagram.items
    assert [page.choice.itemText(n) for n in range(2)] == ["Tree: greet", f"Plan: {GOAL}"]
    assert [(item.title, item.small) for item in items] == [
        ("bring kitchen 2 cups", "1 / 2"),
        ("turn on", "2 / 2"),
        (GOAL, ""),
    ]
    assert statuses == {}
    project = window.workbench.canvas.editor.project
    assert [project.blocks[item.block].type[:10] for item in items[:2]] == ["my.define."] * 2


def test_what_is_done_of_it_and_what_is_being_done_is_shown(tell: Tell) -> None:
    seen = [tell("plan_made"), tell("plan_step", 1), tell("plan_step", 2), tell("plan_done")]

    assert seen == [
        {},
        {"1": "running"},
        {"1": "succeeded", "2": "running"},
        {"1": "succeeded", "2": "succeeded", "goal": "succeeded"},
    ]


def test_a_step_that_fails_is_shown_until_there_is_a_new_plan(
    page: DiagramPage, tell: Tell
) -> None:
    failed = tell("plan_step_failed", 1)
    again = tell("plan_made", 0, [PlannedStep("turn_on", [])])

    assert failed == {"1": "failed"}
    assert again == {}
    assert [item.title for item in page.view.diagram.items] == ["turn on", GOAL]


def test_nothing_is_being_done_when_the_program_has_ended(
    page: DiagramPage, tell: Tell, window: MainWindow
) -> None:
    tell("plan_step", 2)
    ended = ProgramState(program="x", event="finished")
    window.running.runner.arrived.emit([(m.PROGRAM_STATE, ended)])

    assert page.view.statuses == {"1": "succeeded"}


def test_what_is_true_already_has_no_plan(page: DiagramPage, tell: Tell) -> None:
    tell("plan_made", 0, [])

    assert page.choice.count() == 1


def test_a_step_whose_block_is_gone_is_told_by_its_name(
    page: DiagramPage, tell: Tell, window: MainWindow
) -> None:
    tell("plan_made", 0, [PlannedStep("go_home", ["hall"])])

    assert page.view.diagram.items[0].title == "go home hall"
    page.view.open(("box", "1"))  # has no block to show
    assert page.view.words_of(("box", "1")) == "go home hall\n1 / 1"


def test_plans_are_there_without_states_or_trees(draw, window: MainWindow) -> None:
    page = draw([B("event.started")])
    before = page.views.currentWidget() is page.empty
    editor = window.workbench.canvas.editor
    window.running.stage.begin(generate_program(editor.project, editor.language))
    told = ProgramState(program="x", event="plan_made", rule=GOAL, plan=STEPS)
    window.running.runner.arrived.emit([(m.PROGRAM_STATE, told)])

    assert before
    assert page.views.currentWidget() is page.view
    assert page.diagram is not None and page.diagram.kind == "plan"
