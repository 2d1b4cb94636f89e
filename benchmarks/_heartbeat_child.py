"""A real window under load, in a process of its own: prints its longest hold-ups as JSON."""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from PySide6.QtCore import QEventLoop, QTimer

from benchmarks.gui_loads import LOADS, PREPARATIONS
from benchmarks.heartbeat import Heartbeat
from nep_studio.settings import Settings
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.app import make_application
from nep_studio.ui.shell.main_window import MainWindow

LONGEST_S = 90.0
LOOK_MS = 20
SETTLE_S = 0.5


def wait(condition: Callable[[], bool]) -> None:
    """Run the event loop until a condition holds."""
    loop, end_s = QEventLoop(), time.monotonic() + LONGEST_S
    timer = QTimer(interval=LOOK_MS)
    timer.timeout.connect(lambda: loop.quit() if condition() or time.monotonic() > end_s else None)
    timer.start()
    loop.exec()
    timer.stop()
    if time.monotonic() > end_s:
        raise TimeoutError("the window did not come to where it should")


def measure(folder: Path) -> dict[str, dict[str, float]]:
    """The longest hold-ups under each load."""
    app = make_application()
    window = MainWindow(Studio(app, Settings(folder)))
    window.show()
    window.start(None)
    heartbeat = Heartbeat()
    found = {}
    for name, load in LOADS.items():
        if name in PREPARATIONS:
            PREPARATIONS[name](window, folder, wait)
        settled_s = time.monotonic() + SETTLE_S
        wait(lambda settled_s=settled_s: time.monotonic() > settled_s)  # type: ignore[misc]
        heartbeat.begin()
        load(window, folder, wait)
        found[name] = asdict(heartbeat.end()) | {"beats": heartbeat.beats}
        window.running.runner.stop()
        wait(lambda: window.running.runner.state == "idle")
    window.running.close()
    return found


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="nep-heartbeat-", ignore_cleanup_errors=True) as home:
        os.environ["NEP_STUDIO_FOLDER"] = home
        result = measure(Path(home))
        print(json.dumps(result), file=sys.stdout, flush=True)
        os._exit(0)
