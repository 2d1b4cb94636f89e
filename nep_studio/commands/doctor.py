"""``nep-studio doctor``: what to look at when something is wrong, as a report to send."""

from __future__ import annotations

import argparse
from pathlib import Path

from nep_studio.support.report import FILE


def main(arguments: list[str]) -> int:
    """Print or save the report; 1 when there is something to look at."""
    options = parser().parse_args(arguments)
    from nep_studio.support.report import report

    made = report(options.master)
    if options.save is not None:
        path = _file(options.save)
        made.save(path)
        print(f"The report is in {path}. Read report.txt in it before you send it.")
    else:
        print(made.json() if options.json else made.text(), flush=True)
    return 0 if made.is_sound else 1


def _file(told: Path) -> Path:
    """Where the report goes: into a folder, or a file whose ending may be left out."""
    if told.is_dir():
        return told / FILE
    return told if told.suffix else told.with_suffix(".zip")


def parser() -> argparse.ArgumentParser:
    """The words of the command."""
    made = argparse.ArgumentParser(
        prog="nep-studio doctor",
        description="Check this computer for NEP Studio, and make a report that you can send to"
        " whoever helps you. Names, passwords and keys are taken out; nothing is sent.",
        epilog="Exit code: 0 when all is well, 1 when there is something to look at.",
    )
    made.add_argument("--json", action="store_true", help="for machines: one line of JSON")
    made.add_argument("--save", type=Path, metavar="FILE.zip", help="write it into a file")
    made.add_argument("--master", metavar="ENDPOINT", help="where the master is")
    return made
