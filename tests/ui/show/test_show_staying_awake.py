"""During a show the desktop is asked to keep the screen on, and told when that is over."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest

from nep_studio.ui.plugins.show.leaving import StayingAwake

DESKTOP_AND_SHOW = """
from PySide6.QtCore import QCoreApplication, QTimer, Slot, QObject, ClassInfo
from PySide6.QtDBus import QDBusConnection, QDBusServiceWatcher
from nep_studio.ui.plugins.show.leaving import StayingAwake

@ClassInfo({"D-Bus Interface": "org.freedesktop.ScreenSaver"})
class Desktop(QObject):
    @Slot(str, str, result="uint")
    def Inhibit(self, name, reason):
        print("on", name, "/", reason, flush=True)
        asker = QDBusConnection("nep-studio-show").baseService()
        watcher = QDBusServiceWatcher(asker, bus, gone, self)
        watcher.serviceUnregistered.connect(self.forget)
        QTimer.singleShot(100, awake.end)
        return 7

    def forget(self):
        print("off", flush=True)
        app.quit()

app = QCoreApplication([])
desktop, awake = Desktop(), StayingAwake("linux")
bus = QDBusConnection.sessionBus()
gone = QDBusServiceWatcher.WatchModeFlag.WatchForUnregistration
every = QDBusConnection.RegisterOption.ExportAllSlots
assert bus.registerObject("/org/freedesktop/ScreenSaver", desktop, every)
assert bus.registerService("org.freedesktop.ScreenSaver")
QTimer.singleShot(0, awake.begin)
QTimer.singleShot(15000, app.quit)
app.exec()
"""


@pytest.mark.skipif(shutil.which("dbus-run-session") is None, reason="there is no D-Bus here")
def test_the_desktop_is_asked_and_told() -> None:
    ran = subprocess.run(
        ["dbus-run-session", "--", sys.executable, "-c", DESKTOP_AND_SHOW],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert ran.stdout.splitlines() == ["on NEP Studio / A show is on", "off"], ran.stderr


@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
def test_where_nothing_can_be_asked_nothing_fails(system: str, qapp: object) -> None:
    awake = StayingAwake(system)

    awake.begin()
    awake.begin()
    awake.end()
    awake.end()


@pytest.mark.skipif(os.name == "nt", reason="a program of a Mac is played by a script")
def test_on_a_mac_caffeinate_runs_as_long_as_the_show(tmp_path, monkeypatch, qapp: object) -> None:
    program = tmp_path / "caffeinate"
    program.write_text("#!/bin/sh\nexec sleep 60\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    awake = StayingAwake("darwin")

    awake.begin()
    process = awake._process
    is_running = process.poll() is None
    awake.end()

    assert is_running
    assert process.poll() is not None
