"""What the commands share: a project read from its file, its problems and its code."""

from __future__ import annotations

import sys
from pathlib import Path

from nep_core.errors import NepError
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.files import load
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.problems import problem_of
from nep_studio.studio_language import studio_language

UNUSABLE = 2


def read_project(file: str) -> tuple[Project, Language]:
    """The project in ``file``, and the language it is read with; raises BlocksError."""
    language = studio_language()
    return load(Path(file), language), language


def print_utf8(text: str) -> None:
    """Print what another program reads: in UTF-8, whatever this terminal writes."""
    sys.stdout.flush()
    sys.stdout.buffer.write(text.encode())
    sys.stdout.buffer.flush()


def explain(error: NepError | BlocksError) -> None:
    """Tell a person what happened and what to do."""
    print(problem_of(error), file=sys.stderr)
