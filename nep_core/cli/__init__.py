"""The robot developer's command line: ``nep master``, ``nep echo /imu``, ``nep launch ...``."""

from __future__ import annotations

import argparse
import logging
import sys
from importlib import import_module

from nep_core.errors import NepError

COMMANDS = {
    "master": ("services", "run the NEP Master, the name server of the network"),
    "broker": ("services", "run the central service of the broker network"),
    "topics": ("look", "which topics there are, and who publishes and hears them"),
    "nodes": ("look", "which nodes there are"),
    "echo": ("look", "print the messages of a topic"),
    "hz": ("look", "how often a topic's messages come"),
    "send": ("talk", "send one message on a topic"),
    "launch": ("talk", "start a node, and stop it with Ctrl-C"),
    "doctor": ("doctor", "what this computer has, and what is missing"),
}


def main(arguments: list[str] | None = None) -> int:
    """The command ``nep``; the exit code."""
    parser = argparse.ArgumentParser(
        prog="nep", description="Look at a NEP network and take part in it."
    )
    parser.add_argument(
        "--master", help="the master's endpoint (default: NEP_MASTER, or port 7100)"
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (module, help_text) in COMMANDS.items():
        command = commands.add_parser(name, help=help_text, description=help_text)
        import_module(f"nep_core.cli.{module}").add_arguments(name, command)
    return run_command(parser.parse_args(arguments))


def run_command(options: argparse.Namespace) -> int:
    """Run a parsed command; errors become sentences, Ctrl-C ends quietly."""
    logging.basicConfig(level=logging.WARNING, format="%(message)s")
    module = import_module(f"nep_core.cli.{COMMANDS[options.command][0]}")
    try:
        return int(module.run(options))
    except NepError as error:
        print(explain(error), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0


def explain(error: NepError) -> str:
    """An error as text: its title, its sentence and its checklist."""
    steps = [f"  [ ] {step}" for step in error.checklist]
    return "\n".join([error.title, error.sentence, *steps])
