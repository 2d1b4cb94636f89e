"""The shipped fonts: known to Qt, with the weights and characters that the program needs."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QFont, QFontInfo, QFontMetricsF, QRawFont

from nep_studio import paths
from nep_studio.ui.theme.look import Fonts, code_font, text_font

FOLDER = paths.resources() / "fonts"
JAPANESE = FOLDER / "NotoSansJPNEP-Regular.ttf"

LETTERS = "aZ09äßéñłőşžğİ“”…\N{EN DASH}\N{MULTIPLICATION SIGN}÷°€"


def test_the_families_are_the_shipped_ones(fonts: Fonts) -> None:
    assert fonts.text[0] == "Atkinson Hyperlegible Next"
    assert fonts.code[0] == "Atkinson Hyperlegible Mono"


@pytest.mark.parametrize("weight", [400, 500, 600, 700])
def test_each_weight_of_the_text_is_a_drawn_one(fonts: Fonts, weight: int) -> None:
    info = QFontInfo(text_font(12, QFont.Weight(weight)))

    assert (info.family(), info.weight()) == (fonts.text[0], weight)


def test_bolder_text_is_wider(fonts: Fonts) -> None:
    widths = [
        QFontMetricsF(text_font(20, QFont.Weight(weight))).horizontalAdvance("behaviour")
        for weight in (400, 500, 600, 700)
    ]

    assert widths == sorted(set(widths))


def test_the_characters_of_code_are_equally_wide(fonts: Fonts) -> None:
    metrics = QFontMetricsF(code_font(12))

    assert metrics.horizontalAdvance("iiii") == metrics.horizontalAdvance("WWWW")
    assert QFontInfo(code_font(12)).fixedPitch()


def test_the_fonts_have_the_letters_of_european_languages(fonts: Fonts) -> None:
    for path in FOLDER.glob("Atkinson*.ttf"):
        font = QRawFont(str(path), 12)

        assert all(font.supportsCharacter(ord(letter)) for letter in LETTERS), path


def test_the_japanese_font_is_small_and_has_every_kana(fonts: Fonts) -> None:
    font = QRawFont(str(JAPANESE), 12)

    assert JAPANESE.stat().st_size < 400_000
    assert all(font.supportsCharacter(code) for code in range(0x3041, 0x3097))
    assert all(font.supportsCharacter(code) for code in range(0x30A1, 0x30FB))


def test_the_japanese_font_has_every_character_of_our_table_and_help(fonts: Fonts) -> None:
    table = paths.resources() / "translations" / "ja.toml"
    pages = sorted((paths.resources() / "help" / "ja").iterdir())
    text = "".join(path.read_text(encoding="utf-8") for path in (table, *pages))
    font = QRawFont(str(JAPANESE), 12)

    missing = {it for it in text if ord(it) > 0x2E80 and not font.supportsCharacter(ord(it))}

    assert len(pages) > 1
    assert not missing, "run resources/fonts/make_fonts.py as its README.md says"


def test_a_line_with_kanji_is_as_high_as_one_without(fonts: Fonts) -> None:
    latin = QRawFont(str(FOLDER / "AtkinsonHyperlegibleNext-Regular.ttf"), 12)
    japanese = QRawFont(str(JAPANESE), 12)

    assert (japanese.ascent(), japanese.descent()) == (latin.ascent(), latin.descent())


def test_each_font_has_its_licence_beside_it() -> None:
    licences = [path.read_text(encoding="utf-8") for path in FOLDER.glob("LICENSE-*.txt")]

    assert len(licences) == 3
    assert all("SIL Open Font License" in licence for licence in licences)
