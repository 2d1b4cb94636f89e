"""The style of the editors: that of their fields, in the colours of the theme."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .places import editor_scale

if TYPE_CHECKING:
    from ..canvas import Canvas

_RADII = {"round": 11.0, "square": 4.0, "bracket": 4.0}


def line_style(canvas: Canvas, shape: str, *, is_wrong: bool) -> str:
    """The style of a line or a text that lies over a field."""
    theme = canvas.theme
    scale = canvas.measures.unit * editor_scale(canvas)
    width = max(2, round(2.4 * scale))
    border = theme.colour("error" if is_wrong else "focus").name()
    return (
        "QLineEdit, QPlainTextEdit {"
        f" background: {theme.colour('field').name()}; color: {theme.colour('field_text').name()};"
        f" border: {width}px {'dashed' if is_wrong else 'solid'} {border};"
        f" border-radius: {round(_RADII.get(shape, 9.0) * scale)}px;"
        f" padding: 0 {round(2 * scale)}px; min-height: 0; margin: 0;"
        f" selection-background-color: {theme.colour('selection').name()};"
        f" selection-color: {theme.colour('selection_text').name()}; }}"
    )


def note_style(canvas: Canvas) -> str:
    """The style of the small text beside a number: what it comes to."""
    theme = canvas.theme
    return (
        f"QLabel {{ background: {theme.colour('tooltip').name()};"
        f" color: {theme.colour('tooltip_text').name()};"
        " padding: 2px 6px; border-radius: 4px; }"
    )
