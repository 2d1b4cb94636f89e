"""The files that start a show with the computer are what each system can read."""

from __future__ import annotations

import plistlib
import shutil
import subprocess
from configparser import ConfigParser
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.support.startup import NAME, Place, remove, startup_files, write

COMMAND = ["/opt/nep studio/python", "-m", "nep_studio", "show", '/srv/ü/50 % "a\\b" $x `y`.nep']
WORDS = st.text(
    st.characters(codec="utf-8", exclude_categories=("Cc", "Cs")), min_size=1, max_size=12
)


def place(tmp_path: Path, system: str, *, has_systemd: bool = False) -> Place:
    return Place(system, tmp_path, tmp_path / "settings", has_systemd)


def exec_words(value: str) -> list[str]:
    """The words of an Exec key, by the rules of the Desktop Entry Specification."""
    for sign, letter in (("\\\\", "\0"), ("\\n", "\n"), ("\\s", " ")):
        value = value.replace(sign, letter)
    value = value.replace("\0", "\\").replace("%%", "%")
    words, word, is_inside, is_escaped = [], "", False, False
    for letter in value:
        if is_escaped:
            word, is_escaped = word + letter, False
        elif is_inside and letter == "\\":
            is_escaped = True
        elif letter == '"':
            is_inside = not is_inside
            if not is_inside:
                words.append(word)
                word = ""
        elif is_inside:
            word += letter
        else:
            assert letter == " "
    return words


def unit_words(value: str) -> list[str]:
    """The words of ExecStart, by the rules of systemd.service(5), all of them in quotes."""
    value = value.replace("%%", "%").replace("$$", "$")
    words, rest = [], value
    while rest:
        assert rest[0] == '"'
        end = 1
        while rest[end] != '"':
            end += 2 if rest[end] == "\\" else 1
        words.append(rest[1:end].replace('\\"', '"').replace("\\\\", "\\"))
        rest = rest[end + 1 :].removeprefix(" ")
    return words


def read(text: str) -> ConfigParser:
    parser = ConfigParser(interpolation=None, strict=True, delimiters=("=",))
    parser.optionxform = str
    parser.read_string(text)
    return parser


def test_a_desktop_without_systemd_starts_the_show_at_login(tmp_path: Path) -> None:
    [file] = startup_files(place(tmp_path, "linux"), COMMAND)

    entry = read(file.text)["Desktop Entry"]
    assert file.path == tmp_path / "settings" / "autostart" / f"{NAME}.desktop"
    assert (entry["Type"], entry["Terminal"]) == ("Application", "false")
    assert entry["Name"]
    assert exec_words(entry["Exec"]) == COMMAND


@given(st.lists(WORDS, min_size=1, max_size=4))
def test_every_command_survives_the_quotes_of_a_desktop_file(command: list[str]) -> None:
    [file] = startup_files(Place("linux", Path("/h"), Path("/s")), command)

    line = next(line for line in file.text.split("\n") if line.startswith("Exec="))

    assert exec_words(line.removeprefix("Exec=")) == command


@given(st.lists(WORDS, min_size=1, max_size=4))
def test_every_command_survives_the_quotes_of_a_unit(command: list[str]) -> None:
    unit, _ = startup_files(Place("linux", Path("/h"), Path("/s"), True), command)

    line = next(line for line in unit.text.split("\n") if line.startswith("ExecStart="))

    assert unit_words(line.removeprefix("ExecStart=")) == command


def test_with_systemd_a_unit_starts_it_again_and_the_desktop_starts_the_unit(
    tmp_path: Path,
) -> None:
    unit, desktop = startup_files(place(tmp_path, "linux", has_systemd=True), COMMAND)

    service = read(unit.text)["Service"]
    assert unit.path == tmp_path / "settings" / "systemd" / "user" / f"{NAME}.service"
    assert (service["Restart"], service["RestartPreventExitStatus"]) == ("always", "0")
    assert read(unit.text)["Unit"]["StartLimitIntervalSec"] == "0"
    words = exec_words(read(desktop.text)["Desktop Entry"]["Exec"])
    assert words[:2] == ["/bin/sh", "-c"]
    assert f"restart {NAME}.service" in words[2]
    assert subprocess.run(["/bin/sh", "-n", "-c", words[2]], check=False).returncode == 0


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not here")
def test_systemd_itself_finds_nothing_wrong_with_the_unit(tmp_path: Path) -> None:
    command = ["/bin/sh", "-c", 'echo "50 %" $HOME', "a\\b"]
    unit, _ = startup_files(place(tmp_path, "linux", has_systemd=True), command)
    write([unit])

    said = subprocess.run(
        ["systemd-analyze", "--user", "verify", str(unit.path)],
        capture_output=True,
        text=True,
        check=False,
        env={"HOME": str(tmp_path), "XDG_RUNTIME_DIR": str(tmp_path), "PATH": "/usr/bin:/bin"},
    )

    assert unit.path.name not in said.stderr


def test_a_mac_keeps_it_alive_until_it_ends_well(tmp_path: Path) -> None:
    [file] = startup_files(place(tmp_path, "darwin"), COMMAND)

    agent = plistlib.loads(file.text.encode())
    assert file.path.parent == tmp_path / "Library" / "LaunchAgents"
    assert agent["ProgramArguments"] == COMMAND
    assert agent["RunAtLoad"] is True
    assert agent["KeepAlive"] == {"SuccessfulExit": False}
    assert file.path.name == f"{agent['Label']}.plist"


def test_windows_runs_it_in_a_loop_that_a_good_end_leaves(tmp_path: Path) -> None:
    command = [r"C:\Program Files\NEP\nep.exe", "show", r"C:\Stücke\50 %.nep"]

    [file] = startup_files(place(tmp_path, "win32"), command)

    lines = file.text.split("\r\n")
    assert file.path.parent.name == "Startup"
    assert '"C:\\Program Files\\NEP\\nep.exe" "show" "C:\\Stücke\\50 %%.nep"' in lines
    assert lines.index(":again") < lines.index("if %errorlevel% equ 0 exit /b 0")
    assert lines[-2] == "goto again"
    assert "\n" not in file.text.replace("\r\n", "")


@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
def test_files_are_written_as_shown_and_taken_away_again(tmp_path: Path, system: str) -> None:
    files = startup_files(place(tmp_path, system, has_systemd=True), COMMAND)
    before = [file.is_there for file in files]

    write(files)
    written = [file.is_as_written for file in files]
    found = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    remove(files)

    assert not any(before)
    assert all(written)
    assert found == sorted(file.path for file in files)
    assert not any(file.is_there for file in files)
    remove(files)  # again does no harm
