"""Makes the pictures of the phone's page, and those of the warning that comes before it.

    .venv/bin/python tools/phone_page_images.py           into docs/images and resources/phone_page
    .venv/bin/python tools/phone_page_images.py --check   compare the drawings, change nothing

The page is opened in a real Chromium as a phone has it, fed with a movement; the warning is drawn.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.nodes.sensory.chromium import Chromium

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
PAGE = ROOT / "resources" / "phone_page"
WARNINGS = [(phone, theme) for phone in ("android", "ios") for theme in ("light", "dark")]

os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))


def main() -> int:
    """Make or compare the pictures; the exit code is 1 when a drawing is out of date."""
    options = _parsed()
    out_of_date = [name for name in map(_drawn, WARNINGS) if name] if options.check else []
    for name in out_of_date:
        sys.stdout.write(f"{name} is out of date\n")
    if not options.check:
        _draw()
        _photograph()
    return int(bool(out_of_date))


def _draw() -> None:
    for phone, theme in WARNINGS:
        path = PAGE / f"warning_{phone}_{theme}.svg"
        path.write_text(drawing(phone, theme), encoding="utf-8", newline="\n")


def _drawn(warning: tuple[str, str]) -> str:
    """The name of a drawing that is not as it would be drawn now; empty when it is."""
    path = PAGE / f"warning_{'_'.join(warning)}.svg"
    is_there = path.is_file() and path.read_text(encoding="utf-8") == drawing(*warning)
    return "" if is_there else path.name


def _photograph() -> None:
    """Open the page twice, light and dark, move the phone, and take a picture."""
    from PySide6.QtGui import QImage

    from nodes.sensory.connectors.connector import Settings
    from nodes.sensory.phone_page.server import PhonePage
    from tests.nodes.sensory.chromium import Chromium
    from tools.image_files import write_small

    with tempfile.TemporaryDirectory(prefix="nep-page-") as folder:
        server = PhonePage(Settings(port=0), Path(folder))
        server.open()
        url = server.urls[0]
        assert server.certificate is not None
        browser = Chromium(Path(folder) / "profile", server.certificate.spki_sha256)
        try:
            for theme in ("light", "dark"):
                picture = QImage.fromData(_picture(browser, url, is_dark=theme == "dark"))
                size = write_small(picture, IMAGES / f"phone-page-{theme}.png")
                sys.stdout.write(f"phone-page-{theme:14} {size}\n")
        finally:
            browser.close()
            server.close()


def _picture(browser: Chromium, url: str, *, is_dark: bool) -> bytes:
    page = browser.page(url, is_dark=is_dark)
    page.feel((0.0, 0.0, 0.0))
    page.until("document.body?.dataset.state", "ready")
    page.tap("#allow")
    for step in range(300):
        x, y, z = _acceleration(step / 60)
        reading = {"xyz": {"x": x, "y": y, "z": z}}
        page.call("Emulation.setSensorOverrideReadings", type="accelerometer", reading=reading)
        page.value("new Promise(requestAnimationFrame)")
    picture: bytes = page.screenshot()
    page.close()
    return picture


def _acceleration(t: float) -> tuple[float, float, float]:
    """A hand that waves for a while, in m/s²."""
    swing = math.exp(-(((t - 3.4) / 0.9) ** 2))
    wave = swing * math.sin(2 * math.pi * 1.6 * t)
    return 9 * wave, 6.5 + 4 * swing * math.sin(2 * math.pi * 3.2 * t + 1), 6.8 - 3 * swing * wave


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    return parser.parse_args()


THEMES = ROOT / "resources" / "themes"
WIDE, HIGH, GAP, EDGE = 200, 400, 46, 8
INNER = 14  # from the edge of a phone to what is on its screen
NAMES = (
    *("canvas", "menu", "pressed", "line", "muted", "text", "accent", "accent_text"),
    *("error", "success", "success_panel", "plot_1", "plot_2", "plot_3", "field_line"),
)


@dataclass(frozen=True)
class Pen:
    """Writes SVG with the colours of a theme, for one phone whose left edge is at ``x``."""

    colours: dict[str, str]
    x: float = 0.0

    def bar(self, x: float, y: float, wide: float, colour: str = "line", high: float = 9) -> str:
        """A line of text that need not be read."""
        return self.box(x, y, wide, high, colour, radius=high / 2)

    def box(
        self,
        x: float,
        y: float,
        wide: float,
        high: float,
        fill: str,
        line: str = "",
        radius: float = 10,
    ) -> str:
        """A rectangle with round corners."""
        stroke = f' stroke="{self.colours[line]}" stroke-width="3"' if line else ""
        colour = self.colours[fill] if fill else "none"
        return (
            f'<rect x="{self.x + x:g}" y="{y:g}" width="{wide:g}" height="{high:g}" '
            f'rx="{radius:g}" fill="{colour}"{stroke}/>'
        )

    def path(self, path: str, x: float, y: float, colour: str, width: float = 0) -> str:
        """A shape that begins at a place; filled, or a line of some width."""
        look = (
            f'fill="none" stroke="{self.colours[colour]}" stroke-width="{width:g}" '
            'stroke-linecap="round" stroke-linejoin="round"'
            if width
            else f'fill="{self.colours[colour]}"'
        )
        return f'<path transform="translate({self.x + x:g} {y:g})" d="{path}" {look}/>'

    def badge(self, x: float, y: float, number: int) -> str:
        """The number of a step."""
        at = f'x="{self.x + x:g}" y="{y + 8:g}"'
        colour, on_it = self.colours["accent"], self.colours["accent_text"]
        family = "font-family=\"'Atkinson Hyperlegible Next', sans-serif\""
        return (
            f'<circle cx="{self.x + x:g}" cy="{y:g}" r="16" fill="{colour}" '
            f'stroke="{self.colours["canvas"]}" stroke-width="3"/>'
            f'<text {at} text-anchor="middle" {family} font-size="22" font-weight="700" '
            f'fill="{on_it}">{number}</text>'
        )

    def pressed(self, x: float, y: float, wide: float, high: float, number: int) -> str:
        """A ring around what is to be pressed, with the number of the step."""
        ring = self.box(x - 7, y - 7, wide + 14, high + 14, "", "accent", radius=14)
        return ring + self.badge(x + wide + 4, y - 6, number)

    def triangle(self, x: float, y: float, size: float) -> str:
        """The sign for danger."""
        outline = f"M{size / 2:g} 0L{size:g} {size * 0.88:g}H0Z"
        mark = f"M{size / 2:g} {size * 0.36:g}v{size * 0.2:g}M{size / 2:g} {size * 0.71:g}v0.1"
        width = size / 10
        return self.path(outline, x, y, "error", width) + self.path(mark, x, y, "error", width)


def drawing(phone: str, theme: str) -> str:
    """The picture for "android" or "ios" in "light" or "dark", as SVG."""
    found = tomllib.loads((THEMES / f"{theme}.toml").read_text(encoding="utf-8"))["colours"]
    pen = Pen({name: found[name] for name in NAMES})
    steps = {"android": (_chrome, _chrome_more, _page), "ios": (_safari, _details, _asks, _page)}
    parts = []
    for number, step in enumerate(steps[phone]):
        at = Pen(pen.colours, EDGE + number * (WIDE + GAP))
        parts += [_phone(at), step(at)]
        if number:
            parts.append(at.path("M0 0h22m-9 -9l9 9l-9 9", -GAP / 2 - 11, HIGH / 2, "muted", 4))
    wide = 2 * EDGE + len(steps[phone]) * (WIDE + GAP) - GAP
    size = f'viewBox="0 0 {wide} {HIGH + 2 * EDGE}" width="{wide}" height="{HIGH + 2 * EDGE}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n' + "\n".join(parts) + "\n</svg>\n"


def _phone(pen: Pen) -> str:
    speaker = pen.bar(WIDE / 2 - 20, EDGE + 9, 40, "line", 5)
    return pen.box(0, EDGE, WIDE, HIGH, "menu", "field_line", radius=26) + speaker


def _address(pen: Pen, y: float, sign: str) -> str:
    field = pen.box(INNER, y, WIDE - 2 * INNER, 28, "pressed", radius=14)
    dot = pen.triangle(INNER + 9, y + 7, 14) if sign == "danger" else ""
    return field + dot + pen.bar(INNER + 30, y + 10, 92, "muted", 8)


def _lines(pen: Pen, y: float, *widths: float, colour: str = "line") -> str:
    return "".join(
        pen.bar(INNER + 6, y + 17 * row, width, colour) for row, width in enumerate(widths)
    )


def _chrome(pen: Pen) -> str:
    top = _address(pen, 38, "danger") + pen.triangle(INNER + 6, 92, 40)
    title = _lines(pen, 150, 150, 96, colour="text")
    text = _lines(pen, 196, 158, 148, 154, 90)
    advanced = pen.box(INNER + 6, 350, 70, 30, "menu", "field_line", radius=15)
    back = pen.box(INNER + 96, 350, 68, 30, "plot_1", radius=15)
    words = pen.bar(INNER + 19, 361, 44, "plot_1") + pen.bar(INNER + 109, 361, 42, "menu")
    return top + title + text + advanced + back + words + pen.pressed(INNER + 6, 350, 70, 30, 1)


def _chrome_more(pen: Pen) -> str:
    top = _address(pen, 38, "danger") + pen.triangle(INNER + 6, 78, 24)
    text = _lines(pen, 118, 150, 110, colour="text") + _lines(pen, 162, 158, 140, 100)
    hide = pen.box(INNER + 6, 226, 70, 30, "menu", "field_line", radius=15)
    more = _lines(pen, 276, 158, 150, 120)
    link = pen.bar(INNER + 6, 352, 126, "plot_1", 11)
    under = pen.bar(INNER + 6, 366, 126, "plot_1", 2)
    bar = pen.bar(INNER + 19, 237, 44, "plot_1")
    return top + text + hide + bar + more + link + under + pen.pressed(INNER + 2, 345, 134, 28, 2)


def _safari(pen: Pen) -> str:
    card = pen.box(INNER, 62, WIDE - 2 * INNER, 212, "pressed", radius=14)
    title = _lines(pen, 84, 128, 92, colour="text")
    text = _lines(pen, 130, 152, 146, 150, 110)
    show, back = (
        pen.bar(INNER + 14, 236, 66, "plot_1", 11),
        pen.bar(INNER + 112, 236, 46, "plot_1", 11),
    )
    address = _address(pen, 352, "")
    return card + title + text + show + back + address + pen.pressed(INNER + 10, 228, 74, 27, 1)


def _details(pen: Pen) -> str:
    card = pen.box(INNER, 44, WIDE - 2 * INNER, 288, "pressed", radius=14)
    text = _lines(pen, 62, 128, colour="text") + _lines(pen, 90, 152, 146, 150, 110)
    more = _lines(pen, 176, 152, 148, 140, 152) + pen.bar(INNER + 6, 244, 60)
    link = pen.bar(INNER + 6, 282, 104, "plot_1", 11) + pen.bar(INNER + 6, 296, 104, "plot_1", 2)
    return (
        card + text + more + link + _address(pen, 352, "") + pen.pressed(INNER + 2, 275, 112, 28, 2)
    )


def _asks(pen: Pen) -> str:
    behind = _lines(pen, 62, 128, 152, 146, 150, 110)
    card = pen.box(INNER + 6, 146, WIDE - 2 * INNER - 12, 142, "pressed", "line", radius=16)
    words = pen.bar(INNER + 44, 166, 84, "text") + pen.bar(INNER + 26, 188, 120)
    words += pen.bar(INNER + 36, 205, 100)
    middle = pen.path("M0 0H160M80 0V60", INNER + 6, 228, "line", 2)
    cancel = pen.bar(INNER + 28, 254, 40, "plot_1", 10)
    visit = pen.bar(INNER + 104, 254, 46, "plot_1", 10)
    end = _address(pen, 352, "")
    return (
        behind
        + card
        + words
        + middle
        + cancel
        + visit
        + end
        + pen.pressed(INNER + 96, 245, 60, 28, 3)
    )


def _page(pen: Pen) -> str:
    """Our own page, which has come."""
    icon = pen.box(INNER, 44, 24, 24, "accent", radius=7) + pen.bar(INNER + 34, 51, 76, "text", 10)
    card = pen.box(INNER, 86, WIDE - 2 * INNER, 54, "success_panel", "success", radius=14)
    card += pen.box(INNER + 14, 101, 24, 24, "success", radius=12)
    card += pen.path("M0 6l5 5l9 -10", INNER + 19, 107, "menu", 3.5)
    card += pen.bar(INNER + 50, 108, 84, "text", 10)
    graph = pen.box(INNER, 156, WIDE - 2 * INNER, 104, "canvas", "line", radius=14)
    waves = (
        ("plot_1", "M0 0c12 0 14 -44 28 -44s14 62 30 62s16 -36 30 -36s18 18 54 18"),
        ("plot_2", "M0 -8c16 0 18 28 34 28s14 -34 30 -34s16 20 30 20s20 -8 48 -8"),
        ("plot_3", "M0 18c20 0 18 -20 34 -20s18 34 32 34s18 -24 32 -24s20 6 44 6"),
    )
    graph += "".join(pen.path(wave, INNER + 15, 212, colour, 4) for colour, wave in waves)
    button = pen.box(INNER, 282, WIDE - 2 * INNER, 56, "accent", radius=16)
    return icon + card + graph + button + pen.bar(INNER + 46, 304, 80, "accent_text", 12)


if __name__ == "__main__":
    sys.exit(main())
