"""The ways in which a watch or phone reaches this computer, and what a person does for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont, QPainter, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QWidget

from nep_core.errors import NepError
from nep_studio.blocks.operations.fixes import WATCH
from nep_studio.run.plan import REPLAY, VIRTUAL_WATCH
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import UNKNOWN, CopyLine, plain_label
from nep_studio.ui.widgets.layouts import InLines, in_column
from nep_studio.ui.words import tr

OWN_PROFILE = "six_int16"
"""The profile for those who build a sensor themselves."""
Worn = Literal["left", "right", "hand"]
Extra = Literal["", "network", "warning", "address", "gestures", "recording"]


@dataclass(frozen=True)
class ConnectorKind:
    """``name`` is the parameter ``through`` of the node, or the name of a simulated source.

    ``listens``: devices come to this computer; else it goes to the device, at the ``address``
    that a person writes. ``port`` is the usual one here, 0 where none is opened.
    """

    name: str
    icon: str
    node: str = WATCH
    port: int = 0
    listens: bool = False
    protocol: Literal["TCP", "UDP", ""] = ""
    worn: Worn = "hand"
    needs_address: bool = False
    asks_columns: bool = False
    asks_units: bool = False
    asks_wrist: bool = True


@dataclass(frozen=True)
class Step:
    """One thing to do, what is copied for it, and which questions stand below it."""

    words: str
    copied: str = ""
    extra: Extra = ""


@dataclass(frozen=True)
class Place:
    """Where this computer is found: its address and port, and the phone page's address."""

    address: str
    port: int
    url: str = ""

    @property
    def both(self) -> str:
        """The address with the port."""
        return f"{self.address}:{self.port}"


PHONE_PAGE = ConnectorKind(
    "phone_page", "qr-code", port=8443, listens=True, protocol="TCP", asks_wrist=False
)
"""Where the phone is, is asked on the page itself."""
PAPER_WATCH = ConnectorKind(
    "paper_watch", "watch", port=8080, listens=True, protocol="TCP", worn="left"
)
BLUETOOTH = ConnectorKind("bluetooth", "bluetooth", worn="left")
VIRTUAL = ConnectorKind("virtual_watch", "user", VIRTUAL_WATCH, asks_wrist=False)
RECORDING = ConnectorKind("recording", "circle-play", REPLAY, asks_wrist=False)
APPS = (
    ConnectorKind(
        "sensor_logger", "smartphone", port=8000, listens=True, protocol="TCP", asks_units=True
    ),
    ConnectorKind("phyphox", "smartphone", protocol="TCP", needs_address=True, asks_units=True),
    ConnectorKind("sensor_server", "smartphone", protocol="TCP", needs_address=True),
    ConnectorKind(
        "udp", "smartphone", port=8085, listens=True, protocol="UDP", asks_columns=True
    ),
    ConnectorKind(
        "tcp", "smartphone", port=8086, listens=True, protocol="TCP", asks_columns=True
    ),
)  # fmt: skip
CONNECTORS = {
    connector.name: connector
    for connector in (PHONE_PAGE, *APPS, PAPER_WATCH, BLUETOOTH, VIRTUAL, RECORDING)
}


def connector_title(connector: ConnectorKind) -> str:
    """What the page of a way is headed."""
    titles = {
        "phone_page": tr("A phone, without installing anything"),
        "paper_watch": tr("The watch of the paper"),
        "bluetooth": tr("A Bluetooth sensor"),
        "virtual_watch": tr("A simulated person"),
        "recording": tr("A recording"),
    }
    return titles.get(connector.name) or tr("A watch or phone with an app")


def app_words(connector: ConnectorKind) -> str:
    """How an app is called in the list of apps, with what it runs on."""
    words = {
        "sensor_logger": tr("Sensor Logger: iPhone, Android, Apple Watch, Wear OS"),
        "phyphox": tr("phyphox: iPhone, Android"),
        "sensor_server": tr("SensorServer: Android"),
        "udp": tr("SensaGram, HyperIMU, ZIG SIM, a micro:bit… (lines by UDP)"),
        "tcp": tr("SensorStreamer, HyperIMU, ZIG SIM… (lines by TCP)"),
    }
    return words[connector.name]


def steps(connector: ConnectorKind, place: Place) -> list[Step]:
    """What a person does, in this order."""
    return {
        "phone_page": _phone_page,
        "sensor_logger": _sensor_logger,
        "phyphox": _phyphox,
        "sensor_server": _sensor_server,
        "udp": _lines,
        "tcp": _lines,
        "paper_watch": _paper_watch,
        "bluetooth": _bluetooth,
        "virtual_watch": _virtual,
        "recording": _recording,
    }[connector.name](place)


def _same_network() -> Step:
    return Step(tr("The device and this computer are in the same network."), extra="network")


def _phone_page(place: Place) -> list[Step]:
    scan = tr("Point the camera of the phone at the code, and open the address that it finds.")
    warned = tr(
        "The phone warns once: it does not know this computer. That is expected, for the page"
        " comes from here and not from the internet. Let it go on."
    )
    start = tr(
        "On the page, press “Allow motion”, and say where the phone is. Leave the page open."
    )
    return [_same_network(), Step(scan, place.url), Step(warned, extra="warning"), Step(start)]


def _sensor_logger(place: Place) -> list[Step]:
    push = tr(
        "In the app, press the gear on the page Logger. Switch on HTTP Push, and write this as"
        " its Push URL:"
    )
    choose = tr(
        "Choose Accelerometer, Gravity and Gyroscope, on an Apple Watch Wrist Motion. Let it send"
        " as often as it can (batch period), and standardise units and frames."
    )
    start = tr("Press Start Recording, and keep the app open.")
    url = f"http://{place.both}/data"
    return [_same_network(), Step(push, url), Step(choose), Step(start)]


def _phyphox(place: Place) -> list[Step]:
    network = tr("The phone and this computer are in the same network.")
    choose = tr("In phyphox, open the experiment “Acceleration with g”.")
    allow = tr("In its menu (three dots), switch on “Allow remote access”. It shows an address.")
    write = tr("Write the address that it shows:")
    return [Step(network), Step(choose), Step(allow), Step(write, extra="address")]


def _sensor_server(place: Place) -> list[Step]:
    network = tr("The phone and this computer are in the same network.")
    start = tr("In SensorServer, press Start. It shows an address that begins with ws://.")
    write = tr("Write the address that it shows:")
    return [Step(network), Step(start), Step(write, extra="address")]


def _lines(place: Place) -> list[Step]:
    choose = tr(
        "In the app, choose the accelerometer and, if there is one, the gyroscope; about 50"
        " samples a second; as JSON or CSV lines."
    )
    write = tr("Write this address as where it sends to (IP, host or target):")
    port = tr("And this port; then start sending:")
    return [_same_network(), Step(choose), Step(write, place.address), Step(port, str(place.port))]


def _paper_watch(place: Place) -> list[Step]:
    wear = tr("Start NEP's app on the watch, and the one on its phone.")
    write = tr("In the phone's app, write this address; its port is always {port}:", port=8080)
    connect = tr("Press connect in the phone's app.")
    return [_same_network(), Step(wear), Step(write, place.address), Step(connect)]


def _bluetooth(place: Place) -> list[Step]:
    wake = tr("Switch the sensor on, and Bluetooth on this computer.")
    free = tr("See that it is not connected to a phone: most talk to one partner only.")
    write = tr("If several are on, write the name or the address of yours:")
    known = ", ".join(_known_sensors())
    told = f"{wake} {tr('Known are: {names}.', names=known)}" if known else wake
    return [Step(told), Step(free), Step(write, extra="address")]


def _known_sensors() -> list[str]:
    """The Bluetooth sensors for which there is a profile."""
    from nodes.sensory.connectors.bluetooth import profiles

    try:
        return [tr(one.title) for name, one in profiles().items() if name != OWN_PROFILE]
    except NepError:  # one's own profile is wrong: the node says how
        return []


def _virtual(place: Place) -> list[Step]:
    words = tr("A simulated person wears a watch and makes these gestures, 3 seconds apart:")
    return [Step(words, extra="gestures")]


def _recording(place: Place) -> list[Step]:
    words = tr("A recording of a watch or phone is played as if the person moved now:")
    return [Step(words, extra="recording")]


def silence_steps(
    connector: ConnectorKind, place: Place, is_open: bool, address: str
) -> tuple[str, ...]:
    """What to look at, in this order, when nothing arrives; ``is_open``: the network may send."""
    found: list[str] = []
    if connector.listens and not is_open:
        found.append(tr("Above, “Let this network in” is off: nothing from outside is heard."))
    if connector.name == "bluetooth":
        found.append(tr("Is the sensor on, charged, and within 5 metres?"))
        found.append(tr("Is Bluetooth on, on this computer? Is the sensor free of its phone?"))
        return tuple(found)
    if connector.node != WATCH:
        return (tr("Look into the log of the node in the panel What runs."),)
    found.append(tr("Is the screen of the device on, and is it sending?"))
    if connector.needs_address:
        found.append(tr("Is {address} still what the app shows?", address=address or UNKNOWN))
        found.append(tr("Are both in the same Wi-Fi? A guest network often keeps devices apart."))
        return tuple(found)
    where = place.url.partition("?")[0] or place.both
    found.append(tr("Does the device send to {address}? Compare every digit.", address=where))
    found.append(tr("Are both in the same Wi-Fi? A guest network often keeps devices apart."))
    wall = tr(
        "Does a firewall on this computer block {protocol} port {port}? Allow NEP Studio there.",
        protocol=connector.protocol,
        port=place.port,
    )
    return (*found, wall)


# Numbered steps in plain words, each with what is copied for it and what is asked there.

MOST_LETTERS = 24
"""So many letters fit beside the button."""


class StepNumber(InLines):
    """A number in a disc."""

    usual_lines = (1.5, 1.5)

    def __init__(self, number: int, look: Look) -> None:
        super().__init__()
        self._number, self._look = number, look
        self.setFixedSize(self.sizeHint())

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        theme, font = self._look.theme, QFont(self.font())
        font.setWeight(QFont.Weight.DemiBold)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("accent"))
            painter.drawEllipse(QRectF(self.rect()))
            painter.setPen(theme.colour("accent_text"))
            painter.setFont(font)
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, str(self._number))


class StepsList(QWidget):
    """The steps of one way; ``extras`` are the questions that stand below steps, by name."""

    def __init__(self, steps: Sequence[Step], extras: Mapping[str, QWidget], look: Look) -> None:
        super().__init__()
        self.words: list[QLabel] = []
        self.copy_lines: list[CopyLine | None] = []
        line = self.fontMetrics().height()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(1, 1)
        grid.setSpacing(line // 2)
        for number, step in enumerate(steps):
            if len(steps) > 1:
                badge = StepNumber(number + 1, look)
                grid.addWidget(badge, number, 0, Qt.AlignmentFlag.AlignTop)
            label = plain_label()
            is_address = step.copied.startswith("http") or "." in step.copied
            words = tr("Copy the address") if is_address else tr("Copy")
            is_long = len(step.copied) > MOST_LETTERS
            copy_line = CopyLine(look, words, is_long) if step.copied else None
            self.words.append(label)
            self.copy_lines.append(copy_line)
            below = [one for one in (copy_line, extras.get(step.extra)) if one is not None]
            grid.addLayout(in_column(label, *below, spacing=line // 3), number, 1)
        self.fill(steps)

    def fill(self, steps: Sequence[Step]) -> None:
        """Show the same steps with other addresses."""
        for step, label, copy_line in zip(steps, self.words, self.copy_lines, strict=True):
            label.setText(step.words)
            if copy_line is not None:
                copy_line.show_text(step.copied)
