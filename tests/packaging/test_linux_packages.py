"""The .deb and what desktops read: names, types and versions agree, tools find nothing wrong."""

import configparser
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import appimage
import deb
import linux_files
import parts
import pytest

from nep_studio import __version__
from nep_studio.support import safe_mode

DESKTOP = linux_files.LINUX / "nep-studio.desktop"
MIME = linux_files.LINUX / "nep-studio.xml"
METAINFO = linux_files.LINUX / "org.nep.studio.metainfo.xml"
IN_XML = {"mime": "http://www.freedesktop.org/standards/shared-mime-info"}


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A folder laid out as the frozen one, with hardly anything in it."""
    folder = tmp_path / "program"
    (folder / "_internal").mkdir(parents=True)
    (folder / "nep-studio").write_bytes(b"GLIBC_2.2.5\0GLIBC_2.34\0GLIBC_2.9\0")
    (folder / "nep-studio").chmod(0o700)
    (folder / "nep").symlink_to("nep-studio")
    (folder / "_internal" / "libzmq.so.5").write_bytes(b"GLIBC_2.17\0")
    (folder / "_internal" / "libzmq.so.5").chmod(0o700)
    return folder


def entry(section: str = "Desktop Entry") -> configparser.SectionProxy:
    parser = configparser.ConfigParser(interpolation=None)
    parser.optionxform = str  # type: ignore[assignment, method-assign]
    parser.read(DESKTOP, encoding="utf-8")
    return parser[section]


def test_the_menu_entry_opens_the_projects_that_the_system_knows_by_their_ending() -> None:
    mime = ElementTree.parse(MIME).getroot()
    kind = mime.find("mime:mime-type", IN_XML)
    assert kind is not None

    glob = kind.find("mime:glob", IN_XML)

    assert glob is not None and glob.get("pattern") == "*.nep"
    assert kind.get("type") == linux_files.MIME_TYPE
    assert entry()["MimeType"] == f"{linux_files.MIME_TYPE};"
    assert entry()["Exec"] == f"{parts.NAME} %f"
    assert entry()["Icon"] == parts.NAME


def test_the_menu_entry_offers_safe_mode_in_the_words_of_the_window() -> None:
    action = entry("Desktop Action safe-mode")

    names = {key.partition("[")[2].rstrip("]"): value for key, value in action.items()}

    assert entry()["Actions"] == "safe-mode;"
    assert action["Exec"] == f"{parts.NAME} {safe_mode.OPTION}"
    words = action["Name"]
    for file in sorted((parts.ROOT / "resources" / "translations").glob("*.toml")):
        assert f'"{words}" = "{names[file.stem]}"\n' in file.read_text(encoding="utf-8")


def test_software_shops_are_told_this_version_and_the_menu_entry() -> None:
    metainfo = ElementTree.parse(METAINFO).getroot()

    assert metainfo.findtext("id") == parts.ID
    assert metainfo.findtext("launchable") == DESKTOP.name
    assert metainfo.findtext("provides/mediatype") == linux_files.MIME_TYPE
    releases = [release.get("version") for release in metainfo.iter("release")]
    assert releases[0] == __version__
    assert re.fullmatch(r"\d+\.\d+\.\d+", __version__)  # Windows and Debian read it as a number


@pytest.mark.parametrize(
    "command",
    [
        ["desktop-file-validate", DESKTOP],
        ["appstreamcli", "validate", "--no-net", "--pedantic", METAINFO],
        ["sh", "-n", linux_files.LINUX / "try_in_debian.sh"],
        ["sh", "-n", linux_files.LINUX.parent / "macos" / "dmg.sh"],
    ],
    ids=["menu", "shop", "try_in_debian", "dmg"],
)
def test_the_tools_of_others_find_nothing_wrong(command: list[str | Path]) -> None:
    if shutil.which(str(command[0])) is None:
        pytest.skip(f"{command[0]} is not here")

    checked = subprocess.run(command, capture_output=True, text=True)

    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_the_tree_has_the_program_its_names_and_everything_that_desktops_read(
    program: Path, tmp_path: Path
) -> None:
    root = tmp_path / "root"

    linux_files.lay_out(program, root)

    for name in ("nep-studio", "nep"):
        link = root / "usr" / "bin" / name
        assert link.resolve() == root / "usr" / "lib" / "nep-studio" / "nep-studio"
        assert not os.path.isabs(os.readlink(link))
    share = root / "usr" / "share"
    for path in ("applications/nep-studio.desktop", "mime/packages/nep-studio.xml"):
        assert (share / path).is_file()
    icons = share / "icons" / "hicolor"
    assert (icons / "48x48" / "apps" / "nep-studio.png").is_file()
    assert (icons / "scalable/mimetypes/application-x-nep-studio-project.svg").is_file()
    assert (root / "usr/lib/nep-studio/nep-studio").stat().st_mode & 0o777 == 0o755
    assert (root / "usr/lib/nep-studio/_internal/libzmq.so.5").stat().st_mode & 0o777 == 0o644


@pytest.mark.skipif(shutil.which("dpkg-deb") is None, reason="no dpkg-deb")
def test_debian_reads_from_the_package_what_it_is_and_needs(program: Path, tmp_path: Path) -> None:
    umask = os.umask(0o077)  # a careful person builds it
    try:
        made = deb.build(program, tmp_path, "plain")
    finally:
        os.umask(umask)

    fields = ["Package", "Version", "Depends"]
    shown = subprocess.check_output(["dpkg-deb", "--field", made, *fields], text=True)
    listed = subprocess.check_output(["dpkg-deb", "--contents", made], text=True)
    assert "Package: nep-studio\n" in shown
    assert f"Version: {__version__}\n" in shown
    assert "libc6 (>= 2.34), libegl1, libgl1" in shown
    assert "python" not in shown
    assert all(" root/root " in line for line in listed.splitlines())
    modes = {line.split()[0] for line in listed.splitlines()}
    assert modes == {"drwxr-xr-x", "-rwxr-xr-x", "-rw-r--r--", "lrwxrwxrwx"}


def test_the_appimage_starts_the_program_under_both_names(program: Path, tmp_path: Path) -> None:
    root = tmp_path / "AppDir"
    appimage.lay_out(program, root)
    started = root / "usr" / "lib" / "nep-studio" / "nep-studio"
    started.write_text('#!/bin/sh\necho "${0##*/} $*"\n')
    environment = {"APPDIR": str(root), "PATH": os.environ["PATH"]}

    said = [
        subprocess.check_output(
            [root / "AppRun", "one", "two words"], env={**environment, **more}, text=True
        )
        for more in ({}, {"ARGV0": "/somewhere/nep"})
    ]

    assert said == ["nep-studio one two words\n", "nep one two words\n"]
    assert (root / "nep-studio.desktop").is_file() and (root / "nep-studio.png").is_file()
