"""A start loads nothing that only some people need, and only later; ``dev.py bench start``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HEAVY = {"numpy", "pyqtgraph", "sklearn", "scipy", "unittest", "pydoc", "multiprocessing"}
START = """
import sys
from pathlib import Path
from nep_studio.settings import Settings
from nep_studio.ui.app import Studio, make_application
from nep_studio.ui.main_window import MainWindow

app = make_application()
window = MainWindow(Studio(app, Settings(Path(sys.argv[1]))))
window.show()
window.start(None)
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

    loaded = set(child.stdout.split())
    assert "nep_studio.ui.main_window" in loaded, child.stderr
    assert sorted(loaded & HEAVY) == []
