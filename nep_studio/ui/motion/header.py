"""What a motion is called, what it is for, and the posture in which it starts."""

from __future__ import annotations

from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QLineEdit, QWidget

from nep_core.errors import ActionFailed
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_animations import AnimationKind
from nep_studio.ui.motion.desk import MotionDesk
from nep_studio.ui.words import tr
from nodes.action.naobody.body import Body
from nodes.action.naobody.postures import posture_name


class Header(QWidget):
    """Three fields over the robot."""

    def __init__(self, desk: MotionDesk, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.desk = desk
        self.title = QLineEdit()
        self.title.setMaxLength(100)
        self.title.setPlaceholderText(tr("Name of the motion"))
        self.title.setAccessibleName(tr("Name of the motion"))
        self.start = QComboBox()
        self.start.setAccessibleName(tr("Starts from"))
        self.start.addItem(tr("any posture"), "")
        for name, words in posture_words(language, desk.body).items():
            self.start.addItem(words, name)
        self.kind = QComboBox()
        self.kind.setAccessibleName(tr("Used to"))
        for kind, words in kind_words().items():
            self.kind.addItem(words, kind)
        self._lay_out()
        self.title.textEdited.connect(self._on_title_edited)
        self.title.editingFinished.connect(desk.seal)
        self.start.activated.connect(self._on_start_chosen)
        self.kind.activated.connect(self._on_kind_chosen)
        desk.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the motion as it is now."""
        motion = self.desk.motion
        if self.title.text() != motion.title:
            self.title.setText(motion.title)
        self.start.setCurrentIndex(max(0, self.start.findData(motion.starts_from)))
        self.kind.setCurrentIndex(max(0, self.kind.findData(motion.kind)))

    def _lay_out(self) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.title, 1)
        for words, field in ((tr("Starts from"), self.start), (tr("Used to"), self.kind)):
            label = QLabel(words)
            label.setBuddy(field)
            row.addWidget(label)
            row.addWidget(field)

    def _on_title_edited(self, title: str) -> None:
        self.desk.change(tr("name the motion"), merge="title", title=title)

    def _on_start_chosen(self) -> None:
        self.desk.set_start(self.start.currentData(), tr("choose the posture it starts from"))
        self.refresh()

    def _on_kind_chosen(self) -> None:
        self.desk.change(tr("choose what it is for"), kind=self.kind.currentData())


def kind_words() -> dict[AnimationKind, str]:
    """What motions of each kind are used to do."""
    return {
        "animation": tr("be played"),
        "animal": tr("imitate an animal"),
        "gesture": tr("speak with gestures"),
    }


def posture_words(language: Language, body: Body) -> dict[str, str]:
    """What the postures of a body are called, by their names."""
    found = {}
    for word, label in language.choices.get("postures", {}).items():
        try:
            found[posture_name(body, word)] = label
        except ActionFailed:
            continue  # a word for a posture that this body does not have
    return found or {name: name for name in body.postures}
