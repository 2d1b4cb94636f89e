"""What is asked for the sources that need no device: gestures to make, a recording to play."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QCheckBox, QFileDialog, QLabel, QPushButton, QWidget

from nep_studio.plan import Setting
from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr

from .questions import Entry, column_in


class GesturesQuestion(QWidget):
    """Which gestures a simulated person makes, and whether again and again."""

    changed = Signal()

    def __init__(self, gestures: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.gestures = Entry(gestures)
        self.gestures.setAccessibleName(tr("Gestures to make"))
        self.gestures.setPlaceholderText("karate, hand_up")
        self.repeats = QCheckBox(tr("Make them again and again"))
        self.repeats.setChecked(True)
        box = column_in(self)
        box.addWidget(self.gestures)
        box.addWidget(self.repeats)
        self.gestures.written.connect(self.changed)
        self.repeats.toggled.connect(self.changed)

    @property
    def settings(self) -> dict[str, Setting]:
        """The parameters of the node."""
        return {"gestures": self.gestures.text().strip(), "repeat": self.repeats.isChecked()}

    def show_settings(self, settings: Mapping[str, Setting]) -> None:
        """Begin with what was chosen before."""
        self.gestures.setText(str(settings.get("gestures", self.gestures.text())))
        self.repeats.setChecked(bool(settings.get("repeat", True)))


class RecordingQuestion(QWidget):
    """Which file is played."""

    changed = Signal()

    def __init__(self, folder: Path, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.path = ""
        self._folder = folder
        self._look = look
        self.button = QPushButton(tr("Choose a recording…"))
        self.redraw()
        self.button.setAutoDefault(False)
        line = self.fontMetrics().height()
        self.button.setIconSize(QSize(line, line))
        self.name = QLabel()
        self.name.setWordWrap(True)
        self.repeats = QCheckBox(tr("Play it again and again"))
        self.repeats.setChecked(True)
        box = column_in(self)
        for widget in (self.button, self.name, self.repeats):
            box.addWidget(widget)
        box.setAlignment(self.button, Qt.AlignmentFlag.AlignLeading)
        self.name.hide()
        self.button.clicked.connect(self._on_choose)
        self.repeats.toggled.connect(self.changed)

    def redraw(self) -> None:
        """Draw the icon in another theme."""
        self.button.setIcon(icon("folder-open", self._look.theme))

    @property
    def settings(self) -> dict[str, Setting] | None:
        """The parameters of the node; None as long as no file is chosen."""
        if not self.path:
            return None
        return {"recording": self.path, "loop": self.repeats.isChecked()}

    def show_settings(self, settings: Mapping[str, Setting]) -> None:
        """Begin with what was chosen before."""
        self.repeats.setChecked(bool(settings.get("loop", True)))
        self.choose(str(settings.get("recording", "")))

    def choose(self, path: str) -> None:
        """Play this file."""
        self.path = path
        self.name.setText(Path(path).name)
        self.name.setToolTip(path)
        self.name.setVisible(bool(path))
        if path:
            self.changed.emit()

    def _on_choose(self) -> None:
        dialog = QFileDialog(self, tr("Choose a recording"), str(self._folder))
        dialog.setNameFilters([tr("Recordings (*.csv)"), tr("All files (*)")])
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.fileSelected.connect(self.choose)
        dialog.open()
