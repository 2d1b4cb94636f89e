"""A list to choose from; a long one has a search box: type to filter, arrows and Enter choose."""

from __future__ import annotations

import time
import unicodedata
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer
from PySide6.QtGui import QIcon, QKeyEvent
from PySide6.QtWidgets import QLineEdit, QListWidget, QListWidgetItem, QWidget

from nep_studio.blocks.checks.deployment import goal_names
from nep_studio.blocks.deployment import can_be_stopped, rules
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.blocks.slots import ARM_STATE, GESTURE_STATE
from nep_studio.blocks.text import sentence
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.words import tr

from .field_edit import Editing
from .popup import FieldPopup, Question

if TYPE_CHECKING:
    from .editors import FieldEditors


# What a field offers to choose from, as data.


@dataclass(frozen=True, slots=True)
class Option:
    """A row of the list: the value it sets, or the ``action`` that it begins."""

    label: str
    value: str = ""
    icon: str = ""
    section: str = ""
    action: str = ""


SHIPPED_STATES = (
    "touched_head",
    "touched_hand",
    "touched_foot",
    "seen_face",
    "heard_word",
    "not_understood",
    "sonar_close",
)
"""Human states that a robot tells of whatever the program is."""


def matching(options: Iterable[Option], typed: str) -> list[Option]:
    """The options that hold what is typed, whatever its case and accents; beginnings first."""
    wanted = plain(typed).split()
    found = [o for o in options if all(w in plain(f"{o.label} {o.value}") for w in wanted)]
    if wanted:
        found.sort(key=lambda option: not plain(option.label).startswith(wanted[0]))
    return found


def plain(text: str) -> str:
    """A text in small letters without accents, and with spaces for underlines."""
    apart = unicodedata.normalize("NFKD", text.casefold())
    bare = "".join(c for c in apart if not unicodedata.combining(c))
    return unicodedata.normalize("NFKC", bare).replace("_", " ")


def _states(project: Project, language: Language) -> list[Option]:
    gestures = language.choices.get("gestures", {})
    known = dict.fromkeys(language.choices.get("states", ()) or SHIPPED_STATES)
    used = {state: None for state in _used_states(project, language) if state not in known}
    found = [
        Option(label, GESTURE_STATE + name, "hand", tr("Gestures"))
        for name, label in gestures.items()
    ]
    found += [
        Option(_words(state), state, "person-standing", tr("How the arm with the watch is held"))
        for state in (f"{ARM_STATE}{name}" for name in language.choices.get("arm_postures", ()))
    ]
    gesture_states = {option.value for option in found}
    found += [Option(_words(s), s, "eye", tr("What the robot notices")) for s in known]
    rest = (s for s in used if s not in gesture_states)
    return found + [Option(_words(s), s, "user", tr("In this project")) for s in rest]


def _messages(project: Project, language: Language) -> list[Option]:
    """The messages that the blocks of a project tell or wait for."""
    used = dict.fromkeys(_used(project, language, "message"))
    return [Option(message, message, "message-square-text") for message in sorted(used)]


def _modes(project: Project, language: Language) -> list[Option]:
    """The states of the program that its blocks name."""
    used = dict.fromkeys(_used(project, language, "mode"))
    return [Option(state, state, "route") for state in sorted(used)]


def _rules(project: Project, language: Language) -> list[Option]:
    """The rules that can be stopped, as their first blocks say."""
    firsts = [chain[0] for chain in rules(project, language)]
    return [
        Option(sentence(project, language, hat), hat, "flag")
        for hat in firsts
        if can_be_stopped(project, language, hat)
    ]


def _words(state: str) -> str:
    return state.replace("_", " ")


def _used_states(project: Project, language: Language) -> Iterator[str]:
    return _used(project, language, "state")


def _used(project: Project, language: Language, kind: str) -> Iterator[str]:
    """What stands in the fields of a kind."""
    for block in project.blocks.values():
        definition = language.definitions.get(block.type)
        if definition is None:
            continue
        for key in (k for k, slot in definition.keys(block.groups) if slot.kind.name == kind):
            value = definition.value(block, key)
            if isinstance(value, str) and value:
                yield value


_MOST_ROWS, _MOST_PICTURES = 11, 9
_PICTURES = {
    "animations": "person-standing",
    "animals": "person-standing",
    "postures": "person-standing",
    "things": "box",
    "placed_things": "box",
}
"""The tables of choices that have small pictures, and what stands where there is none."""

_PICTURE_LINES = 2.4
_DRAWN_AT_ONCE_S = 0.012
"""So long pictures are drawn before what a person does is looked after again."""

FEWEST_TO_SEARCH = 8
"""So many choices have a search box; fewer are seen at a glance."""

_OPTION = Qt.ItemDataRole.UserRole
_MOVES = frozenset({Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown})


class ChoicePopup(FieldPopup):
    """Chooses one of the options; with ``is_free``, what is typed is a value too."""

    is_free = False
    icon_name = ""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.search = QLineEdit(self)
        self.search.setPlaceholderText(tr("Type to search"))
        self.search.setAccessibleName(tr("Search: {what}", what=title))
        self.search.textEdited.connect(self._on_typed)
        self.search.installEventFilter(self)
        self.list = QListWidget(self)
        self.list.setAccessibleName(title)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.installEventFilter(self)
        self.list.setIconSize(QSize(self.line, self.line))
        self.list.itemClicked.connect(self._choose)
        self.list.currentItemChanged.connect(self._on_row)
        self.question: Question | None = None
        editor = editors.canvas.editor
        block = editor.project.blocks[edit.block]
        self._table = editor.language.table_of(edit.slot, block, edit.key)
        self._undrawn: list[QListWidgetItem] = []
        self._drawing = QTimer(self, interval=0)
        self._drawing.timeout.connect(self._draw_some)
        if self._table in _PICTURES:
            side = round(_PICTURE_LINES * self.line)
            self.list.setIconSize(QSize(side, side))
        self.column.addWidget(self.search)
        self.column.addWidget(self.list)
        self.is_searched = self.is_free or len(self.options()) >= FEWEST_TO_SEARCH
        self.search.setVisible(self.is_searched)
        self.fill("")

    def first(self) -> QWidget:
        """The search box has the keyboard, or the list of few choices."""
        return self.search if self.is_searched else self.list

    def options(self) -> list[Option]:
        """What can be chosen."""
        editor = self._editors.canvas.editor
        block = editor.project.blocks[self.edit.block]
        offered = editor.language.choices_of(self.edit.slot, block, self.edit.key)
        sign = _PICTURES.get(self._table, self.icon_name)
        return [Option(label, value, sign) for value, label in offered.items()]

    def more_rows(self) -> list[Option]:
        """Rows at the end that do something else."""
        return []

    def act(self, action: str) -> None:
        """Do what a row at the end says."""

    def fill(self, typed: str) -> None:
        """Show the options that hold what is typed."""
        self._undrawn = []
        self.list.clear()
        section, found = "", matching(self.options(), typed)
        for option in found:
            if option.section != section and not typed:
                section = option.section
                self._add_heading(section)
            self._add(option)
        if not found and not self.is_free:
            self._add_heading(tr("Nothing is called “{typed}”.", typed=typed))
        for option in self.more_rows():
            self._add(option)
        # Point at the value of the field, or at what is found first
        rows = [self.list.item(row) for row in range(self.list.count())]
        choosable = [item for item in rows if item.data(_OPTION) is not None]
        now = [i for i in choosable if i.data(_OPTION).value == self.edit.value]
        is_value = bool(typed) and self.is_free
        if choosable and not is_value:
            self.list.setCurrentItem((now if now and not typed else choosable)[0])
            self.list.scrollToItem(self.list.currentItem())
        self._fit()

    def ask(self, question: Question | None) -> None:
        """Show a question instead of the list, or the list again."""
        old, self.question = self.question, question
        if question is not None:
            self.column.insertWidget(0, question)
            question.show()
        else:
            self.search.setVisible(self.is_searched)
            self.list.show()
        # the keyboard leaves a widget before it is hidden, or Qt would send it to the next field
        (question.first() if question else self.first()).setFocus(Qt.FocusReason.OtherFocusReason)
        self.search.setVisible(question is None and self.is_searched)
        self.list.setVisible(question is None)
        if old is not None:
            old.hide()
            old.deleteLater()
        self.reason.tell(None)
        self.column.activate()
        self.follow()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """The arrows move in the list and Enter chooses, from the search box too."""
        if event.type() == QEvent.Type.KeyPress:
            key = cast(QKeyEvent, event).key()
            if key in _MOVES:
                self._move(cast(QKeyEvent, event))
                return True
            if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self._choose(self.list.currentItem())
                return True
        return super().eventFilter(watched, event)

    def _add(self, option: Option) -> None:
        item = QListWidgetItem(option.label)
        item.setData(_OPTION, option)
        item.setSizeHint(QSize(self._wide(option.label), self._row))
        is_now = not option.action and option.value == self.edit.value
        if is_now and self._table in _PICTURES:
            font = self.list.font()
            font.setBold(True)  # the picture takes the place of the tick
            item.setFont(font)
        name = "check" if is_now and self._table not in _PICTURES else option.icon
        if name:
            item.setIcon(icon(name, self._editors.canvas.look.theme))
        spoken = tr("{label}, chosen now", label=option.label) if is_now else option.label
        item.setData(Qt.ItemDataRole.AccessibleTextRole, spoken)
        self.list.addItem(item)
        if self._table in _PICTURES and not option.action:
            self._undrawn.append(item)
            self._drawing.start()

    def _draw_some(self) -> None:
        """Draw some pictures, those in view first; the list is open meanwhile."""
        end, view = time.perf_counter() + _DRAWN_AT_ONCE_S, self.list.viewport().rect()
        seen = [item for item in self._undrawn if self.list.visualItemRect(item).intersects(view)]
        while self._undrawn and time.perf_counter() < end:
            item = seen.pop(0) if seen else self._undrawn[0]
            self._undrawn.remove(item)
            side = self.list.iconSize().width()
            value = str(item.data(_OPTION).value)
            picture = self._editors.picture_of(self._table, value, self.edit.block, side)
            if picture is not None:
                shown = QIcon(picture)
                shown.addPixmap(picture, QIcon.Mode.Selected)  # Qt would veil it there
                item.setIcon(shown)
        if not self._undrawn:
            self._drawing.stop()

    @property
    def _row(self) -> int:
        """The height of a row."""
        return max(round(1.6 * self.line), self.list.iconSize().height() + 2)

    def _wide(self, words: str) -> int:
        room = self.list.iconSize().width() + 2 * self.line
        return self.list.fontMetrics().horizontalAdvance(words) + room

    def _add_heading(self, words: str) -> None:
        item = QListWidgetItem(words)
        item.setFlags(Qt.ItemFlag.NoItemFlags)
        font = self.list.font()
        font.setBold(True)
        font.setPointSizeF(font.pointSizeF() * 0.9)
        item.setFont(font)
        item.setSizeHint(QSize(self._wide(words), self._row))
        self.list.addItem(item)

    def _fit(self) -> None:
        most = _MOST_PICTURES if self._table in _PICTURES else _MOST_ROWS
        rows = min(max(self.list.count(), 1), most)
        self.list.setFixedHeight(rows * self._row + 2 * self.list.frameWidth() + self.line // 3)
        wide = self.list.sizeHintForColumn(0) + 2 * self.line
        self.list.setMinimumWidth(max(13 * self.line, min(wide, 26 * self.line)))
        self.adjustSize()

    def _move(self, event: QKeyEvent) -> None:
        step = -1 if event.key() in (Qt.Key.Key_Up, Qt.Key.Key_PageUp) else 1
        count = 8 if event.key() in (Qt.Key.Key_PageUp, Qt.Key.Key_PageDown) else 1
        rows = range(self.list.count())
        choosable = [row for row in rows if self.list.item(row).data(_OPTION) is not None]
        if not choosable:
            return
        here = self.list.currentRow()
        if here not in choosable:
            at = 0 if step > 0 else len(choosable) - 1
        else:
            at = choosable.index(here) + step * count
            at = at % len(choosable) if count == 1 else max(0, min(at, len(choosable) - 1))
        self.list.setCurrentRow(choosable[at])

    def _choose(self, item: QListWidgetItem | None) -> None:
        option: Option | None = item.data(_OPTION) if item is not None else None
        if option is None:
            if self.is_free:
                self._editors.close()
        elif option.action:
            self.act(option.action)
        elif self.try_set(option.value):
            self._editors.close()

    def _on_typed(self, typed: str) -> None:
        self.fill(typed)
        if self.is_free and typed:
            self.try_set(self.edit.slot.kind.read(typed))

    def _on_row(self, item: QListWidgetItem | None) -> None:
        if item is not None and self.isVisible():
            self._editors.canvas.news.announced.emit(
                item.data(Qt.ItemDataRole.AccessibleTextRole) or ""
            )


class GesturePopup(ChoicePopup):
    """One of the gestures that a recogniser knows."""

    icon_name = "hand"


class StatePopup(ChoicePopup):
    """A human state: one that is known, or any word that a node will say."""

    is_free = True

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.search.setText(_words(str(edit.value or "")))
        self.search.selectAll()
        self.search.setPlaceholderText(tr("Type a state, or choose one"))

    def options(self) -> list[Option]:
        """The states that are known."""
        editor = self._editors.canvas.editor
        return _states(editor.project, editor.language)


class MessagePopup(ChoicePopup):
    """A message: one that the project has already, or any words."""

    is_free = True

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.search.setText(str(edit.value or ""))
        self.search.selectAll()
        self.search.setPlaceholderText(tr("Type a message, or choose one"))

    def options(self) -> list[Option]:
        """The messages of the project."""
        editor = self._editors.canvas.editor
        return _messages(editor.project, editor.language)


class ModePopup(ChoicePopup):
    """A state of the program: one that it has already, or any words."""

    is_free = True

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.search.setText(str(edit.value or ""))
        self.search.selectAll()
        self.search.setPlaceholderText(tr("Type a state, or choose one"))

    def options(self) -> list[Option]:
        """The states of the program."""
        editor = self._editors.canvas.editor
        return _modes(editor.project, editor.language)


class RulePopup(ChoicePopup):
    """One of the rules of the project."""

    def options(self) -> list[Option]:
        """The rules that can be stopped."""
        editor = self._editors.canvas.editor
        return _rules(editor.project, editor.language)


class GoalPopup(ChoicePopup):
    """One of the goals of the program, or a name that one will have."""

    is_free = True

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        self.search.setText(str(edit.value or ""))
        self.search.selectAll()
        self.search.setPlaceholderText(tr("Type a name, or choose one"))

    def options(self) -> list[Option]:
        """The goals that there are, as the person has named them."""
        editor = self._editors.canvas.editor
        names = goal_names(editor.project, editor.language)
        return [Option(name, name, "target") for name in names]


CHOSEN: dict[str, type[FieldPopup]] = {
    "choice": ChoicePopup,
    "gesture": GesturePopup,
    "message": MessagePopup,
    "mode": ModePopup,
    "rule": RulePopup,
    "goal": GoalPopup,
    "state": StatePopup,
}
"""The editors of this file, by the kind of field."""
