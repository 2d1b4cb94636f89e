"""The dialog that prints a program, with a preview that is always what will come out."""

from __future__ import annotations

from typing import cast

from PySide6.QtCore import Qt
from PySide6.QtGui import QPageLayout
from PySide6.QtPrintSupport import QPageSetupDialog, QPrintDialog, QPrinter, QPrintPreviewWidget
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFormLayout,
    QPushButton,
    QToolButton,
    QWidget,
)

from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .paper import PrintOptions, print_program
from .picture import What


class ProgramPrintDialog(QDialog):
    """Asks what is printed, and on what paper; ``code`` is "" where there is no Python yet."""

    def __init__(
        self, canvas: CanvasHost, code: str, parent: QWidget, printer: QPrinter | None = None
    ) -> None:
        super().__init__(parent)
        self._canvas, self._code = canvas, code
        self.setWindowTitle(tr("Print"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.printer = printer or QPrinter(QPrinter.PrinterMode.HighResolution)
        self.what = QComboBox()
        self.what.addItem(tr("All pages"), "pages")
        self.what.addItem(tr("This page"), "page")
        if canvas.selection.ids:
            self.what.addItem(tr("The selected blocks"), "selection")
        self.code = QCheckBox(tr("The Python, too"))
        self.code.setEnabled(bool(code))
        self.orientation = QComboBox()
        self.orientation.addItem(tr("Upright"), QPageLayout.Orientation.Portrait)
        self.orientation.addItem(tr("Across"), QPageLayout.Orientation.Landscape)
        self.preview = QPrintPreviewWidget(self.printer, self)
        self.preview.setAccessibleName(tr("What will be printed"))
        self.setup_button = QPushButton(tr("Page setup…"))
        self.print_button = QPushButton(tr("Print…"))
        self.close_button = QPushButton(tr("Close"))
        self._arrange(canvas.look.theme)
        self._connect()

    @property
    def options(self) -> PrintOptions:
        """What was chosen."""
        what = cast(What, self.what.currentData())
        return PrintOptions(what, has_code=self.code.isChecked())

    def print_to(self, printer: QPrinter) -> int:
        """Print what was chosen; how many sheets there are."""
        return print_program(self._canvas, printer, self._code, self.options)

    def _arrange(self, theme: Theme) -> None:
        line = self.fontMetrics().height()
        form = QFormLayout()
        form.addRow(tr("What"), self.what)
        form.addRow("", self.code)
        form.addRow(tr("Paper"), self.orientation)
        top = in_row(form, 1)
        for name, words, do in (
            ("zoom-out", tr("Zoom out"), self.preview.zoomOut),
            ("zoom-in", tr("Zoom in"), self.preview.zoomIn),
            ("maximize", tr("Show whole pages"), self.preview.fitInView),
        ):
            button = QToolButton()
            button.setIcon(icon(name, theme))
            button.setToolTip(words)
            button.setAccessibleName(words)
            button.clicked.connect(do)
            top.addWidget(button, 0, Qt.AlignmentFlag.AlignBottom)
        buttons = in_row(self.setup_button, 1, self.close_button, self.print_button)
        self.print_button.setDefault(True)
        in_column(top, (self.preview, 1), buttons, of=self, margins=line, spacing=line // 2)
        self.resize(line * 40, line * 36)

    def _connect(self) -> None:
        self.preview.paintRequested.connect(self.print_to)
        self.what.currentIndexChanged.connect(self.preview.updatePreview)
        self.code.toggled.connect(self.preview.updatePreview)
        self.orientation.currentIndexChanged.connect(self._on_turned)
        self.setup_button.clicked.connect(self._on_setup_clicked)
        self.print_button.clicked.connect(self._on_print_clicked)
        self.close_button.clicked.connect(self.reject)

    def _on_turned(self) -> None:
        self.preview.setOrientation(self.orientation.currentData())

    def _on_setup_clicked(self) -> None:
        dialog = QPageSetupDialog(self.printer, self)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.accepted.connect(self._on_set_up)
        dialog.open()

    def _on_set_up(self) -> None:
        orientation = self.printer.pageLayout().orientation()
        self.orientation.setCurrentIndex(self.orientation.findData(orientation))
        self.preview.updatePreview()

    def _on_print_clicked(self) -> None:
        dialog = QPrintDialog(self.printer, self)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.setOption(QPrintDialog.PrintDialogOption.PrintPageRange)
        dialog.accepted.connect(self._on_print_accepted)
        QDialog.open(dialog)  # its own needs a receiver

    def _on_print_accepted(self) -> None:
        self.print_to(self.printer)
        self.accept()
