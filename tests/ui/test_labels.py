"""Words that stay on a widget follow the language of the window."""

from collections.abc import Iterator

import pytest
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QLabel, QPushButton, QTabWidget, QWidget

from faults import text_of
from nep_studio.ui.labels import follow_words, labelled, labelled_items, tell_again
from nep_studio.ui.words import tr, use_language


@pytest.fixture(autouse=True)
def _english_again() -> Iterator[None]:
    yield
    use_language("en")


def speak(code: str) -> None:
    use_language(code)
    tell_again()


def test_a_label_is_told_again_in_the_language_that_is_chosen(qtbot):
    button = labelled(QPushButton(), text="Run", tip="Cancel", name="Stop")
    qtbot.addWidget(button)

    speak("de")

    assert [button.text(), button.toolTip(), button.accessibleName()] == [
        tr("Run"),
        tr("Cancel"),
        tr("Stop"),
    ]
    assert button.text() != "Run"


def test_values_are_told_with_their_words(qtbot):
    action = labelled(QAction(), text=text_of("Opening “{name}”…", name="Dance"))

    speak("de")

    assert action.text() == tr("Opening “{name}”…", name="Dance") and "Dance" in action.text()


def test_tabs_are_told_again(qtbot):
    tabs = QTabWidget()
    qtbot.addWidget(tabs)
    for _ in range(2):
        tabs.addTab(QWidget(), "")
    labelled_items(tabs, "Run", "Stop")

    speak("de")

    assert [tabs.tabText(0), tabs.tabText(1)] == [tr("Run"), tr("Stop")] != ["Run", "Stop"]


def test_the_newest_words_are_the_ones_that_follow(qtbot):
    label = labelled(QLabel(), text="Run")
    qtbot.addWidget(label)
    labelled(label, text="Stop")

    speak("de")

    assert label.text() == tr("Stop")


def test_what_depends_on_more_than_the_language_is_made_again(qtbot):
    class Counter(QWidget):
        def __init__(self) -> None:
            super().__init__()
            self.told: list[str] = []
            follow_words(self, self.tell)

        def tell(self) -> None:
            self.told.append(tr("Run"))

    counter = Counter()
    qtbot.addWidget(counter)

    speak("de")

    assert counter.told == ["Run", tr("Run")] and counter.told[0] != counter.told[1]


def test_what_is_gone_is_left_alone(qtbot):
    parent = QWidget()
    label = labelled(QLabel(parent), text="Run")
    qtbot.addWidget(parent)
    label.deleteLater()
    qtbot.waitUntil(lambda: not parent.children())

    speak("de")  # says nothing, raises nothing
