"""The installers of Windows and macOS, the archive and the release: what can be checked here."""

import re
import shutil
import sys
import tarfile
from pathlib import Path

import archive
import nsis
import package
import parts
import pytest

import dev
from nep_studio import __version__

RELEASE = parts.ROOT / ".github" / "workflows" / "release.yml"


@pytest.mark.skipif(shutil.which("makensis") is None, reason="no makensis")
def test_the_installer_for_windows_is_made_of_the_whole_folder(tmp_path: Path) -> None:
    program = tmp_path / "program"
    (program / "_internal").mkdir(parents=True)
    for name in (*parts.PROGRAMS["win32"], "_internal/python3"):
        (program / f"{name}.exe").write_bytes(b"MZ")

    made = nsis.build(program, tmp_path)

    assert made.name == f"NEP-Studio-{__version__}-Windows.exe"
    assert made.read_bytes()[:2] == b"MZ"


def test_the_installer_for_windows_asks_no_administrator_and_takes_away_what_it_brought() -> None:
    script = nsis.SCRIPT.read_text(encoding="utf-8")
    installing, removing = script.split('Section "Uninstall"')

    assert "RequestExecutionLevel user" in script
    assert "HKLM" not in script and "$PROGRAMFILES" not in script
    for name in parts.PROGRAMS["win32"]:
        assert f'StopIfRunning "$INSTDIR\\{name}.exe"' in removing
        assert f'Delete "$INSTDIR\\{name}.exe"' in removing
    assert 'RMDir /r "$INSTDIR"\n' not in removing  # it may be a folder that holds more
    for key in set(re.findall(r'WriteReg\w+ HKCU "([^"]+)"', installing)):
        kept = key.removesuffix(r"\shell\open\command").removesuffix(r"\DefaultIcon")
        assert re.search(rf'DeleteReg\w+ (/ifempty )?HKCU "{re.escape(kept)}"', removing), key


def test_the_archive_unpacks_into_one_folder_that_belongs_to_nobody(tmp_path: Path) -> None:
    (tmp_path / "program").mkdir(mode=0o700)
    (tmp_path / "program" / "nep-studio").write_text("it")
    (tmp_path / "program" / "nep-studio").chmod(0o700)

    made = archive.build(tmp_path / "program", tmp_path, preset=0)

    with tarfile.open(made) as opened:
        members = {member.name: member for member in opened}
    folder = made.name.removesuffix(".tar.xz")
    assert set(members) == {folder, f"{folder}/nep-studio"}
    assert {(member.uid, member.gname) for member in members.values()} == {(0, "root")}
    assert {member.mode for member in members.values()} == {0o755}


@pytest.mark.parametrize(
    ("system", "has_tool", "packers"),
    [
        ("linux", False, ["deb.py", "archive.py"]),
        ("linux", True, ["deb.py", "archive.py", "appimage.py"]),
        ("win32", False, ["nsis.py"]),
        ("darwin", False, ["dmg.sh"]),
    ],
)
def test_each_system_tries_what_it_froze_before_it_packs_it(
    system: str, has_tool: bool, packers: list[str]
) -> None:
    steps = package.steps(system, is_quick=False, has_appimagetool=has_tool)

    scripts = [next(word for word in step[1:] if Path(word).suffix) for step in steps]
    assert [Path(script).name for script in scripts] == ["freeze.py", "smoke.py", *packers]
    assert all(Path(script).is_file() for script in scripts)


def test_the_release_uses_actions_by_their_major_version_and_the_command_of_everybody() -> None:
    release = RELEASE.read_text(encoding="utf-8")

    uses = re.findall(r"uses: (\S+)", release)

    assert uses and all(re.fullmatch(r"actions/[\w-]+@v\d+", action) for action in uses)
    assert "run: python dev.py package" in release
    assert {"ubuntu-22.04", "windows-2022", "macos-14"} <= set(
        re.findall(r"[\w.]+-[\w.-]+", release)
    )
    assert "package" in dev.modules([], is_shown=False)


def test_every_system_that_is_packed_has_its_programs() -> None:
    assert set(parts.PROGRAMS) == {"linux", "win32", "darwin"}
    assert sys.platform in parts.PROGRAMS


def test_freezing_takes_along_what_is_here_so_that_it_must_be_here() -> None:
    freezing, nothing = dev.system_needs("freeze", [], is_shown=False)
    packaging, tools = dev.system_needs("package", [], is_shown=False)

    assert freezing == packaging
    assert {"libgl1", "libxcb-icccm4", "binutils"} <= set(freezing)
    assert nothing == {}
    trying, _ = dev.system_needs("test", ["-m", "freeze"], is_shown=False)
    assert "binutils" in trying
    assert {"dpkg", "nsis", "appstream", "desktop-file-utils", "xz-utils"} == set(tools)


def test_what_packs_is_a_file_that_python_is_told_to_run() -> None:
    freezing, packing = (
        dev.modules(["--quick"], is_shown=False)[name][0] for name in ("freeze", "package")
    )

    assert dev.how_to_run(freezing) == ["packaging/freeze.py"]
    assert dev.how_to_run(packing) == ["packaging/package.py", "--quick"]
    assert dev.how_to_run(["pytest", "-x"]) == ["-m", "pytest", "-x"]
    assert all((parts.ROOT / script[0]).is_file() for script in (freezing, packing))
