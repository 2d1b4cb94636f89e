"""The style sheet of a theme: the template with its colours, lengths and little marks filled in."""

from __future__ import annotations

import atexit
import tempfile
from functools import cache
from pathlib import Path
from string import Template

from PySide6.QtGui import QColor, QFontMetricsF

from nep_studio import paths
from nep_studio.ui.theme.colours import HIGH_CONTRAST, Theme
from nep_studio.ui.theme.icons import recoloured

_LENGTHS = {
    "tiny": 0.15,
    "small": 0.30,
    "gap": 0.50,
    "double": 0.85,
    "wide": 1.60,
    "round": 0.42,
    "round_small": 0.28,
    "mark": 0.85,
    "bar": 0.16,
    "line_height": 1.15,
    "row": 1.55,
    "double_row": 3.00,
    "arrow_room": 1.40,
    "menu_button": 1.20,
    "group_top": 0.90,
    "title": 1.25,
}
"""Lengths in heights of a line of text."""

_MARKS = {
    "chevron_down": ("chevron-down", "text"),
    "chevron_down_disabled": ("chevron-down", "disabled"),
    "plus_text": ("plus", "text"),
    "plus_disabled": ("plus", "disabled"),
    "minus_text": ("minus", "text"),
    "minus_disabled": ("minus", "disabled"),
    "check_text": ("check", "text"),
    "check_selected": ("check", "selection_text"),
    "check_accent": ("check", "accent_text"),
    "minus_accent": ("minus", "accent_text"),
    "dot_accent": ("dot", "accent_text"),
    "close": ("x", "muted"),
}
"""The drawings that a style sheet takes from files: icon and colour."""


def style_sheet(theme: Theme, metrics: QFontMetricsF, is_right_to_left: bool = False) -> str:
    """Return the style sheet for a theme and a size of text."""
    values = {name: _css(colour) for name, colour in theme.colours.items()}
    values |= {name: str(pixels) for name, pixels in _lengths(theme, metrics.height()).items()}
    values |= {name: _mark(*look, theme) for name, look in _MARKS.items()}
    start, end = ("right", "left") if is_right_to_left else ("left", "right")
    values |= {
        "start": start,
        "end": end,
        "chevron_forward": _mark(f"chevron-{end}", "text", theme),
    }
    return Template(_template()).substitute(values)


def _lengths(theme: Theme, line: float) -> dict[str, int]:
    """Every length of the template in pixels, from the height of a line of text."""
    pixels = {name: max(1, round(line * heights)) for name, heights in _LENGTHS.items()}
    hair = max(1, round(line / 18))
    edge = max(2, round(line / 9)) if theme.name == HIGH_CONTRAST else max(1, round(line / 14))
    groove, knob, box = 2 * max(2, round(line / 8)), 2 * round(line * 0.42), round(line * 0.85)
    margin = max(2, round(line / 6))
    scroll = 2 * margin + 2 * max(2, round(line / 7))
    # a focus ring is thicker than an edge by a hair, which the room inside it gives
    rings = {f"{name}_ring": max(0, pixels[name] - hair) for name in ("tiny", "small", "double")}
    return (
        pixels
        | rings
        | {
            "hair": hair,
            "edge": edge,
            "ring": edge + hair,
            "groove": groove,
            "groove_round": groove // 2,
            "knob": knob,
            "knob_round": knob // 2 + edge,
            "knob_over": (knob + 2 * edge - groove) // 2,
            "knob_room": knob + 4 * edge,
            "box": box,
            "box_round": box // 2 + edge,
            "scroll_width": scroll,
            "scroll_margin": margin,
            "scroll_round": (scroll - 2 * margin) // 2,
        }
    )


def _css(colour: QColor) -> str:
    if colour.alpha() == 255:
        return colour.name()
    return f"rgba({colour.red()}, {colour.green()}, {colour.blue()}, {colour.alpha()})"


@cache
def _template() -> str:
    return (paths.resources() / "themes" / "style.qss").read_text(encoding="utf-8")


@cache
def _marks_folder() -> Path:
    """A folder for the drawings; a style sheet can name files only, not recolour them."""
    folder = tempfile.TemporaryDirectory(prefix="nep-studio-", ignore_cleanup_errors=True)
    atexit.register(folder.cleanup)
    return Path(folder.name)


def _mark(icon: str, colour: str, theme: Theme) -> str:
    path = _marks_folder() / f"{theme.name}-{icon}-{colour}.svg"
    if not path.exists():
        path.write_text(recoloured(icon, theme.colour(colour)), encoding="utf-8")
    return f'"{path.as_posix()}"'
