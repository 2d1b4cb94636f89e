"""A diagnostic of a program as data: what is wrong, where, and what to do about it."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from faults import Words, fault_of

from ..language import Language
from ..program import Project
from ..text import sentence

Severity = Literal["error", "warning", "info"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
"""The worst first."""


@dataclass(frozen=True, slots=True)
class Fix:
    """Something that the studio can do about a problem: its name, its button, what it needs."""

    name: str
    label: Words
    data: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """What is wrong with a program.

    An ``error`` keeps the program from running, a ``warning`` does not, ``info`` is good to know.
    ``kind`` is the same for all problems of a sort; ``block`` is empty when no block is meant.
    """

    severity: Severity
    kind: str
    page: str
    block: str
    sentence: Words
    checklist: tuple[Words, ...] = ()
    fix: Fix | None = None


AT_FIRST = frozenset(("no_rule",))
"""What every program lacks at first, by kind: it is news to nobody who has just begun."""


def in_time(
    problems: Iterable[Diagnostic], made: Container[str], *, is_asked: bool
) -> list[Diagnostic]:
    """Those that are told while somebody works; ``made`` are the blocks that are just being made.

    What such a block lacks, the person is about to give it. Once somebody ``is_asked`` how it is,
    as by Run, the program is told of as a whole, too.
    """
    return [
        problem
        for problem in problems
        if problem.block not in made and (is_asked or problem.kind not in AT_FIRST)
    ]


Found = Iterator[Diagnostic | None]
"""What a check finds, one after the other; None wherever it may rest."""


@dataclass(frozen=True, slots=True)
class Sort:
    """What all diagnostics of a sort have in common; ``{block}`` is what their block says."""

    severity: Severity
    sentence: str
    checklist: tuple[str, ...]


SORTS = {
    "unknown_block": Sort(
        "error",
        "This version does not know the block “{type}”. It is kept as it is.",
        ("Update NEP Studio.", "Is a block pack missing?", "Or take the block out."),
    ),
    "unknown_own_block": Sort(
        "error",
        "This block belongs to an own block that is not like this any more.",
        ("Take it out, or put another block in its place.",),
    ),
    "wrong_page": Sort(
        "error", "This block belongs on the page {page}.", ("Move it to the page {page}.",)
    ),
    "loose_block": Sort(
        "info",
        "“{block}” is under no “when” block and will not run.",
        ("Drag it under a “when” block, or leave it here for later.",),
    ),
    "same_trigger": Sort(
        "warning",
        "Two rules begin with “{block}”. Both will run.",
        ("Put the blocks of both rules under one.", "Or let one wait for something else."),
    ),
    "same_goal": Sort(
        "error",
        "Two goals are called “{name}”.",
        ("Give each goal a name of its own.",),
    ),
    "unknown_goal": Sort(
        "warning",
        "There is no goal with the name “{name}”.",
        ("Write the name as the goal's own block has it.",),
    ),
    "unheard_message": Sort(
        "warning",
        "No rule begins when “{message}” is told.",
        ("Make a rule with “when … is told”.", "Or choose another message in this block."),
    ),
    "untold_message": Sort(
        "info",
        "Nothing tells “{message}” yet.",
        ("Put a “tell” block with this message into another rule.",),
    ),
    "unknown_rule": Sort(
        "error",
        "The rule that “{block}” stops is not there.",
        ("Choose a rule in this block.", "Or take this block out."),
    ),
    "outside_goal": Sort(
        "warning",
        "“{block}” is in no goal: when it is reached, the rule ends with an error.",
        ("Put it below the block of a goal, or below “when the goal …”.",),
    ),
    "no_fact": Sort(
        "error", "“{block}”: the fact has no name.", ("Write what is true, in words.",)
    ),
    "never_true": Sort(
        "warning",
        "“{block}” needs a fact that nothing makes true.",
        (
            "Write the name as in the block that makes it true, with as many values.",
            "Or say somewhere that it is now true.",
        ),
    ),
    "not_planned": Sort(
        "warning",
        "“{block}” is for plans, which look only directly under the “define” of an own block.",
        (
            "Move it there, out of other blocks.",
            "Or say with “it is now true” or “it is no longer true” what is so.",
        ),
    ),
    "same_tree": Sort(
        "error",
        "Two behaviour trees are called “{name}”.",
        ("Give each tree a name of its own.",),
    ),
    "unknown_tree": Sort(
        "error",
        "There is no behaviour tree with the name “{name}”.",
        ("Write the name as the tree's own block has it.",),
    ),
    "torn_apart": Sort(
        "warning",
        "“{block}” waits: what other rules do to “{variable}” meanwhile is lost.",
        ("Put what is waited for into a variable of its own first, then use that here.",),
    ),
    "grows_in_loop": Sort(
        "info",
        "“{block}” changes the list that the loop goes through. The loop still takes the items "
        "that there were when it began.",
        (
            "Is that meant? Then leave it as it is.",
            "To go on with what is added, use “while” and take the items out one by one.",
        ),
    ),
    # own blocks
    "defined_twice": Sort(
        "error",
        "The block “{own_block}” is defined twice.",
        ("Take one of the two definitions out.",),
    ),
    "gives_nothing": Sort(
        "warning",
        "“{own_block}” gives a value, but there is no “give back” block in it.",
        ("Put “give back” at its end.", "Or let the block give no value."),
    ),
    "no_definition": Sort(
        "error",
        "Nothing says what “{own_block}” does: its “define” block is on no page, or it "
        "is switched off.",
        ("Put its “define” block onto a page again.", "Or take this block out."),
    ),
    "calls_itself": Sort(
        "info",
        "“{own_block}” calls itself, at once or through another block.",
        ("Make sure that it comes to an end: some way through it must not call it.",),
    ),
    # how it runs
    "no_pause": Sort(
        "warning",
        "“{block}” never pauses: the computer would do nothing else.",
        ("Put a “wait” block inside.", "Or let the robot do something inside."),
    ),
    "never_reached": Sort(
        "warning",
        "“{block}” is never reached: it comes after “{block_2}”.",
        ("Move it above, or take it out.",),
    ),
    "not_standing": Sort(
        "warning",
        "{name} cannot walk after the posture “{label}”.",
        ("Let the robot stand first.",),
    ),
    "too_deep": Sort(
        "error",
        "Blocks are nested too deep here: {deepest_loop} loops, {deepest_indent} blocks or "
        "{deepest_value} values at most.",
        ("Take the inner blocks out into a rule of their own, or into a variable.",),
    ),
    # robots and nodes
    "same_name": Sort(
        "error", "Two parts of this project are called “{name}”.", ("Give each a name of its own.",)
    ),
    "robot_lacks": Sort(
        "error",
        "“{block}”: “{choice}” is not there for {robots}.",
        ("Choose another one.", "Or choose another robot in this block."),
    ),
    "needs_real_robot": Sort(
        "warning",
        "“{block}” needs a real robot: the program would stop here with the robot on this screen.",
        (
            "Give the robot the address of a real one, on the page Robots.",
            "Or switch this block off for now.",
        ),
    ),
    "gesture_unrecognised": Sort(
        "warning",
        "Nothing recognises the gesture “{gesture}” yet.",
        ("Teach it on the page Gestures.", "Or choose another gesture in this block."),
    ),
    "gesture_untrained": Sort(
        "warning",
        "The gesture “{title}” is not learned yet.",
        ("Record it five times on the page Gestures.", "Press Train there."),
    ),
}
"""By ``kind``, what is always told in the same words."""


def found(
    kind: str,
    project: Project,
    language: Language,
    block: str,
    fix: Fix | None = None,
    **values: Any,
) -> Diagnostic:
    """The diagnostic of a sort at a block; ``values`` fill the places of its sentence."""
    sort = SORTS[kind]
    if "{block}" in sort.sentence:
        values["block"] = sentence(project, language, block)
    told = fault_of(sort.sentence, checklist=sort.checklist, **values)
    page = project.page_of(block)
    return Diagnostic(sort.severity, kind, page, block, told.sentence, told.checklist, fix)
