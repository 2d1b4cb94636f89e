"""The fonts that come with the program, made known to Qt."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from functools import cache

from PySide6.QtGui import QFont, QFontDatabase

from nep_studio import paths

log = logging.getLogger(__name__)

_JAPANESE_FILE = "NotoSansJPNEP-Regular.ttf"


@dataclass(frozen=True)
class Fonts:
    """The families that texts and code are set in, the first choice first."""

    text: tuple[str, ...]
    code: tuple[str, ...]


@cache
def load_fonts() -> Fonts:
    """Make the shipped fonts known to Qt, once, and return their families.

    The Japanese one has kana and common kanji only, so it serves only where the system has none.
    """
    folder = paths.resources() / "fonts"
    text = _load([str(path) for path in sorted(folder.glob("AtkinsonHyperlegibleNext-*.ttf"))])
    code = _load([str(path) for path in sorted(folder.glob("AtkinsonHyperlegibleMono-*.ttf"))])
    if not QFontDatabase.families(QFontDatabase.WritingSystem.Japanese):
        japanese = _load([str(folder / _JAPANESE_FILE)])
        text, code = [*text, *japanese], [*code, *japanese]
    return Fonts(tuple(text), tuple(code))


def text_font(point_size: float, weight: QFont.Weight = QFont.Weight.Normal) -> QFont:
    """Return the font of the window's words."""
    return _font(load_fonts().text, QFont.StyleHint.SansSerif, point_size, weight)


def code_font(point_size: float, weight: QFont.Weight = QFont.Weight.Normal) -> QFont:
    """Return the font of programs, all characters equally wide."""
    font = _font(load_fonts().code, QFont.StyleHint.Monospace, point_size, weight)
    font.setFixedPitch(True)
    return font


def _font(
    families: tuple[str, ...], hint: QFont.StyleHint, point_size: float, weight: QFont.Weight
) -> QFont:
    font = QFont(list(families))
    font.setStyleHint(hint)
    font.setPointSizeF(point_size)
    font.setWeight(weight)
    return font


def _load(files: list[str]) -> list[str]:
    families: list[str] = []
    for file in files:
        number = QFontDatabase.addApplicationFont(file)
        found = QFontDatabase.applicationFontFamilies(number) if number >= 0 else []
        if not found:
            log.warning("The font %s cannot be read.", file)
        families += found
    return [min(families, key=len)] if families else []  # not "... SemiBold", which is one weight
