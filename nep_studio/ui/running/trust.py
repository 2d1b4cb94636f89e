"""Asks, before it runs, about what a project brings that is not blocks; shows all of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QTextOption
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QScrollArea,
    QWidget,
)

from nep_studio.blocks.code_text import plainly_and_short, plainly_in_a_line
from nep_studio.project.trust import Concern
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.theme.look import Look, code_font
from nep_studio.ui.widgets.forms import breakable, fit_on_screen, styled
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

SIGNS = {"python": "code", "node": "box", "robot": "bot"}
MOST_LINES = 14
"""A longer text scrolls in its card, whose title says how long it is."""


MOST_CARDS = 60
"""What comes after them is in one card, whole too: thousands of cards would take a minute."""


class TrustDialog(QDialog):
    """Accepted means: run it. Escape, Enter and closing mean: not now."""

    def __init__(
        self,
        over: QWidget,
        look: Look,
        name: str,
        concerns: Sequence[Concern],
        titles: Mapping[str, str],
    ) -> None:
        """``titles`` are what the pages of the project called ``name`` are called."""
        super().__init__(over)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Run what is not blocks?"))
        self._look, self._titles = look, titles
        line = self.fontMetrics().height()
        headline = styled(QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText), role="title")
        words = tr("“{name}” brings more than blocks", name=plainly_in_a_line(name))
        headline.setText(breakable(words))
        about = QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        about.setText(
            tr(
                "Blocks do what their words say. What is listed here can do more: read and change "
                "your files, or reach the network. Run it only if you trust who made it."
            )
        )
        self.texts: list[QPlainTextEdit] = []
        inner = QWidget()
        cards = [self._card(concern, line) for concern in concerns[:MOST_CARDS]]
        if rest := concerns[MOST_CARDS:]:
            cards.append(self._card_of_all(rest, line))
        again = styled(QLabel(wordWrap=True), role="hint")
        again.setText(tr("You are asked once: again only when one of these has changed."))
        # With large letters the words have no room beside the list: they scroll with it
        in_column(
            about, *cards, again, 1, of=inner, margins=(0, 0, line // 2, 0), spacing=line // 2
        )
        self.list = QScrollArea(widgetResizable=True)
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        self.list.setAccessibleName(
            count_words(len(concerns), "1 thing to look at", "{n} things to look at")
        )
        self.list.setWidget(inner)
        self.run_button = styled(QPushButton(tr("Run"), autoDefault=False), kind="run")
        self.run_button.setIcon(icon("play", look.theme, "run_text"))
        self.run_button.setIconSize(icon_room(line))
        self.refuse_button = QPushButton(tr("Not now"))
        self.run_button.clicked.connect(self.accept)
        self.refuse_button.clicked.connect(self.reject)
        buttons = in_row(1, self.run_button, self.refuse_button, spacing=line // 2)
        in_column(headline, (self.list, 1), buttons, of=self, margins=line, spacing=line // 2)
        self.setAccessibleDescription(f"{words} {about.text()}")
        fit_on_screen(self, 44, 34 if len(concerns) > 1 else 26)
        self.refuse_button.setDefault(True)
        wide = self.fontMetrics().horizontalAdvance(self.refuse_button.text())
        self.refuse_button.setMinimumWidth(round(1.2 * wide) + 3 * line)  # its letters grow bold
        self.refuse_button.setFocus()

    def _card(self, concern: Concern, line: int) -> QWidget:
        """What it is, where it is, and all of it."""
        plain = Qt.TextFormat.PlainText
        words, where = plainly_in_a_line(tr(concern.title)), self._place(concern)
        place = styled(QLabel(breakable(where), wordWrap=True, textFormat=plain), role="hint")
        text = self._text(plainly_and_short(concern.text), f"{words}, {where}")
        return self._framed(SIGNS[concern.kind], words, line, place, text)

    def _card_of_all(self, concerns: Sequence[Concern], line: int) -> QWidget:
        """Many in one text: each with its words, and all of it below them, further in."""
        told = []
        for concern in concerns:
            told.append(f"{plainly_in_a_line(tr(concern.title))}, {self._place(concern)}")
            told += [f"    {one}" for one in plainly_and_short(concern.text).split("\n")]
        words = tr("And {count} more, one below the other", count=len(concerns))
        return self._framed("list", words, line, self._text("\n".join(told), words))

    def _place(self, concern: Concern) -> str:
        page = self._titles.get(concern.page, concern.page)
        return " · ".join([tr("page {title}", title=page), *map(tr, concern.notes)])

    def _framed(self, sign_name: str, words: str, line: int, *parts: QWidget) -> QWidget:
        card, sign, side = styled(QFrame(), kind="card"), QLabel(), round(line * 1.2)
        picture = icon(sign_name, self._look.theme.colour("warning"))
        sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))
        title = QLabel(breakable(words), wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        styled(title, role="heading")
        head = in_row((sign, 0, Qt.AlignmentFlag.AlignTop), (title, 1), spacing=line // 2)
        in_column(head, *parts, of=card, margins=line // 2, spacing=line // 3)
        return card

    def _text(self, shown: str, name: str) -> QPlainTextEdit:
        text = QPlainTextEdit(readOnly=True)
        text.setAccessibleName(name)
        text.setTabChangesFocus(True)
        text.setFont(code_font(self.font().pointSizeF() * 0.95))
        text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        # No line goes on beside the edge, where nobody would look for it
        text.setWordWrapMode(QTextOption.WrapMode.WrapAnywhere)
        text.setPlainText(shown)
        rows = min(max(text.document().blockCount() + 1, 2), MOST_LINES)
        letters = max(map(len, text.toPlainText().split("\n")), default=0)
        if letters > 60:
            rows = min(rows + letters // 60, MOST_LINES)
        text.setFixedHeight(rows * text.fontMetrics().lineSpacing() + text.fontMetrics().height())
        self.texts.append(text)
        return text
