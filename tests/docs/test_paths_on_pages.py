"""Every file and folder that a page names is there."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import PROJECT

PAGES = [
    *(PROJECT / name for name in ("README.md", "CONTRIBUTING.md", "GLOSSARY.md")),
    *sorted((PROJECT / "docs").rglob("*.md")),
    *sorted(PROJECT.glob("[a-z]*/README.md")),
    *sorted((PROJECT / "resources").glob("*/README.md")),
]
"""Not CHANGELOG.md: it tells what was."""

FENCE = re.compile(r"^```.*?^```", re.S | re.M)
PYTHON = re.compile(r"```python\n(.*?)```", re.S)
NAMED = re.compile(r"`([\w.-]+(?:/[\w.-]+)*/?)`")
OURS = ("faults", "nep_core", "nep_studio", "nodes", "robots", "resources")
ROOMS = (*OURS, "tests", "docs", "tools", "examples", "packaging", "benchmarks")
FILE = re.compile(r"\w\.(py|md|toml)$")

NOT_HERE = {
    "microbit.toml": "a reader of the page writes it",
    "pinetime.toml": "a reader of the page writes it",
    "six_int16.toml": "a reader of the page writes it",
    "thingy52.toml": "a reader of the page writes it",
    "sensory/letterbox.toml": "the page tells how to write it",
    "sensory/letterbox.py": "the page tells how to write it",
    "perceptual/post.toml": "the page tells how to write it",
    "perceptual/post.py": "the page tells how to write it",
}
"""Names of files that no copy of the project has, each with its reason."""


def all_places(root: Path) -> set[str]:
    """Every file and folder of the project that people wrote, as a path."""
    places = set()
    for room in ROOMS:
        for path in (root / room, *(root / room).rglob("*")):
            if "__pycache__" not in path.parts:
                places.add(path.relative_to(root).as_posix())
    return places | {path.name for path in root.iterdir()}


def is_there(name: str, page: Path, root: Path, places: set[str]) -> bool:
    """Whether a name is a place from the root, from its page, or the end of one in a room.

    A page about one room may leave its folder out: ``layout/page.py`` of the canvas.
    """
    name = name.rstrip("/")
    if (root / name).exists() or (page.parent / name).exists():
        return True
    return any(place.endswith(f"/{name}") for place in places)


def wrong_paths(page: Path, root: Path, places: set[str]) -> Iterator[str]:
    """The names of files and folders of ours on a page that lead nowhere."""
    for name in NAMED.findall(FENCE.sub("", page.read_text(encoding="utf-8"))):
        is_ours = name.split("/")[0] in ROOMS and "/" in name
        is_folder = is_ours and name.endswith("/")
        if not (FILE.search(name) or is_folder or (is_ours and "." in name)):
            continue
        if name not in NOT_HERE and not is_there(name, page, root, places):
            yield name


@pytest.fixture(scope="module")
def places() -> set[str]:
    return all_places(PROJECT)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(PROJECT).as_posix())
def test_every_file_that_a_page_names_is_there(page: Path, places: set[str]) -> None:
    assert list(wrong_paths(page, PROJECT, places)) == []


def test_a_file_that_is_not_there_is_found(tmp_path: Path) -> None:
    (tmp_path / "nep_core").mkdir()
    (tmp_path / "nep_core" / "here.py").touch()
    page = tmp_path / "page.md"
    page.write_text(
        "`nep_core/here.py`, `here.py`, `nep_core/gone.py`, `gone.py`, `nep_core/old/`, `rad/s`\n"
        "```\n`nep_core/not_read.py`\n```\n"
    )

    wrong = list(wrong_paths(page, tmp_path, all_places(tmp_path)))

    assert wrong == ["nep_core/gone.py", "gone.py", "nep_core/old/"]


def test_every_exception_is_still_named_on_a_page() -> None:
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)

    assert [name for name in NOT_HERE if f"`{name}`" not in text] == []


def imports_on(page: Path) -> Iterator[tuple[str, str]]:
    """The modules of ours that the Python on a page imports, each with a name out of it."""
    for code in PYTHON.findall(page.read_text(encoding="utf-8")):
        for node in ast.walk(ast.parse(textwrap.dedent(code))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in OURS:
                yield from ((str(node.module), alias.name) for alias in node.names)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(PROJECT).as_posix())
def test_what_the_python_of_a_page_imports_is_there(page: Path) -> None:
    for module, name in imports_on(page):
        exec(f"from {module} import {name}", {})  # as the reader's program does
