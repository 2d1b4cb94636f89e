"""What do you have? The ways as cards, in the order of ease."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from nep_studio.run.plan import Setting
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import column_in
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import is_right_to_left, tr

from .connectors import APPS, BLUETOOTH, PAPER_WATCH, PHONE_PAGE, RECORDING, VIRTUAL
from .questions import Entry


@dataclass(frozen=True)
class Offer:
    """A card: the way that it opens, its icon, what one has, and what is done with it."""

    connector: str
    icon: str
    title: str
    sentence: str


def offers() -> list[Offer]:
    """All cards, the easiest first."""
    return [
        Offer(
            PHONE_PAGE.name,
            PHONE_PAGE.icon,
            tr("A phone"),
            tr("Scan a code with its camera. Nothing is installed."),
        ),
        Offer(
            APPS[0].name,
            APPS[0].icon,
            tr("A watch or phone with an app"),
            tr("Sensor Logger (also for Apple Watch and Wear OS), phyphox, SensorServer, others."),
        ),
        Offer(
            PAPER_WATCH.name,
            PAPER_WATCH.icon,
            tr("The watch of the paper"),
            tr("An Android watch with NEP's own app of 2016."),
        ),
        Offer(
            BLUETOOTH.name,
            BLUETOOTH.icon,
            tr("A Bluetooth sensor"),
            tr("A micro:bit, a PineTime or another motion sensor."),
        ),
        Offer(
            VIRTUAL.name,
            VIRTUAL.icon,
            tr("Nothing yet"),
            tr("A simulated person makes the gestures, so that all can be tried."),
        ),
        Offer(
            RECORDING.name,
            RECORDING.icon,
            tr("A recording"),
            tr("A file of movements is played as if somebody moved now."),
        ),
    ]


class OfferCard(QPushButton):
    """One thing that a person may have; the whole card is a button."""

    def __init__(self, offer: Offer, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.offer = offer
        self.setAutoDefault(False)
        self.setAccessibleName(offer.title)
        self.setAccessibleDescription(offer.sentence)
        line = self.fontMetrics().height()
        row = QHBoxLayout(self)
        row.setContentsMargins(line * 2 // 3, line // 2, line * 2 // 3, line // 2)
        row.setSpacing(line * 2 // 3)
        self._look = look
        self._pictures: list[tuple[QLabel, str, int]] = []
        row.addWidget(self._picture(offer.icon, round(line * 1.7)))
        title, sentence = QLabel(offer.title), QLabel(offer.sentence)
        title.setProperty("role", "heading")
        sentence.setProperty("role", "hint")
        words = QVBoxLayout()
        words.setSpacing(0)
        for label in (title, sentence):
            label.setWordWrap(True)
            label.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
            words.addWidget(label)
        row.addLayout(words, 1)
        chevron = "chevron-left" if is_right_to_left() else "chevron-right"
        row.addWidget(self._picture(chevron, round(line * 1.1)))
        self.redraw()
        policy = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)

    def _picture(self, name: str, side: int) -> QLabel:
        label = QLabel()
        label.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        label.setFixedWidth(side)
        self._pictures.append((label, name, side))
        return label

    def redraw(self) -> None:
        """Draw the icons in another theme."""
        for label, name, side in self._pictures:
            picture = icon(name, self._look.theme)
            label.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter opens it too."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.click()
        else:
            super().keyPressEvent(event)

    def heightForWidth(self, width: int) -> int:
        """The height that its words need."""
        layout = self.layout()
        return layout.totalHeightForWidth(width) if layout is not None else 0

    def sizeHint(self) -> QSize:
        """That of what is in it; a button measures only its own words."""
        layout = self.layout()
        return layout.totalSizeHint() if layout is not None else QSize()

    def minimumSizeHint(self) -> QSize:
        """That of what is in it."""
        layout = self.layout()
        return layout.totalMinimumSize() if layout is not None else QSize()


class ChoosingPage(QWidget):
    """``chosen`` gives the name of a way."""

    chosen = Signal(str)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        line = self.fontMetrics().height()
        heading = QLabel(tr("What do you have?"), wordWrap=True)
        heading.setProperty("role", "title")
        box = in_column(heading, of=self, margins=(0, 0, line // 2, 0), spacing=line // 2)
        self.cards = {one.connector: OfferCard(one, look) for one in offers()}
        for connector, card in self.cards.items():
            card.clicked.connect(lambda _=False, connector=connector: self.chosen.emit(connector))
            box.addWidget(card)
        box.addStretch(1)


# What is asked for the sources that need no device: gestures to make, a recording to play.


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
        self.button = QPushButton(tr("Choose a recording…"), autoDefault=False)
        self.redraw()
        line = self.fontMetrics().height()
        self.button.setIconSize(QSize(line, line))
        self.name = QLabel(wordWrap=True)
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
