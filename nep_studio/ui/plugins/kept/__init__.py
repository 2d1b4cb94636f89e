"""What a program keeps for its next run: forgotten at one press, and there again by another."""

from __future__ import annotations

from pathlib import Path

from faults.files import write_whole
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.messages import Answer
from nep_studio.ui.widgets.questions import tell_not_saved
from nep_studio.ui.words import tr


def forget(host: Host) -> bool:
    """Let the variables that are kept begin anew at the next run; whether there were any."""
    messages, document = host.services.messages, host.services.document
    file = document.kept_file if document is not None else None
    if file is None or not file.is_file():
        messages.confirm(tr("Nothing is kept of this program."))
        return False
    if host.services.runner.running:
        messages.refuse("The program runs already.", ("Stop it, then try again.",))
        return False
    try:
        held = file.read_bytes()
        file.unlink()
    except OSError as error:
        tell_not_saved(messages, str(file), error.strerror or str(error))
        return False
    undo = Answer(tr("Undo"), lambda: _bring_back(host, file, held))
    messages.confirm(tr("What was kept is forgotten: the next run begins anew."), undo)
    return True


def _bring_back(host: Host, file: Path, held: bytes) -> None:
    """Write it again, unless the program has run since and kept something new."""
    if file.exists():
        host.services.messages.refuse(
            "The program has run since, and kept other values.",
            ("Set the variables in the program.",),
        )
        return
    try:
        write_whole(file, held)
    except OSError as error:
        tell_not_saved(host.services.messages, str(file), error.strerror or str(error))


def make(host: Host) -> Parts:
    """One action of the menu Run."""
    action = NewAction(
        "forget_kept",
        "Forget what is kept for the next run",
        lambda: forget(host),
        "rotate-ccw",
        menu="run",
    )
    return Parts(actions=[action])


plugin = Plugin("kept", make, order=96, needs_project=True)
