"""Checks of the Robots and Nodes pages against the rules: who is missing, who is there twice."""

from __future__ import annotations

from collections.abc import Iterator

from ..deployment import (
    gestures_used,
    is_recognised,
    node_entries,
    robot_entries,
    robots_used,
)
from ..language import Language
from ..own_gestures import own_gestures, trained_gestures
from ..program import ALL_ROBOTS, Project
from ..values import why_not_name
from .problem import Fix, Problem, page_of


def check_deployment(project: Project, language: Language) -> Iterator[Problem]:
    """Problems of which robots and nodes there are."""
    yield from _missing_robots(project, language)
    yield from _unrecognised_gestures(project, language)
    yield from _names(project, language)


def _missing_robots(project: Project, language: Language) -> Iterator[Problem]:
    listed = {entry.name for entry in robot_entries(project, language)}
    for name, block in robots_used(project, language).items():
        if name == ALL_ROBOTS and not listed:
            sentence = "There is no robot on the Robots page."
        elif name == ALL_ROBOTS or name in listed or not name.strip():
            continue
        else:
            sentence = f"{name} is not on the Robots page."
        robot = language.profile.title if name == ALL_ROBOTS else name
        yield Problem(
            "error",
            "robot_missing",
            page_of(project, block),
            block,
            sentence,
            ("Add the robot to the Robots page.", "Or choose another robot in this block."),
            Fix("add_robot", f"Add {robot}", {"name": robot}),
        )


def _unrecognised_gestures(project: Project, language: Language) -> Iterator[Problem]:
    nodes, shipped = node_entries(project, language), language.choices.get("gestures", {})
    own, trained = own_gestures(project), trained_gestures(project)
    for gesture, block in gestures_used(project, language).items():
        if gesture in own and gesture not in trained:
            yield _untrained(own[gesture].title, page_of(project, block), block)
        elif gesture in trained or not gesture.strip():
            continue  # the project's own recogniser is started with the program
        elif not is_recognised(gesture, nodes, shipped, trained):
            yield Problem(
                "warning",
                "gesture_unrecognised",
                page_of(project, block),
                block,
                f"No node of the Nodes page recognises the gesture “{gesture}”.",
                ("Launch a gesture node for it on the Nodes page.",),
                Fix("add_gesture_node", f"Recognise “{gesture}”", {"gesture": gesture}),
            )


def _untrained(title: str, page: str, block: str) -> Problem:
    return Problem(
        "warning",
        "gesture_untrained",
        page,
        block,
        f"The gesture “{title}” is not learned yet.",
        ("Record it five times in the panel Gestures.", "Press Train there."),
    )


def _names(project: Project, language: Language) -> Iterator[Problem]:
    """Robots are nodes too, so that all their names must differ."""
    robots = [("robots", e.name, e.block_id) for e in robot_entries(project, language)]
    nodes = [("nodes", e.name, e.block_id) for e in node_entries(project, language)]
    seen: set[str] = set()
    for page, name, block in [*robots, *nodes]:
        reason = why_not_name(name)
        if name == ALL_ROBOTS:
            reason = f"“{ALL_ROBOTS}” stands for all robots, and cannot be the name of one."
        if reason is not None:
            yield Problem("error", "bad_name", page, block, reason, ("Give it another name.",))
        elif name in seen:
            yield Problem(
                "error",
                "same_name",
                page,
                block,
                f"Two robots or nodes are called “{name}”.",
                ("Give each a name of its own.",),
            )
        seen.add(name)
