"""The dialog that saves or copies a picture of a program."""

from __future__ import annotations

from pathlib import Path
from typing import cast

from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QPushButton,
    QWidget,
)

from nep_studio.blocks.errors import EditRefused
from nep_studio.ui.canvas.fields.field_edit import ReasonBubble
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .picture import SCALES, Format, PictureOptions, What, copy_picture, write_picture


class PictureDialog(QDialog):
    """Asks what is to be in the picture and how large it is.

    ``folder`` and ``name`` are where the file dialog begins.
    """

    def __init__(
        self, canvas: CanvasHost, folder: Path, name: str, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent or canvas.area.window())
        self._canvas, self._folder, self._name = canvas, folder, name
        self.setWindowTitle(tr("Picture of the blocks"))
        self.what = QComboBox(self)
        self.what.addItem(tr("This page"), "page")
        self.what.addItem(tr("All pages"), "pages")
        if canvas.selection.ids:
            self.what.addItem(tr("The selected blocks"), "selection")
        self.format = QComboBox(self)
        for kind, label in (
            ("png", tr("PNG, for documents and web pages")),
            ("svg", tr("SVG, sharp at any size")),
            ("pdf", tr("PDF, to print")),
        ):
            self.format.addItem(label, kind)
        self.scale = QDoubleSpinBox(self, singleStep=0.5, decimals=1)
        self.scale.setRange(*SCALES)
        self.scale.setValue(2.0)
        self.transparent = QCheckBox(tr("Nothing behind the blocks (transparent)"), self)
        self.program = QCheckBox(tr("With the program inside: the picture can be opened"), self)
        self.program.setChecked(True)
        self.reason = ReasonBubble(canvas.look.theme, self)
        self.format.currentIndexChanged.connect(self._on_format_changed)
        self._arrange()

    @property
    def options(self) -> PictureOptions:
        """What was chosen."""
        return PictureOptions(
            cast(What, self.what.currentData()),
            self.scale.value(),
            self.transparent.isChecked(),
            has_program=self.program.isChecked(),
        )

    @property
    def kind(self) -> Format:
        """The kind of file that was chosen."""
        return cast(Format, self.format.currentData())

    def save(self, path: Path) -> bool:
        """Write the picture; says why not when that fails."""
        if not path.suffix:
            path = path.with_suffix(f".{self.kind}")
        try:
            write_picture(self._canvas, path, self.kind, self.options)
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
            return False
        return True

    def _arrange(self) -> None:
        form = QFormLayout()
        form.addRow(tr("What"), self.what)
        form.addRow(tr("File"), self.format)
        form.addRow(tr("Size"), self.scale)
        form.addRow("", self.transparent)
        form.addRow("", self.program)
        standard = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(standard.Save | standard.Cancel)
        buttons.button(standard.Save).setText(tr("Save…"))
        buttons.button(standard.Cancel).setText(tr("Cancel"))
        copying = QPushButton(tr("Copy picture"), autoDefault=False)
        copying.clicked.connect(self._on_copied)
        buttons.addButton(copying, QDialogButtonBox.ButtonRole.ActionRole)
        buttons.accepted.connect(self._on_save)
        buttons.rejected.connect(self.reject)
        in_column(form, self.reason, 1, buttons, of=self)

    def _on_format_changed(self) -> None:
        self.scale.setEnabled(self.kind == "png")
        self.program.setEnabled(self.kind != "pdf")

    def _on_save(self) -> None:
        start = str(self._folder / f"{self._name}.{self.kind}")
        name, _filter = QFileDialog.getSaveFileName(
            self, tr("Save the picture"), start, f"{self.kind.upper()} (*.{self.kind})"
        )
        if name and self.save(Path(name)):
            self.accept()

    def _on_copied(self) -> None:
        try:
            copy_picture(self._canvas, self.options)
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
            return
        self.accept()
