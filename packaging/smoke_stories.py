"""What a person does first: ask what it is, open the window, play the karate story."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import numpy as np
import parts
from PySide6.QtGui import QImage
from smoke_program import Figures, Program, expect, finished, is_windows

from nep_studio import __version__

WINDOWS = 3
"""So often the window is opened; the first time is not warm."""
SPEED = "4"
MOST_DIFFERENT = 0.002
"""The share of the picture that may look different: a font of the system, a word of the day."""
SENTENCES = [
    "Show me a karate chop!",
    "Impressive!",
    "I can do that, too.",
    "Thank you for the lesson, master.",
    "Now I have to rest.",
]


def version(frozen: Program, source: Program, folder: Path) -> Figures:
    """It knows its version, and is one program under all its names."""
    told = frozen.run("--version").strip()
    expect(told == f"NEP Studio {__version__}", f"its version is {told}")
    told = frozen.run("nep", "--version").strip()
    expect(told.split()[-1] == __version__, f"the version of nep is {told}")
    return {"version": __version__}


def command_line(frozen: Program, source: Program, folder: Path) -> Figures:
    """Its help is the same; under the name of nep it is the developer's command line."""
    expect(frozen.run("--help") == source.run("--help"), "its help is another one")
    overview = frozen.run("nep")
    expect(overview == source.run("nep"), "the help of nep is another one")
    nep = Path(frozen.words[0]).with_name("nep.exe" if is_windows() else "nep")
    if nep.exists():
        under_its_name = Program((str(nep),), is_frozen=True)
        expect(under_its_name.run() == overview, "nep is something else")
    return {"nep": nep.exists()}


def code(frozen: Program, source: Program, folder: Path) -> Figures:
    """Every example is here, is as it was, and becomes the same Python."""
    examples = sorted((parts.ROOT / "resources" / "examples").glob("*.nep"))
    for example in examples:
        shipped = frozen.folder / "resources" / "examples" / example.name
        expect(shipped.read_bytes() == example.read_bytes(), f"{example.name} was changed")
    some = [example for example in examples if example.stem in ("quiz", "theatre_cues")]
    for example in some:
        python = frozen.run("code", example)
        expect(python == source.run("code", example), f"{example.name} becomes another Python")
    return {"examples": len(examples), "compared": len(some)}


def window(frozen: Program, source: Program, folder: Path) -> Figures:
    """The window opens, soon, and looks as it does from source."""
    karate = parts.ROOT / "resources" / "examples" / "karate_greeting.nep"
    first = [_picture(frozen, folder / "start.png") for _ in range(WINDOWS)]
    both = {"frozen": frozen, "source": source}
    drawing = [
        program.start("picture", folder / f"{name}.png", karate) for name, program in both.items()
    ]
    for one in drawing:
        finished(one)
    share = _difference(folder / "frozen.png", folder / "source.png")
    expect(share <= MOST_DIFFERENT, f"{share:.1%} of the window looks different")
    seconds = [one["window_s"] for one in first]
    return {
        "platform": first[0]["platform"],
        "first_s": seconds[0],
        "warm_s": min(seconds[1:]),
        "warm_cpu_s": min(one["cpu_s"] for one in first[1:]),
        "different": share,
    }


def karate(frozen: Program, source: Program, folder: Path) -> Figures:
    """The karate story goes as from source: who takes part, what is recognised, said and done."""
    example = frozen.folder / "resources" / "examples" / "karate_greeting.nep"
    words = ("run", example, "--speed", SPEED, "--json")
    running = [program.start(*words) for program in (frozen, source)]
    told = [[json.loads(line) for line in finished(one).splitlines()] for one in running]
    seen, reference = (_story(events) for events in told)
    expect(seen["said"] == SENTENCES, f"it says {seen['said']}")
    for part, told_from_source in reference.items():
        expect(seen[part] == told_from_source, f"{part}: {seen[part]} is not {told_from_source}")
    return {"sentences": len(seen["said"]), "nodes": seen["nodes"]}


def _story(events: list[dict[str, Any]]) -> dict[str, Any]:
    requests = {e["id"]: e for e in events if e["topic"] == "/action_request"}
    started = [e for e in events if e["topic"] == "/action_result" and e["state"] == "started"]
    asked = [requests[e["id"]] for e in started if e["id"] in requests]
    said = [e["args"]["text"] for e in asked if e["action"] == "say"]
    return {
        "said": list(dict.fromkeys(said)),
        "done": sorted({e["action"] for e in asked}),
        "nodes": sorted({e["node"] for e in events if e["topic"] == "/node_state"}),
        "heard": sorted({e["human_state"] for e in events if e["topic"] == "/human_behavior"}),
        "rules": [e["rule"] for e in events if e.get("event") == "rule_started"],
        "crashed": [e for e in events if e.get("event") == "crashed"],
    }


def _picture(program: Program, path: Path) -> dict[str, Any]:
    started_at = time.time()
    report: dict[str, Any] = json.loads(program.run("picture", path).splitlines()[-1])
    return {**report, "window_s": round(report["painted_at"] - started_at, 3)}


def _difference(one: Path, other: Path) -> float:
    """The share of points that two pictures have in different colours."""
    images = [
        QImage(str(path)).convertToFormat(QImage.Format.Format_RGB32) for path in (one, other)
    ]
    expect(images[0].size() == images[1].size(), "the window has another size")
    rows = [bytes(image.constBits()) for image in images]
    one_colours, other_colours = (np.frombuffer(row, np.uint32) for row in rows)
    return round(float(np.mean(one_colours != other_colours)), 5)
