"""The curve of a joint, and which one it is."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QComboBox, QVBoxLayout, QWidget

from nep_studio.blocks.language import Language
from nep_studio.ui.motion.curve import CurveView
from nep_studio.ui.motion.desk import MotionDesk
from nep_studio.ui.motion.joint_words import joint_words, limb_of_joint_words
from nep_studio.ui.motion.timeline import Timeline
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr


class CurvePanel(QWidget):
    """A choice of the joints, those that move first, and the curve of the chosen one."""

    def __init__(
        self, desk: MotionDesk, timeline: Timeline, language: Language, look: Look
    ) -> None:
        super().__init__()
        self.desk, self._language = desk, language
        self.curve = CurveView(desk, timeline, look)
        self.joint = QComboBox()
        self.joint.setAccessibleName(tr("Joint"))
        self._moving: tuple[str, ...] | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self.joint)
        box.addWidget(self.curve, 1)
        self.joint.currentIndexChanged.connect(self._on_chosen)
        desk.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Put the joints that move before the others."""
        body = self.desk.body
        moving = tuple(name for name in body.names if name in self.desk.motion.joints)
        if moving == self._moving:
            return
        self._moving = moving
        shown = self.curve.joint if self.joint.count() else ""
        names = [n for n in (*moving, *body.names) if n not in body.same_motor]
        with QSignalBlocker(self.joint):
            self.joint.clear()
            for name in dict.fromkeys(names):
                limb = limb_of_joint_words(body, name)
                self.joint.addItem(f"{limb}: {joint_words(self._language, body, name)}", name)
            self.joint.setCurrentIndex(max(0, self.joint.findData(shown)))
        self._on_chosen()

    def show_joint(self, name: str) -> None:
        """Show the curve of a joint."""
        self.joint.setCurrentIndex(max(0, self.joint.findData(name)))

    def _on_chosen(self) -> None:
        if self.joint.currentData() is not None:
            self.curve.show_joint(self.joint.currentData())
