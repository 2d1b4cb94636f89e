"""Opens the documentation that comes with the program, in the person's browser."""

from __future__ import annotations

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices

from nep_studio.documentation import first_page
from nep_studio.ui.messages import Message, Messages
from nep_studio.ui.words import language_code, tr


def open_documentation(messages: Messages) -> None:
    """Show its first page in the language in use, or say why that does not go."""
    page = first_page(language_code())
    if page is None:
        sentence = tr("Its pages are not on this computer.")
        steps = [tr("In a copy of the source, docs/build_site.py makes the pages.")]
    elif QDesktopServices.openUrl(QUrl.fromLocalFile(str(page))):
        return
    else:
        sentence = tr("No browser could be started for the page {page}.", page=page)
        steps = [tr("Open that file in a browser by hand.")]
    steps.append(tr("Press F1: the help in this window has most of it."))
    messages.tell(
        Message("warning", tr("The documentation cannot be shown"), sentence, tuple(steps))
    )
