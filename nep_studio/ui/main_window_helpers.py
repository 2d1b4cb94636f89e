"""What helps on the canvas: finding, inserting by typing, the minimap, the trash."""

from __future__ import annotations

from PySide6.QtCore import QObject

from nep_studio.settings import Settings
from nep_studio.ui.actions_view import is_minimap_shown
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.empty_hint import EmptyHint
from nep_studio.ui.find_bar import FindBar
from nep_studio.ui.help_card import BlockOpening
from nep_studio.ui.insert_bar import InsertBar
from nep_studio.ui.minimap import MARGIN, Minimap
from nep_studio.ui.palette.palette import Palette
from nep_studio.ui.trash_panel import TrashButton


class CanvasHelpers(QObject):
    """The helpers of one canvas; they follow what it shows when they are refreshed."""

    def __init__(self, canvas: Canvas, settings: Settings) -> None:
        super().__init__(canvas)
        self._settings = settings
        self.palette = Palette(canvas, settings)
        self.find_bar = FindBar(canvas)
        self.opening = BlockOpening(canvas, self.find_bar)
        self.insert_bar = InsertBar(canvas, settings)
        self.minimap = Minimap(canvas)
        self.trash = TrashButton(canvas)
        self.empty_hint = EmptyHint(canvas)
        canvas.layout_changed.connect(canvas.update_scroll_bars)
        self.find_bar.hide()
        self._stack_corner()
        self.minimap.setVisible(is_minimap_shown(settings))

    def show_minimap(self, is_shown: bool) -> None:
        """Show or hide the minimap."""
        self._settings.set_shown("Minimap", is_shown)
        self.minimap.setVisible(is_shown)
        self.minimap.refresh()

    def refresh(self) -> None:
        """Take the theme, the words and the project that the canvas has now."""
        helpers = (self.palette, self.find_bar, self.insert_bar, self.trash, self.empty_hint)
        for helper in helpers:
            helper.refresh()
        self._stack_corner()

    def _stack_corner(self) -> None:
        """The minimap is above the trash."""
        self.minimap.below = self.trash.height() + MARGIN
        self.minimap.refresh()
