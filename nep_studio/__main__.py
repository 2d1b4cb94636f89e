"""The one program with several jobs; the first word chooses, and only that job is loaded."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Mapping
from importlib import import_module

JOBS = {
    "run": "nep_studio.commands.run:main",
    "show": "nep_studio.ui.shell.show_command:main",
    "code": "nep_studio.commands.project:code",
    "check": "nep_studio.commands.project:check",
    "doctor": "nep_studio.support.report:main",
    "doctor-screen": "nep_studio.ui.shell.screen_report:main",
    "node": "nep_core.cli.node:main",
    "guard": "nep_core.processes.guard:main",
    "naoqi": "nep_studio.commands.naoqi:main",
    "exec": "nep_studio.commands.project:execute",
    "train": "nodes.perceptual.recognition.command:main",
    "train-worker": "nodes.perceptual.recognition.worker:main",
    "master": "nep_core.cli.services:run_master",
    "nep": "nep_core.cli:main",
    "picture": "nep_studio.ui.shell.window_picture:main",
}

WINDOW = "nep_studio.ui.shell.app:main"
ON_A_SCREEN = ("show", "picture")
"""The jobs that need a display, as the window does."""

USAGE = """NEP Studio: give a social robot its behaviour with blocks.

  nep-studio [FILE.nep]        the window, with a project
  nep-studio show FILE.nep     show mode: a project on the whole screen, for a public
  nep-studio run FILE.nep      play a project, on the robots on the screen unless it names others
  nep-studio code FILE.nep     the Python that the blocks make
  nep-studio check FILE.nep    what is not right yet, in plain words
  nep-studio naoqi             offer a NAO on the screen to programs made for a real one
  nep-studio exec PROGRAM.py   run a Python program as a cognitive node
  nep-studio node TYPE/NAME    run one node in this terminal
  nep-studio train DIRECTORY   learn gestures from recordings
  nep-studio doctor            what to look at when something is wrong, as a report to send

  nep-studio --safe-mode       the window without your settings and own nodes
  nep-studio --portable        keep everything in a folder beside the program, as on a stick

Each of them explains itself with --help. For robot developers there is also: nep --help
"""

NO_WINDOW = """NEP Studio needs a display for its window, and there is none here. In a terminal, try

  nep-studio run {example}

"""


FAILED = 1
UNUSABLE = 2
INTERRUPTED = 130
"""The exit code after Ctrl-C, by the shells' custom."""


def main(arguments: list[str] | None = None) -> int:
    """Do the job that the first word names; the exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    try:
        # Let a letter that the terminal does not have become "?"
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="replace")
        try:
            return _do(_begin(words))
        finally:
            _flush()  # here, and not at the very end, an error can be told
    except KeyboardInterrupt:
        return INTERRUPTED
    except OSError as error:
        if words[:1] == ["node"]:
            raise  # a fault of the node: its log shows where
        # Let what cannot be written go nowhere: Python would try again, and fail, at its end
        try:
            _flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _tell(error)


def _begin(words: list[str]) -> list[str]:
    """Choose where things are kept, and what is left out; the words without the options of that."""
    from .support import portable, safe_mode

    options = set()
    while words and words[0] in (portable.OPTION, safe_mode.OPTION):
        options.add(words[0])
        words = words[1:]
    if words and _is_project(words[0]):  # of the window, where they may also come last
        options |= {*words} & {portable.OPTION, safe_mode.OPTION}
        words = [word for word in words if word not in options]
    portable.begin(is_asked=portable.OPTION in options)
    if safe_mode.OPTION in options:
        safe_mode.begin()
    return words


def _do(words: list[str]) -> int:
    has_display = _has_display(os.environ, sys.platform)
    if words and words[0] in JOBS and (has_display or words[0] not in ON_A_SCREEN):
        return _load(JOBS[words[0]])(words[1:])
    if words and words[0] in ("-h", "--help", "help"):
        print(USAGE)
        return 0
    if words and words[0] == "--version":
        from nep_studio import __version__

        print(f"NEP Studio {__version__}")
        return 0
    from nep_studio import paths

    if words and not _is_project(words[0]) and words[0] not in ON_A_SCREEN:
        print(f'"{words[0]}" is not something that nep-studio can do.\n', file=sys.stderr)
        print(USAGE, file=sys.stderr)
        return UNUSABLE
    if has_display:
        return _load(WINDOW)(words)
    files = [word for word in words if _is_project(word)]
    example = files[0] if files else f"{paths.examples()}/karate_greeting.nep"
    print(NO_WINDOW.format(example=example) + USAGE, file=sys.stderr)
    return UNUSABLE


def _is_project(word: str) -> bool:
    return word.lower().endswith(".nep")


def _has_display(environment: Mapping[str, str], system: str) -> bool:
    """Whether a window can be shown, as far as can be told without Qt."""
    if not system.startswith(("linux", "freebsd")):
        return True
    return any(environment.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"))


def _flush() -> None:
    print(end="", flush=True)  # also where there is no output


def _tell(error: OSError) -> int:
    if isinstance(error, BrokenPipeError):
        return FAILED  # whoever read us has gone, as "head" does: nobody misses anything
    from nep_studio.problems import Problem

    where = f" ({error.filename})" if error.filename else ""
    checklist = ("Is there room on the disk?", "May this program write there?")
    sentence = f"The computer says: {error.strerror or error}{where}."
    print(Problem("A file could not be read or written", sentence, checklist), file=sys.stderr)
    return FAILED


def _load(place: str) -> Callable[[list[str]], int]:
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)  # type: ignore[no-any-return]


if __name__ == "__main__":
    sys.exit(main())
