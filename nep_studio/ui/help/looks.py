"""How pages of the help look: their style sheet, from the theme and the size of the text."""

from __future__ import annotations

from PySide6.QtGui import QFontInfo

from nep_studio.ui.theme import Theme, code_font

H1, H2, H3, SMALL = 1.35, 1.15, 1.0, 0.92
"""Sizes of titles and small words, beside the size of the text."""


def style(theme: Theme, points: float) -> str:
    """The style sheet of a page, in the part of CSS that Qt knows."""

    def colour(name: str) -> str:
        return theme.colour(name).name()

    code = QFontInfo(code_font(points)).family()
    line, muted, text = colour("line"), colour("muted"), colour("text")
    return f"""
        body, p, li, td, th {{ color: {text}; font-size: {points:.1f}pt; }}
        h1 {{ font-size: {points * H1:.1f}pt; font-weight: 600; color: {text}; }}
        h2 {{ font-size: {points * H2:.1f}pt; font-weight: 600; color: {text}; margin-top: 14px; }}
        h3 {{ font-size: {points * H3:.1f}pt; font-weight: 600; color: {text}; margin-top: 10px; }}
        a {{ color: {colour("link")}; }}
        li {{ margin-bottom: 3px; }}
        .hint {{ color: {muted}; font-size: {points * SMALL:.1f}pt; }}
        code, pre {{ font-family: '{code}'; }}
        pre {{ color: {text}; }}
        .table {{ border-collapse: collapse; border: 1px solid {line}; }}
        .table td, .table th {{ border: 1px solid {line}; padding: 5px; }}
        .table th {{ background-color: {colour("panel_alt")}; font-weight: 600; text-align: left; }}
        .tip, .code {{ margin-top: 8px; margin-bottom: 4px; }}
        .tip td {{ background-color: {colour("info_panel")}; padding: 8px; }}
        .code td {{ background-color: {colour("panel_alt")}; padding: 8px; }}
    """
