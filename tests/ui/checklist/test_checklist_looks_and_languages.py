"""The checklist, looks and languages: one test for each row of the feature inventory."""

from __future__ import annotations

import sys

import pytest
from PySide6.QtCore import QAbstractAnimation, QPoint, QRect, Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_core.wire.messages import PROGRAM_STATE, ProgramState
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.canvas.painting.overlay import badge_rect
from nep_studio.ui.theme.colours import load_theme, themes
from nep_studio.ui.words import PSEUDO, available_languages
from tests.blocks.block_building import B
from tests.ui.checklist.person import CTRL, LEFT, Key, PaintedPixels, Person, story
from tests.ui.theme.colour_seeing import contrast


def choose_in_view_menu(person: Person, data: str) -> None:
    """Trigger the entry of the View menu that stands for a value."""
    menus = [action.menu() for action in person.window.menus["view"].actions() if action.menu()]
    entries = [entry for menu in menus for entry in menu.actions()]
    action = next(entry for entry in entries if entry.data() == data)
    assert isinstance(action, QAction)
    action.trigger()


def shown(person: Person, block: str) -> str:
    """What is written on a block."""
    placed = person.canvas.page_layout.placed(block)
    assert placed is not None
    return " ".join(piece.text for piece in placed.box.pieces)


def test_warnings_are_shown_on_their_block_with_a_reason_and_a_fix(person: Person) -> None:
    """Warnings on blocks (icon + text), errors mapped to the block: live type check."""
    lost = B("robot.say", {"text": "x", "robot": "Pepe"})  # a robot that nobody has
    person.make([B("event.started"), B("control.if", bodies={"do": [lost]})])
    before = person.file
    checks, canvas = person.window.workbench.checks, person.canvas
    check = person.block("control.if").id

    person.qtbot.waitUntil(lambda: check in canvas.problems.problems)
    placed = canvas.page_layout.placed(check)
    rect = badge_rect(placed, canvas)
    middle = canvas.sight.camera.to_view(rect.center().x(), rect.center().y()).toPoint()
    person.click(middle)
    bubble = person.window.workbench.bubble
    sentence = str(canvas.problems.problems[check].sentence)

    assert bubble is not None and bubble.isVisible()
    assert sentence in bubble.accessibleName() or any(
        sentence in label.text() for label in bubble.findChildren(object) if hasattr(label, "text")
    )
    bubble.close()
    assert any(problem.fix is not None for problem in checks.problems)
    person.key(Key.Key_F8)
    assert person.window.workbench.problems.isVisible()
    assert person.file == before


def test_the_running_blocks_glow_in_small_rectangles(person: Person) -> None:
    """Highlight of the running block: per block, live."""
    person.make(story(), story())
    first, second = person.body()[1], person.body(1)[2]
    stage, runner = person.window.running.stage, person.window.running.runner
    code = generate_program(person.canvas.editor.project, person.canvas.editor.language)
    stage.begin(code)
    plain = [person.seen("glow", person.rect(block)) for block in (first, second)]
    with person.qtbot.waitSignal(person.window.workbench.checks.found):
        person.window.workbench.checks.start()  # it draws badges when it is done
    person.qtbot.waitUntil(lambda: not person.canvas.layers.sharpen.isActive())
    QApplication.processEvents()
    view, painted = person.canvas.viewport(), PaintedPixels()
    view.installEventFilter(painted)
    lines = {block: [code.lines_of(block)[0]] for block in (first, second)}
    told = ProgramState(program="program", event="line", lines=lines)
    runner.arrived.emit([(PROGRAM_STATE, told)])
    person.qtbot.waitUntil(lambda: painted.count > 0)

    assert painted.count < view.width() * view.height() / 8
    assert plain == [0, 0]
    assert all(person.seen("glow", person.rect(block)) > 100 for block in (first, second))


@pytest.mark.parametrize("code", ["es", "it", "ja", "fr", "de"])
def test_the_words_of_window_and_blocks_are_in_the_chosen_language(
    person: Person, code: str
) -> None:
    """Localisation."""
    person.make([B("event.started"), B("control.repeat")])
    loop, english = person.body()[1], shown(person, person.body()[1])
    before = person.file
    menus = [action.text() for action in person.window.menuBar().actions()]
    titles = [entry.text for entry in person.palette.shelf.entries if entry.kind == "heading"]

    choose_in_view_menu(person, code)

    assert code in available_languages()
    assert shown(person, loop) != english
    assert [action.text() for action in person.window.menuBar().actions()] != menus
    now = [entry.text for entry in person.palette.shelf.entries if entry.kind == "heading"]
    assert len(set(now) & set(titles)) < len(titles) / 2
    assert person.file == before
    person.select(person.body()[0])
    person.key(Key.Key_Delete)
    assert person.undo() == before


def test_right_to_left_mirrors_blocks_and_window(person: Person) -> None:
    """Right-to-left: mirror in layout."""
    person.make(story(), [B("control.wait")])
    before = person.file
    person.window.studio.choose_language(PSEUDO)
    person.look_at_corner()
    one, two = person.body()[1:3]
    field = person.piece(one, "text")

    assert person.window.layoutDirection() == Qt.LayoutDirection.RightToLeft
    assert person.palette.mapTo(person.window, QPoint()).x() > person.canvas.x()
    assert person.canvas.page_layout.placed(one).box.is_mirrored
    assert person.rect(one).right() == pytest.approx(person.rect(two).right())
    assert field.x() > person.rect(one).center().x() - person.rect(one).width() / 2
    wait = person.body(1)[0]
    person.put(wait, person.foot(one))
    assert person.body()[2] == wait
    assert person.undo() == before
    place = person.carry(two, person.corner(two) + QPoint(-200, 300))
    person.key(Key.Key_Escape)
    person.release(place)
    assert person.file == before


@pytest.mark.parametrize("name", themes())
def test_themes_light_dark_and_high_contrast(person: Person, name: str) -> None:
    """Themes: dark, high contrast, colour-blind."""
    person.make(story())

    choose_in_view_menu(person, name)

    theme = load_theme(name)
    assert person.canvas.look.theme is theme
    image = person.canvas.viewport().grab(QRect(500, 600, 4, 4)).toImage()
    assert contrast(image.pixelColor(2, 2), theme.colour("text")) >= 4.5
    panel = person.window.palette().window().color()
    assert contrast(panel, person.window.palette().windowText().color()) >= 4.5
    robot = theme.block("robot")
    assert person.canvas.viewport().grab().toImage().pixelColor(person.grip(person.body()[1]))
    assert contrast(robot.fill, robot.text) >= 4.5
    assert person.window.settings.theme == name


def test_larger_text_makes_window_and_blocks_larger(person: Person) -> None:
    """Top ask 15: dark / high contrast / larger."""
    person.make(story())
    high = person.rect(person.body()[1]).height()
    letters, before = person.window.fontMetrics().height(), person.file

    choose_in_view_menu(person, "2")

    assert person.rect(person.body()[1]).height() > 1.7 * high
    assert person.window.fontMetrics().height() > 1.7 * letters
    assert person.file == before


def test_nothing_sounds_and_nothing_moves_by_itself(person: Person) -> None:
    """Sounds off/on, animation off."""
    person.make(story(), [B("control.wait")])

    person.put(person.body(1)[0], person.foot(person.body()[1]))
    person.key(Key.Key_Z, CTRL)

    running = [
        animation
        for animation in person.window.findChildren(QAbstractAnimation)
        if animation.state() == QAbstractAnimation.State.Running
    ]
    assert running == []
    assert "PySide6.QtMultimedia" not in sys.modules
    QTest.mouseClick(person.canvas.viewport(), LEFT, pos=QPoint(600, 600))
