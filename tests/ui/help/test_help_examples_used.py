"""Examples of the help: dragged out onto the canvas, put there by a button, and tried."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.ui.canvas.canvas import Canvas
from tests.ui.help.conftest import LANGUAGE

LEFT = Qt.MouseButton.LeftButton


WAYS = [
    f"{what}_{way}" for what in ("karate", "quiz", "guide") for way in ("rules", "tree", "states")
]
"""The examples of the page Three ways to say it."""


def types(canvas: Canvas) -> list[str]:
    return [block.type for block in canvas.editor.project.blocks.values()]


def test_the_example_is_dragged_out_onto_the_canvas(panel, canvas, qtbot):
    panel.open(
        "block/robot.imitate",
    )
    browser = panel.browser
    browser._go_to("example")
    place = next(
        QPoint(x, y)
        for y in range(0, browser.viewport().height(), 4)
        for x in range(0, browser.viewport().width(), 8)
        if browser.anchorAt(QPoint(x, y)).startswith("drag:")
    )
    viewport = browser.viewport()
    target = viewport.mapFromGlobal(canvas.viewport().mapToGlobal(QPoint(300, 200)))

    qtbot.mousePress(viewport, LEFT, pos=place)
    qtbot.mouseMove(viewport, place + QPoint(30, 30))
    qtbot.mouseMove(viewport, target)
    qtbot.mouseRelease(viewport, LEFT, pos=target)

    assert types(canvas) == ["event.started", "robot.say", "robot.imitate"]
    canvas.editor.history.undo()
    assert types(canvas) == []


def test_a_press_on_the_example_without_a_drag_leaves_the_program_alone(panel, canvas, qtbot):
    panel.open("block/robot.say")
    panel.browser._go_to("example")
    viewport = panel.browser.viewport()

    qtbot.mouseClick(viewport, LEFT, pos=QPoint(60, 60))

    assert types(canvas) == []


def test_a_button_puts_the_example_on_the_page_in_one_step(panel, canvas, qtbot):
    panel.open("block/goal.goal")

    qtbot.mouseClick(panel.example.insert, LEFT)

    assert types(canvas).count("goal.when_goal") == 1
    assert len(canvas.selection.ids) == 2
    rects = canvas.page_layout.index.rects
    stacks = [rects[stack.id] for stack in canvas.editor.project.pages["behaviour"]]
    assert stacks[0].bottom <= stacks[1].y
    canvas.editor.history.undo()
    assert types(canvas) == []


def test_an_example_of_robots_and_nodes_goes_to_their_pages(panel, canvas, qtbot):
    panel.open("block/nodes.launch")

    qtbot.mouseClick(panel.example.insert, LEFT)

    project = canvas.editor.project
    assert [len(project.pages[page]) for page in ("behaviour", "nodes")] == [1, 1]
    assert canvas.page == "nodes"


def test_every_example_can_be_put_on_the_page_and_tried(panel, canvas, qtbot):
    asked: list[Project] = []
    panel.try_requested.connect(asked.append)
    for name in [n for n in panel.book.titles if n.startswith("block/")]:
        panel.open(name)
        canvas.set_editor(Editor(Project(), LANGUAGE))

        assert panel.example.put_on_page(), name
        panel.example.ask_to_try()

        errors = [p for p in check(asked[-1], LANGUAGE) if p.severity == "error"]
        assert errors == [], name
    assert len(asked) >= 159


def test_trying_asks_for_a_project_that_is_called_like_the_page(panel, qtbot):
    panel.open("block/event.gesture")

    with qtbot.waitSignal(panel.try_requested) as asked:
        qtbot.mouseClick(panel.example.try_it, LEFT)

    [project] = asked.args
    assert project.name == panel.book.titles["block/event.gesture"]
    assert {block.type for block in project.blocks.values()} >= {"robots.robot", "nodes.launch"}


def test_only_pages_with_an_example_have_its_buttons(panel):
    panel.open("block/robot.say")
    assert panel.example.isVisible()

    panel.open("howto/words")

    assert not panel.example.isVisible()


def tab_to(panel, address, qtbot):
    """Go from link to link with the keyboard, as far as the one with this address."""
    panel.browser.setFocus()
    for _ in range(100):
        qtbot.keyClick(panel.browser, Qt.Key.Key_Tab)
        if panel.browser.textCursor().charFormat().anchorHref() == address:
            return
    raise AssertionError(f"the keyboard does not come to {address}")


def test_a_page_shows_the_same_behaviours_as_rules_as_a_tree_and_as_states(panel):
    panel.open("howto/three-ways")

    html = panel.browser.page.html
    assert [html.count(f'src="example:{name}"') for name in WAYS] == [1] * len(WAYS)
    assert not panel.example.isVisible()


def test_the_buttons_act_on_the_example_of_the_page_that_was_chosen(panel, canvas, qtbot):
    panel.open("howto/three-ways")

    tab_to(panel, "choose:karate_tree", qtbot)
    qtbot.keyClick(panel.browser, Qt.Key.Key_Return)

    assert panel.example.isVisible()
    assert "Impressive" in panel.example.insert.accessibleDescription()
    qtbot.mouseClick(panel.example.insert, LEFT)
    assert types(canvas)[0] == "tree.tree" and "robot.say" in types(canvas)


def test_each_of_several_examples_of_a_page_is_dragged_out_by_itself(panel, canvas, qtbot):
    panel.open("howto/three-ways")
    browser = panel.browser
    viewport = browser.viewport()
    browser._go_to("part-4")  # “As states”, under the first heading
    place = next(
        QPoint(x, y)
        for y in range(0, viewport.height(), 4)
        for x in range(0, viewport.width(), 8)
        if browser.anchorAt(QPoint(x, y)) == "drag:karate_states"
    )
    target = viewport.mapFromGlobal(canvas.viewport().mapToGlobal(QPoint(300, 200)))

    qtbot.mousePress(viewport, LEFT, pos=place)
    qtbot.mouseMove(viewport, place + QPoint(30, 30))
    qtbot.mouseMove(viewport, target)
    qtbot.mouseRelease(viewport, LEFT, pos=target)

    assert types(canvas).count("state.begins") == 2
