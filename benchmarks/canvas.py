"""The canvas with up to 20,000 blocks, against a QGraphicsScene with an item for each block.

All times are CPU time from a real event to what is painted, on the reference program. The figures
are taken offscreen, then under Xvfb where it is installed. With ``--with-peers`` Blockly is
measured too: in headless Chromium, with the same program, only the CPU of its main thread.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

from . import peers
from .canvas_blockly.chromium import ChromiumFailed
from .canvas_blockly.measuring import BlocklyFigures, PeerMissing, measure
from .virtual_display import NoDisplay, virtual_display

PEER_SIZES = (100, 1_000, 5_000)
PEER_PASSES = 3
LARGEST_MB = 160.0
LIMIT_S = 1800
"""Programs to compare with are fetched first, when they are asked for."""
CHILD_S = 400

BUDGETS_MS = {
    "ours 5000 load": ("load, 5,000 blocks", 240.0),
    "ours 5000 drag": ("drag step, 5,000 blocks", 1.0),
    "ours 5000 preview": ("gap preview", 8.0),
    "field edit": ("a field changes", 10.0),
    "keystroke": ("a key in a field", 10.0),
    "ours 5000 undo": ("undo of deleting 100 blocks", 14.0),
    "live code": ("live code after an edit", 2.0),
    "long drag": ("drag step, one stack of 10,000", 1.0),
}
"""What the design allows, by the name of what is measured."""

PLAIN = {
    "ours 100 load": "load, 100 blocks",
    "ours 1000 load": "load, 1,000 blocks",
    "ours 20000 load": "load, 20,000 blocks",
    "ours 5000 drag p95": "drag step, 5,000 blocks, p95",
    "scroll": "scroll step",
    "zoom": "zoom step",
    "full repaint": "all painted anew",
    "long load": "load, one stack of 10,000",
    "long save": "save, one stack of 10,000",
    "long generate": "Python of one stack of 10,000",
}
SHOWN_ON_XVFB = ("ours 5000 load", "ours 5000 drag", "ours 5000 preview", "ours 5000 undo")

Row = dict[str, Any]


def run() -> list[Row]:
    """Rows of CPU milliseconds, ratios and megabytes."""
    offscreen = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    found = measured("figures", offscreen)
    rows = [budget(key, found, "canvas") for key in BUDGETS_MS]
    rows += [row(f"canvas: {name}", found.get(key), "ms CPU") for key, name in PLAIN.items()]
    rows += against_scene(found, "canvas")
    rows.append(at_any_size(found, "canvas"))
    rows.append(memory(offscreen))
    rows += under_xvfb()
    return rows + (against_blockly(found) if peers.are_wanted() else [])


def measured(what: str, environment: dict[str, str]) -> dict[str, float]:
    """Measure in a process of its own; give its figures."""
    command = [sys.executable, "-m", "benchmarks._canvas_child", what]
    child = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, check=True, timeout=CHILD_S
    )
    figures: dict[str, float] = json.loads(child.stdout)
    return figures


def row(name: str, value: float | None, unit: str) -> Row:
    """A figure without a goal."""
    return {"name": name, "value": None if value is None else round(value, 3), "unit": unit}


def compared(name: str, value: float, reference: float, unit: str, most: float) -> Row:
    """A figure that must be at most ``most`` of its reference."""
    ratio = value / reference
    return {
        **row(name, value, unit),
        "reference": round(reference, 3),
        "ratio": round(ratio, 4),
        "goal": f"at most {most:.3g} of it",
        "ok": ratio <= most,
    }


def budget(key: str, found: dict[str, float], where: str) -> Row:
    """A time that must stay below what the design allows."""
    name, most_ms = BUDGETS_MS[key]
    value = found.get(key)
    is_kept = value is not None and value < most_ms
    return {
        **row(f"{where}: {name}", value, "ms CPU"),
        "goal": f"under {most_ms:g} ms",
        "ok": is_kept,
    }


def against_scene(found: dict[str, float], where: str) -> list[Row]:
    """Load, drag and undo against a plain QGraphicsScene."""
    pairs = (("drag", "drag step", 0.1), ("load", "load", 1.0), ("undo", "undo", 1.0))
    return [
        compared(
            f"{where}: {name}, 5,000 blocks, to a scene of items",
            found[f"ours 5000 {key}"],
            found[f"reference 5000 {key}"],
            "ms CPU",
            most,
        )
        for key, name, most in pairs
    ]


def at_any_size(found: dict[str, float], where: str) -> Row:
    """A drag step may not depend on how large the program is."""
    largest, smallest = found["ours 20000 drag"], found["ours 100 drag"]
    return compared(f"{where}: drag step, 20,000 to 100 blocks", largest, smallest, "ms CPU", 1.5)


def memory(environment: dict[str, str]) -> Row:
    """What a fresh process needs that shows 5,000 blocks."""
    rss_mb = measured("memory", environment)["rss"]
    goal = {"goal": f"under {LARGEST_MB:g} MB", "ok": rss_mb < LARGEST_MB}
    return {**row("canvas: process with 5,000 blocks", rss_mb, "MB"), **goal}


def under_xvfb() -> list[Row]:
    """The figures that a display changes most, on a real X server."""
    try:
        with virtual_display() as environment:
            found = measured("figures", environment)
    except NoDisplay as reason:
        return [row(f"canvas under Xvfb: not measured. {reason}", None, "")]
    rows = [budget(key, found, "canvas under Xvfb") for key in SHOWN_ON_XVFB]
    return [*rows, *against_scene(found, "canvas under Xvfb")[:1]]


def against_blockly(found: dict[str, float]) -> list[Row]:
    """Load, drag, undo and memory against Blockly in Chromium."""
    try:
        theirs = measure(PEER_SIZES, PEER_PASSES)
    except (PeerMissing, ChromiumFailed) as reason:
        missing = row(f"canvas to Blockly: not measured. {reason}", None, "")
        return [missing | {"goal": "to be measured", "ok": False}]
    rows = [r for blocks in PEER_SIZES for r in blockly_rows(blocks, theirs[blocks])]
    largest = theirs[5_000]
    for key, name, reference, times in (
        ("load", "load", largest.load_ms, 25),
        ("drag", "drag step", largest.drag_ms, 70),
        ("undo", "undo", largest.undo_ms, 30),
    ):
        label = f"canvas: {name}, 5,000 blocks, to Blockly"
        rows.append(compared(label, found[f"ours 5000 {key}"], reference, "ms CPU", 1 / times))
    return rows


def blockly_rows(blocks: int, figures: BlocklyFigures) -> list[Row]:
    """What Blockly needs with a program of one size."""
    name = f"Blockly with {blocks:,} blocks"
    return [
        row(f"{name}: load", figures.load_ms, "ms CPU"),
        row(f"{name}: drag step", figures.drag_ms, "ms CPU"),
        row(f"{name}: drag step, p95", figures.drag_p95_ms, "ms CPU"),
        row(f"{name}: undo", figures.undo_ms, "ms CPU"),
        row(f"{name}: process that draws", figures.rss_mb, "MB"),
    ]
