"""What do you have? The ways as cards, in the order of ease, and what each of them asks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QComboBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QRadioButton,
    QSizePolicy,
    QSpinBox,
    QWidget,
)

from nep_studio.run.plan import Setting
from nep_studio.ui.labels import plain_tip
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import (
    column_in,
    hint,
    label_of,
    labelled,
    plain_label,
    quiet_button,
)
from nep_studio.ui.widgets.layouts import Flow, in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import is_right_to_left, tr

from .connectors import APPS, BLUETOOTH, PAPER_WATCH, PHONE_PAGE, RECORDING, VIRTUAL, ConnectorKind

# What is asked while a watch is connected: who may send, where it is worn, and the like.

LARGEST_PORT = 65_535


class Entry(QLineEdit):
    """A line that is written; ``written`` tells once it is done and is another than before.

    To be left unchanged means nothing: a press of a button elsewhere must not be lost by it.
    """

    written = Signal()

    def __init__(self, text: str = "") -> None:
        super().__init__(text)
        self.editingFinished.connect(self._on_finished)

    def _on_finished(self) -> None:
        if self.isModified():
            self.setModified(False)
            self.written.emit()


class NetworkQuestion(QWidget):
    """Whether devices of the network may send to this computer, and at which of its addresses."""

    changed = Signal()

    def __init__(self, addresses: Sequence[str]) -> None:
        super().__init__()
        self.switch = QCheckBox(tr("Let this network in"))
        self.addresses = QComboBox()
        self.told = hint(
            tr(
                "While it is on, anybody in the same network could send movements to this"
                " computer. In networks that you do not know, leave it off."
            )
        )
        self.missing = hint(
            tr("This computer is in no network. Connect it to the Wi-Fi that the device is in.")
        )
        self.again = quiet_button("Look again")
        self.choice = labelled("This computer is", self.addresses)
        again = (self.again, 0, Qt.AlignmentFlag.AlignLeading)
        column_in(self, self.switch, self.told, self.choice, self.missing, again)
        self.show_addresses(addresses)
        self.switch.toggled.connect(self.changed)
        self.addresses.currentIndexChanged.connect(self.changed)

    def show_addresses(self, addresses: Sequence[str]) -> None:
        """Offer these; the first is the most likely one."""
        chosen = self.address
        with QSignalBlocker(self.addresses):
            self.addresses.clear()
            self.addresses.addItems(list(addresses))
            self.addresses.setCurrentText(chosen)
        self.choice.setVisible(len(addresses) > 1)
        self.missing.setVisible(not addresses)
        self.again.setVisible(not addresses)
        self.changed.emit()

    @property
    def is_open(self) -> bool:
        """Whether the network may send."""
        return self.switch.isChecked()

    @property
    def address(self) -> str:
        """Where this computer is found; "" when it is in no network."""
        return self.addresses.currentText()


class WornQuestion(QWidget):
    """Where the device is: on the left wrist, on the right one, in the hand."""

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        words = {
            "left": tr("On the left wrist"),
            "right": tr("On the right wrist"),
            "hand": tr("In the hand"),
        }
        self._group = QButtonGroup(self)
        self.buttons = {name: QRadioButton(said) for name, said in words.items()}
        for button in self.buttons.values():
            self._group.addButton(button)
        Flow(self, self.fontMetrics().height() // 2, self.buttons.values())
        policy = self.sizePolicy()
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)
        self.setAccessibleName(tr("Where is it?"))
        self._group.buttonClicked.connect(self.changed)

    @property
    def worn(self) -> str:
        """The place that is chosen."""
        return next((name for name, one in self.buttons.items() if one.isChecked()), "hand")

    def choose(self, worn: str) -> None:
        """Choose a place."""
        if worn in self.buttons:
            self.buttons[worn].setChecked(True)


class MoreSettings(QWidget):
    """The port, which columns lines have, and how an app counts: hidden until they are wanted."""

    changed = Signal()

    def __init__(self, connector: ConnectorKind) -> None:
        super().__init__()
        self._connector = connector
        self.toggle = QCheckBox(tr("More settings"))
        self.port = QSpinBox(minimum=1, maximum=LARGEST_PORT)
        self.port.setKeyboardTracking(False)
        self.port.setValue(connector.port or 1)
        self.columns = Entry()
        self.columns.setPlaceholderText("t,ax,ay,az,gx,gy,gz")
        self.columns.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.units = QComboBox()
        for units, words in units_words().items():
            self.units.addItem(words, units)
        self.fields = QWidget()
        self._lay_out()
        self.toggle.toggled.connect(self.fields.setVisible)
        for signal in (self.port.valueChanged, self.columns.written, self.units.activated):
            signal.connect(self.changed)

    def _lay_out(self) -> None:
        form = QFormLayout(self.fields)
        form.setContentsMargins(0, 0, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        if self._connector.listens:
            form.addRow(label_of("Port", self.port), self.port)
        if self._connector.asks_columns:
            form.addRow(label_of("Columns", self.columns), self.columns)
            words = tr(
                "Empty: they are guessed. t is the time, ax ay az the acceleration, gx gy gz the"
                " rotation; units may follow, as in t(ms),ax(g),gx(deg/s); a - is left out."
            )
            form.addRow(hint(words))
        if self._connector.asks_units:
            form.addRow(label_of("How it counts", self.units), self.units)
        column_in(self, self.toggle, self.fields)
        self.fields.hide()
        if not form.rowCount():
            self.hide()

    @property
    def settings(self) -> dict[str, Setting]:
        """The parameters that differ from what is usual; the port is its own."""
        found: dict[str, Setting] = {}
        if self._connector.asks_columns and self.columns.text().strip():
            found["columns"] = self.columns.text().strip()
        if self._connector.asks_units and self.units.currentIndex():
            found["units"] = str(self.units.currentData())
        return found

    def show_settings(self, settings: Mapping[str, Setting]) -> None:
        """Begin with what was chosen before."""
        self.port.setValue(int(settings.get("port") or self._connector.port or 1))
        self.columns.setText(str(settings.get("columns", "")))
        self.units.setCurrentIndex(max(0, self.units.findData(settings.get("units", "guess"))))
        is_unusual = bool(self.settings) or self.port.value() != (self._connector.port or 1)
        self.toggle.setChecked(is_unusual)


def units_words() -> dict[str, str]:
    """How an app counts, by the name of the setting."""
    return {
        "guess": tr("Guess"),
        "standard": tr("As Android: m/s²"),
        "apple": tr("As Apple: g, axes the other way"),
    }


# What do you have? The ways as cards, in the order of ease.


@dataclass(frozen=True)
class Offer:
    """A card: the way that it opens, what one has, and what is done with it."""

    connector: ConnectorKind
    title: str
    sentence: str


def offers() -> list[Offer]:
    """All cards, the easiest first."""
    return [
        Offer(
            PHONE_PAGE,
            tr("A phone"),
            tr("Scan a code with its camera. Nothing is installed."),
        ),
        Offer(
            APPS[0],
            tr("A watch or phone with an app"),
            tr("Sensor Logger (also for Apple Watch and Wear OS), phyphox, SensorServer, others."),
        ),
        Offer(
            PAPER_WATCH,
            tr("The watch of the paper"),
            tr("An Android watch with NEP's own app of 2016."),
        ),
        Offer(
            BLUETOOTH,
            tr("A Bluetooth sensor"),
            tr("A micro:bit, a PineTime or another motion sensor."),
        ),
        Offer(
            VIRTUAL,
            tr("Nothing yet"),
            tr("A simulated person makes the gestures, so that all can be tried."),
        ),
        Offer(
            RECORDING,
            tr("A recording"),
            tr("A file of movements is played as if somebody moved now."),
        ),
    ]


class OfferCard(QPushButton):
    """One thing that a person may have; the whole card is a button."""

    def __init__(self, offer: Offer, look: Look) -> None:
        super().__init__(autoDefault=False)
        self.setAccessibleName(offer.title)
        self.setAccessibleDescription(offer.sentence)
        line = self.fontMetrics().height()
        wide, high = line * 2 // 3, line // 2
        self._look = look
        self._pictures: list[tuple[QLabel, str, int]] = []
        title, sentence = plain_label(offer.title), plain_label(offer.sentence)
        title.setProperty("role", "heading")
        sentence.setProperty("role", "hint")
        for label in (title, sentence):
            label.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        words = in_column(title, sentence, spacing=0)
        before = self._picture(offer.connector.icon, round(line * 1.7))
        chevron = "chevron-left" if is_right_to_left() else "chevron-right"
        behind = self._picture(chevron, round(line * 1.1))
        in_row(before, (words, 1), behind, of=self, margins=(wide, high, wide, high), spacing=wide)
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

    def __init__(self, look: Look) -> None:
        super().__init__()
        line = self.fontMetrics().height()
        heading = QLabel(tr("What do you have?"), wordWrap=True)
        heading.setProperty("role", "title")
        self.cards = {one.connector.name: OfferCard(one, look) for one in offers()}
        for connector, card in self.cards.items():
            card.clicked.connect(lambda _=False, connector=connector: self.chosen.emit(connector))
        margins = (0, 0, line // 2, 0)
        in_column(heading, *self.cards.values(), 1, of=self, margins=margins, spacing=line // 2)


# What is asked for the sources that need no device: gestures to make, a recording to play.


class GesturesQuestion(QWidget):
    """Which gestures a simulated person makes, and whether again and again.

    ``known`` are all that it can make, names to titles, ``wanted`` those that it begins with.
    """

    changed = Signal()

    def __init__(self, known: Mapping[str, str], wanted: Sequence[str]) -> None:
        super().__init__()
        self.boxes = {name: QCheckBox(title.replace("&", "&&")) for name, title in known.items()}
        self._check(wanted)
        self.repeats = QCheckBox(tr("Make them again and again"))
        self.repeats.setChecked(True)
        offered = QWidget()
        offered.setLayout(Flow(spacing=self.fontMetrics().height(), widgets=self.boxes.values()))
        column_in(self, offered, self.repeats)
        for box in (*self.boxes.values(), self.repeats):
            box.toggled.connect(self.changed)

    @property
    def chosen(self) -> list[str]:
        """The names of those that are to be made."""
        return [name for name, box in self.boxes.items() if box.isChecked()]

    def _check(self, wanted: Sequence[str]) -> None:
        for name, box in self.boxes.items():
            box.setChecked(name in wanted)

    @property
    def settings(self) -> dict[str, Setting]:
        """The parameters of the node."""
        return {"gestures": ", ".join(self.chosen), "repeat": self.repeats.isChecked()}

    def show_settings(self, settings: Mapping[str, Setting]) -> None:
        """Begin with what was chosen before."""
        if "gestures" in settings:
            self._check([one.strip() for one in str(settings["gestures"]).split(",")])
        self.repeats.setChecked(bool(settings.get("repeat", True)))


class RecordingQuestion(QWidget):
    """Which file is played."""

    changed = Signal()

    def __init__(self, folder: Path, look: Look) -> None:
        super().__init__()
        self.path = ""
        self._folder = folder
        self._look = look
        self.button = QPushButton(tr("Choose a recording…"), autoDefault=False)
        self.redraw()
        line = self.fontMetrics().height()
        self.button.setIconSize(QSize(line, line))
        self.name = plain_label()
        self.repeats = QCheckBox(tr("Play it again and again"))
        self.repeats.setChecked(True)
        button = (self.button, 0, Qt.AlignmentFlag.AlignLeading)
        column_in(self, button, self.name, self.repeats)
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
        self.name.setToolTip(plain_tip(path))
        self.name.setVisible(bool(path))
        if path:
            self.changed.emit()

    def _on_choose(self) -> None:
        kinds, title = (tr("Recordings (*.csv)"), tr("All files (*)")), tr("Choose a recording")
        ask_for_path(self, title, self._folder, lambda path: self.choose(str(path)), kinds=kinds)
