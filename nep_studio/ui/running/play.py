"""One run of a program: its session, in a thread of its own."""

from __future__ import annotations

import logging
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from PySide6.QtCore import QThread, Signal

from nep_core.errors import NepError
from nep_studio.blocks.generate.source_map import Code
from nep_studio.local_network import LocalNetwork
from nep_studio.plan import PlannedNode
from nep_studio.problems import Problem, problem_of
from nep_studio.session import Ending, Session, Watching

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Request:
    """What is to be run: the code, the nodes that it needs, and how it is watched."""

    code: Code
    nodes: tuple[PlannedNode, ...]
    watching: Watching = field(default_factory=Watching)


class Play(QThread):
    """Runs until the program ends or ``end`` is called; ``ending`` then tells how it went."""

    begun = Signal()

    def __init__(self, request: Request, network: LocalNetwork) -> None:
        super().__init__()
        self.request = request
        self.ending = Ending()
        self.session = Session(
            Path(), list(request.nodes), _ignore, network=network, watching=request.watching
        )

    def run(self) -> None:
        """Start everything, wait for the end, stop everything."""
        try:
            self.ending = self._play()
        except NepError as error:
            self.ending = Ending(problem_of(error))
        except OSError as error:
            self.ending = Ending(_disk_problem(error))
        except Exception as error:
            log.exception("the program could not be run")
            sentence = f"{type(error).__name__}: {error}"
            steps = ("Try it once more.", "Save the project, and start NEP Studio again.")
            self.ending = Ending(Problem("The program could not be started", sentence, steps))

    def _play(self) -> Ending:
        with tempfile.TemporaryDirectory(prefix="nep-", ignore_cleanup_errors=True) as folder:
            program = Path(folder) / "program.py"
            program.write_text(self.request.code.text, encoding="utf-8")
            self.session.use_program(program)
            with self.session as session:
                self.begun.emit()
                return session.wait()

    def end(self) -> None:
        """Stop the robots at once; the rest follows in the thread. Does not wait."""
        self.session.hush()
        self.session.end()


def _ignore(*_message: object) -> None:
    """The window hears the network itself."""


def _disk_problem(error: OSError) -> Problem:
    return Problem(
        "The program could not be written",
        f"The computer says: {error.strerror or error}.",
        (
            "Is there room on the disk?",
            "May this program write into the folder for temporary files?",
        ),
        details=str(error),
    )
