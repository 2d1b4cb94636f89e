"""The rooms of the design: who may import whom, read from the source of every module."""

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

import dev

ROOT = Path(dev.__file__).parent


@dataclass(frozen=True)
class Room:
    """What the modules of one folder may import beside the standard library."""

    ours: tuple[str, ...] = ()
    others: tuple[str, ...] = ()


TALK = ("zmq", "msgspec", "psutil", "platformdirs")
UI = ("faults", "nep_core", "robots", "nodes", "nep_studio", "nep_studio.blocks", "nep_studio.ui")
QT = (*TALK, "numpy", "PySide6", "shiboken6", "pyqtgraph")
AROUND = ("nep_studio.ui.canvas", "nep_studio.ui.workbench", "nep_studio.ui.running")
OFFERED = ("nep_studio.ui.host", "nep_studio.ui.services")
"""What plugins see of the window; it names what runs and the workbench, for types only."""
SHARED = (
    *("nep_studio.ui.floor", "nep_studio.ui.speech", "nep_studio.ui.node_style"),
    *("nep_studio.ui.network_feed", "nep_studio.ui.network_watch", "nep_studio.ui.watch_view"),
    "nep_studio.ui.widgets.questions",
)
"""What several plugins use of what runs and of the canvas: below all plugins."""
ROOMS = {
    "dev": Room(("dev_system", "dev_tests")),
    "fuzz": Room(("fuzz", "fuzz.targets", "faults"), ("msgspec", "psutil")),
    "fuzz.targets": Room(
        ("fuzz", *UI, "nep_studio.ui.plugins"),  # every door, wherever it is
        ("zmq", "msgspec", "numpy", "aiohttp"),
    ),
    "dev_tests": Room(("dev_system",)),
    "dev_system": Room(),
    "faults": Room((), ("msgspec",)),
    "nep_core": Room(("nep_core", "faults"), TALK),
    "robots": Room(("robots", "faults"), ("numpy", "msgspec", "platformdirs")),
    "nodes": Room(("nodes", "robots", "nep_core", "faults"), (*TALK, "numpy")),
    "nep_studio.blocks": Room(("nep_studio.blocks", "faults"), ("msgspec",)),
    "nep_studio": Room(
        ("nep_studio", "nep_studio.blocks", "nep_core", "faults"), ("msgspec", "PySide6.QtCore")
    ),
    "nep_studio.ui": Room(UI, QT),
    "nep_studio.ui.canvas": Room((*UI, "nep_studio.ui.canvas"), QT),
    "nep_studio.ui.workbench": Room(
        (
            *(*UI, "nep_studio.ui.canvas", "nep_studio.ui.workbench", "nep_studio.ui.services"),
            "nep_studio.ui.widgets.questions",
        ),
        QT,
    ),
    "nep_studio.ui.running": Room((*UI, *AROUND, *OFFERED), QT),
    **dict.fromkeys((*OFFERED, *SHARED), Room((*UI, *AROUND, *OFFERED, *SHARED), QT)),
    "nep_studio.ui.plugins": Room(
        (*UI, *AROUND, *OFFERED, *SHARED, "nep_studio.ui.plugins"),  # but no other plugin
        QT,
    ),
    "nep_studio.ui.shell": Room(
        (*UI, *AROUND, *OFFERED, *SHARED, "nep_studio.ui.plugins", "nep_studio.ui.shell"), QT
    ),
}
"""The arrows of the design; a module is in the room with the longest name that fits."""

LATE = {
    "nep_core": ("mcap", "lz4", "zstandard", "spake2", "zenoh", "zeroconf"),
    "robots.naoqi": ("zeroconf",),
    "nodes.sensory": ("aiohttp", "cryptography", "bleak"),
    "nep_studio.ui": ("segno", "mcap"),
    "fuzz": ("numpy", "lz4", "zstandard"),
}
"""Libraries that are imported when they are needed: only inside functions, or for types."""
LEARNING = ("sklearn", "scipy")
TRAINING_ROOM, TRAINING = "nodes.perceptual.recognition", re.compile("_*(train|fit)")
"""Where the libraries of learning may be imported: only inside functions of such names."""


FOR_TYPES = "TYPE_CHECKING"


@dataclass(frozen=True)
class Import:
    """One name that a module imports, in full, and where."""

    name: str
    line: int
    function: str  # the function that it is in; empty at the top of the module; FOR_TYPES


def is_within(name: str, package: str) -> bool:
    return name == package or name.startswith(package + ".")


def room_of(name: str) -> str | None:
    """Return the room of a module or of a name in it; None when it is not ours."""
    fitting = [room for room in ROOMS if is_within(name, room)]
    return max(fitting, key=len, default=None)


def imported_names(node: ast.AST, package: str) -> list[str]:
    """Return the full names that a statement or an ``import_module("literal")`` imports."""
    match node:
        case ast.Import():
            return [alias.name for alias in node.names]
        case ast.ImportFrom():
            above = package.split(".")[: len(package.split(".")) - node.level + 1]
            start = ".".join([*(above if node.level else []), *filter(None, [node.module])])
            return [f"{start}.{alias.name}" for alias in node.names]
        case ast.Call(
            func=ast.Attribute(attr="import_module") | ast.Name(id="import_module" | "__import__"),
            args=[ast.Constant(value=str(name)), *_],
        ):
            return [name]
    return []


def imports_of(source: str, package: str) -> Iterator[Import]:
    """Give every import of a module, also those inside functions."""
    waiting: list[tuple[ast.AST, str]] = [(ast.parse(source), "")]
    while waiting:
        node, function = waiting.pop()
        for name in imported_names(node, package):
            yield Import(name, getattr(node, "lineno", 0), function)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            function = node.name
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and not function:
            function = FOR_TYPES if node.test.id == FOR_TYPES else ""
        waiting += [(child, function) for child in ast.iter_child_nodes(node)]


PLUGINS = "nep_studio.ui.plugins"


def plugin_of(name: str) -> str:
    """Return the plugin that a module or a name in it belongs to; empty when to none."""
    return name.split(".")[3] if name.startswith(PLUGINS + ".") else ""


def is_allowed(module: str, found: Import) -> bool:
    """Whether the design has an arrow from this module's room to what it imports."""
    room = ROOMS[room_of(module) or ""]
    ours, theirs = plugin_of(module), plugin_of(found.name)
    if ours and theirs and ours != theirs:
        return False
    if found.name.partition(".")[0] in sys.stdlib_module_names:
        return True
    if room_of(found.name):
        return room_of(found.name) in room.ours
    if is_within(module, TRAINING_ROOM) and any(is_within(found.name, it) for it in LEARNING):
        return bool(TRAINING.match(found.function))
    for late_room, libraries in LATE.items():
        if is_within(module, late_room) and any(is_within(found.name, it) for it in libraries):
            return bool(found.function)
    return any(is_within(found.name, other) for other in room.others)


@cache
def modules_in(root: Path) -> tuple[tuple[str, list[Import]], ...]:
    """Return every module of a room, by its full name, with what it imports."""
    return tuple(_modules_in(root))


def _modules_in(root: Path) -> Iterator[tuple[str, list[Import]]]:
    folders = {room.partition(".")[0] for room in ROOMS}  # not the libraries in .venv
    inside = [path for folder in folders for path in (root / folder).rglob("*.py")]
    for path in sorted([*root.glob("*.py"), *inside]):
        parts = path.relative_to(root).with_suffix("").parts
        module = ".".join(parts).removesuffix(".__init__")
        if room_of(module) is not None:
            package = module if path.name == "__init__.py" else ".".join(parts[:-1])
            yield module, list(imports_of(path.read_text(encoding="utf-8"), package))


def wrong_arrows(root: Path) -> list[str]:
    """Return every import that leaves its room by a way that the design does not have."""
    return [
        f"{module}:{it.line} {it.name}"
        for module, found in modules_in(root)
        for it in found
        if not is_allowed(module, it)
    ]


def import_circles(root: Path) -> list[list[str]]:
    """Return the modules that import each other in a circle, the largest circle first.

    Imports inside functions and for types count too: who reads one must read them all.
    """
    found = dict(modules_in(root))
    arrows = {
        module: {
            it.name if it.name in found else it.name.rpartition(".")[0] for it in imports
        }.intersection(found)
        - {module}
        for module, imports in found.items()
    }
    reached = {module: _reached(module, arrows) for module in arrows}
    circles = {
        tuple(sorted(it for it in seen if module in reached[it]))
        for module, seen in reached.items()
        if module in seen
    }
    return sorted(map(list, circles), key=len, reverse=True)


def _reached(start: str, arrows: Mapping[str, set[str]]) -> set[str]:
    reached: set[str] = set()
    waiting = [start]
    while waiting:
        new = arrows[waiting.pop()] - reached
        reached |= new
        waiting += new
    return reached


def test_every_import_follows_an_arrow_of_the_design() -> None:
    assert wrong_arrows(ROOT) == []


@pytest.mark.parametrize(
    ("place", "source", "name"),
    [
        ("dev.py", "import numpy", "numpy"),
        ("nep_core/program/robot.py", "import numpy.linalg as la", "numpy.linalg"),
        ("nep_core/program/robot.py", "from nodes import resources", "nodes.resources"),
        ("nep_core/program/robot.py", "from ...nodes import action", "nodes.action"),
        ("nep_core/program/robot.py", "def f():\n    import PySide6", "PySide6"),
        ("nep_core/cli/__init__.py", "import nep_studio.paths", "nep_studio.paths"),
        ("nodes/action/nao.py", "from nep_studio import paths", "nep_studio.paths"),
        ("nodes/action/nao.py", "import sklearn", "sklearn"),
        ("nodes/action/nao.py", "def find():\n    import zeroconf", "zeroconf"),
        ("robots/naoqi/discovery.py", "import zeroconf", "zeroconf"),
        ("robots/body/gait.py", "from nep_core import errors", "nep_core.errors"),
        ("robots/body/gait.py", "from nodes import recordings", "nodes.recordings"),
        ("faults/__init__.py", "from nep_core import errors", "nep_core.errors"),
        ("nodes/perceptual/recognition/gmr.py", "def match():\n    import scipy", "scipy"),
        ("nodes/perceptual/recognition/training.py", "import sklearn.tree", "sklearn.tree"),
        ("nep_studio/blocks/edits.py", "import nep_core.errors", "nep_core.errors"),
        ("nep_studio/blocks/edits.py", "from ..run import session", "nep_studio.run.session"),
        ("nep_studio/blocks/edits.py", "from PySide6 import QtCore", "PySide6.QtCore"),
        ("nep_studio/run/session.py", "from PySide6.QtGui import QImage", "PySide6.QtGui.QImage"),
        ("nep_studio/run/session.py", "import PySide6", "PySide6"),
        ("nep_studio/run/session.py", "from .. import ui", "nep_studio.ui"),
        ("nep_studio/run/session.py", "from nodes.action import nao", "nodes.action.nao"),
        ("nep_studio/run/session.py", 'x.import_module("nodes.action.nao")', "nodes.action.nao"),
        ("nep_studio/ui/shell/app.py", "import tests.fakes", "tests.fakes"),
        ("nep_studio/ui/shell/app.py", "import sklearn", "sklearn"),
        ("nep_studio/ui/plugins/watches/code.py", "import segno", "segno"),
        (
            "nep_studio/ui/plugins/watches/code.py",
            "from nep_studio.ui.plugins import cues",
            "nep_studio.ui.plugins.cues",
        ),
        (
            "nep_studio/ui/plugins/watches/code.py",
            "if TYPE_CHECKING:\n    from nep_studio.ui.shell import main_window",
            "nep_studio.ui.shell.main_window",
        ),
        (
            "nep_studio/ui/canvas/canvas.py",
            "from nep_studio.ui.workbench import code",
            "nep_studio.ui.workbench.code",
        ),
        (
            "nep_studio/ui/documents.py",
            "from .plugins import picture",
            "nep_studio.ui.plugins.picture",
        ),
        ("nodes/sensory/connectors/push.py", "import aiohttp.web", "aiohttp.web"),
        ("nodes/action/nao.py", "def f():\n    import aiohttp", "aiohttp"),
    ],
)
def test_a_planted_wrong_arrow_is_found(tmp_path: Path, place: str, source: str, name: str) -> None:
    path = tmp_path / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)

    [wrong] = wrong_arrows(tmp_path)

    assert wrong.endswith(f" {name}")


@pytest.mark.parametrize(
    ("place", "source"),
    [
        ("nep_core/program/robot.py", "from . import messages\nimport zmq.utils, msgspec, json"),
        ("nodes/action/nao.py", "from nep_core.processes.node import Node\nimport numpy as np"),
        ("nodes/perceptual/recognition/gmr.py", "def fit():\n    from sklearn import mixture"),
        ("robots/naoqi/discovery.py", "def find():\n    from zeroconf import Zeroconf"),
        ("nodes/sensory/connectors/push.py", "def serve():\n    from aiohttp import web"),
        ("nodes/sensory/connectors/push.py", "if TYPE_CHECKING:\n    from aiohttp import web"),
        ("nep_studio/blocks/generate/names.py", "from ..edits import Edit\nimport msgspec"),
        ("nep_studio/run/session.py", "from nep_studio.blocks import edits\nimport nep_core"),
        ("nep_studio/run/session.py", "from PySide6.QtCore import QObject"),
        ("robots/body/gait.py", "import numpy, math\nfrom faults import Fault"),
        ("nep_studio/ui/shell/app.py", "import nodes, pyqtgraph\nfrom PySide6.QtGui import QImage"),
        ("nep_studio/ui/shell/rooms.py", "from nep_studio.ui.plugins import cues"),
        ("nep_studio/ui/plugins/cues/panel.py", "from . import board\nfrom ... import words"),
        ("tests/test_any.py", "import sklearn"),
    ],
)
def test_the_arrows_of_the_design_are_allowed(tmp_path: Path, place: str, source: str) -> None:
    path = tmp_path / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)

    assert wrong_arrows(tmp_path) == []


LARGEST_CIRCLE = 12


def test_no_circle_of_imports_is_larger_than_one_can_read() -> None:
    assert [circle for circle in import_circles(ROOT) if len(circle) > LARGEST_CIRCLE] == []


def test_a_planted_circle_is_found_through_late_and_typing_imports(tmp_path: Path) -> None:
    sources = {
        "one": "from .two import a",
        "two": "def f():\n    from nep_core import three",
        "three": "if TYPE_CHECKING:\n    from .one import b",
        "four": "from . import one",
    }
    (tmp_path / "nep_core").mkdir()
    for name, source in sources.items():
        (tmp_path / "nep_core" / f"{name}.py").write_text(source)

    assert import_circles(tmp_path) == [["nep_core.one", "nep_core.three", "nep_core.two"]]


SMALL_LINES, ENOUGH_IMPORTERS = 60, 3
SMALL_FOR_A_REASON = {
    "dev_tests": "dev.py is read by a person first; how tests are run beside each other is apart"
}
"""Modules that are small and stand alone all the same, and why."""


def lonely_modules(root: Path) -> list[str]:
    """Return the small modules that fewer than three others import: they belong into another.

    A package's own file is no choice, and the file that ``python -m`` starts is none either, nor
    one that a node's manifest beside it names.
    """
    found = dict(modules_in(root))
    importers = Counter(
        name
        for module, imports in found.items()
        for name in {n for it in imports for n in (it.name, it.name.rpartition(".")[0])}
        if name != module
    )
    return [
        module
        for module in found
        if (path := root / f"{module.replace('.', '/')}.py").exists()
        if path.name != "__main__.py" and not path.with_suffix(".toml").exists()
        if len(path.read_text(encoding="utf-8").splitlines()) < SMALL_LINES
        if importers[module] < ENOUGH_IMPORTERS
    ]


def test_a_small_module_has_three_importers_or_a_reason() -> None:
    assert sorted(lonely_modules(ROOT)) == sorted(SMALL_FOR_A_REASON)


def test_a_lonely_module_is_found(tmp_path: Path) -> None:
    long = "x = 1\n" * SMALL_LINES
    sources = {"lonely": "x = 1", "shared": "x = 1", "long": long, "__init__": ""}
    sources |= dict.fromkeys("abc", f"from .shared import x\n{long}")
    (tmp_path / "nep_core").mkdir()
    for name, source in sources.items():
        (tmp_path / "nep_core" / f"{name}.py").write_text(source)

    assert lonely_modules(tmp_path) == ["nep_core.lonely"]


LOAD_ALL = """
import importlib, pkgutil, sys
package = importlib.import_module({package!r})
for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
    if not module.name.endswith("__main__"):
        importlib.import_module(module.name)
print(*sorted(name for name in {slow!r} if name in sys.modules))
"""


@pytest.mark.parametrize(
    ("package", "slow"),
    [
        ("nep_core", ("numpy", "sklearn", "scipy", "PySide6", "pyqtgraph")),
        ("robots", ("nep_core", "nodes", "sklearn", "scipy", "PySide6", "zmq", "zeroconf")),
        ("nep_studio.blocks", ("numpy", "sklearn", "scipy", "PySide6", "pyqtgraph", "zmq")),
        ("nodes", ("sklearn", "scipy", "PySide6", "pyqtgraph", "zeroconf")),
    ],
)
def test_no_module_of_a_quick_room_loads_a_slow_library(package: str, slow: tuple[str]) -> None:
    code = LOAD_ALL.format(package=package, slow=slow)

    child = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True
    )

    assert child.stdout.strip() == ""
