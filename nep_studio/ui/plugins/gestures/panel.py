"""The panel "Gestures" of the window: empty until it is shown for the first time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

    from .gesture_controller import TrainerDesk
    from .page import TrainerPage

LEAST_SHARE = 0.55
"""How much of the height beside the canvas gestures need."""


class TrainerPanel(QWidget):
    """Makes its page when it is shown: numpy is slow to load."""

    def __init__(self, make: Callable[[], TrainerPage]) -> None:
        super().__init__()
        self._make = make
        self.page: TrainerPage | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)

    def opened(self) -> TrainerPage:
        """What is in it; made now if it is not there yet."""
        if self.page is None:
            self.page = self._make()
            box = self.layout()
            if box is not None:
                box.addWidget(self.page)
        return self.page

    def sizeHint(self) -> QSize:
        """Room for the graph and a few takes."""
        line = self.fontMetrics().height()
        return QSize(line * 45, line * 22)

    def minimumSizeHint(self) -> QSize:
        """Less is of no use."""
        line = self.fontMetrics().height()
        return QSize(line * 14, line * 9)

    def showEvent(self, event: QShowEvent) -> None:
        """Open it."""
        self.opened()
        super().showEvent(event)


def add_trainer_panel(window: MainWindow) -> TrainerPanel:
    """Put the trainer below the canvas; call it each time the workbench is made."""
    panel = TrainerPanel(lambda: _page(window))
    added = window.add_side_panel(panel, tr("Gestures"), "hand", "bottom", is_shown=False)
    window.workbench.panels.give_room(added, LEAST_SHARE)
    return panel


def desk_of(window: MainWindow) -> TrainerDesk:
    """The desk of a window; what it heard stays when the window is made anew."""
    from .gesture_controller import TrainerDesk

    owner = window.running
    return owner.findChild(TrainerDesk) or TrainerDesk(
        window.files, owner.runner, window.messages, window.look, owner
    )


def _page(window: MainWindow) -> TrainerPage:
    from nep_studio.ui.plugins.watches import open_watches

    from .page import TrainerPage
    from .results.training import Training

    desk = desk_of(window)
    training = desk.findChild(Training)
    if training is None:
        training = Training(desk, desk)
        desk.runner.closing.connect(training.close)
    page = TrainerPage(desk, training, window.workbench.canvas)
    page.connect_asked.connect(lambda: open_watches(window))
    return page
