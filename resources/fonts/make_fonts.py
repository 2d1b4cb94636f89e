"""Make the fonts of this folder from the npm packages that README.md names.

python make_fonts.py FOLDER      where FOLDER holds the packages, unpacked
"""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path

from fontTools.merge import Merger
from fontTools.subset import Options, Subsetter
from fontTools.ttLib import TTFont

HERE = Path(__file__).resolve().parent
WEIGHTS = {400: "Regular", 500: "Medium", 600: "SemiBold", 700: "Bold"}
"""The weights we use, and what fonts call them."""

LATIN = {
    "atkinson-hyperlegible-next": ("Atkinson Hyperlegible Next", (400, 500, 600, 700)),
    "atkinson-hyperlegible-mono": ("Atkinson Hyperlegible Mono", (400, 700)),
}
JAPANESE, JAPANESE_FAMILY = "noto-sans-jp", "Noto Sans JP NEP"
COMMON_SLICES = 26
"""Kana and the commonest kanji: the last parts of the package, which are sorted by use."""


def subset(font: TTFont, characters: set[int]) -> TTFont:
    """Leave out all glyphs but those of these characters."""
    options = Options(layout_features=["kern", "mark", "mkmk", "ccmp"], hinting=False)
    subsetter = Subsetter(options)
    subsetter.populate(unicodes=characters)
    subsetter.subset(font)
    return font


def name(font: TTFont, family: str, weight: int) -> None:
    """Name a font so that Windows, macOS and fontconfig see one family with several weights."""
    style = WEIGHTS[weight]
    is_basic = style in ("Regular", "Bold")
    names = {
        1: family if is_basic else f"{family} {style}",
        2: style if is_basic else "Regular",
        4: f"{family} {style}",
        6: f"{family.replace(' ', '')}-{style}",
    }
    if not is_basic:
        names |= {16: family, 17: style}
    table = font["name"]
    for number in (1, 2, 3, 4, 6, 16, 17, 25):
        table.removeNames(nameID=number)
    for number, text in names.items():
        table.setName(text, number, 3, 1, 0x409)
    font["OS/2"].usWeightClass = weight
    if "STAT" in font:
        del font["STAT"]


def match_lines(font: TTFont, model: TTFont) -> None:
    """Give a font the line height of another, so that lines of both have one height and baseline.

    Kanji reach from -0.12 to 0.88 of the size, which is within the lines of the Latin font.
    """
    for table, fields in {
        "hhea": ("ascent", "descent", "lineGap"),
        "OS/2": (
            "sTypoAscender",
            "sTypoDescender",
            "sTypoLineGap",
            "usWinAscent",
            "usWinDescent",
            "fsSelection",
        ),
    }.items():
        for each in fields:
            setattr(font[table], each, getattr(model[table], each))


def files(packages: Path, package: str) -> Path:
    """Where a package has its fonts, whatever the folder it was unpacked to is called."""
    [found] = {path.parent for path in packages.rglob(f"{package}-latin-400-normal.woff2")} or {
        path.parent for path in packages.rglob(f"{package}-japanese-400-normal.woff2")
    }
    return found


def make_latin(packages: Path) -> None:
    """Join the two halves of each weight, which the package has apart."""
    for package, (family, weights) in LATIN.items():
        folder = files(packages, package)
        for weight in weights:
            halves = [
                folder / f"{package}-{part}-{weight}-normal.woff2"
                for part in ("latin", "latin-ext")
            ]
            first = TTFont(halves[0])
            second = subset(
                TTFont(halves[1]), set(TTFont(halves[1]).getBestCmap()) - set(first.getBestCmap())
            )
            parts = []
            for number, font in enumerate((first, second)):
                if "STAT" in font:
                    del font["STAT"]
                font.flavor = None
                parts.append(HERE / f"part{number}.ttf")
                font.save(parts[-1])
            merged = Merger().merge([str(part) for part in parts])
            for part in parts:
                part.unlink()
            name(merged, family, weight)
            merged.save(HERE / f"{family.replace(' ', '')}-{WEIGHTS[weight]}.ttf")


def code_points(ranges: str) -> set[int]:
    """Read "U+3041-3096,U+30FB"."""
    points: set[int] = set()
    for part in ranges.replace("U+", "").split(","):
        first, _, last = part.strip().partition("-")
        points.update(range(int(first, 16), int(last or first, 16) + 1))
    return points


def japanese_words() -> set[int]:
    """Every character of our Japanese table and help that Latin fonts may not have."""
    table = HERE.parent / "translations" / "ja.toml"
    tomllib.loads(table.read_text(encoding="utf-8"))
    pages = (HERE.parent / "help" / "ja").iterdir()
    text = "".join(path.read_text(encoding="utf-8") for path in (table, *pages))
    return {ord(character) for character in text if ord(character) > 0x2E80}


def make_japanese(packages: Path) -> None:
    """Cut the Japanese font to kana, the commonest kanji, and all that our own words use."""
    folder = files(packages, JAPANESE)
    slices = json.loads((folder.parent / "unicode.json").read_text(encoding="utf-8"))
    numbered = sorted(
        (key for key in slices if key.startswith("[")), key=lambda key: int(key[1:-1])
    )
    wanted = japanese_words()
    for key in numbered[-COMMON_SLICES:]:
        wanted |= {point for point in code_points(slices[key]) if point > 0x2E80}
    wanted |= set(range(0x3000, 0x3100))
    font = subset(TTFont(folder / f"{JAPANESE}-japanese-400-normal.woff2"), wanted)
    font.flavor = None
    name(font, JAPANESE_FAMILY, 400)
    match_lines(font, TTFont(HERE / "AtkinsonHyperlegibleNext-Regular.ttf"))
    font.save(HERE / f"{JAPANESE_FAMILY.replace(' ', '')}-Regular.ttf")


if __name__ == "__main__":
    make_latin(Path(sys.argv[1]))
    make_japanese(Path(sys.argv[1]))
