"""Dress the application in a theme: style, palette, font and style sheet."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontMetricsF, QPalette
from PySide6.QtWidgets import QApplication, QToolTip

from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.fonts import text_font
from nep_studio.ui.theme.style_sheet import style_sheet

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
    if app.style().name() != "fusion":  # a style sheet hides it behind a nameless style
        app.setStyleSheet("")
        app.setStyle("Fusion")
    app.setPalette(palette(theme))
    QToolTip.setPalette(palette(theme))
    app.setFont(font)
    is_right_to_left = app.layoutDirection() == Qt.LayoutDirection.RightToLeft
    app.setStyleSheet(style_sheet(theme, QFontMetricsF(font), is_right_to_left))
