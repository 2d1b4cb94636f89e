"""The sizes of blocks, all taken from the height of a line of text."""

from __future__ import annotations

from collections.abc import Callable


class Measures:
    """Sizes in canvas units, and how wide a text is.

    ``line`` is the height of a line of text; everything else follows from it, so that a larger
    font makes larger blocks. ``is_mirrored`` lays blocks out from right to left.
    """

    def __init__(
        self, line: float, text_width: Callable[[str], float], *, is_mirrored: bool = False
    ) -> None:
        self.line = line
        self.text_width = text_width
        self.is_mirrored = is_mirrored
        unit = self.unit = line / 18.0
        self.gap = 6 * unit
        self.pad = 12 * unit
        self.value_pad = 4 * unit
        self.field_pad = 7 * unit
        self.field_height = line + 6 * unit
        self.row_pad = 6 * unit
        self.row_height = self.field_height + 2 * self.row_pad
        self.corner = 9 * unit
        self.notch_x = 18 * unit
        self.notch_width = 30 * unit
        self.notch_depth = 6 * unit
        self.indent = 18 * unit
        self.mouth_height = 30 * unit
        self.foot = 18 * unit
        self.hat = 16 * unit
        self.socket = 44 * unit
        self.button = line + 2 * unit
        self.widest = 460 * unit
        self.narrowest = 96 * unit
        self.narrowest_field = 24 * unit
        self.widest_field = 300 * unit
