"""Live plots of sensors: six numbers at 1,000 Hz over 30 s, drawn 60 times a second.

The reference is pyqtgraph given all samples at each frame. The figures are percent of one core,
hearing and painting together, offscreen and then under Xvfb where it is installed. Memory is
measured over hours of samples, which are fed as fast as they can be taken.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

from .virtual_display import NoDisplay, virtual_display

CHILD_S = 300
MOST_SHARE = 25.0
MOST_OF_REFERENCE = 0.25
LEAST_FRAMES_HZ = 55.0
MOST_HIDDEN = 0.5
MOST_GROWN_MB = 3.0

Row = dict[str, Any]


def run() -> list[Row]:
    """Rows of percent, frames and megabytes."""
    found = measured(os.environ | {"QT_QPA_PLATFORM": "offscreen"}, "memory")
    rows = drawing(found, "sensors")
    rows.append(at_most("sensors: CPU while hidden", found["hidden"], "% of a core", MOST_HIDDEN))
    hours = f"sensors: memory grown, {found['heard'] / 1e6:.1f} million samples"
    rows.append(at_most(hours, found["grown"], "MB", MOST_GROWN_MB))
    rows.append(row("sensors: samples kept of one sensor", found["kept"], "MB"))
    return rows + under_xvfb()


def measured(environment: dict[str, str], *what: str) -> dict[str, float]:
    """Measure in a process of its own; give its figures."""
    command = [sys.executable, "-m", "benchmarks._sensors_child", *what]
    child = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, check=True, timeout=CHILD_S
    )
    figures: dict[str, float] = json.loads(child.stdout)
    return figures


def row(name: str, value: float | None, unit: str) -> Row:
    """A figure without a goal."""
    return {"name": name, "value": None if value is None else round(value, 2), "unit": unit}


def at_most(name: str, value: float, unit: str, most: float) -> Row:
    """A figure that has a limit."""
    return {**row(name, value, unit), "goal": f"at most {most:g}", "ok": value <= most}


def drawing(found: dict[str, float], where: str) -> list[Row]:
    """What drawing costs, beside the reference of the same run, and how often it is done."""
    share, reference = found["share"], found["reference share"]
    frames_hz = found["frames"]
    against = {
        **row(f"{where}: CPU at 60 frames, to pyqtgraph with all samples", share, "% of a core"),
        "reference": round(reference, 1),
        "ratio": round(share / reference, 3),
        "goal": f"at most {MOST_OF_REFERENCE:g} of it",
        "ok": share / reference <= MOST_OF_REFERENCE,
    }
    frames = {
        **row(f"{where}: frames painted", frames_hz, "a second"),
        "goal": f"at least {LEAST_FRAMES_HZ:g}",
        "ok": frames_hz >= LEAST_FRAMES_HZ,
    }
    limit = at_most(f"{where}: CPU at 60 frames a second", share, "% of a core", MOST_SHARE)
    return [limit, against, frames]


def under_xvfb() -> list[Row]:
    """The same on a real X server."""
    try:
        with virtual_display() as environment:
            return drawing(measured(environment), "sensors under Xvfb")
    except NoDisplay as reason:
        return [row(f"sensors under Xvfb: not measured. {reason}", None, "")]
