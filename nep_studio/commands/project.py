"""``nep-studio check FILE.nep``: what is not right yet, in plain words."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from nep_core.cli import node
from nep_core.cli.console import number
from nep_core.errors import NepError
from nep_studio.blocks import text
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.files import load
from nep_studio.blocks.generate.program import generate_launch, generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.problems import Problem, problem_of
from nep_studio.run.installation import all_problems, studio_language

# What the commands share: a project read from its file, its problems and its code.

UNUSABLE = 2


def read_project(file: str) -> tuple[Project, Language]:
    """The project in ``file``, and the language it is read with; raises BlocksError."""
    language = studio_language()
    return load(Path(file), language), language


def _parser(job: str, description: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=f"nep-studio {job}", description=description)
    parser.add_argument("file", metavar="FILE.nep")
    return parser


def print_utf8(text: str) -> None:
    """Print what another program reads: in UTF-8, whatever this terminal writes."""
    sys.stdout.flush()
    sys.stdout.buffer.write(text.encode())
    sys.stdout.buffer.flush()


def explain(error: NepError | BlocksError) -> None:
    """Tell a person what happened and what to do."""
    print(problem_of(error), file=sys.stderr)


SIGNS = {"error": "Error", "warning": "Warning", "info": "Note"}


def check(arguments: list[str]) -> int:
    """Print the problems; 0 when none keeps the program from running, 1 when one does."""
    parser = _parser("check", "Say in plain words what is not right in a project.")
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


def describe(problem: Diagnostic, project: Project, language: Language) -> str:
    """A problem with the place of its block and its checklist."""
    place = ""
    if problem.block:
        block = text.sentence(project, language, problem.block)
        place = f"“{block}” on the page {problem.page.capitalize()}"
    sentence = f"{SIGNS[problem.severity]}: {problem.sentence}"
    return str(Problem(sentence, checklist=problem.checklist, place=place))


# ``nep-studio code FILE.nep``: the Python that the blocks make.


def code(arguments: list[str]) -> int:
    """Print the code; 2 when the project cannot be used."""
    parser = _parser("code", "Print the Python that a project's blocks make.")
    told = "print what the Robots and Nodes pages start"
    parser.add_argument("--nodes", action="store_true", help=told)
    options = parser.parse_args(arguments)
    try:
        project, language = read_project(options.file)
        generate = generate_launch if options.nodes else generate_program
        print_utf8(generate(project, language).text)
    except BlocksError as error:
        explain(error)
        return UNUSABLE
    return 0


# ``nep-studio exec PROGRAM.py``: run a program as a cognitive node.


def execute(arguments: list[str]) -> int:
    """Run the program until it ends; 1 when it fails."""
    parser = argparse.ArgumentParser(
        prog="nep-studio exec",
        description="Run a Python program, made from blocks or by hand, as a cognitive node.",
    )
    parser.add_argument("program", metavar="PROGRAM.py")
    parser.add_argument("--name", default="program", help="its name in the network")
    options = parser.parse_args(arguments)
    return node.main(["cognitive/program", f"--name={options.name}", f"file={options.program}"])


# Kinds of arguments that several commands take.

SLOWEST, FASTEST = 0.1, 50


def speed(word: str) -> float:
    """How many times as fast something goes, for argparse; raises ArgumentTypeError."""
    return number(word, SLOWEST, FASTEST)
