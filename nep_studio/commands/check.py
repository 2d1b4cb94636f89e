"""``nep-studio check FILE.nep``: what is not right yet, in plain words."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from nep_studio import problems as told
from nep_studio.blocks import text
from nep_studio.blocks.checks import Problem
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.commands.project import UNUSABLE, explain, read_project
from nep_studio.node_checks import all_problems

SIGNS = {"error": "Error", "warning": "Warning", "info": "Note"}


def main(arguments: list[str]) -> int:
    """Print the problems; 0 when none keeps the program from running, 1 when one does."""
    parser = argparse.ArgumentParser(
        prog="nep-studio check", description="Say in plain words what is not right in a project."
    )
    parser.add_argument("file", metavar="FILE.nep")
    options = parser.parse_args(arguments)
    try:
        project, language = read_project(options.file)
    except BlocksError as error:
        explain(error)
        return UNUSABLE
    problems = all_problems(project, language, Path(options.file).resolve().parent)
    for problem in problems:
        print(describe(problem, project, language))
    if not problems:
        print("Nothing to correct.")
    return 1 if any(problem.severity == "error" for problem in problems) else 0


def describe(problem: Problem, project: Project, language: Language) -> str:
    """A problem with the place of its block and its checklist."""
    place = ""
    if problem.block:
        block = text.sentence(project, language, problem.block)
        place = f"“{block}” on the page {problem.page.capitalize()}"
    sentence = f"{SIGNS[problem.severity]}: {problem.sentence}"
    return str(told.Problem(sentence, checklist=problem.checklist, place=place))


def tell_errors(project: Project, language: Language, folder: Path) -> bool:
    """Print the problems that keep a program from running; whether there are any."""
    errors = [p for p in all_problems(project, language, folder) if p.severity == "error"]
    for problem in errors:
        print(describe(problem, project, language), file=sys.stderr)
    return bool(errors)
