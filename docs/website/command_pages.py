"""The page of all commands, from what they themselves say to ``--help``."""

from __future__ import annotations

import contextlib
import io
import os
import re
from html import escape

from nep_core.cli import overview
from nep_studio.__main__ import USAGE, main

from .page import HERE, Page

PATH = "commands.html"
ABOUT = "What can be done in a terminal: every command, with what it says about itself."
COLUMNS = "80"
_JOB = re.compile(r"^  nep-studio (\w+)", re.M)


def commands_page() -> Page:
    """Every job of ``nep-studio`` with its help; those of ``nep`` have a page of their own."""
    parts = [
        '<h1 id="top">Commands</h1>',
        f"<p>{ABOUT}</p>",
        '<h2 id="nep-studio">nep-studio</h2>',
        _shown(USAGE),
    ]
    for job in jobs():
        parts += [f'<h3 id="{job}">nep-studio {job}</h3>', _shown(help_of(job))]
    parts += [
        '<h2 id="nep">nep</h2>',
        f'<p>For robot developers; <a href="{HERE}developers/command_line.html">the command line '
        "nep</a> has each command with examples.</p>",
        _shown(overview()),
    ]
    return Page(PATH, "Commands", "\n".join(parts), "commands", about=ABOUT)


def jobs() -> list[str]:
    """What ``nep-studio`` can do, as it says itself; jobs that only it asks for are not told."""
    return _JOB.findall(USAGE)


def help_of(job: str) -> str:
    """What ``nep-studio JOB --help`` prints."""
    os.environ["COLUMNS"] = COLUMNS
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.suppress(SystemExit):
        main([job, "--help"])
    return printed.getvalue()


def _shown(text: str) -> str:
    return f'<pre tabindex="0"><code>{escape(text.strip())}</code></pre>'
