"""What each picture of the documentation shows."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPoint, QPointF, QRect, QRectF, QSize
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.edits.content import RemoveNote, SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.places import InStack
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.plugins.gestures import TrainerPanel
from nep_studio.ui.plugins.show import ShowMode
from nep_studio.ui.plugins.watches.dialog import WatchDialog
from nep_studio.ui.shell.main_window import MainWindow
from tools.image_window import SIZE, SMALL, Stage, around, block_of, drag, part_of, picture, quiet

Scene = Callable[[Stage], QImage]
SCENES: dict[str, Scene] = {}
LARGE_SCENES = ("window-200",)
"""Those for a screen with small pixels, which need a process of their own."""


def scene(name: str) -> Callable[[Scene], Scene]:
    """Give a scene its name, which is that of the file."""

    def keep(made: Scene) -> Scene:
        SCENES[name] = made
        return made

    return keep


def _whole(name: str, **look: object) -> None:
    """A picture of the whole window with the karate example."""

    def shown(stage: Stage) -> QImage:
        with stage.window(**look) as window:  # type: ignore[arg-type]
            return picture(window)

    SCENES[name] = shown


_whole("window-light")
_whole("window-dark", theme="dark")
_whole("window-high-contrast", theme="high_contrast")
_whole("window-japanese", language="ja")
_whole("window-right-to-left", language="qps-rtl")
_whole("window-small", size=SMALL)
_whole("window-200", size=(960, 600))
_whole("start-page", example=None)


def _canvas(window: MainWindow) -> Canvas:
    return window.workbench.canvas


def _rect(canvas: Canvas, block: str) -> QRectF:
    """Where a block is in the view."""
    rect = canvas.sight.view_rect_of(block)
    assert rect is not None
    return rect


def _canvas_part(window: MainWindow, width: int, height: int) -> QRect:
    """A part of the canvas, from its corner on."""
    whole = part_of(window, _canvas(window).viewport())
    return whole.intersected(QRect(whole.topLeft(), QSize(width, height)))


@scene("palette-search")
def palette_search(stage: Stage) -> QImage:
    """The palette after a word was typed into its search box."""
    with stage.window() as window:
        palette = window.workbench.helpers.palette
        palette.search.setText("walk")
        quiet()
        whole = part_of(window, palette)
        return picture(window, whole.intersected(QRect(whole.topLeft(), QSize(900, 420))))


@scene("insert-bar")
def insert_bar(stage: Stage) -> QImage:
    """Blocks inserted by typing what they say."""
    with stage.window() as window:
        canvas = _canvas(window)
        canvas.selection.set([block_of(canvas, "robot.say")])
        window.workbench.helpers.insert_bar.open(None, "say hello twice")
        quiet()
        return picture(window, _canvas_part(window, 560, 620))


@scene("drag-gap")
def drag_gap(stage: Stage) -> QImage:
    """Blocks that are carried, and the gap that opens for them."""
    with stage.window() as window:
        canvas = _canvas(window)
        target = _rect(canvas, block_of(canvas, "robot.do"))
        drag(canvas, block_of(canvas, "robot.play"), target.bottomLeft() + QPointF(16, 12))
        return picture(window, _canvas_part(window, 560, 480))


@scene("replace-preview")
def replace_preview(stage: Stage) -> QImage:
    """A value that is carried over another one, which it would replace."""
    with stage.window() as window:
        canvas = _canvas(window)
        editor, walk = canvas.editor, block_of(canvas, "robot.walk")
        with editor.transaction("a value"):
            value = editor.create("math.arithmetic", editor.new_stack("behaviour", 560, 330))
        canvas.show_block(walk)
        quiet()
        placed = canvas.page_layout.placed(walk)
        assert placed is not None
        piece = next(piece for piece in placed.box.pieces if piece.key == "forward")
        corner = canvas.sight.camera.to_view(placed.x + piece.x, placed.y + piece.y)
        drag(canvas, value, corner + QPointF(6, 8))
        rect = _rect(canvas, walk)
        place = canvas.viewport().mapTo(window, rect.topLeft().toPoint())
        shown = QRect(place - QPoint(20, 120), QSize(560, 240))
        return picture(window, shown.intersected(part_of(window, canvas.viewport())))


def _field(name: str, kind: str, key: str, size: tuple[int, int], typed: str = "") -> None:
    """A picture of a field that is edited."""

    def shown(stage: Stage) -> QImage:
        with stage.window() as window:
            canvas = _canvas(window)
            block = _made(canvas, kind)
            canvas.fields.open(block, key)
            search = getattr(canvas.fields.widget, "search", None)
            if search is not None and typed:
                search.setText(typed)
                search.textEdited.emit(typed)
            quiet()
            return picture(window, around(canvas, block, size))

    SCENES[name] = shown


def _made(canvas: Canvas, kind: str) -> str:
    """The block of a type; one is made when the example has none."""
    editor = canvas.editor
    if not any(block.type == kind for block in editor.project.blocks.values()):
        with editor.transaction("a block"):
            editor.create(kind, editor.new_stack("behaviour", 40, 180))
        quiet()
    return block_of(canvas, kind)


_field("field-choice", "robot.play", "animation", (520, 400), "a")
_field("field-colour", "robot.leds", "colour", (480, 280))
_field("field-angle", "robot_moves.move_joint", "degrees", (640, 280))


@scene("find-bar")
def find_bar(stage: Stage) -> QImage:
    """What was found in the program."""
    with stage.window() as window:
        bar = window.workbench.helpers.find_bar
        bar.open("says")
        bar.step(1)
        quiet()
        whole = part_of(window, bar, _canvas(window))
        return picture(window, whole.intersected(QRect(whole.topLeft(), QSize(620, 420))))


@scene("context-menu")
def context_menu(stage: Stage) -> QImage:
    """What can be done with a block."""
    with stage.window() as window:
        canvas = _canvas(window)
        rect = _rect(canvas, block_of(canvas, "control.together"))
        canvas.pointing.request_menu((rect.topLeft() + QPointF(40, 16)).toPoint())
        quiet()
        assert canvas.menu is not None
        return picture(window, part_of(window, canvas.menu, margin=60))


def _page(name: str, page: str) -> None:
    def shown(stage: Stage) -> QImage:
        with stage.window() as window:
            _canvas(window).show_page(page)
            quiet()
            return picture(window)

    SCENES[name] = shown


_page("page-robots", "robots")
_page("page-nodes", "nodes")


@scene("code-edit")
def code_edit(stage: Stage) -> QImage:
    """The Python of the blocks while it is changed."""
    with stage.window() as window:
        code = window.workbench.code
        window.workbench.panels.show(code)
        quiet()
        code.begin_editing()
        quiet()
        return picture(window, part_of(window, window.workbench.panels.areas["right"]))


@scene("problem")
def problem(stage: Stage) -> QImage:
    """Something that is not right yet: the badge, what to try, and the list of problems."""
    with stage.window() as window:
        canvas = _canvas(window)
        for stack in list(canvas.editor.project.pages["robots"]):
            canvas.editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
        window.show_problems()
        quiet()
        first = next(one.block for one in window.workbench.checks.problems if one.block)
        window.workbench.open_bubble(first)
        quiet()
        return picture(window)


@scene("outline")
def outline(stage: Stage) -> QImage:
    """The same program as a tree."""
    with stage.window() as window:
        canvas = _canvas(window)
        window.workbench.panels.show(window.workbench.outline)
        canvas.selection.set([block_of(canvas, "control.together")])
        quiet()
        return picture(window, part_of(window, window.workbench.panels.areas["right"]))


def _panel(window: MainWindow, name: str) -> QWidget:
    """Show a panel by its name in the settings."""
    panel = next(one for one in window.workbench.panels.all if one.name == name)
    window.workbench.panels.show(panel.widget)
    return panel.widget


@scene("help")
def help_page(stage: Stage) -> QImage:
    """The page of a block, with its example."""
    with stage.window() as window:
        window.host.ask("help.open", "block/robot.say")
        quiet()
        quiet()
        return picture(window)


@scene("diagram")
def diagram(stage: Stage) -> QImage:
    """States as blocks, and drawn beside them."""
    with stage.window(example="reception") as window:
        _panel(window, "DiagramPanel")
        quiet()
        return picture(window)


@scene("robots-and-nodes")
def robots_and_nodes(stage: Stage) -> QImage:
    """What the karate example needs, before it runs."""
    with stage.window() as window:
        _panel(window, "RobotsPanel")
        _panel(window, "NodesPanel")
        quiet()
        return picture(window)


@scene("cues")
def cues(stage: Stage) -> QImage:
    """A button for each thing that may happen in the theatre piece."""
    with stage.window(example="theatre_cues") as window:
        _panel(window, "CuePanel")
        quiet()
        return picture(window)


@scene("commands")
def commands(stage: Stage) -> QImage:
    """All that can be done, found by a few letters."""
    with stage.window() as window:
        window.actions_by_name["palette"].trigger()
        quiet()
        return picture(window)


@scene("gestures")
def gestures(stage: Stage) -> QImage:
    """Three gestures that were taught, with their takes."""
    with stage.window(example="own_gestures") as window:
        panel = window.findChild(TrainerPanel)
        assert panel is not None
        window.workbench.panels.show(panel)
        quiet()
        return picture(window)


@scene("connect-watch")
def connect_watch(stage: Stage) -> QImage:
    """What somebody may have to send movements with."""
    with stage.window() as window:
        window.actions_by_name["connect_watch"].trigger()
        quiet()
        dialog = window.findChild(WatchDialog)
        assert dialog is not None
        return dialog.grab().toImage()


RULE, SAYS = "robot_events.touched", "robot.say"


def _make_rule(window: MainWindow) -> None:
    """Let the page hold nothing but a rule of two blocks."""
    editor = window.workbench.canvas.editor
    project = editor.project
    for stack in list(project.pages["behaviour"]):
        editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    for note in list(project.notes):
        editor.apply(RemoveNote(note))
    place = editor.new_stack("behaviour", 60, 60)
    with editor.transaction("a rule"):
        editor.create(RULE, place)
        says = editor.create(SAYS, InStack(place.stack, 1))
        editor.apply(SetField(says, "text", "That tickles."))


@scene("first-rule")
def first_rule(stage: Stage) -> QImage:
    """A rule: when the head is touched, the robot says something."""
    with stage.window() as window:
        canvas = window.workbench.canvas
        _make_rule(window)
        canvas.show_block(block_of(canvas, SAYS))
        quiet()
        whole = part_of(window, canvas.viewport())
        return picture(window, whole.intersected(QRect(whole.topLeft(), QSize(460, 200))))


@scene("show-mode")
def show_mode(stage: Stage) -> QImage:
    """What the public sees."""
    with stage.window(example="museum_coach") as window:
        mode = window.findChild(ShowMode)
        assert mode is not None
        show = mode.begin()
        show.showNormal()
        show.resize(*SIZE)
        quiet(1500)
        shown = show.grab().toImage()
        show.left.emit()
        return shown
