"""A project as a Python file that runs outside the studio, and says at its top how."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.plan import Choices, PlannedNode, plan
from nep_studio.problems import on_one_line

SUFFIX = ".py"


def python_file(
    project: Project, language: Language, folder: Path, file_name: str = "program.py"
) -> str:
    """The program with its comment; ``folder`` is the project's. Raises CodeRefused."""
    code = generate_program(project, language).text
    nodes = plan(project, language, Choices(), folder)
    return "\n".join([*_how_to_run(nodes, file_name), "", code])


def _how_to_run(nodes: list[PlannedNode], file_name: str) -> list[str]:
    """The comment: commands that can be copied, each for a terminal of its own."""
    file = _word(file_name)
    sensors = [node for node in nodes if node.is_sensory]  # last: nothing they say is missed
    others = [node for node in nodes if not node.is_sensory]
    program = f"nep-studio exec {file}"
    commands = ["nep-studio master", *map(_command, others), program, *map(_command, sensors)]
    told = [
        "To run this program, give each of these commands in a terminal of its own:",
        *(f"  {command}" for command in commands),
        f"Instead of nep-studio exec, any Python that has nep_core will do: python {file}",
    ]
    return [f"# {on_one_line(line)}" for line in told]


def _command(node: PlannedNode) -> str:
    settings = (f"{key}={_text(value)}" for key, value in node.parameters.items() if value != "")
    words = [node.node, f"--name={node.name}", *settings]
    return f"nep-studio node {' '.join(map(_word, words))}"


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _word(text: str) -> str:
    """A word as this computer's terminal takes it."""
    if os.name == "nt":
        return f'"{text}"' if " " in text else text
    return shlex.quote(text)
