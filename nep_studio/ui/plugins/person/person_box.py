"""A person who comes before a robot, shows a name and a look, comes closer and steps back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from PySide6.QtCore import (
    QElapsedTimer,
    QEvent,
    QSignalBlocker,
    QSize,
    Qt,
    QTextBoundaryFinder,
    QTimer,
)
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QSlider,
    QStyle,
    QStyleOptionButton,
    QStylePainter,
    QToolButton,
    QWidget,
)

from faults import Words, verbatim
from nep_core.wire.states import plain
from nep_studio.blocks.language import Language
from nep_studio.project.surroundings import FIRST_NAMES, LONGEST_NAME
from nep_studio.project.triggers import Occurrence
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.theme.icons import icon, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import FlowLayout, in_column, in_row
from nep_studio.ui.words import tr

from .stimuli import DISTANCES_M, ICONS, Stimuli, words_of

NEAREST_CM, FARTHEST_CM = 30, 350
CLOSE_M, MIDDLE_M = 1.0, 2.0


class PersonBox(QWidget):
    """Somebody who is there or not; the person stands in the scene of the robots too."""

    def __init__(self, stimuli: Stimuli, language: Callable[[], Language], look: Look) -> None:
        super().__init__()
        self._stimuli, self._language = stimuli, language
        self.is_there = labelled(QCheckBox(), text="Somebody is there")
        self.name = QComboBox(editable=True, insertPolicy=QComboBox.InsertPolicy.NoInsert)
        line_edit = self.name.lineEdit() or QLineEdit()
        labelled(line_edit, placeholder="anybody")
        line_edit.setMaxLength(LONGEST_NAME)
        self.name.setMinimumContentsLength(6)
        labelled(self.name, name="Whose face it is")
        self.way = QSlider(Qt.Orientation.Horizontal)
        self.way.setRange(NEAREST_CM, FARTHEST_CM)
        self.way.setPageStep(50)
        self.way.setSingleStep(10)
        labelled(self.way, name="How far the person is")
        self.way_words = QLabel()
        self.before = WordsButton("Step before its eyes", look, "eye")
        self.looks = [
            OccurrenceButton(Occurrence("emotion", value), look, stimuli.begin, stimuli.end)
            for value in language().choices.get("emotions", {})
        ]
        self._lay_out()
        self.set_names([])
        self.is_there.toggled.connect(self._on_toggled)
        self.name.editTextChanged.connect(self._on_renamed)
        self.way.valueChanged.connect(self._on_moved)
        self.before.clicked.connect(self._come)
        stimuli.visitors.changed.connect(self.refresh)
        follow_words(self, self._say)

    def _lay_out(self) -> None:
        named = in_row(labelled(QLabel(), text="Face of"), (self.name, 1))
        far = in_row((self.way, 1), self.way_words)
        before = self.before, 0, Qt.AlignmentFlag.AlignLeading
        label = labelled(QLabel(), text="The person looks")
        label.setProperty("role", "hint")
        looks = Buttons(self.looks)
        in_column(self.is_there, named, far, before, label, looks, of=self, margins=0)

    def set_names(self, names: list[str]) -> None:
        """Offer these names first: those that the program knows."""
        offered = list(dict.fromkeys([*names, *FIRST_NAMES]))
        if offered == [self.name.itemText(row) for row in range(1, self.name.count())]:
            return
        text = self.name.currentText()
        with QSignalBlocker(self.name):
            self.name.clear()
            self.name.addItem("")
            self.name.addItems(offered)
            self.name.setEditText(text)

    def _say(self) -> None:
        call(self.looks, self._language().choices.get("emotions", {}))
        self.refresh()

    def refresh(self) -> None:
        """Show who is there, and how far away."""
        visitors = self._stimuli.visitors
        person = visitors.find("face")
        with QSignalBlocker(self.is_there), QSignalBlocker(self.way), QSignalBlocker(self.name):
            self.is_there.setChecked(person is not None)
            if person is not None:
                self.way.setValue(round(100 * visitors.way_m("face", self._stimuli.robot)))
                if plain(person.name) != plain(self.name.currentText()):
                    self.name.setEditText(person.name)
        for widget in (self.way, self.way_words, self.before):
            widget.setEnabled(person is not None)
        way_m = self.way.value() / 100
        which = "close" if way_m < CLOSE_M else "middle" if way_m < MIDDLE_M else "far"
        label = self._language().choices.get("distances", dict.fromkeys(DISTANCES_M, ""))[which]
        self.way_words.setText(tr("{m} m: {distance}", m=f"{way_m:.1f}", distance=label))

    def _come(self) -> None:
        name = self.name.currentText().strip()
        self._stimuli.visitors.come("face", self._stimuli.robot, name)

    def _on_toggled(self, is_there: bool) -> None:
        if is_there:
            self._come()
        else:
            self._stimuli.visitors.go("face")

    def _on_renamed(self, name: str) -> None:
        self._stimuli.visitors.rename("face", name)

    def _on_moved(self, way_cm: int) -> None:
        self._stimuli.visitors.stand("face", self._stimuli.robot, way_cm / 100)


# The buttons of the simulated human, which are pressed, held, or put on and off.

LASTS_MS = 500
"""A touch lasts at least so long, however short the click is."""
FEWEST_LETTERS = 6
KEPT = ("face", "ball", "mark")


class WordsButton(QPushButton):
    """A button whose words take two lines where there is no room for all of them in one."""

    def __init__(self, words: Words, look: Look, icon_name: str) -> None:
        super().__init__()
        self._look, self._icon_name = look, icon_name
        self._said, self.words = words, ""
        policy = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)
        follow_words(self, self._say)
        look.theme_changed.connect(self._dress)
        self._dress()

    def set_words(self, words: Words) -> None:
        """Show these words."""
        self._said = words
        self._say()

    def _say(self) -> None:
        self.words = tr(self._said)
        self.setText(self.words.replace("&", "&&"))
        self.setAccessibleName(self.words)
        self.setToolTip(plain_tip(self.words))

    def minimumSizeHint(self) -> QSize:
        """A few letters at least."""
        usual, letter = self.sizeHint(), self.fontMetrics().averageCharWidth()
        spare = self.fontMetrics().horizontalAdvance(self.words) - letter * FEWEST_LETTERS
        return QSize(usual.width() - max(spare, 0), usual.height())

    def heightForWidth(self, width: int) -> int:
        """Room for a second line, where one is needed."""
        usual = self.sizeHint()
        return usual.height() + (self.fontMetrics().lineSpacing() if width < usual.width() else 0)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint as many of the words as there is room for."""
        option = QStyleOptionButton()
        self.initStyleOption(option)
        lacking = max(self.sizeHint().width() - self.width(), 0)
        lines = self.in_two_lines() if lacking else [self.words]
        metrics, elide = self.fontMetrics(), Qt.TextElideMode.ElideRight
        room = metrics.horizontalAdvance(self.words) + 1 - lacking
        shown = "\n".join(metrics.elidedText(line, elide, room) for line in lines)
        option.text = shown.replace("&", "&&")
        QStylePainter(self).drawControl(QStyle.ControlElement.CE_PushButton, option)

    def in_two_lines(self) -> list[str]:
        """The words, broken where both lines are shortest; in the middle where none may end."""
        words, measured = self.words, self.fontMetrics().horizontalAdvance
        finder, ends = QTextBoundaryFinder(QTextBoundaryFinder.BoundaryType.Line, words), []
        while 0 < (end := finder.toNextBoundary()) < len(words):
            ends.append(end)
        ends = ends or [(len(words) + 1) // 2]
        broken = [[words[:end].rstrip(), words[end:].lstrip()] for end in ends]
        return min(broken, key=lambda lines: max(measured(line) for line in lines))

    def _dress(self) -> None:
        self.setIcon(icon(self._icon_name, self._look.theme))
        self.setIconSize(icon_room(self.fontMetrics().height()))


class OccurrenceButton(WordsButton):
    """Lets something happen: while it is held, until it is pressed again, or once."""

    def __init__(
        self,
        occurrence: Occurrence,
        look: Look,
        begin: Callable[[Occurrence], bool],
        end: Callable[[Occurrence], None],
    ) -> None:
        super().__init__(verbatim(words_of(occurrence)), look, ICONS[occurrence.kind])
        self.occurrence, self._begin, self._end = occurrence, begin, end
        self._letting_go = QTimer(self, singleShot=True, interval=LASTS_MS)
        self._letting_go.timeout.connect(self.let_go)
        self.is_held = False
        self._since = QElapsedTimer()
        if occurrence.kind == "touch":
            self.pressed.connect(self._on_pressed)
            self.released.connect(self._on_released)
        elif occurrence.kind in KEPT:
            self.setCheckable(True)
            self.clicked.connect(self._on_switched)
        else:
            self.clicked.connect(lambda: self._begin(self.occurrence))

    def call(self, words: str) -> None:
        """Call what happens by its words in the language that is used now."""
        self.occurrence = replace(self.occurrence, words=words)
        self.set_words(verbatim(words[:1].upper() + words[1:]))

    def let_go(self) -> None:
        """End a touch."""
        if self.is_held:
            self.is_held = False
            self._end(self.occurrence)

    def _on_pressed(self) -> None:
        self._letting_go.stop()
        self.let_go()
        self._since.start()
        self.is_held = self._begin(self.occurrence)

    def _on_released(self) -> None:
        """A quick click is felt as well as a long one."""
        self._letting_go.start(max(LASTS_MS - self._since.elapsed(), 0))

    def _on_switched(self, is_on: bool) -> None:
        if not is_on:
            self._end(self.occurrence)
        elif not self._begin(self.occurrence):
            self.setChecked(False)


def call(buttons: Iterable[OccurrenceButton], names: Mapping[str, str]) -> None:
    """Call buttons as the choices that they stand for are called now."""
    for button in buttons:
        button.call(names.get(button.occurrence.value, button.occurrence.value))


class Buttons(QWidget):
    """Buttons, and fields, in as many rows as they need; others may take their place."""

    def __init__(self, widgets: Iterable[QWidget] = ()) -> None:
        super().__init__()
        self._flow = FlowLayout(self, self.fontMetrics().height() // 3, widgets)

    def replace(self, old: Iterable[OccurrenceButton], new: Iterable[OccurrenceButton]) -> None:
        """Throw buttons away, which are let go, and show others."""
        for button in old:
            button.let_go()
            self._flow.removeWidget(button)
            button.hide()
            button.deleteLater()
        for button in new:
            self._flow.addWidget(button)
            button.show()  # now: Qt would show it later, and not make room for it then


# A part of a panel with a heading, which can be folded away.


class Section(QWidget):
    """A heading that folds, and a box below it."""

    def __init__(self, title: Words, held: QWidget, look: Look, *, is_open: bool = True) -> None:
        super().__init__()
        self._look, self.is_open = look, is_open
        self.heading = labelled(QToolButton(), text=title)
        self.heading.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.heading.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.body = QWidget()
        line = self.fontMetrics().height()
        in_column(held, of=self.body, margins=(line // 2, 0, 0, line // 2), spacing=line // 3)
        in_column(self.heading, self.body, of=self, margins=0, spacing=line // 6)
        self.heading.clicked.connect(lambda: self.open(not self.is_open))
        look.theme_changed.connect(self._dress)
        self.open(is_open)

    def open(self, is_open: bool) -> None:
        """Show or fold away what is in it."""
        self.is_open = is_open
        self.body.setVisible(is_open)
        labelled(self.heading, description="open" if is_open else "folded")
        self._dress()

    def changeEvent(self, event: QEvent) -> None:
        """A heading that is folded points where one reads on."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.LayoutDirectionChange:
            self._dress()

    def _dress(self) -> None:
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        folded = "chevron-left" if is_mirrored else "chevron-right"
        name = "chevron-down" if self.is_open else folded
        font = self.font()
        font.setBold(True)
        self.heading.setFont(font)
        self.heading.setIcon(icon(name, self._look.theme))
        self.heading.setIconSize(icon_room(self.fontMetrics().height()))
