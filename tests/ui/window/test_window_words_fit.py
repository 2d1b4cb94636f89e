"""Nothing in the window is cut off: toolbar, tabs, buttons and labels, in every language."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtWidgets import (
    QAbstractButton,
    QLabel,
    QPushButton,
    QSizePolicy,
    QTabBar,
    QToolBar,
    QToolButton,
    QWidget,
)
from pytestqt.qtbot import QtBot

from faults import verbatim
from nep_studio import paths
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.plugins.nodes.card import NodeCard
from nep_studio.ui.plugins.person.person_box import WordsButton
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.plugins.robots.stage_tools import StageTools
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.help_dialogs import ShortcutsDialog
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.words import PSEUDO, use_language
from tests.ui.window.putting_away import put_away

pytestmark = pytest.mark.long

SIZE = (1280, 800)
TABLES = sorted(path.stem for path in (paths.resources() / "translations").glob("*.toml"))
LANGUAGES = ["en", *TABLES, PSEUDO]


@pytest.fixture(params=LANGUAGES)
def spoken(request: pytest.FixtureRequest, studio: Studio) -> Iterator[str]:
    """Each language in turn."""
    studio.choose_language(request.param)
    yield request.param
    use_language("en")


def shown(window: QWidget, kind: type) -> list:
    return [widget for widget in window.findChildren(kind) if widget.isVisible()]


def cut_buttons(window: QWidget) -> list[str]:
    """Buttons with words that are narrower than they want to be."""
    return [
        f"{button.text()}: {button.width()} of {button.sizeHint().width()}"
        for button in shown(window, QAbstractButton)
        if has_words(button) and button.width() < button.sizeHint().width()
    ]


def has_words(button: QAbstractButton) -> bool:
    if isinstance(button, QToolButton):
        style = button.toolButtonStyle()
        return bool(button.text()) and style != style.ToolButtonIconOnly
    return isinstance(button, QPushButton) and bool(button.text())


def cut_labels(window: QWidget) -> list[str]:
    """Labels that show only a part of their words, without a sign that there is more."""
    return [
        f"{label.text()}: {label.width()} x {label.height()}"
        for label in shown(window, QLabel)
        if label.text() and not label.text().endswith("…") and is_cut(label)
    ]


def is_cut(label: QLabel) -> bool:
    if label.wordWrap():
        return label.height() < label.heightForWidth(label.width())
    if label.sizePolicy().horizontalPolicy() != QSizePolicy.Policy.Ignored:
        return label.width() < label.minimumSizeHint().width()
    words = label.fontMetrics().horizontalAdvance(label.text())
    return words > label.contentsRect().width()


def cut_tabs(window: QWidget) -> list[str]:
    """Tab bars that scroll because their tabs have no room."""
    bars = [bar for bar in shown(window, QTabBar) if bar.count()]
    return [bar.tabText(0) for bar in bars if any(shown(bar, QToolButton)) or is_squeezed(bar)]


def is_squeezed(bar: QTabBar) -> bool:
    metrics = bar.fontMetrics()
    tabs = [number for number in range(bar.count()) if bar.isTabVisible(number)]
    words = (metrics.horizontalAdvance(bar.tabText(number).replace("&", "")) for number in tabs)
    return any(bar.tabRect(n).width() < w for n, w in zip(tabs, words, strict=True))


def hidden_tools(window: MainWindow) -> bool:
    """Whether a part of the toolbar is behind an arrow."""
    bar = window.findChild(QToolBar, "tools")
    extension = bar.findChild(QToolButton, "qt_toolbar_ext_button")
    return extension is not None and extension.isVisible()


def test_the_start_page_and_the_workbench_show_all_their_words(
    spoken: str, window: MainWindow, qtbot: QtBot
) -> None:
    window.resize(*SIZE)

    assert cut_buttons(window) == []
    assert cut_labels(window) == []
    assert not hidden_tools(window)

    open_karate_with_problems(window, qtbot)

    assert cut_buttons(window) == []
    assert cut_labels(window) == []
    assert cut_tabs(window) == []
    assert not hidden_tools(window)


def open_karate_with_problems(window: MainWindow, qtbot: QtBot) -> None:
    workbench = window.workbench
    window.files.open_example(paths.examples() / "karate_greeting.nep")
    qtbot.waitUntil(workbench.canvas.isVisible)
    workbench.panels.show(workbench.code)
    qtbot.waitUntil(lambda: "nao.say" in workbench.code.text.toPlainText())
    workbench.panels.restore(window.fontMetrics().height())
    window.show_problems()
    qtbot.waitUntil(workbench.problems.isVisible)
    qtbot.wait(50)  # until what was shown has found its place


def test_the_canvas_has_the_most_room_of_all(karate) -> None:
    karate.resize(*SIZE)

    karate.workbench.panels.restore(karate.fontMetrics().height())

    assert karate.workbench.canvas.width() >= 0.55 * karate.width()


def test_what_is_cut_off_is_found(qtbot) -> None:
    """The checks themselves: a button and a label that are too narrow."""
    box = QWidget()
    qtbot.addWidget(box)
    button, label = QPushButton("Open a project", box), QLabel("Made from the blocks", box)
    box.show()
    button.resize(40, 30)
    label.resize(30, 30)

    assert len(cut_buttons(box)) == len(cut_labels(box)) == 1


SMALL = (1093, 582)
"""What is left of 1366 x 768 pixels at 125 %."""


def test_on_a_small_screen_the_first_window_and_its_dialogs_fit(
    studio: Studio, qtbot: QtBot
) -> None:
    room = room_around(None).size()

    window = MainWindow(studio)
    qtbot.addWidget(window, before_close_func=put_away)
    shortcuts = ShortcutsDialog(
        [("Redo", "Ctrl+Y, Alt+Shift+Backspace, Ctrl+Shift+Z")] * 60, window
    )

    assert window.width() <= room.width() and window.height() < room.height()
    assert shortcuts.height() <= room.height() * 0.9
    assert shortcuts.table.horizontalScrollBar().maximum() == 0


def test_the_buttons_of_the_person_show_all_words_in_a_small_window(karate, qtbot) -> None:
    karate.resize(*SMALL)
    person = next(p.widget for p in karate.workbench.panels.all if p.name == "HumanPanel")
    for is_shown in (True, False, True):  # closed and opened again
        action = next(p.action for p in karate.workbench.panels.all if p.widget is person)
        action.setChecked(is_shown)
        qtbot.wait(50)

    narrow = [one for one in shown(person, WordsButton) if one.width() < one.sizeHint().width()]

    assert narrow
    assert all(one.height() >= one.heightForWidth(one.width()) for one in narrow)


def test_beside_an_open_person_the_card_of_the_robot_is_seen_whole(karate, qtbot) -> None:
    karate.resize(*SMALL)
    panels = karate.workbench.panels
    panels.restore(karate.fontMetrics().height())
    panels.show(next(one.widget for one in panels.all if one.name == "HumanPanel"))
    robots = karate.findChild(RobotsPanel)

    def is_whole() -> bool:
        [card] = robots.cards.values()
        return robots.area.viewport().height() >= card.height() > 0

    qtbot.waitUntil(is_whole)


def test_words_of_twice_the_size_leave_the_open_person_on_a_small_screen(karate, qtbot) -> None:
    panels = karate.workbench.panels
    panels.show(next(one.widget for one in panels.all if one.name == "HumanPanel"))

    karate.look.set_scale(2.0)

    qtbot.waitUntil(lambda: karate.fontMetrics().height() > 30)
    assert karate.minimumSizeHint().height() < 768
    karate.look.set_scale(1.0)


def test_answers_go_to_the_next_row_where_the_page_is_narrow(karate, qtbot) -> None:
    karate.resize(*SMALL)
    panels = karate.workbench.panels
    panels.show(next(one.widget for one in panels.all if one.name == "HelpPanel"))
    words = "Use the robot on the screen", "Find it and test the connection"

    karate.messages.tell(Message("error", "NAO is away", answers=tuple(map(_answer, words))))

    [card] = karate.message_area.cards
    qtbot.waitUntil(lambda: card.height() >= card.heightForWidth(card.width()))
    assert cut_buttons(card) == []
    assert all(card.rect().contains(button.geometry()) for button in card.buttons)


def _answer(words: str) -> Answer:
    return Answer(words, lambda: None)


def test_a_node_is_told_whole_in_a_window_of_the_usual_size(karate, qtbot) -> None:
    karate.resize(*SIZE)
    panels = karate.workbench.panels
    panels.restore(karate.fontMetrics().height())

    panels.show(next(one.widget for one in panels.all if one.name == "NodesPanel"))

    qtbot.waitUntil(lambda: bool(shown(karate, NodeCard)))
    card = shown(karate, NodeCard)[0]
    qtbot.waitUntil(lambda: card.visibleRegion().boundingRect().height() == card.height())


def test_the_first_example_is_seen_in_its_whole_width(spoken: str, karate, qtbot) -> None:
    karate.resize(*SIZE)
    canvas = karate.workbench.canvas
    karate.workbench.panels.restore(karate.fontMetrics().height())
    qtbot.wait(50)

    bounds = canvas.page_layout.bounds()
    right = canvas.sight.camera.to_view(bounds.x + bounds.width, 0).x()
    assert right <= canvas.viewport().width() or spoken == PSEUDO  # which begins at its right


def test_a_line_of_a_button_never_ends_with_a_bracket_that_opens(karate) -> None:
    button = WordsButton(verbatim("ジェスチャー「空手」をする"), karate.look, "hand")

    lines = button.in_two_lines()

    assert lines == ["ジェスチャー", "「空手」をする"]
    button.deleteLater()


def test_the_tools_of_the_stage_take_one_row(karate, qtbot) -> None:
    karate.resize(*SMALL)
    tools = karate.findChild(StageTools)

    qtbot.waitUntil(lambda: tools.isVisible() and tools.height() < 2 * tools.sound.height())


def test_a_page_that_is_seen_whole_has_no_scroll_bars(karate, qtbot) -> None:
    canvas = karate.workbench.canvas
    canvas.show_page("robots")
    qtbot.wait(50)

    assert not canvas.horizontalScrollBar().isVisible()
    assert not canvas.verticalScrollBar().isVisible()


def test_beside_the_page_of_motions_stands_no_second_robot(karate) -> None:
    panels = karate.workbench.panels

    karate.actions_by_name["make_motion"].trigger()
    assert panels.stage.isHidden()

    panels.rooms.show_canvas()
    assert not panels.stage.isHidden()


def test_cues_that_do_not_fit_beside_each_other_are_below(window, qtbot) -> None:
    window.files.open_example(paths.examples() / "theatre_cues.nep")
    window.resize(*SMALL)
    panels = window.workbench.panels
    cues = next(p.widget for p in panels.all if p.name == "CuePanel")
    panels.show(cues)
    qtbot.wait(100)

    assert cues.page.board.width() <= cues.page.board.parentWidget().width()
