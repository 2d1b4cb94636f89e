"""The libraries about robots stand alone: another project could use them."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from nep_core.wire import messages as wire
from nep_core.wire import states
from robots.body import driver as messages

ROOT = Path(__file__).resolve().parents[2]
REFUSED = ("nep_core", "nep_studio", "nodes", "PySide6", "zmq")

LOAD_ALL = f"""
import importlib, pkgutil, sys

class Refusing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {REFUSED!r}:
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, Refusing())
import robots
found = [one.name for one in pkgutil.walk_packages(robots.__path__, "robots.")]
for name in found:
    importlib.import_module(name)
print(len(found))
"""


def test_every_module_about_robots_is_imported_without_the_rest_of_the_program() -> None:
    child = subprocess.run(
        [sys.executable, "-c", LOAD_ALL], cwd=ROOT, capture_output=True, text=True, check=False
    )

    assert child.stderr == ""
    files = [path for path in (ROOT / "robots").rglob("*.py") if path.parent != ROOT / "robots"]
    assert int(child.stdout) >= len(files)


@pytest.mark.parametrize("path", sorted((ROOT / "robots").rglob("*.py")), ids=lambda p: p.stem)
def test_no_function_imports_the_rest_of_the_program_later(path: Path) -> None:
    tree = ast.walk(ast.parse(path.read_text(encoding="utf-8")))

    named = [
        name.partition(".")[0]
        for node in tree
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in _names(node)
    ]

    assert not set(named) & set(REFUSED)


def _names(node: ast.Import | ast.ImportFrom) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [node.module or ""] if not node.level else []


@pytest.mark.parametrize(
    "name", ["ActionRequest", "RobotState", "SenseRequest", "Thing", "Surroundings"]
)
def test_what_a_robot_takes_and_tells_has_the_keys_of_the_network_s_messages(name: str) -> None:
    ours, theirs = (
        {field.name: (str(field.type), field.default) for field in msgspec.structs.fields(kind)}
        for kind in (getattr(messages, name), getattr(wire, name))
    )

    assert ours == {
        key: (of.replace(wire.__name__, messages.__name__), default)
        for key, (of, default) in theirs.items()
    }


@pytest.mark.parametrize("words", ["Good morning!", "größe_2", "  ", "ÉTÉ", "\u22122,5 °C", "5-3"])
def test_a_robot_tells_human_states_in_the_network_s_words(words: str) -> None:
    assert messages.plain(words) == states.plain(words)
    assert messages.state_of_word(words) == states.state_of_word(words)
    assert messages.NOT_UNDERSTOOD == states.NOT_UNDERSTOOD


@pytest.mark.parametrize("thing", ["face", "face_anna", "ball", "sound", "mark_64"])
def test_a_robot_names_what_it_notices_as_the_network_does(thing: str) -> None:
    assert messages.state_of_thing(thing) == states.state_of_thing(thing)
