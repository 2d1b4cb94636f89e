"""The robot developer's command line: ``nep master``, ``nep echo /imu``, ``nep record FILE``.

Enters what a person types in a terminal and what is printed for it, a module for each group of
commands; ``lessons`` has the examples, which tests run. How a network works is in ``networks``;
nobody but the program ``nep`` imports this.
"""

from __future__ import annotations

import argparse
import io
import logging
import os
import signal
import sys
import traceback
from importlib import import_module
from typing import NoReturn

from faults import FaultError
from faults.files import write_whole
from nep_core.cli.lessons import EXIT_CODES, FIRST_STEPS, LESSONS
from nep_core.errors import NepError
from nep_core.places import log_folder, private_folder
from nep_core.processes.handover import hand_over

from .console import near, only_visible

COMMANDS = {
    "master": ("services", "run the NEP Master, the name server of the network"),
    "broker": ("services", "run the central service of the broker network"),
    "open": ("pair", "run a master that paired computers of your network reach too"),
    "pair": ("pair", "let this computer take part in the open network of another one"),
    "find": ("pair", "which open networks there are around"),
    "computers": ("pair", "which computers an open network lets in"),
    "launch": ("talk", "start a node, and stop it with Ctrl-C"),
    "kill": ("kill", "ask a node to stop, and wait until it is gone"),
    "topics": ("look", "which topics there are, and who publishes and hears them"),
    "nodes": ("look", "which nodes there are, and how they are doing"),
    "graph": ("look", "who is connected with whom, as text or for Graphviz"),
    "echo": ("listen", "print the messages of a topic"),
    "hz": ("listen", "how often, how evenly and how much comes on a topic"),
    "send": ("talk", "send messages on a topic"),
    "record": ("record", "record topics into an MCAP file"),
    "play": ("record", "play a recording in its true timing"),
    "doctor": ("doctor", "check this computer for NEP, with what to do"),
}

GROUPS = {
    "Run a network": ("master", "broker", "launch", "kill"),
    "Several computers": ("open", "pair", "find", "computers"),
    "Look around": ("topics", "nodes", "graph", "doctor"),
    "Messages": ("echo", "hz", "send"),
    "Recordings": ("record", "play"),
}
"""How the list of commands is ordered."""

ASK_NO_MASTER = ("master", "broker", "open", "pair", "find", "computers")
"""Commands that take --master, as all do, but have no use for it."""

WRONG_USE = 2


class Parser(argparse.ArgumentParser):
    """Tells what is wrong with the words after ``nep``, and what may have been meant."""

    def error(self, message: str) -> NoReturn:
        """End with a sentence instead of the whole usage."""
        print(f"{message[:1].upper()}{message[1:]}.\nHelp: {self.prog} --help", file=sys.stderr)
        sys.exit(WRONG_USE)


def main(arguments: list[str] | None = None) -> int:
    """The command ``nep``; the exit code. A closed pipe and Ctrl-C end it quietly."""
    # Let a command that was started without a standard stream (``nep topics >&-``) work too
    if sys.stdin is None:
        sys.stdin = open(os.devnull, encoding="utf-8")  # noqa: SIM115  as long as the program
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
    # Messages hold any letter, whatever this terminal's language is
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            errors = "replace" if stream is sys.stdin else "backslashreplace"
            stream.reconfigure(encoding="utf-8", errors=errors)
    try:
        try:
            with only_visible():
                return _main(arguments)
        finally:
            sys.stdout.flush()
    except BrokenPipeError:  # the reader has seen enough, as in `nep echo /imu | head -1`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _main(arguments: list[str] | None) -> int:
    parser = Parser(prog="nep", add_help=False)
    parser.add_argument("--help", "-h", action="store_true")
    parser.add_argument("--version", action="store_true")
    parser.add_argument("--master")
    parser.add_argument("command", nargs="?")
    parser.add_argument("rest", nargs=argparse.REMAINDER)
    given = parser.parse_args(arguments)
    if given.command is None:
        print(f"nep {_version()}" if given.version else overview())
        return 0
    if given.command not in COMMANDS:
        meant = near(given.command, COMMANDS)[:1]
        hint = f" Did you mean: nep {meant[0]}?" if meant else ""
        print(f'There is no command "{given.command}".{hint}\nHelp: nep', file=sys.stderr)
        return WRONG_USE
    words = ["--help"] if given.help else given.rest
    return run_command(parse(given.command, words, given.master))


def _version() -> str:
    from importlib import metadata  # here: commands start fast

    try:
        return metadata.version("nep-studio")
    except metadata.PackageNotFoundError:  # run from a folder that was not installed
        return "of unknown version"


def overview() -> str:
    """All commands in their groups, a line each, and how to begin."""
    lines = ["Look at a NEP network and take part in it.", "", "nep COMMAND [OPTIONS]", ""]
    width = max(map(len, COMMANDS))
    for title, names in GROUPS.items():
        lines += [title, *(f"  {name:{width}} {COMMANDS[name][1]}" for name in names), ""]
    return "\n".join([*lines, FIRST_STEPS])


def parser_of(command: str) -> Parser:
    """What a command takes, with the help that teaches it."""
    module, line = COMMANDS[command]
    lesson = LESSONS.get(command)
    parser = Parser(
        prog=f"nep {command}",
        description=lesson.text if lesson else f"{line[:1].upper()}{line[1:]}.",
        epilog=f"{lesson.epilog}\n\n{EXIT_CODES}" if lesson else EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    import_module(f"nep_core.cli.{module}").add_arguments(command, parser)
    parser.add_argument(
        "--master",
        default=argparse.SUPPRESS,
        metavar="ENDPOINT",
        help=argparse.SUPPRESS
        if command in ASK_NO_MASTER
        else "where the master is (default: NEP_MASTER, else tcp://127.0.0.1:7100)",
    )
    parser.set_defaults(command=command)
    return parser


def parse(command: str, words: list[str], master: str | None = None) -> argparse.Namespace:
    """The options of a command; ends the program with a sentence when they are wrong."""
    parser = parser_of(command)
    start = argparse.Namespace(master=master)
    if any(action.nargs == "*" for action in parser._actions):
        options, unknown = parser.parse_known_intermixed_args(words, start)
    else:
        options, unknown = parser.parse_known_args(words, start)
    if unknown:
        known = [name for action in parser._actions for name in action.option_strings]
        meant = near(unknown[0].partition("=")[0], known) if unknown[0].startswith("-") else []
        hint = f" (did you mean {meant[0]}?)" if meant else ""
        parser.error(f'"{unknown[0]}" is not understood{hint}')
    return options


def run_command(options: argparse.Namespace) -> int:
    """Run a parsed command; errors become sentences."""
    logging.basicConfig(level=logging.WARNING, format="%(message)s")
    module = import_module(f"nep_core.cli.{COMMANDS[options.command][0]}")
    on_ctrl_c = signal.getsignal(signal.SIGINT)
    try:
        return int(module.run(options))
    except NepError as error:
        hand_over(error.fault)
        print(explain(error), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    except BrokenPipeError:
        raise  # main() knows
    except Exception as error:  # the last resort: a mistake of ours is told, and kept for us
        print(_explain_mistake(error), file=sys.stderr)
        return 1
    finally:
        if signal.getsignal(signal.SIGINT) is not on_ctrl_c:
            signal.signal(signal.SIGINT, on_ctrl_c)


def explain(error: NepError) -> str:
    """An error as text: its title, its sentence and its checklist."""
    return "\n".join([error.title, str(error), *steps_of(error)])


def steps_of(error: FaultError) -> list[str]:
    """What to try, as lines for a person at a terminal."""
    return [f"  [ ] {step}" for step in error.checklist]


def _explain_mistake(error: Exception) -> str:
    path = log_folder() / "nep-command.log"
    try:
        private_folder(path.parent)
        write_whole(path, "".join(traceback.format_exception(error)), is_private=True)
        kept = f"Details are in {path}"
    except OSError:
        kept = "Details could not be kept"
    return (
        f"Something went wrong inside the command ({type(error).__name__}: {error}).\n"
        f"{kept}; please send them to the authors of NEP Studio."
    )
