"""What is asked while a watch is connected: who may send, where it is worn, and the like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QComboBox,
    QFormLayout,
    QLineEdit,
    QRadioButton,
    QSpinBox,
    QWidget,
)

from nep_studio.run.plan import Setting
from nep_studio.ui.widgets.forms import column_in, hint, label_of, labelled, quiet_button
from nep_studio.ui.widgets.layouts import Flow
from nep_studio.ui.words import tr

from .connectors import ConnectorKind

LARGEST_PORT = 65_535


class Entry(QLineEdit):
    """A line that is written; ``written`` tells once it is done and is another than before.

    To be left unchanged means nothing: a press of a button elsewhere must not be lost by it.
    """

    written = Signal()

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.editingFinished.connect(self._on_finished)

    def _on_finished(self) -> None:
        if self.isModified():
            self.setModified(False)
            self.written.emit()


class NetworkQuestion(QWidget):
    """Whether devices of the network may send to this computer, and at which of its addresses."""

    changed = Signal()

    def __init__(self, addresses: Sequence[str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
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
        self.again = quiet_button(tr("Look again"))
        self.choice = labelled(tr("This computer is"), self.addresses)
        box = column_in(self)
        for widget in (self.switch, self.told, self.choice, self.missing, self.again):
            box.addWidget(widget)
        box.setAlignment(self.again, Qt.AlignmentFlag.AlignLeading)
        self.show_addresses(addresses)
        self.switch.toggled.connect(self.changed)
        self.addresses.currentIndexChanged.connect(self.changed)

    def show_addresses(self, addresses: Sequence[str]) -> None:
        """Offer these; the first is the most likely one."""
        chosen = self.address
        self.addresses.blockSignals(True)
        self.addresses.clear()
        self.addresses.addItems(list(addresses))
        self.addresses.setCurrentText(chosen)
        self.addresses.blockSignals(False)
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

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        words = {
            "left": tr("On the left wrist"),
            "right": tr("On the right wrist"),
            "hand": tr("In the hand"),
        }
        self._group = QButtonGroup(self)
        flow = Flow(self, spacing=self.fontMetrics().height() // 2)
        self.buttons = {name: QRadioButton(said) for name, said in words.items()}
        for button in self.buttons.values():
            self._group.addButton(button)
            flow.addWidget(button)
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

    def __init__(self, connector: ConnectorKind, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._connector = connector
        self.toggle = QCheckBox(tr("More settings"))
        self.port = QSpinBox()
        self.port.setRange(1, LARGEST_PORT)
        self.port.setValue(connector.port or 1)
        self.port.setKeyboardTracking(False)
        self.columns = Entry()
        self.columns.setPlaceholderText("t,ax,ay,az,gx,gy,gz")
        self.columns.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.units = QComboBox()
        for units, words in units_words().items():
            self.units.addItem(words, units)
        self.fields = QWidget()
        self._lay_out()
        self.toggle.toggled.connect(self.fields.setVisible)
        self.port.valueChanged.connect(self.changed)
        self.columns.written.connect(self.changed)
        self.units.activated.connect(self.changed)

    def _lay_out(self) -> None:
        form = QFormLayout(self.fields)
        form.setContentsMargins(0, 0, 0, 0)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        if self._connector.listens:
            form.addRow(label_of(tr("Port"), self.port), self.port)
        if self._connector.asks_columns:
            form.addRow(label_of(tr("Columns"), self.columns), self.columns)
            words = tr(
                "Empty: they are guessed. t is the time, ax ay az the acceleration, gx gy gz the"
                " rotation; units may follow, as in t(ms),ax(g),gx(deg/s); a - is left out."
            )
            form.addRow(hint(words))
        if self._connector.asks_units:
            form.addRow(label_of(tr("How it counts"), self.units), self.units)
        box = column_in(self)
        box.addWidget(self.toggle)
        box.addWidget(self.fields)
        self.setVisible(form.rowCount() > 0)
        self.fields.hide()

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
