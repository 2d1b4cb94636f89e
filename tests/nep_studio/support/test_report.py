"""``nep-studio doctor``: one report of everything that helps, without names and secrets."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from nep_core.cli.doctor import Finding, _found
from nep_studio.support.anonymous import Anonymous
from nep_studio.support.report import (
    FILE,
    Part,
    Report,
    last_lines,
    log_part,
    report_of,
    setting_lines,
)

pytestmark = pytest.mark.long

SETTINGS = """[look]
theme=dark
[files]
recent=/HOME/annaschmidt/Anna in hospital.nep
[show]
at_once=yes
pin=0123456789abcdef
[folders]
logs=/HOME/j\\xf6rg/logs
"""

LOG = """2026-01-05 10:00:00,000 INFO nep_studio: begin
2026-01-05 10:00:01,000 ERROR nep_studio.ui: Nobody expected this:
Traceback (most recent call last):
  File "{home}/nep/x.py", line 3, in <module>
ValueError: the password: open-sesame
2026-01-05 10:00:02,000 INFO nep_studio: went on, robot said Robot4Ever
2026-01-05 10:00:03,000 INFO nep_studio: {home}/Clinic/Anna in hospital.nep from 8.8.8.8:7000
"""


def doctor(home: Path, *words: str, **more: str) -> subprocess.CompletedProcess[str]:
    """The command as the person ``annaschmidt``."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("XDG")}
    told = {"HOME": str(home), "USERPROFILE": str(home), "LOGNAME": home.name, "USER": home.name}
    command = [sys.executable, "-m", "nep_studio", "doctor", *words]
    return subprocess.run(
        command,
        env=environment | told | {"QT_QPA_PLATFORM": "offscreen"} | more,
        capture_output=True,
        text=True,
        timeout=60,
    )


def test_a_saved_report_has_all_parts_and_nothing_that_tells_who_sends_it(tmp_path: Path) -> None:
    home = tmp_path / "annaschmidt"
    kept = home / ".config" / "nep-studio"
    kept.mkdir(parents=True)
    (kept / "settings.ini").write_text(SETTINGS, encoding="utf-8")
    (kept / "nep-studio.log").write_text(LOG.format(home=home), encoding="utf-8")
    (kept / "crashes.log").write_text("Fatal Python error: Aborted\n\nCurrent thread\n")
    logins = {"192.168.1.10": {"user": "nao", "password": "Robot4Ever", "fingerprint": ""}}
    (kept / "robots.json").write_text(json.dumps(logins))
    told = {"NEP_STUDIO_FOLDER": str(kept), "NEP_ROBOT_PASSWORD": "hunter2hunter2"}
    told |= {"NEP_ROBOT_USER": "klinikrobot", "LC_ODD": "\udcff"}  # bytes that are no UTF-8

    done = doctor(home, "--save", str(tmp_path), **told)

    assert done.returncode in (0, 1), done.stderr
    assert str(tmp_path / FILE) in done.stdout
    with zipfile.ZipFile(tmp_path / FILE) as file:
        assert sorted(file.namelist()) == ["report.json", "report.txt"]
        text, data = file.read("report.txt").decode(), file.read("report.json").decode()
    report = report_of(data)
    assert [part.title for part in report.parts][:8] == [
        *("NEP Studio", "Computer", "Screen, graphics and sound", "Network", "Folders", "Nodes"),
        *("Settings", "Last crash"),
    ]
    secrets = ("annaschmidt", "Robot4Ever", "hunter2", "open-sesame", "0123456789ab", "jörg")
    for secret in (*secrets, "klinikrobot", "Clinic", "hospital", "8.8.8.8"):
        assert secret not in text + data
    assert "~/<folder>/x.py" in text
    assert "Fatal Python error: Aborted" in text
    assert "Atkinson Hyperlegible" in text
    assert report.text() == text


def test_a_qt_that_cannot_start_is_told_with_what_to_do(tmp_path: Path) -> None:
    home = tmp_path / "annaschmidt"
    home.mkdir()

    done = doctor(home, "--json", QT_QPA_PLATFORM="imaginary")

    report = report_of(done.stdout)
    [screen] = [part for part in report.parts if part.title.startswith("Screen")]
    [qt] = [one for one in screen.findings if one.state == "look"]
    assert done.returncode == 1
    assert "imaginary" in qt.sentence
    assert "nep-studio --safe-mode" in qt.steps[1]
    assert not report.is_sound


def test_a_report_is_the_same_after_its_way_through_json(tmp_path: Path) -> None:
    parts = [Part("One", (Finding("a", "look", "it is so", ("do that",)),), ("line",))]
    report = Report.of(parts, Anonymous())

    again = report_of(report.json())

    assert again == report
    assert "  One: a" in again.text()
    assert "[ ] do that" in again.text()


@pytest.mark.parametrize("text", ["", "{}", "nonsense", "[1]", '{"parts": 3, "made": ""}'])
def test_what_is_no_report_is_refused(text: str) -> None:
    with pytest.raises(ValueError):
        report_of(text)


def test_settings_are_shown_without_secrets_and_names_of_projects(tmp_path: Path) -> None:
    file = tmp_path / "settings.ini"
    file.write_text(SETTINGS, encoding="utf-8")

    lines = list(setting_lines(file))

    assert "theme=dark" in lines
    assert "at_once=yes" in lines
    assert "pin=(16 letters, not shown)" in lines
    assert "recent=(38 letters, not shown)" in lines
    assert "logs=/HOME/jörg/logs" in lines
    assert list(setting_lines(tmp_path / "missing.ini")) == ["(no such file or directory)"]


def test_of_damaged_settings_a_report_holds_no_more_than_it_can_show(tmp_path: Path) -> None:
    file = tmp_path / "settings.ini"
    file.write_bytes(b"[look]\nname=\\xd83d\n" + b"\x1b" * 5000 + b"\nx=1" * 100_000)

    report = Report.of([Part("Settings", lines=tuple(setting_lines(file)))], Anonymous())

    assert "name=?" in report.text()
    assert "\x1b" not in report.text()
    assert len(report.json().encode()) < 20_000


def test_a_check_that_fails_hides_no_other() -> None:
    def fail() -> Finding:
        raise RuntimeError("Could not determine home directory.")

    [found] = _found("home", fail)

    assert (found.about, found.state) == ("home", "unknown")


def test_of_a_long_log_the_last_whole_lines_are_kept(tmp_path: Path) -> None:
    log = tmp_path / "node.log"
    log.write_bytes(b"".join(b"line %d\n" % number for number in range(20_000)) + b"\xff end")

    part = log_part(log)

    assert part.lines[-2:] == ("line 19999", "\ufffd end")
    assert len(part.lines) == 60
    assert all(line.startswith("line ") for line in last_lines(log)[:-1])
    assert log_part(tmp_path / "none.log").findings[0].state == "note"


def test_a_report_that_cannot_be_written_is_told_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")

    with pytest.raises(OSError):
        Report((), "now").save(tmp_path / "file" / "report.zip")

    assert [path.name for path in tmp_path.iterdir()] == ["file"]
