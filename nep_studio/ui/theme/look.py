"""The look that a person chose, which follows the system where they left it to the system."""

from __future__ import annotations

import atexit
import logging
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from string import Template

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontDatabase, QFontMetricsF, QPalette, QStyleHints
from PySide6.QtWidgets import QApplication, QTabBar, QToolTip

from nep_studio import paths

from .colours import DARK, HIGH_CONTRAST, LIGHT, Theme, load_theme, themes
from .icons import recoloured, wear

log = logging.getLogger(__name__)


# The fonts that come with the program, made known to Qt.

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


# The style sheet of a theme: the template with its colours, lengths and little marks filled in.

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


# Dress the application in a theme: style, palette, font and style sheet.

_SMALLEST_POINTS = 10.5
_SYSTEM_POINTS = "system_font_points"

_ROLES = {
    QPalette.ColorRole.Window: "panel",
    QPalette.ColorRole.WindowText: "text",
    QPalette.ColorRole.Base: "field",
    QPalette.ColorRole.AlternateBase: "panel_alt",
    QPalette.ColorRole.Text: "field_text",
    QPalette.ColorRole.PlaceholderText: "muted",
    QPalette.ColorRole.Button: "panel_alt",
    QPalette.ColorRole.ButtonText: "text",
    QPalette.ColorRole.BrightText: "accent_text",
    QPalette.ColorRole.Highlight: "selection",
    QPalette.ColorRole.HighlightedText: "selection_text",
    QPalette.ColorRole.Accent: "accent",
    QPalette.ColorRole.Link: "link",
    QPalette.ColorRole.LinkVisited: "link",
    QPalette.ColorRole.ToolTipBase: "tooltip",
    QPalette.ColorRole.ToolTipText: "tooltip_text",
    QPalette.ColorRole.Light: "field",
    QPalette.ColorRole.Midlight: "hover",
    QPalette.ColorRole.Mid: "line",
    QPalette.ColorRole.Dark: "field_line",
    QPalette.ColorRole.Shadow: "field_line",
}

_WORDS = (
    QPalette.ColorRole.WindowText,
    QPalette.ColorRole.Text,
    QPalette.ColorRole.ButtonText,
    QPalette.ColorRole.HighlightedText,
    QPalette.ColorRole.PlaceholderText,
)


def palette(theme: Theme) -> QPalette:
    """Return a theme's colours in the roles that Qt's own widgets ask for."""
    made = QPalette()
    for role, name in _ROLES.items():
        made.setColor(role, theme.colour(name))
    for role in _WORDS:
        made.setColor(QPalette.ColorGroup.Disabled, role, theme.colour("disabled"))
    made.setColor(
        QPalette.ColorGroup.Disabled, QPalette.ColorRole.Highlight, theme.colour("panel_alt")
    )
    return made


def base_point_size(app: QApplication) -> float:
    """The size of text at scale 1: the system's, but never too small to read with ease."""
    if app.property(_SYSTEM_POINTS) is None:
        app.setProperty(_SYSTEM_POINTS, app.font().pointSizeF())
    return max(_SMALLEST_POINTS, float(app.property(_SYSTEM_POINTS)))


def apply_theme(app: QApplication, theme: Theme, scale: float = 1.0) -> None:
    """Dress every window in a theme; ``scale`` makes text larger, all else follows the text."""
    font = text_font(base_point_size(app) * scale)
    wear(theme)
    if app.style().name() != "fusion":  # a style sheet hides it behind a nameless style
        app.setStyleSheet("")
        app.setStyle("Fusion")
    app.setPalette(palette(theme))
    QToolTip.setPalette(palette(theme))
    app.setFont(font)
    is_right_to_left = app.layoutDirection() == Qt.LayoutDirection.RightToLeft
    app.setStyleSheet(style_sheet(theme, QFontMetricsF(font), is_right_to_left))
    _resize_tabs(app, font)


def _resize_tabs(app: QApplication, font: QFont) -> None:
    """Give the tabs the font of the rest.

    WORKAROUND: tab bars that were not shown before a style sheet came keep the size of text that
    they were made with (seen in Qt 6.11); no report of it is known to us.
    """
    for widget in app.allWidgets():
        if isinstance(widget, QTabBar) and widget.font().pointSizeF() != font.pointSizeF():
            widget.setFont(QFont())  # it asks anew what it inherits


SYSTEM = "system"


def system_theme_name(hints: QStyleHints) -> str:
    """Return the theme that fits the system; light where the system does not say."""
    if hints.accessibility().contrastPreference() == Qt.ContrastPreference.HighContrast:
        return HIGH_CONTRAST
    return DARK if hints.colorScheme() == Qt.ColorScheme.Dark else LIGHT


class Look(QObject):
    """The theme and the size of text in use; views listen to ``theme_changed``.

    ``read_system`` says which theme fits the system at the moment.
    """

    theme_changed = Signal(object)  # the Theme

    def __init__(
        self,
        app: QApplication,
        choice: str = SYSTEM,
        scale: float = 1.0,
        read_system: Callable[[QStyleHints], str] = system_theme_name,
    ) -> None:
        super().__init__(app)
        self._app, self._read_system = app, read_system
        self.choice = SYSTEM
        """What the person chose: a theme's name, or "system"."""
        self.scale = scale
        """How much larger than the system's the text is."""
        hints = app.styleHints()
        hints.colorSchemeChanged.connect(self._on_system_changed)
        hints.accessibility().contrastPreferenceChanged.connect(self._on_system_changed)
        self.theme = load_theme(LIGHT)
        """The theme in use."""
        self.choose(choice)

    def choose(self, choice: str) -> None:
        """Use a theme by its name, or "system"; a name that is not known means the system."""
        self.choice = choice if choice in themes() else SYSTEM
        self._tell_the_system()
        self._apply()

    def set_scale(self, scale: float) -> None:
        """Make the text, and all that is measured by it, this much larger than the system's."""
        self.scale = scale
        self._apply()

    def refresh(self) -> None:
        """Dress the windows again after a change of the direction of writing; no colour changes."""
        apply_theme(self._app, self.theme, self.scale)

    def _tell_the_system(self) -> None:
        """Let title bars and the system's own dialogs be as light or dark as we are."""
        hints = self._app.styleHints()
        if self.choice == SYSTEM:
            hints.unsetColorScheme()
            return
        is_dark = load_theme(self.choice).is_dark
        hints.setColorScheme(Qt.ColorScheme.Dark if is_dark else Qt.ColorScheme.Light)

    def _on_system_changed(self) -> None:
        if self.choice == SYSTEM:
            self._apply()

    def _apply(self) -> None:
        is_left = self.choice == SYSTEM
        name = self._read_system(self._app.styleHints()) if is_left else self.choice
        self.theme = load_theme(name)
        apply_theme(self._app, self.theme, self.scale)
        self.theme_changed.emit(self.theme)
