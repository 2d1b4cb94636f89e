"""What can go wrong while gestures are learned, as problems with a checklist."""

from __future__ import annotations

import errno
import re

from nep_core.errors import RecordingError
from nep_studio.problems import Problem

_MEMORY = ("MemoryError", "Cannot allocate memory", "bad_alloc", "(9)", "(137)")


def not_enough_room(error: OSError | RecordingError) -> Problem:
    """Files could not be written or read."""
    if isinstance(error, RecordingError):
        return _problem(error.sentence, error.checklist, error.details)
    if error.errno == errno.ENOSPC:
        return _problem(
            "The disk is full: there is no room for the recordings.",
            (
                "Delete files that you do not need, and empty the trash.",
                "Then train again: your recordings are still in the project.",
            ),
            str(error),
        )
    return _problem(
        "Files for the training could not be written.",
        (
            "May programs write into the folder for temporary files?",
            "Is there room on the disk?",
            "Start the studio again, then train again.",
        ),
        str(error),
    )


def worker_ended(why: str) -> Problem:
    """The process that learns is gone."""
    if any(sign in why for sign in _MEMORY):
        return _problem(
            "The computer has too little memory for the training.",
            (
                "Close other programs, then train again.",
                "Delete recordings that are very long, such as hours of everyday movement.",
            ),
            why,
        )
    if re.search(r"No module named '?(sklearn|scipy|numpy)", why):
        return _problem(
            "A part that learning needs is not installed.",
            ("Install NEP Studio again.", "From source: install the requirements again."),
            why,
        )
    return _problem(
        "The training ended in the middle.",
        (
            "Train again: your recordings are still in the project.",
            "Leave the newest takes out, one after the other, to see whether one is the reason.",
            "Start the studio again.",
        ),
        why,
    )


def _problem(sentence: str, checklist: tuple[str, ...], details: str) -> Problem:
    return Problem("The gestures were not learned", sentence, checklist, details)
