"""Words of an SVG file that stay inside their blocks, whatever fonts the computer has."""

from __future__ import annotations

import html
import re

from nep_studio.ui.canvas.canvas import Canvas

_TEXT = re.compile(r'(<text [^>]*font-weight="(\d+)"[^>]*?)\s*>([^<]*)</text>')
_FAMILY = re.compile(r'font-family="([^"]*)"')


def fitted(svg: bytes, canvas: Canvas) -> bytes:
    """The file with the width of each word, and with a usual font after ours."""
    text = svg.decode()
    text = _FAMILY.sub(r'font-family="\1,sans-serif"', text)
    weight = str(int(canvas.block_font.weight()))

    def with_width(match: re.Match[str]) -> str:
        opening, its_weight, said = match.groups()
        if its_weight != weight or not said.strip():
            return match.group(0)
        width = canvas.measures.text_width(html.unescape(said))
        return f'{opening} textLength="{width:g}" lengthAdjust="spacingAndGlyphs">{said}</text>'

    return _TEXT.sub(with_width, text).encode()
