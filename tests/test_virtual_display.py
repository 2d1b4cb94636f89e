"""A display of our own: Qt opens a window on it, nobody else may, and it ends."""

import os
import subprocess
import sys

import pytest

from benchmarks import virtual_display

SHOW = """
from PySide6.QtWidgets import QApplication, QLabel
application = QApplication([])
label = QLabel("hello")
label.show()
application.processEvents()
print(application.platformName(), label.isVisible())
"""


def show(environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", SHOW]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)


def test_qt_opens_a_window_on_the_display(xvfb: dict[str, str]) -> None:
    shown = show(xvfb)

    assert shown.stdout == "xcb True\n", shown.stderr


def test_without_the_key_nobody_may_use_the_display(xvfb: dict[str, str]) -> None:
    refused = show(xvfb | {"XAUTHORITY": os.devnull})

    assert refused.returncode != 0
    assert "could not connect to display" in refused.stderr


def test_without_the_programs_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")

    with (
        pytest.raises(virtual_display.NoDisplay, match="apt-get install xvfb xauth"),
        virtual_display.virtual_display(),
    ):
        pass
