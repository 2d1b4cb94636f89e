"""The page of a studio that takes part in the network of another computer."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from nep_core.security.keys import Keys
from nep_studio.ui.watches.questions import column_in
from nep_studio.ui.words import tr

from .closed_page import words_label
from .told import joined_words


class JoinedPage(QWidget):
    """Says what one can do there."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.title = words_label("", "title")
        box = column_in(self)
        box.setSpacing(self.fontMetrics().height() * 2 // 3)
        box.addWidget(self.title)
        for words in (
            tr("Nodes that you start here join there, and the robots there can be used here."),
            tr("Each node needs a name of its own, and one program runs at a time."),
        ):
            box.addWidget(words_label(words))
        box.addStretch(1)

    def show_network(self, keys: Keys) -> None:
        """Say whose network it is."""
        self.title.setText(joined_words(keys))
