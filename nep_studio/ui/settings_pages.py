"""The pages of the settings: look, folders, show mode, network."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFileDialog,
    QFormLayout,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSlider,
    QSpinBox,
    QWidget,
)

from nep_studio.settings import (
    LARGEST_TEXT,
    MOST_RESTARTS,
    SMALLEST_TEXT,
    SYSTEM,
    FolderName,
    Settings,
)
from nep_studio.ui.elided_label import ElidedLabel
from nep_studio.ui.theme import load_theme, themes
from nep_studio.ui.words import available_languages, tr

TEXT_STEP = 5
"""Percent between two sizes of the text."""

FOLDERS: tuple[FolderName, ...] = ("projects", "recordings", "logs")


class LookPage(QWidget):
    """Language, theme, size of the text. ``size_chosen``: the knob has been let go."""

    size_chosen = Signal()

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        system = {SYSTEM: tr("Like the computer's")}
        self.language = _choice({**system, **available_languages()}, settings.language)
        named = {name: tr(load_theme(name).title) for name in themes()}
        self.theme = _choice({**system, **named}, settings.theme)
        self.text_size = QSlider(Qt.Orientation.Horizontal)
        self.text_percent = QLabel()
        self._set_up_slider(settings.text_scale)
        form = _form(self)
        form.addRow(tr("Language"), self.language)
        form.addRow(tr("Theme"), self.theme)
        form.addRow(tr("Size of the text"), self._size_row())
        form.addRow("", _hint(tr("The window makes no sounds, and nothing in it moves by itself.")))
        self.text_size.valueChanged.connect(self._show_percent)
        self.text_size.sliderReleased.connect(self.size_chosen)
        self.text_size.actionTriggered.connect(self._on_size_stepped)

    def _set_up_slider(self, scale: float) -> None:
        slider = self.text_size
        slider.setRange(
            round(100 * SMALLEST_TEXT / TEXT_STEP), round(100 * LARGEST_TEXT / TEXT_STEP)
        )
        slider.setPageStep(5)
        slider.setValue(round(100 * scale / TEXT_STEP))
        slider.setAccessibleName(tr("Size of the text"))
        self._show_percent(slider.value())

    def _size_row(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.addWidget(self.text_size, 1)
        row.addWidget(self.text_percent)
        self.text_percent.setMinimumWidth(self.fontMetrics().horizontalAdvance("0000 %"))
        return row

    def _show_percent(self, steps: int) -> None:
        self.text_percent.setText(f"{steps * TEXT_STEP} %")

    def _on_size_stepped(self) -> None:
        """A key or a click beside the knob; while it is dragged, the window waits."""
        if not self.text_size.isSliderDown():
            self.text_size.setValue(self.text_size.sliderPosition())
            self.size_chosen.emit()


class FoldersPage(QWidget):
    """Where projects, recordings and logs are kept."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        self.paths = {name: ElidedLabel() for name in FOLDERS}
        self.reset_buttons: dict[FolderName, QPushButton] = {}
        titles = {
            "projects": tr("Projects"),
            "recordings": tr("Recordings"),
            "logs": tr("Logs of nodes"),
        }
        grid = QGridLayout(self)
        line = self.fontMetrics().height()
        grid.setContentsMargins(line, line, line, line)
        grid.setVerticalSpacing(line // 2)
        grid.setColumnStretch(1, 1)
        for row, name in enumerate(FOLDERS):
            grid.addWidget(QLabel(titles[name]), row, 0)
            grid.addWidget(self.paths[name], row, 1)
            grid.addLayout(self._buttons(name, titles[name]), row, 2)
        words = tr("Another folder for logs is used when the network is started the next time.")
        grid.addWidget(_hint(words), len(FOLDERS), 0, 1, 3)
        grid.setRowStretch(len(FOLDERS) + 1, 1)
        self._refresh()

    def choose(self, name: FolderName, folder: Path | None) -> None:
        """Keep it there from now on; None: where it usually is."""
        self._settings.set_folder(name, folder)
        self._refresh()

    def _buttons(self, name: FolderName, title: str) -> QHBoxLayout:
        row = QHBoxLayout()
        for words, do in (
            (tr("Open"), self._on_open),
            (tr("Change…"), self._on_change),
            (tr("Reset"), self._on_reset),
        ):
            button = QPushButton(words)
            button.setAutoDefault(False)
            button.setAccessibleName(f"{title}: {words}")
            button.clicked.connect(lambda _=False, do=do: do(name))
            row.addWidget(button)
        self.reset_buttons[name] = button
        return row

    def _refresh(self) -> None:
        for name in FOLDERS:
            folder = str(self._settings.folder_for(name))
            self.paths[name].set_words(folder)
            self.reset_buttons[name].setEnabled(self._settings.chosen_folder(name) is not None)

    def _on_open(self, name: FolderName) -> None:
        """Show it in the system's own file window; the nearest folder that is there."""
        folder = self._settings.folder_for(name)
        there = next(one for one in (folder, *folder.parents) if one.is_dir() or not one.name)
        QDesktopServices.openUrl(QUrl.fromLocalFile(str(there)))

    def _on_change(self, name: FolderName) -> None:
        dialog = QFileDialog(self, tr("Choose a folder"), str(self._settings.folder_for(name)))
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.fileSelected.connect(lambda folder: self.choose(name, Path(folder)))
        dialog.open()

    def _on_reset(self, name: FolderName) -> None:
        self.choose(name, None)


class ShowPage(QWidget):
    """How show mode goes, and the PIN with which it is left."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        chosen = settings.show_options
        self.at_once = QCheckBox(tr("Run at once"))
        self.at_once.setChecked(chosen.runs_at_once)
        self.again = QCheckBox(tr("Begin again when the program has ended"))
        self.again.setChecked(chosen.again)
        self.cues = QCheckBox(tr("Show the cue buttons, for an operator"))
        self.cues.setChecked(chosen.has_cues)
        self.restarts = QSpinBox()
        self.restarts.setRange(0, MOST_RESTARTS)
        self.restarts.setValue(chosen.restarts)
        self.pin = QLineEdit()
        self.pin.setEchoMode(QLineEdit.EchoMode.Password)
        self.pin.setPlaceholderText(tr("A new PIN"))
        self.pin_button = QPushButton()
        self.pin_button.setAutoDefault(False)
        pin = QHBoxLayout()
        pin.addWidget(self.pin, 1)
        pin.addWidget(self.pin_button)
        form = _form(self)
        for box in (self.at_once, self.again, self.cues):
            form.addRow(box)
            box.toggled.connect(self._on_chosen)
        form.addRow(tr("After errors in a row, begin again at most"), self.restarts)
        form.addRow(tr("PIN to leave"), pin)
        form.addRow(_hint(tr("To leave a show, hold Esc or its title for two seconds.")))
        self.restarts.valueChanged.connect(self._on_chosen)
        self.pin.textChanged.connect(self._show_pin)
        self.pin_button.clicked.connect(self._on_pin)
        self._show_pin()

    def _on_chosen(self) -> None:
        self._settings.show_options = replace(
            self._settings.show_options,
            runs_at_once=self.at_once.isChecked(),
            again=self.again.isChecked(),
            has_cues=self.cues.isChecked(),
            restarts=self.restarts.value(),
        )

    def _show_pin(self) -> None:
        has_pin, is_new = self._settings.has_pin, bool(self.pin.text())
        self.pin_button.setText(tr("Set the PIN") if is_new or not has_pin else tr("Without PIN"))
        self.pin_button.setEnabled(is_new or has_pin)
        self.pin.setPlaceholderText(tr("There is a PIN") if has_pin else tr("A new PIN"))

    def _on_pin(self) -> None:
        self._settings.set_pin(self.pin.text())
        self.pin.clear()
        self._show_pin()


class NetworkPage(QWidget):
    """Who else may join the network of the studio."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self.original = QCheckBox(tr("Programs of the original NEP may join"))
        self.original.setChecked(settings.lets_original_join)
        form = _form(self)
        form.addRow(self.original)
        words = tr(
            "Programs of this computer only, by its ports 7000 and 50000. It counts when the"
            " network is started the next time."
        )
        form.addRow(_hint(words))
        self.original.toggled.connect(lambda on: setattr(settings, "lets_original_join", on))


def _form(page: QWidget) -> QFormLayout:
    line = page.fontMetrics().height()
    form = QFormLayout(page)
    form.setContentsMargins(line, line, line, line)
    form.setVerticalSpacing(line // 2)
    form.setHorizontalSpacing(line)
    form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
    return form


def _hint(words: str) -> QLabel:
    label = QLabel(words)
    label.setProperty("role", "hint")
    label.setWordWrap(True)
    return label


def _choice(words: dict[str, str], chosen: str) -> QComboBox:
    box = QComboBox()
    for value, word in words.items():
        box.addItem(word, value)
    box.setCurrentIndex(max(0, box.findData(chosen)))
    return box
