"""The one program with several jobs; the first word chooses, and only that job is loaded."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module

JOBS = {
    "run": "nep_studio.commands.run:main",
    "code": "nep_studio.commands.code:main",
    "check": "nep_studio.commands.check:main",
    "node": "nep_core.cli.node:main",
    "exec": "nep_studio.commands.execute:main",
    "train": "nodes.perceptual.recognition.command:main",
    "master": "nep_core.cli.services:run_master",
}

USAGE = """NEP Studio: give a social robot its behaviour with blocks.

  nep-studio run FILE.nep      play a project, on the robots on the screen unless it names others
  nep-studio code FILE.nep     the Python that the blocks make
  nep-studio check FILE.nep    what is not right yet, in plain words
  nep-studio exec PROGRAM.py   run a Python program as a cognitive node
  nep-studio node TYPE/NAME    run one node in this terminal
  nep-studio train DIRECTORY   learn gestures from recordings

Each of them explains itself with --help. For robot developers there is also: nep --help
"""

NO_WINDOW = """NEP Studio has no window yet: this version plays projects in the terminal. Try

  nep-studio run {example}

"""


def main(arguments: list[str] | None = None) -> int:
    """Do the job that the first word names; the exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    if words and words[0] in JOBS:
        return _load(JOBS[words[0]])(words[1:])
    if words and words[0] in ("-h", "--help", "help"):
        print(USAGE)
        return 0
    if words and words[0] == "--version":
        from nep_studio import __version__

        print(f"NEP Studio {__version__}")
        return 0
    from nep_studio import paths

    if words and not words[0].endswith(".nep"):
        print(f'"{words[0]}" is not something that nep-studio can do.\n', file=sys.stderr)
    example = words[0] if words and words[0].endswith(".nep") else _example(paths.examples())
    print(NO_WINDOW.format(example=example) + USAGE, file=sys.stderr)
    return 2


def _example(folder: object) -> str:
    return f"{folder}/karate_greeting.nep"


def _load(place: str) -> Callable[[list[str]], int]:
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)  # type: ignore[no-any-return]


if __name__ == "__main__":
    sys.exit(main())
