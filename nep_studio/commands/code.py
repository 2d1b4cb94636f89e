"""``nep-studio code FILE.nep``: the Python that the blocks make."""

from __future__ import annotations

import argparse

from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.launch import generate_launch
from nep_studio.blocks.generate.program import generate_program
from nep_studio.commands.project import UNUSABLE, explain, print_utf8, read_project


def main(arguments: list[str]) -> int:
    """Print the code; 2 when the project cannot be used."""
    options = _parser().parse_args(arguments)
    try:
        project, language = read_project(options.file)
        generate = generate_launch if options.nodes else generate_program
        print_utf8(generate(project, language).text)
    except BlocksError as error:
        explain(error)
        return UNUSABLE
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="nep-studio code", description="Print the Python that a project's blocks make."
    )
    parser.add_argument("file", metavar="FILE.nep")
    parser.add_argument(
        "--nodes", action="store_true", help="print what the Robots and Nodes pages start"
    )
    return parser
