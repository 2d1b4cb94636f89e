"""Checks of what the robot on the screen cannot do: it has no camera and no files."""

from __future__ import annotations

from collections.abc import Iterator

from ..deployment import robot_entries, rules
from ..language import Language
from ..program import ALL_ROBOTS, Project
from ..text import sentence
from .problem import Problem


def check_real_robots(project: Project, language: Language) -> Iterator[Problem]:
    """Blocks that need a real robot, and name a virtual one."""
    virtual = {e.name for e in robot_entries(project, language) if e.driver == "virtual"}
    for chain in rules(project, language):
        for block in project.within(chain, enabled=True):
            definition = language.definitions.get(block.type)
            if definition is None or "needs_real_robot" not in definition.flags:
                continue
            robot = str(definition.value(block, "robot"))
            if robot not in virtual and not (robot == ALL_ROBOTS and virtual):
                continue
            yield Problem(
                "warning",
                "needs_real_robot",
                "behaviour",
                block.id,
                f"“{sentence(project, language, block.id)}” needs a real robot: "
                "the program would stop here with the robot on this screen.",
                (
                    "Give the robot the address of a real one, on the page Robots.",
                    "Or switch this block off for now.",
                ),
            )
