"""A start loads nothing that only some people need, and only later; ``dev.py bench start``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

HEAVY = {"numpy", "pyqtgraph", "sklearn", "scipy", "unittest", "pydoc", "multiprocessing"}
SELDOM = {"asyncio", "hashlib", "ssl", "http.client", "email", "PySide6.QtPrintSupport"}
"""What only a few of the things that a person may do need."""
LATER = {"nep_studio.blocks.program", "nep_studio.ui.canvas.canvas"}
"""What the first page does not need: it is loaded after that has been painted."""
WHEN_USED = {
    *("zmq", "psutil", "nep_core.processes.launcher", "nep_studio.run.local_network"),
    *("nep_studio.blocks.from_python.learning", "nep_studio.blocks.typing_in.suggesting"),
    *("nep_studio.ui.plugins.help.panel", "nep_studio.ui.plugins.log.panel"),
    "nep_studio.ui.plugins.diagrams.panel",
}
"""What the first run needs, typing, and panels that are closed at first."""

PLUGINS = "nep_studio.ui.plugins."

START = """
import sys
from pathlib import Path
from nep_studio.settings import Settings
from nep_studio.ui.shell.app import Studio, make_application
from nep_studio.ui.shell.main_window import MainWindow

app = make_application()
window = MainWindow(Studio(app, Settings(Path(sys.argv[1]))), is_gradual=True)
window.show()
window.start(None)
print(*sys.modules, file=sys.__stdout__, flush=True)
window.lazy.finish()
app.processEvents()
print(*sys.modules, file=sys.__stdout__, flush=True)
window.running.close()
"""


def test_a_window_that_shows_the_first_page_has_loaded_nothing_heavy(tmp_path: Path) -> None:
    environment = os.environ | {"QT_QPA_PLATFORM": "offscreen", "NEP_STUDIO_FOLDER": str(tmp_path)}

    child = subprocess.run(
        [sys.executable, "-c", START, str(tmp_path)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert child.returncode == 0, child.stderr
    first, complete = (set(line.split()) for line in child.stdout.splitlines())
    assert sorted(first & (LATER | WHEN_USED)) == []
    assert [name for name in first if name.startswith(PLUGINS)] == []
    assert complete >= LATER
    assert sorted(complete & (HEAVY | SELDOM | WHEN_USED)) == []
