"""The settings of a node: those of its manifest by name, and any others."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QWidget,
)

from nep_core.errors import ManifestError, NodeNotFound, ParameterError
from nep_core.places import node_folders
from nep_core.processes.manifest import NodeCatalog, Parameter
from nep_studio.blocks.slots import Setting, kind_of
from nep_studio.ui.labels import plain_tip
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr

from .field_edit import Editing
from .popup import FieldPopup

if TYPE_CHECKING:
    from .editors import FieldEditors

_ANY = kind_of("any")


def parameters_of(node: str) -> dict[str, Parameter]:
    """What a node can be set to, by its manifest; nothing for one that is not known."""
    try:
        return NodeCatalog(node_folders()).find(node).parameters
    except (ManifestError, NodeNotFound):
        return {}


class SettingsPopup(FieldPopup):
    """A row for each setting; what is as it always is is not written into the block."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self._known = parameters_of(self._node())
        self._inputs: dict[str, QWidget] = {}
        self._grid = QGridLayout()
        self._grid.setHorizontalSpacing(self.line // 2)
        self.column.addLayout(self._grid)
        for name in (*self._known, *(n for n in self._settings() if n not in self._known)):
            self._add_row(name)
        self.new_name = QLineEdit(self)
        self.new_name.setPlaceholderText(tr("another setting"))
        self.new_name.setAccessibleName(tr("Name of another setting"))
        self.add = QPushButton(icon("plus", editors.canvas.look.theme), tr("Add"), self)
        self.add.clicked.connect(self._on_add)
        self.column.addLayout(in_row((self.new_name, 1), self.add))

    def first(self) -> QWidget:
        """The first setting has the keyboard."""
        return next(iter(self._inputs.values()), self.new_name)

    def input(self, name: str) -> QWidget:
        """The widget of a setting."""
        return self._inputs[name]

    def focusNextPrevChild(self, forward: bool) -> bool:
        """Tab goes from setting to setting, and behind the last to the next field."""
        order = [*self._inputs.values(), self.new_name, self.add]
        here = self.focusWidget()
        at = order.index(here) if here in order else -1
        at += 1 if forward else -1
        if not 0 <= at < len(order):
            return super().focusNextPrevChild(forward)
        order[at].setFocus(Qt.FocusReason.TabFocusReason)
        return True

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter behind a new name adds it."""
        is_enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if is_enter and (self.add.hasFocus() or self.new_name.text()):
            self._on_add()
        else:
            super().keyPressEvent(event)

    def _node(self) -> str:
        editor = self._editors.canvas.editor
        block = editor.project.blocks[self.edit.block]
        return str(editor.language.definitions[block.type].value(block, "node") or "")

    def _settings(self) -> dict[str, Setting]:
        value = self.edit.value
        return dict(value) if isinstance(value, dict) else {}

    def _add_row(self, name: str) -> None:
        parameter, row = self._known.get(name), self._grid.rowCount()
        label = QLabel(name, self)
        widget = self._widget(name, parameter)
        widget.setAccessibleName(name)
        label.setBuddy(widget)
        if parameter is not None:
            label.setToolTip(plain_tip(parameter.help))
            widget.setToolTip(plain_tip(parameter.help))
            widget.setAccessibleDescription(parameter.help)
        self._grid.addWidget(label, row, 0)
        self._grid.addWidget(widget, row, 1)
        self._inputs[name] = widget

    def _widget(self, name: str, parameter: Parameter | None) -> QWidget:
        value = self._settings().get(name)
        usual = parameter.default if parameter is not None else None
        now = value if value is not None else usual
        if parameter is not None and parameter.type == "boolean":
            box = QCheckBox(self)
            box.setChecked(bool(now))
            box.toggled.connect(lambda on: self._set(name, on))
            return box
        if parameter is not None and parameter.type == "choice":
            return self._combo(name, parameter, str(now))
        line = QLineEdit(_ANY.write(value) if value is not None else "", self)
        line.setPlaceholderText(_ANY.write(usual))
        line.setMinimumWidth(10 * self.line)
        line.textEdited.connect(lambda text: self._on_typed(name, text))
        return line

    def _combo(self, name: str, parameter: Parameter, now: str) -> QComboBox:
        combo = QComboBox(self)
        combo.addItems(parameter.choices)
        combo.setCurrentText(now)
        combo.currentTextChanged.connect(lambda text: self._set(name, text))
        return combo

    def _on_typed(self, name: str, text: str) -> None:
        parameter = self._known.get(name)
        if not text.strip():
            self._change(lambda settings: settings.pop(name, None))
            return
        value = text if parameter is not None and parameter.type in ("text", "file") else None
        self._set(name, value if value is not None else _ANY.read(text))  # type: ignore[arg-type]

    def _set(self, name: str, value: Setting) -> None:
        parameter = self._known.get(name)
        if parameter is not None:
            try:
                value = parameter.read(name, value)
            except ParameterError as error:
                self.reason.tell(error.sentence)
                self.adjustSize()
                return
            if value == parameter.default:
                self._change(lambda settings: settings.pop(name, None))
                return
        self._change(lambda settings: settings.__setitem__(name, value))

    def _change(self, change: Callable[[dict[str, Setting]], object]) -> None:
        settings = self._settings()
        change(settings)
        self.try_set(settings)

    def _on_add(self) -> None:
        name = self.new_name.text().strip()
        if name in self._inputs:
            self._inputs[name].setFocus(Qt.FocusReason.OtherFocusReason)
        elif self.try_set({**self._settings(), name: ""}):
            self.new_name.clear()
            self._add_row(name)
            self.adjustSize()
            self._inputs[name].setFocus(Qt.FocusReason.OtherFocusReason)
