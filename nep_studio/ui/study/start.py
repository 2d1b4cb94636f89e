"""Begins a study: who takes part, under which condition, and what is recorded, in plain words."""

from __future__ import annotations

from contextlib import suppress

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_studio.study.records import Sitting, StudyFolder
from nep_studio.ui.screens import room_around
from nep_studio.ui.words import tr

from .who import Who


class StartDialog(QDialog):
    """Nothing is recorded before Start is pressed; ``started`` gives the Sitting."""

    started = Signal(object)

    def __init__(self, folder: StudyFolder, parent: QWidget) -> None:
        super().__init__(parent)
        self._folder = folder
        self.setWindowTitle(tr("Start a study"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.who = Who(folder, may_change_conditions=True)
        self.start_button = QPushButton(tr("Start the study"))
        self.cancel_button = QPushButton(tr("Cancel"))
        self._lay_out()
        self.who.changed.connect(self._show_whether_it_may_start)
        self.start_button.clicked.connect(self._on_start_clicked)
        self.cancel_button.clicked.connect(self.reject)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        card = QFrame()
        card.setProperty("kind", "info")
        told = QVBoxLayout(card)
        for number, words in enumerate(what_is_recorded(self._folder)):
            label = QLabel(words)
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            if not number:
                label.setProperty("role", "heading")
            told.addWidget(label)
        self.start_button.setDefault(True)
        self.start_button.setProperty("kind", "primary")
        foot = QHBoxLayout()
        foot.addStretch(1)
        foot.addWidget(self.cancel_button)
        foot.addWidget(self.start_button)
        page = QWidget()
        inner = QVBoxLayout(page)
        inner.setContentsMargins(0, 0, 0, 0)
        inner.setSpacing(line)
        inner.addWidget(self.who)
        inner.addWidget(card)
        inner.addStretch(1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(page)
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line)
        box.addWidget(area, 1)
        box.addLayout(foot)
        room = room_around(self).size()
        self.resize(min(line * 34, room.width()), min(line * 26, room.height()))

    def _show_whether_it_may_start(self) -> None:
        self.start_button.setEnabled(bool(self.who.participant))

    def _on_start_clicked(self) -> None:
        with suppress(OSError):  # who begins the study tells that its folder cannot be written
            self._folder.set_conditions(self.who.all_conditions())
        self.started.emit(Sitting(self.who.participant, self.who.chosen_condition))
        self.accept()


def what_is_recorded(folder: StudyFolder) -> list[str]:
    """What a study keeps and what it does not, in plain words."""
    return [
        tr("What is recorded while a study is on"),
        tr(
            "Kept, each with its time: the studio and projects being opened (how many blocks, not"
            " which), how many changes are made, Run and Stop, how a run ends, the titles of"
            " errors and warnings, and which help is opened."
        ),
        tr(
            "Not kept: names of people, what the program says or does, what is typed, sound,"
            " pictures, what sensors measure, and anything of other programs."
        ),
        tr("Everything stays on this computer, in {folder}.", folder=folder.folder),
        tr("A sign in the window is there as long as something is recorded."),
    ]
