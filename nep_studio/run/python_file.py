"""A project as a Python file that runs outside the studio, and says at its top how."""

from __future__ import annotations

import os
import shlex
from dataclasses import replace
from pathlib import Path

from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.problems import on_one_line

from .plan import Choices, PlannedNode, Setting, plan

SUFFIX = ".py"


def python_file(
    project: Project, language: Language, folder: Path, file_name: str = "program.py"
) -> str:
    """The program with its comment; ``folder`` is the project's. Raises CodeRefused.

    What its nodes read of the project is meant to be beside it: see ``write_kept``.
    """
    code = generate_program(project, language).text
    kept = _kept_folder(file_name)
    choices = Choices(by_itself=True)
    nodes = [_moved(node, kept) for node in plan(project, language, choices, folder)]
    # The comment: commands that can be copied, each for a terminal of its own
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
    return "\n".join([*[f"# {on_one_line(line)}" for line in told], "", code])


def write_kept(project: Project, language: Language, path: Path) -> None:
    """Write what the nodes read of a project beside its Python file. Raises OSError."""
    kept = path.parent / _kept_folder(path.name)
    for node in plan(project, language, Choices(), path.parent):
        if node.files is not None:
            replace(node.files, folder=kept / node.files.folder.name).write()


def _kept_folder(file_name: str) -> Path:
    return Path(f"{Path(file_name).stem}_files")


def _moved(node: PlannedNode, kept: Path) -> PlannedNode:
    """A node that reads its files in another folder; others as they are."""
    if node.files is None:
        return node
    old = node.files.folder
    settings = {key: _elsewhere(value, old, kept) for key, value in node.parameters.items()}
    return replace(node, parameters=settings)


def _elsewhere(value: Setting, old: Path, kept: Path) -> Setting:
    if not isinstance(value, str) or not value or not Path(value).is_relative_to(old):
        return value
    return str(kept / old.name / Path(value).relative_to(old))


def _command(node: PlannedNode) -> str:
    words = [node.node, f"--name={node.name}"]
    for key, value in node.parameters.items():
        if value != "":
            words.append(f"{key}={str(value).lower() if isinstance(value, bool) else value}")
    return f"nep-studio node {' '.join(map(_word, words))}"


def _word(text: str) -> str:
    """A word as this computer's terminal takes it."""
    if os.name == "nt":
        return f'"{text}"' if " " in text else text
    return shlex.quote(text)
