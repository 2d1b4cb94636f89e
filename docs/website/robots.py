"""On which robots a block works: what was tried, and what a robot has fewer of."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from functools import cache
from html import escape
from pathlib import Path

from nep_studio import paths
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.ui.canvas.fields.editors import slot_name
from nep_studio.ui.words import tr

from .words import word

TRIED = Path(__file__).resolve().parents[1] / "robot_blocks.md"
"""What docs/make_robot_blocks.py found out about each block, on both robots."""

_ROW = re.compile(r"\| (.+) \| (.+) \| (yes|\*\*no\*\*) \| (yes|\*\*no\*\*) \|")
OURS = "nao"


@cache
def tried() -> dict[str, tuple[str, bool, bool]]:
    """By the English sentence of a block: what was looked at, and whether it was right on each."""
    rows = (_ROW.fullmatch(line) for line in TRIED.read_text(encoding="utf-8").splitlines())
    return {row[1]: (row[2], row[3] == "yes", row[4] == "yes") for row in rows if row}


@cache
def others() -> dict[str, dict[str, dict[str, object]]]:
    """The choices of the other robots that we ship, by their titles."""
    files = sorted((paths.resources() / "robots").glob("*/robot.toml"))
    told = [tomllib.loads(file.read_text("utf-8")) for file in files if file.parent.name != OURS]
    return {each["title"]: each["choices"] for each in told}


def robots_html(code: str, language: Language, definition: Definition, english: Definition) -> str:
    """What is said of robots in the part about a block."""
    heading = f"<h3>{escape(word(code, 'robots'))}</h3>"
    found = tried().get(english.told.replace("|", "\\|"))
    if found is None:
        return f"{heading}<p>{escape(word(code, 'any_robot'))}</p>"
    look, on_screen, on_real = found
    lines = [
        _line(code, "screen", on_screen, look if code == "en" else ""),
        _line(code, "real", on_real),
        *(escape(line) for line in _fewer(code, language, definition)),
    ]
    return f'{heading}<ul class="robots">{"".join(f"<li>{line}</li>" for line in lines)}</ul>'


def _line(code: str, robot: str, works: bool, look: str = "") -> str:
    sign = '<span aria-hidden="true">✓</span> ' if works else ""
    tail = f" (tried by a test: {escape(look)})" if look else ""
    answer = word(code, "yes" if works else "no")
    return f"{sign}{escape(word(code, robot))}: {escape(answer)}{tail}"


def _fewer(code: str, language: Language, definition: Definition) -> Iterator[str]:
    for title, choices in others().items():
        for slot in definition.slots.values():
            known = language.choices.get(slot.table, {})
            some = [name for name in choices.get(slot.table, {}) if name in known]
            if some and len(some) < len(known):
                values = {"robot": title, "some": len(some), "all": len(known)}
                yield word(code, "fewer", **values, slot=tr(slot_name(slot)))
