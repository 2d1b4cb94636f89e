"""A person who comes before a robot, shows a name and a look, comes closer and steps back."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from nep_core.program.human import plain
from nep_studio.blocks.language import Language
from nep_studio.project.surroundings import FIRST_NAMES, LONGEST_NAME
from nep_studio.project.triggers import Happening
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import FlowLayout
from nep_studio.ui.words import tr

from .buttons import HappeningButton, WordsButton
from .stimuli import DISTANCES_M, Hands

NEAREST_CM, FARTHEST_CM = 30, 350
CLOSE_M, MIDDLE_M = 1.0, 2.0


class PersonBox(QWidget):
    """Somebody who is there or not; the person stands in the scene of the robots too."""

    def __init__(self, hands: Hands, language: Language, look: Look) -> None:
        super().__init__()
        self._hands, self._language = hands, language
        self.is_there = QCheckBox(tr("Somebody is there"))
        self.name = QComboBox()
        self.name.setEditable(True)
        line_edit = self.name.lineEdit() or QLineEdit()
        line_edit.setPlaceholderText(tr("anybody"))
        line_edit.setMaxLength(LONGEST_NAME)
        self.name.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.name.setMinimumContentsLength(6)
        self.name.setAccessibleName(tr("Whose face it is"))
        self.way = QSlider(Qt.Orientation.Horizontal)
        self.way.setRange(NEAREST_CM, FARTHEST_CM)
        self.way.setPageStep(50)
        self.way.setSingleStep(10)
        self.way.setAccessibleName(tr("How far the person is"))
        self.way_words = QLabel()
        self.before = WordsButton(tr("Step before its eyes"), look, "eye")
        self.looks = [
            HappeningButton(
                Happening("emotion", value, label), look, hands.begin, hands.end, label.capitalize()
            )
            for value, label in language.choices.get("emotions", {}).items()
        ]
        self._lay_out()
        self.set_names([])
        self.is_there.toggled.connect(self._on_toggled)
        self.name.editTextChanged.connect(self._on_renamed)
        self.way.valueChanged.connect(self._on_moved)
        self.before.clicked.connect(self._come)
        hands.visitors.changed.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        named = QHBoxLayout()
        named.addWidget(QLabel(tr("Face of")))
        named.addWidget(self.name, 1)
        far = QHBoxLayout()
        far.addWidget(self.way, 1)
        far.addWidget(self.way_words)
        looks = QWidget()
        flow = FlowLayout(looks, line // 3)
        for button in self.looks:
            flow.addWidget(button)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self.is_there)
        box.addLayout(named)
        box.addLayout(far)
        box.addWidget(self.before, 0, Qt.AlignmentFlag.AlignLeading)
        label = QLabel(tr("The person looks"))
        label.setProperty("role", "hint")
        box.addWidget(label)
        box.addWidget(looks)

    def set_names(self, names: list[str]) -> None:
        """Offer these names first: those that the program knows."""
        offered = list(dict.fromkeys([*names, *FIRST_NAMES]))
        if offered == [self.name.itemText(row) for row in range(1, self.name.count())]:
            return
        text = self.name.currentText()
        with QSignalBlocker(self.name):
            self.name.clear()
            self.name.addItem("")
            self.name.addItems(offered)
            self.name.setEditText(text)

    def refresh(self) -> None:
        """Show who is there, and how far away."""
        visitors = self._hands.visitors
        person = visitors.find("face")
        with QSignalBlocker(self.is_there), QSignalBlocker(self.way), QSignalBlocker(self.name):
            self.is_there.setChecked(person is not None)
            if person is not None:
                self.way.setValue(round(100 * visitors.way_m("face", self._hands.robot)))
                if plain(person.name) != plain(self.name.currentText()):
                    self.name.setEditText(person.name)
        for widget in (self.way, self.way_words, self.before):
            widget.setEnabled(person is not None)
        self.way_words.setText(self._way_words(self.way.value() / 100))

    def _way_words(self, way_m: float) -> str:
        which = "close" if way_m < CLOSE_M else "middle" if way_m < MIDDLE_M else "far"
        label = self._language.choices.get("distances", dict.fromkeys(DISTANCES_M, ""))[which]
        return tr("{m} m: {distance}", m=f"{way_m:.1f}", distance=label)

    def _come(self) -> None:
        name = self.name.currentText().strip()
        self._hands.visitors.come("face", self._hands.robot, name)

    def _on_toggled(self, is_there: bool) -> None:
        if is_there:
            self._come()
        else:
            self._hands.visitors.go("face")

    def _on_renamed(self, name: str) -> None:
        self._hands.visitors.rename("face", name)

    def _on_moved(self, way_cm: int) -> None:
        self._hands.visitors.stand("face", self._hands.robot, way_cm / 100)
