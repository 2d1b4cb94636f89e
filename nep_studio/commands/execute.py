"""``nep-studio exec PROGRAM.py``: run a program as a cognitive node."""

from __future__ import annotations

import argparse

from nep_core.cli import node


def main(arguments: list[str]) -> int:
    """Run the program until it ends; 1 when it fails."""
    parser = argparse.ArgumentParser(
        prog="nep-studio exec",
        description="Run a Python program, made from blocks or by hand, as a cognitive node.",
    )
    parser.add_argument("program", metavar="PROGRAM.py")
    parser.add_argument("--name", default="program", help="its name in the network")
    options = parser.parse_args(arguments)
    return node.main(["cognitive/program", f"--name={options.name}", f"file={options.program}"])
