"""The site, made once as a person makes it, in English and in Japanese."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.conftest import PROJECT
from tests.docs.terminals import wait_until

LANGUAGES = ("en", "ja")


class MadeSite:
    """The files of the site, read once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.pages = {
            path.relative_to(folder).as_posix(): _read(path) for path in folder.rglob("*.html")
        }

    def text(self, name: str) -> str:
        """What is in a file."""
        return (self.folder / name).read_text(encoding="utf-8")

    def anchors(self, page: str) -> set[str]:
        """The places in a page that a link can lead to."""
        return {
            element.attrib["id"] for element in self.pages[page].iter() if "id" in element.attrib
        }


def _read(path: Path) -> Element:
    """A page, which must be well formed."""
    text = path.read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>\n"), path
    return fromstring(text.removeprefix("<!DOCTYPE html>\n"))


@pytest.fixture(scope="session")
def made_site(tmp_path_factory: pytest.TempPathFactory) -> MadeSite:
    """It is made once, whoever of several processes of pytest needs it first."""
    shared = tmp_path_factory.getbasetemp()
    shared = shared.parent if "PYTEST_XDIST_WORKER" in os.environ else shared
    folder, said = shared / "site", shared / "site.txt"
    try:
        (shared / "site.begun").mkdir()
    except FileExistsError:
        wait_until(said.exists, lambda: "another process makes the site")
    else:
        _make(folder, said)
    assert (folder / "index.html").is_file(), said.read_text(encoding="utf-8")
    return MadeSite(folder)


def _make(folder: Path, said: Path) -> None:
    """Make the site; what that said is in a file when it is done."""
    command = [sys.executable, str(PROJECT / "tools" / "build_site.py"), "--folder", str(folder)]
    done = subprocess.run([*command, "--languages", *LANGUAGES], capture_output=True, text=True)
    written = said.with_suffix(".part")
    written.write_text(done.stdout + done.stderr, encoding="utf-8")
    written.replace(said)
