"""Pictures of blocks as small SVG that stands in the page: sharp, in its font, light and dark."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape
from xml.etree.ElementTree import Element, fromstring

from PySide6.QtCore import QBuffer, QIODevice, QPointF, QRectF
from PySide6.QtGui import QPainter
from PySide6.QtSvg import QSvgGenerator

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.ui.canvas.block_pictures import HelpPicture, PictureLook
from nep_studio.ui.theme.colours import Theme, load_theme
from nep_studio.ui.theme.look import text_font

POINTS = 10.0
PIXELS_AN_EM = 15.0
"""How large the blocks are beside the text of the page: their font has 13.3 pixels."""

THEMES = ("light", "dark")
Colours = tuple[str, ...]
"""A colour in each of the themes."""

_SVG = "{http://www.w3.org/2000/svg}"
_NUMBER = re.compile(r"-?\d+\.\d+")
_MATRIX = re.compile(r"matrix\(1,0,0,1,([^,]+),([^)]+)\)")
_FORM = ("d", "points", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry")
_USUAL = {
    "stroke-width": "1",
    "stroke-linecap": "square",
    "stroke-linejoin": "bevel",
    "fill-opacity": "1",
    "stroke-opacity": "1",
}


@dataclass
class Pictures:
    """Draws blocks. A colour is a class of the page's style sheet, which knows all themes."""

    _fills: dict[Colours, str] = field(default_factory=dict)
    _lines: dict[Colours, str] = field(default_factory=dict)

    def of(self, project: Project, language: Language, words: str) -> str:
        """The picture of all stacks of a project, with words for who cannot see it."""
        drawings = [_drawing(project, language, load_theme(theme)) for theme in THEMES]
        _, _, width, height = (float(side) for side in drawings[0].attrib["viewBox"].split())
        groups = zip(*(drawing.iterfind(f"{_SVG}g/{_SVG}g") for drawing in drawings), strict=True)
        shapes = "".join(self._shapes(alike) for alike in groups)
        return (
            f'<svg class="blocks" role="img" aria-label="{escape(words)}" '
            f'viewBox="0 0 {width:.1f} {height:.1f}" style="width:{width / PIXELS_AN_EM:.2f}em">'
            f"{shapes}</svg>"
        )

    def style(self) -> str:
        """The rules for all colours that were used."""
        told = [(f".{name}{{fill:", pair) for pair, name in self._fills.items()]
        told += [(f".{name}{{stroke:", pair) for pair, name in self._lines.items()]
        light = "\n".join(f"{rule}{light}}}" for rule, (light, _) in told)
        dark = "\n".join(f"{rule}{dark}}}" for rule, (light, dark) in told if dark != light)
        return f"{light}\n@media screen and (prefers-color-scheme: dark) {{\n{dark}\n}}\n"

    def _shapes(self, groups: Sequence[Element]) -> str:
        return "".join(self._shape(groups, each) for each in zip(*groups, strict=True))

    def _shape(self, groups: Sequence[Element], shapes: Sequence[Element]) -> str:
        group, shape, kind = groups[0], shapes[0], shapes[0].tag.removeprefix(_SVG)
        move = _MATRIX.fullmatch(group.get("transform", "matrix(1,0,0,1,0,0)"))
        if move is None:
            raise ValueError(f"Blocks that are turned or stretched: {group.attrib}")
        corner = QPointF(float(move[1]), float(move[2]))
        if kind == "text":
            return self._text(shapes, corner)
        fills = [
            each.get("fill", of.attrib["fill"]) for of, each in zip(groups, shapes, strict=True)
        ]
        told = [
            self._paint("fill", fills),
            self._paint("stroke", [g.attrib["stroke"] for g in groups]),
        ]
        names = " ".join(name for name in told if name)
        said = {"class": names} if names else {}
        said |= {} if told[0] else {"fill": "none"}
        said |= {
            key: group.attrib[key]
            for key, usual in _USUAL.items()
            if group.get(key, usual) != usual
        }
        said |= {key: _short(value) for key, value in shape.attrib.items() if key in _FORM}
        if not corner.isNull():
            said["transform"] = f"translate({corner.x():.4g} {corner.y():.4g})"
        return f"<{kind} {_attributes(said)}/>"

    def _text(self, shapes: Sequence[Element], corner: QPointF) -> str:
        shape = shapes[0]
        x, y = float(shape.attrib["x"]) + corner.x(), float(shape.attrib["y"]) + corner.y()
        said = {"class": self._paint("fill", [each.attrib["fill"] for each in shapes])}
        said |= {"x": f"{x:.1f}", "y": f"{y:.1f}"}
        said |= {"font-size": f"{float(shape.attrib['font-size']):.3g}"}
        return f"<text {_attributes(said)}>{escape(shape.text or '')}</text>"

    def _paint(self, what: str, colours: Iterable[str]) -> str:
        """The class of a colour; an empty text where nothing is painted."""
        pair = tuple(colours)
        if set(pair) == {"none"}:
            return ""
        table, sign = (self._fills, "f") if what == "fill" else (self._lines, "s")
        return table.setdefault(pair, f"{sign}{len(table)}")


def _drawing(project: Project, language: Language, theme: Theme) -> Element:
    """What Qt draws of a project, as SVG."""
    look = PictureLook(
        theme, text_font(POINTS), is_mirrored=False, ratio=1.0, scale=1.0, widest=1.0
    )
    picture = HelpPicture(project, language, look)
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    generator = QSvgGenerator(QSvgGenerator.SvgVersion.Svg11)
    generator.setOutputDevice(buffer)
    generator.setResolution(96)
    generator.setViewBox(QRectF(QPointF(), picture.size))
    with QPainter(generator) as painter:
        picture.paint(painter)
    return fromstring(bytes(buffer.data().data()))


def _attributes(said: dict[str, str]) -> str:
    return " ".join(f'{key}="{value}"' for key, value in said.items())


def _short(value: str) -> str:
    """Numbers with one digit behind the point: a tenth of a pixel cannot be seen."""
    return _NUMBER.sub(lambda found: f"{float(found[0]):.1f}".removesuffix(".0"), value.strip())


NAMES = (
    "canvas",
    "panel",
    "panel_alt",
    "menu",
    "line",
    "text",
    "muted",
    "link",
    "focus",
    "accent",
    "info",
    "info_panel",
    "field",
    "field_text",
    "field_line",
)
USED_WHEN = {
    "light": "",
    "dark": "@media screen and (prefers-color-scheme: dark)",
    "high_contrast": "@media screen and (prefers-contrast: more)",
}
"""Which theme is used when; a later one wins."""


def colours_css() -> str:
    """The named colours of each theme as properties."""
    rules = []
    for name, condition in USED_WHEN.items():
        theme = load_theme(name)
        told = "".join(f"--{n.replace('_', '-')}:{theme.colour(n).name()};" for n in NAMES)
        scheme = "dark" if theme.is_dark else "light"
        rule = f":root{{color-scheme:{scheme};{told}}}"
        rules.append(f"{condition} {{ {rule} }}" if condition else rule)
    return "\n".join(rules) + "\n"
