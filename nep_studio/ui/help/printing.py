"""Prints a page of the help."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QPageLayout
from PySide6.QtPrintSupport import QPrintDialog, QPrinter
from PySide6.QtWidgets import QDialog, QWidget

from .browser import HelpBrowser


def ask_to_print(browser: HelpBrowser, parent: QWidget) -> None:
    """Let the person choose a printer, then print."""
    dialog = QPrintDialog(QPrinter(), parent)
    dialog.accepted.connect(lambda: print_page(browser, dialog.printer()))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    QDialog.open(dialog)


def print_page(browser: HelpBrowser, printer: QPrinter) -> None:
    """Print the page that is shown, dark on light."""
    layout = printer.pageLayout()
    width = layout.paintRect(QPageLayout.Unit.Point).width()
    document = browser.printed(width * 0.9)
    document.print_(printer)
    document.deleteLater()
