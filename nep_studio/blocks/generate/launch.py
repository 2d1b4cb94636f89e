"""The Robots and Nodes pages as Python: the launcher starts each of them."""

from __future__ import annotations

import ast

from ..deployment import NodeEntry, RobotEntry, node_entries, robot_entries
from ..language import Language
from ..program import Project
from ..values import Setting
from .nodes import constant, method_call
from .printing import show
from .source_map import Code


def generate_launch(project: Project, language: Language) -> Code:
    """The Python that starts the robots and the nodes of a project."""
    lines = ["from nep_core import Launcher", "", "launcher = Launcher()"]
    blocks = [""] * len(lines)
    for robot in robot_entries(project, language):
        lines.append(_start(language.profile.node, robot.name, _robot_settings(robot)))
        blocks.append(robot.block_id)
    for node in node_entries(project, language):
        lines.append(_start(node.node, node.name, _node_settings(node)))
        blocks.append(node.block_id)
    return Code("\n".join(lines) + "\n", tuple(blocks))


def _robot_settings(robot: RobotEntry) -> dict[str, Setting]:
    settings = {"robot": robot.name, "driver": robot.driver, "address": robot.address}
    return {**settings, "model": robot.model} if robot.model else {**settings}


def _node_settings(node: NodeEntry) -> dict[str, Setting]:
    return dict(node.parameters)


def _start(node: str, name: str, settings: dict[str, Setting]) -> str:
    keywords = {key: constant(value) for key, value in {"name": name, **settings}.items()}
    start = method_call(ast.Name("launcher"), "start", [ast.Constant(node)], keywords)
    return show(start)
