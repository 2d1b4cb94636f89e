"""What a launched process hands to its launcher when it will not go on: its fault, as data.

The launcher names a file in the environment that is not there yet; who refuses writes the fault
into it as JSON, beside what a person reads in the terminal or the log. A process that knows
nothing of this, such as a node in another language, is told of by the last line that it wrote.
"""

from __future__ import annotations

import contextlib
import logging
import os
from collections.abc import Mapping
from pathlib import Path

import msgspec

from faults import Fault, heard_fault
from faults.files import opened
from nep_core.places import opened_privately
from nep_core.wire.frames import CANNOT_DECODE

log = logging.getLogger(__name__)

SECRETS_VARIABLE = "NEP_SECRET_SETTINGS"
"""In the environment of a launched node: its settings that are ``secret``, as a JSON object.

Everybody on a computer sees the words of a command; its environment only who started it.
"""

VARIABLE = "NEP_FAULT_FILE"
"""In the environment of a launched process: where it may write why it would not go on."""

MOST_BYTES = 100_000


def secrets_in(settings: Mapping[str, str]) -> dict[str, str]:
    """The environment that hands these settings to a node; nothing for none."""
    if not settings:
        return {}
    return {SECRETS_VARIABLE: msgspec.json.encode(dict(settings)).decode()}


def take_secrets() -> dict[str, str]:
    """The settings that were handed over so; what this process starts does not get them."""
    try:
        return msgspec.json.decode(os.environ.pop(SECRETS_VARIABLE, "{}"), type=dict[str, str])
    except CANNOT_DECODE:
        return {}


def hand_over(fault: Fault) -> None:
    """Leave a fault for the launcher; nothing when there is none, or the disk is full."""
    path = os.environ.get(VARIABLE, "")
    if not path:
        return
    try:
        # Never into somebody else's file, nor for others to read: addresses may be in it
        with open(path, "xb", opener=opened_privately) as file:
            file.write(msgspec.json.encode(fault))
    except OSError as error:
        log.info("The launcher will not know more than the last line: %s", error)


def take(path: Path) -> Fault | None:
    """What a process left there, which is taken away; None when it left nothing to be read."""
    try:
        with opened(path) as file:
            data = file.read(MOST_BYTES)
    except OSError:
        return None
    with contextlib.suppress(OSError):
        path.unlink()
    try:
        return heard_fault(msgspec.json.decode(data))
    except CANNOT_DECODE:
        return None
