"""The cues of a stage piece: its operator tells by hand what a person does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel

if TYPE_CHECKING:
    from .panel import CuePage


class CuePanel(LatePanel["CuePage"]):
    """Makes the buttons when it is shown for the first time."""

    usual_lines = (22, 24)


def make(host: Host) -> Parts:
    """The panel beside the canvas, and for a show one that is large."""

    def new_page() -> CuePage:
        from .panel import CuePage

        return CuePage(host)

    def make_large(parent: QWidget) -> CuePage:
        from .panel import CuePage

        return CuePage(host, is_large=True, parent=parent)

    panel = NewPanel(CuePanel(new_page), "Cues", "flag", "right")
    return Parts(panel, commands={"cues.make_large": make_large})


plugin = Plugin("cues", make, order=30)
