"""Gestures: take them down from a watch, teach a recogniser, see how well it does."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin

if TYPE_CHECKING:
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


def make(host: Host) -> Parts:
    """The panel below the canvas; its page is made when it is opened."""
    panel = TrainerPanel(lambda: _page(host))
    return Parts(NewPanel(panel, "Gestures", "hand", "bottom", least_share=LEAST_SHARE))


def _page(host: Host) -> TrainerPage:
    from .gesture_controller import GestureController
    from .page import TrainerPage
    from .results.training import Training

    services = host.services
    controller = GestureController(
        services.files, services.runner, services.messages, services.look, services.running
    )
    training = Training(controller, controller)
    controller.runner.closing.connect(training.close)
    page = TrainerPage(controller, training, host.workbench.canvas)
    page.connect_asked.connect(lambda: host.ask("watches.open"))
    return page


plugin = Plugin("gestures", make, order=70)
