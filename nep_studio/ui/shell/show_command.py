"""``nep-studio show FILE.nep``: a project in show mode, from the beginning."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from nep_studio import settings
from nep_studio.settings import MOST_RESTARTS, ShowOptions


def main(arguments: list[str]) -> int:
    """Show the project; 0 when somebody left on purpose and closed the studio."""
    from nep_studio.ui.services import Studio
    from nep_studio.ui.shell.app import StopSignals, make_application
    from nep_studio.ui.shell.crash_handler import LastResort
    from nep_studio.ui.shell.main_window import MainWindow

    options = parser().parse_args(arguments)
    app = make_application()
    with LastResort(settings.log_file()) as last_resort, StopSignals():
        window = MainWindow(Studio(app))
        last_resort.watch(window)
        window.workbench.restore(window.fontMetrics().height())
        chosen = show_options(options, window.settings.show_options)
        window.host.ask("show.begin", chosen, Path(options.file).absolute())
        code = app.exec()
        window.running.close()
        window.deleteLater()
    return code


def show_options(given: argparse.Namespace, kept: ShowOptions) -> ShowOptions:
    """What the words of the command say, else what the settings do."""
    return replace(
        kept,
        runs_at_once=given.run or kept.runs_at_once,
        again=given.again or kept.again,
        has_cues=given.cues or kept.has_cues,
        restarts=kept.restarts if given.restarts is None else given.restarts,
    )


def parser() -> argparse.ArgumentParser:
    """The words of the command."""
    made = argparse.ArgumentParser(
        prog="nep-studio show",
        description="Show a project on the whole screen; hold Esc or the corner to leave.",
    )
    made.add_argument("file", metavar="FILE.nep")
    made.add_argument("--run", action="store_true", help="run it at once")
    made.add_argument("--again", action="store_true", help="run it again when it has ended")
    made.add_argument("--cues", action="store_true", help="with buttons that send human states")
    made.add_argument(
        "--restarts",
        type=_count,
        metavar="N",
        help="how often in a row a program that failed is run again",
    )
    return made


def _count(word: str) -> int:
    number = int(word)
    if not 0 <= number <= MOST_RESTARTS:
        raise argparse.ArgumentTypeError(f"a number from 0 to {MOST_RESTARTS}")
    return number
