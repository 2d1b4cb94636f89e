"""What the frozen program starts: the shipped nodes, a person's own ones, a training."""

from __future__ import annotations

import contextlib
import json
import os
import statistics
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import parts
from numpy.typing import NDArray
from smoke_program import Figures, Program, expect

from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher
from nep_core.processes.manifest import NodeCatalog
from nep_studio.blocks.files import load
from nep_studio.project.kept_files import take_files
from nep_studio.run.installation import studio_language

ROUNDS = 3
READY_S = 20.0
"""Far more than it takes: how long it took is told, and judged by people."""

OWN_MANIFEST = 'type = "sensory"\nname = "{name}"\ntitle = "Own"\ndescription = "Ours."\n'
OWN_NODE = """\
import statistics, csv, sqlite3, json, wave
import numpy

def run(node):
    node.ready(f"{statistics.mean([1, 3])} {numpy.arange(4).sum()}")
    node.wait(60)
"""
FOREIGN_NODE = """\
import os, sys
sys.path.insert(0, {root!r})
from nep_core import Node
wrong = [name for name in ("LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "QT_PLUGIN_PATH")
         if name in os.environ]
name = sys.argv[sys.argv.index("--name") + 1]
with Node(name, "sensory") as node:
    node.stop_on_signals()
    if not wrong and not getattr(sys, "frozen", False):
        node.ready("another Python")
    node.wait(60)
"""
OWN_PROGRAM = """\
import csv, datetime, math, random, statistics, sys, zoneinfo
from pathlib import Path

import nep_core

Path({output!r}).write_text(f"{{statistics.median([1, 2, 9])}} {{getattr(sys, 'frozen', False)}}")
"""


@contextlib.contextmanager
def _launcher(program: Program, folder: Path, *more: Path) -> Iterator[Launcher]:
    """A launcher that starts nodes as this program would."""
    master = Master("tcp://127.0.0.1:*")
    folders = (*more, program.folder / "nodes")
    try:
        with (
            mock.patch(
                "nep_core.processes.launcher.program_command", lambda *w: [*program.words, *w]
            ),
            PeerNetwork("smoke", master=master.endpoint) as network,
            Launcher(folders=folders, master=master.endpoint, logs=folder) as launcher,
        ):
            launcher.hear(network)
            yield launcher
    finally:
        master.close()


def nodes(frozen: Program, source: Program, folder: Path) -> Figures:
    """Each shipped node gets ready."""
    needs = _needs(folder)
    with _launcher(frozen, folder) as launcher:
        paths = NodeCatalog((frozen.folder / "nodes",)).paths()
        names = [f"{path.parent.name}/{path.stem}" for path in paths]
        shipped = NodeCatalog((parts.ROOT / "nodes",)).paths()
        expect(len(names) == len(shipped), f"only these nodes are shipped: {names}")
        return {
            name: round(
                statistics.median(
                    _ready_s(launcher, name, needs.get(name, {})) for _ in range(ROUNDS)
                ),
                3,
            )
            for name in names
        }


def own_nodes(frozen: Program, source: Program, folder: Path) -> Figures:
    """A person's own nodes run: Python inside the program, another Python by its command."""
    place = folder / "own" / "sensory"
    place.mkdir(parents=True)
    (place / "inside.toml").write_text(OWN_MANIFEST.format(name="inside"))
    (place / "inside.py").write_text(OWN_NODE)
    command = f"command = {json.dumps([sys.executable, '{folder}/foreign_node.py'])}\n"
    (place / "foreign.toml").write_text(OWN_MANIFEST.format(name="foreign") + command)
    (place / "foreign_node.py").write_text(FOREIGN_NODE.format(root=str(parts.ROOT)))
    with _launcher(frozen, folder, folder / "own") as launcher:
        found = {name: _ready_s(launcher, f"sensory/{name}", {}) for name in ("inside", "foreign")}
    return {name: round(seconds, 3) for name, seconds in found.items()}


def own_program(frozen: Program, source: Program, folder: Path) -> Figures:
    """A program written by hand runs inside, with the standard library."""
    output, program = folder / "output.txt", folder / "own_program.py"
    program.write_text(OWN_PROGRAM.format(output=str(output)))
    master = Master("tcp://127.0.0.1:*")
    try:
        frozen.run("exec", program, variables={"NEP_MASTER": master.endpoint})
    finally:
        master.close()
    expect(output.read_text() == "2 True", f"it wrote {output.read_text()}")
    return {}


def training(frozen: Program, source: Program, folder: Path) -> Figures:
    """Gestures are learned from the recordings of the example, and the same is learned."""
    takes = _shipped_takes(frozen, folder)
    models = {}
    for name, program in (("frozen", frozen), ("source", source)):
        models[name] = folder / f"{name}.gestures"
        program.run("train", takes, "-o", models[name], "--method", "trees")
    learned = [_arrays(path) for path in models.values()]
    expect(learned[0].keys() == learned[1].keys(), "the model has other parts")
    for key, array in learned[0].items():
        expect(np.array_equal(array, learned[1][key]), f"{key} was learned differently")
    return {"arrays": len(learned[0]), "bytes": models["frozen"].stat().st_size}


def trainer(frozen: Program, source: Program, folder: Path) -> Figures:
    """The studio's trainer, a process that keeps warm, gets ready and ends with its orders."""
    started_s = time.monotonic()
    process = frozen.start("train-worker", str(os.getpid()))
    assert process.stdin is not None and process.stdout is not None
    told = json.loads(process.stdout.readline())
    seconds = time.monotonic() - started_s
    expect(told == {"ready": True}, f"it says {told}")
    process.communicate(timeout=READY_S)
    return {"ready_s": round(seconds, 3)}


def _shipped_takes(frozen: Program, folder: Path) -> Path:
    example = frozen.folder / "resources" / "examples" / "own_gestures.nep"
    files = take_files(load(example, studio_language()))
    assert files is not None
    files = replace(files, folder=folder / "takes")
    files.write()
    return files.folder


def _arrays(path: Path) -> dict[str, NDArray[Any]]:
    with np.load(path) as model:
        return {name: model[name] for name in model.files if name != "about"}


def _needs(folder: Path) -> dict[str, dict[str, str | float]]:
    """What nodes must be told to get ready."""
    program = folder / "waits.py"
    program.write_text("import nep_core\n")
    recording = folder / "still_nothing.csv"
    lines = ["t,ax,ay,az", *(f"{n / 50:.2f},0,0,9.81" for n in range(3000))]
    recording.write_text("\n".join(lines) + "\n")
    return {
        "cognitive/program": {"file": str(program), "hold": True},
        "sensory/replay": {"recording": str(recording)},
    }


def _ready_s(launcher: Launcher, name: str, parameters: dict[str, str | float]) -> float:
    started_s = time.monotonic()
    launched = launcher.launch(name, "smoke_node", parameters, restart="never")
    is_ready = launched.ready.wait(READY_S)
    elapsed_s = time.monotonic() - started_s
    said = launched.process.last_lines if launched.process else []
    launcher.stop("smoke_node")
    expect(is_ready, f"{name} is not ready after {READY_S:.0f} s: {said}")
    return elapsed_s
