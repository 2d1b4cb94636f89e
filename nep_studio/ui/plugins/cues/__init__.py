"""The cues of a stage piece: its operator tells by hand what a person does."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from nep_studio.ui.host import Host, NewPanel, Parts, Plugin


def make(host: Host) -> Parts:
    """The panel beside the canvas, and for a show one that is large."""
    from .panel import CuePanel

    def make_large(parent: QWidget) -> CuePanel:
        return CuePanel(host, is_large=True, parent=parent)

    panel = NewPanel(CuePanel(host), "Cues", "flag", "right")
    return Parts(panel, commands={"cues.make_large": make_large})


plugin = Plugin("cues", make, order=30, modules=("panel",))
