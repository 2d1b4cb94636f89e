"""Brings in a motion that Choregraphe has exported: pasted, or from a file."""

from __future__ import annotations

import errno
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QDialog, QLabel, QPlainTextEdit, QPushButton, QWidget

from faults.files import content
from nep_studio.blocks.own_animations import OwnAnimation, why_not_animation
from nep_studio.ui.widgets.forms import fit_on_screen, plain_label
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import tr
from robots.body.body import Body
from robots.body.choregraphe import KeyframesUnreadable, read_choregraphe
from robots.body.limbs import Limb

from .motion_controller import STANDING, joints_of

LARGEST_FILE = 4_000_000


class ImportDialog(QDialog):
    """Asks for the text; ``read`` gives an OwnAnimation."""

    read = Signal(object)

    def __init__(self, body: Body, parent: QWidget) -> None:
        super().__init__(parent)
        self._body = body
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("A motion from Choregraphe"))
        self.text = QPlainTextEdit()
        self.text.setAccessibleName(tr("The exported text"))
        self.text.setPlaceholderText('names.append("HeadYaw")\ntimes.append([0.8, 1.6])\n…')
        self.reason = plain_label()
        self.file_button = QPushButton(tr("From a file…"))
        self.use_button = QPushButton(tr("Use this motion"))
        self.cancel_button = QPushButton(tr("Cancel"))
        self._title = ""
        words = tr(
            "In Choregraphe, right-click in the timeline and choose “Export motion to "
            "clipboard”, Python or C++. Paste it here."
        )
        how = QLabel(words, wordWrap=True)
        self.use_button.setProperty("kind", "primary")
        foot = in_row(self.file_button, 1, self.cancel_button, self.use_button)
        in_column(how, (self.text, 1), self.reason, foot, of=self)
        fit_on_screen(self, 36, 24)
        self.text.textChanged.connect(self._on_text_changed)
        self.file_button.clicked.connect(self._on_file_asked)
        self.use_button.clicked.connect(self._on_use_clicked)
        self.cancel_button.clicked.connect(self.reject)
        self._on_text_changed()

    def read_file(self, path: Path) -> None:
        """Take the text of a file."""
        try:
            text = content(path, LARGEST_FILE).decode()
        except (OSError, UnicodeDecodeError) as error:
            self.text.clear()
            why = str(getattr(error, "strerror", None) or error)
            if getattr(error, "errno", 0) == errno.EFBIG:
                why = tr("it is too large for a motion")
            self.reason.setText(tr("{name} cannot be read: {why}.", name=path.name, why=why))
            return
        self.text.setPlainText(text)
        self._title = path.stem

    def _motion(self) -> OwnAnimation | str:
        """The motion in the text, or why there is none."""
        try:
            found = joints_of(read_choregraphe(self.text.toPlainText()))
        except KeyframesUnreadable as error:
            return tr(error.sentence)
        known = {name: joint for name, joint in found.items() if name in self._body.index}
        if not known:
            return tr("The robot has none of these joints: {names}.", names=", ".join(found)[:200])
        moves_legs = Limb.LEGS in self._body.limbs_of(known)
        title = self._title or tr("From Choregraphe")
        motion = OwnAnimation(title, known, starts_from=STANDING if moves_legs else "")
        reason = why_not_animation("motion", motion)
        return tr(reason) if reason is not None else motion

    def _on_text_changed(self) -> None:
        if not self.text.toPlainText().strip():
            self.use_button.setEnabled(False)
            self.reason.clear()
            return
        motion = self._motion()
        self.use_button.setEnabled(isinstance(motion, OwnAnimation))
        if isinstance(motion, OwnAnimation):
            count, seconds = len(motion.joints), f"{motion.duration_s:.1f}"
            self.reason.setText(tr("{n} joints, {time} s", n=count, time=seconds))
        else:
            self.reason.setText(motion)

    def _on_file_asked(self) -> None:
        ask_for_path(self, tr("A file from Choregraphe"), Path(), self.read_file)

    def _on_use_clicked(self) -> None:
        motion = self._motion()
        if isinstance(motion, OwnAnimation):
            self.accept()
            self.read.emit(motion)
