"""A report that a person can send to those who help: what is in it, as text, JSON and a file.

Everything that leaves this module has been made anonymous.
"""

from __future__ import annotations

import io
import time
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from nep_core.cli.doctor import finding_lines
from nep_core.cli.finding import Finding
from nep_studio.anonymous import Anonymous

FILE = "NEP Studio report.zip"
FORMAT = "nep-studio-report"
VERSION = 1
START = (
    "Report of NEP Studio for support",
    "",
    "Names of people, computers, folders and projects have been taken out,",
    "and so have passwords, keys and addresses of the internet.",
    "Read it before you send it: what programs and nodes wrote into logs is in it too.",
)


@dataclass(frozen=True)
class Part:
    """A part of the report: findings, and lines as some program wrote them."""

    title: str
    findings: tuple[Finding, ...] = ()
    lines: tuple[str, ...] = ()


@dataclass(frozen=True)
class Report:
    """All parts, and when they were made (as ISO 8601)."""

    parts: tuple[Part, ...]
    made: str

    @classmethod
    def of(cls, parts: Sequence[Part], anonymous: Anonymous) -> Report:
        """The report of parts, without what tells who the person is."""
        made = time.strftime("%Y-%m-%dT%H:%M:%S%z")
        return cls(tuple(_without_names(part, anonymous) for part in parts), made)

    @property
    def is_sound(self) -> bool:
        """Whether there is nothing to look at."""
        return not any(one.state == "look" for part in self.parts for one in part.findings)

    def text(self) -> str:
        """The report for people."""
        looks = [
            f"  {part.title}: {one.about}"
            for part in self.parts
            for one in part.findings
            if one.state == "look"
        ]
        looks = looks or ["  Nothing of what was checked is wrong."]
        lines = [*START, self.made, "", "Look at", "=======", *looks]
        for part in self.parts:
            lines += ["", part.title, "=" * len(part.title), *finding_lines(part.findings)]
            lines += [f"  {line}" for line in part.lines]
        return "\n".join([*lines, ""])

    def json(self) -> str:
        """The same for machines."""
        told = {"format": FORMAT, "version": VERSION, "made": self.made, "parts": self.parts}
        return msgspec.json.encode(told).decode()

    def save(self, path: Path) -> None:
        """Write a zip file with both, as a whole; raises OSError."""
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as file:
            file.writestr("report.txt", self.text())
            file.writestr("report.json", self.json())
        new = path.with_name(f".{path.name}.new")
        try:
            new.write_bytes(made.getvalue())
            new.replace(path)
        finally:
            new.unlink(missing_ok=True)


def report_of(text: bytes | str) -> Report:
    """The report that ``json`` gave; raises msgspec.MsgspecError (a ValueError)."""

    class Told(msgspec.Struct):
        made: str
        parts: tuple[Part, ...]

    told = msgspec.json.decode(text, type=Told)
    return Report(told.parts, told.made)


def _without_names(part: Part, anonymous: Anonymous) -> Part:
    hide = anonymous.text
    return Part(
        hide(part.title),
        tuple(
            Finding(hide(one.about), one.state, hide(one.told), tuple(map(hide, one.steps)))
            for one in part.findings
        ),
        tuple(hide("\n".join(part.lines)).splitlines()),  # together: a key may take many lines
    )
