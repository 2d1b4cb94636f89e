"""The measures of the house: sizes, importers, and circles in three ways."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import dev
from tools.house import House, Known, measured

pytestmark = pytest.mark.long

ROOT = Path(dev.__file__).parent


@pytest.fixture
def house(tmp_path: Path) -> House:
    """A package of four files: two import each other late, three for types."""
    package = tmp_path / "ours"
    package.mkdir()
    files = {
        "__init__": '"""Ours."""\n',
        "window": (
            "from .canvas import Canvas\n\n\nclass MainWindow:\n"
            "    def take(self, canvas: Canvas) -> None:\n        pass\n" + "x = 1\n" * 600
        ),
        "canvas": (
            "from __future__ import annotations\nfrom typing import TYPE_CHECKING\n"
            "if TYPE_CHECKING:\n    from .panel import Panel\n\n\nclass Canvas:\n"
            '    def ask(self, window: "MainWindow | None", panel: Panel) -> None:\n'
            "        from ours import window as known\n"
        ),
        "panel": "import ours.window\nfrom ours.window import MainWindow\n",
    }
    for name, text in files.items():
        (package / f"{name}.py").write_text(text)
    return measured(tmp_path, ("ours",))


def test_files_and_lines_are_counted(house: House) -> None:
    assert (house.files, house.lines) == (4, 1 + 606 + 9 + 2)
    assert house.median == 5.5
    assert house.small == ["ours/__init__.py", "ours/canvas.py", "ours/panel.py"]
    assert house.large == ["ours/window.py"]
    assert house.largest == []


def test_circles_are_found_at_import_with_late_and_with_typing_imports(house: House) -> None:
    assert house.circles == {
        "at import": [],
        "with late imports": [2],
        "with typing imports": [3],
    }


def test_importers_and_who_knows_a_class_are_counted(house: House) -> None:
    assert house.with_one_importer == 2  # canvas and panel; the window has two
    assert house.known["Canvas"] == Known(parameters=1, files_of_parameters=1, files=1)


def test_the_script_measures_this_house() -> None:
    command = [sys.executable, str(ROOT / "tools" / "house.py")]

    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=True)

    words = ("files", "lines", "parameters typed MainWindow", "circles with typing imports")
    assert all(any(line.startswith(word) for line in done.stdout.splitlines()) for word in words)
