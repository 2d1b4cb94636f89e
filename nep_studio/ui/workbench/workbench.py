"""The workbench: the canvas with its pages, the code, the problems, all of one project."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QRect, QSignalBlocker
from PySide6.QtGui import QFont, QFontInfo, QPixmap
from PySide6.QtWidgets import QFrame, QWidget

from faults import Words
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.fixes import apply_fix
from nep_studio.blocks.program import Project
from nep_studio.settings import MINIMAP, Settings
from nep_studio.ui.canvas.accessibility import make_accessible
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.painting.overlay import badge_rect
from nep_studio.ui.documents import Document
from nep_studio.ui.messages import Answer, Messages, announce
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.look import text_font
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import is_right_to_left, tr

from .code import CodePane
from .find_bar import FindBar
from .help_card import BlockOpening
from .insert_bar import InsertBar
from .live_checks import LiveChecks
from .minimap import MARGIN, EmptyHint, Minimap
from .outline import Outline
from .pages_bar import PagesBar, page_title
from .palette.palette import Palette
from .problems import ProblemBubble, ProblemsPanel
from .side_panels import AreaName, Panel, Panels, Rooms
from .trash import TrashButton

# What helps on the canvas: finding, inserting by typing, the minimap, the trash.


class CanvasHelpers(QObject):
    """The helpers of one canvas; they follow what it shows when they are refreshed."""

    def __init__(self, canvas: Canvas, settings: Settings) -> None:
        super().__init__(canvas)
        self._settings = settings
        self.canvas = canvas
        canvas.following.is_on = settings.follows_running
        canvas.fields.picture_of = self._picture_of
        self.palette = Palette(canvas, settings)
        self.find_bar = FindBar(canvas)
        self.opening = BlockOpening(canvas, self.find_bar)
        self.insert_bar = InsertBar(canvas, settings)
        self.minimap = Minimap(canvas)
        self.trash = TrashButton(canvas)
        self.empty_hint = EmptyHint(canvas)
        self.find_bar.hide()
        self._stack_corner()
        self.minimap.setVisible(settings.is_minimap_shown)

    def show_minimap(self, is_shown: bool) -> None:
        """Show or hide the minimap."""
        self._settings.set_shown(MINIMAP, is_shown)
        self.minimap.setVisible(is_shown)
        self.minimap.refresh()

    def follow_running(self, is_on: bool) -> None:
        """Let the canvas follow the block that runs, or not."""
        self._settings.follows_running = is_on
        self.canvas.following.is_on = is_on

    def refresh(self) -> None:
        """Take the theme and the project that the canvas has now."""
        helpers = (self.palette, self.find_bar, self.insert_bar, self.trash, self.empty_hint)
        for helper in helpers:
            helper.refresh()
        self._stack_corner()

    def _picture_of(self, table: str, value: str, block: str, side: int) -> QPixmap | None:
        """A small picture of what can be chosen in a field, as the block's robot does it."""
        # Bodies are read when somebody first chooses one, not when the window comes
        from nep_studio.ui.robot_view.small_pictures import small_picture

        editor, theme = self.canvas.editor, self.canvas.look.theme.name
        changed = editor.project.blocks.get(block)  # it may have been deleted meanwhile
        asked = editor.language.robot_of(changed) if changed is not None else ""
        entries = robot_entries(editor.project, editor.language)
        models = [one.model for one in entries if one.name == asked] or [e.model for e in entries]
        ratio = self.canvas.devicePixelRatioF()
        model = models[0] if models else ""
        return small_picture(table, value, model=model, theme=theme, side=side, ratio=ratio)

    def _stack_corner(self) -> None:
        """The minimap is above the trash."""
        self.minimap.below = self.trash.height() + MARGIN
        self.minimap.refresh()


BLOCK_FONT_PIXELS = 14
LEAST_LINES = 50
"""In a window that is narrower, in lines of text, not all panels have room at first."""

NARROW_PALETTE = "NarrowPalette"


class Workbench(QWidget):
    """Where a project is worked on."""

    def __init__(self, studio: Studio, messages: Messages, parent: QWidget) -> None:
        super().__init__(parent)
        self._studio, self._messages = studio, messages
        editor = Editor(Project(), studio.language)
        self.canvas = Canvas(
            editor, studio.look.theme, font=block_font(studio), is_mirrored=is_right_to_left()
        )
        make_accessible(self.canvas)
        self.code = CodePane(editor, studio.look, self.canvas.selection)
        self.outline = Outline(self.canvas)
        self.problems = ProblemsPanel(studio.look)
        self.checks = LiveChecks(self.canvas.selection, self)
        self.helpers = CanvasHelpers(self.canvas, studio.settings)
        self.bubble: ProblemBubble | None = None
        self._run_problem: Diagnostic | None = None
        self._usual_scale = usual_scale(studio)
        middle, below = QFrame(), QWidget()
        in_column(self.helpers.find_bar, (self.canvas, 1), of=below, margins=0, spacing=0)
        self.rooms = Rooms(below)
        self.pages_bar = PagesBar(editor, studio.look, self.canvas.attempt, self.rooms)
        in_column(self.pages_bar, (self.rooms, 1), of=middle, margins=0, spacing=0)
        self.panels = Panels(middle, self.rooms, studio.look, studio.settings, self)
        self.add_side_panel(self.helpers.palette, "Blocks", "blocks", "left", is_shown=True)
        self.add_side_panel(self.code, "Python", "code", "right")
        self.add_side_panel(self.outline, "Outline", "list-tree", "right")
        self.add_side_panel(self.problems, "Problems", "circle-check", "bottom")
        self._connect()

    def _connect(self) -> None:
        canvas = self.canvas
        self.pages_bar.page_chosen.connect(canvas.show_page)
        self.pages_bar.tree_begun.connect(lambda: self.helpers.palette.offer("tree"))
        canvas.news.page_asked.connect(self.rooms.show_canvas)
        canvas.news.page_changed.connect(self.pages_bar.show_page)
        canvas.news.page_changed.connect(self.code.show_page)
        canvas.news.refused.connect(self._messages.refuse)
        canvas.news.announced.connect(lambda words: announce(canvas, words))
        canvas.news.problem_opened.connect(self.open_bubble)
        canvas.news.layout_changed.connect(self._messages.clear_passing)
        self.code.block_asked.connect(self.show_block)
        self.checks.found.connect(self._show_problems)
        self.problems.opened.connect(self._on_problem_opened)
        self.problems.fix_asked.connect(self.fix)
        self._studio.look.theme_changed.connect(self._on_theme_changed)
        self._studio.words_changed.connect(self._on_words_changed)
        self.helpers.palette.narrowed.connect(self._on_palette_narrowed)
        self.helpers.palette.room_asked.connect(self._give_palette_room)

    def add_side_panel(
        self,
        widget: QWidget,
        title: Words,
        icon_name: str,
        area: AreaName,
        *,
        is_shown: bool = False,
    ) -> Panel:
        """Add a panel beside the canvas."""
        return self.panels.add(widget, title, icon_name, area, is_shown=is_shown)

    def show_document(self, document: Document | None) -> None:
        """Work on another project; on none, the canvas is empty."""
        self._run_problem = None
        editor = Editor(Project(), self._studio.language) if document is None else document.editor
        self.canvas.set_editor(editor)
        self.pages_bar.set_editor(editor)
        self.code.set_editor(editor)
        self.rooms.show_canvas()
        self.outline.refresh()
        self.helpers.refresh()
        # Look at the corner of the page where reading begins, at the usual size
        self.zoom_usual()
        self.canvas.sight.show_beginning()
        self.checks.follow(document)

    def restore(self, line: int) -> None:
        """Lay the panels out as the person left them; ``line`` is a line of text.

        A narrow window that nobody has arranged yet leaves the room to the page.
        """
        palette, is_small = self.helpers.palette, self.window().width() < LEAST_LINES * line
        with QSignalBlocker(palette):  # this is not the person's choice
            palette.set_narrow(self._studio.settings.is_shown(NARROW_PALETTE, default=is_small))
        self.panels.restore(line)
        if palette.is_narrow:
            self._give_palette_room()

    def reset(self, line: int) -> None:
        """Lay the panels out as at the first start, when the settings have forgotten them."""
        self.panels.show_usual()
        self.restore(line)

    def retire(self) -> None:
        """Let go of the project: the window is closed."""
        with QSignalBlocker(self.checks):  # what is not checked any more is not without problems
            self.show_document(None)
        self.checks.cancel()

    def zoom_usual(self) -> None:
        """Show the blocks with words as large as those of the window."""
        self.canvas.sight.zoom(usual_scale(self._studio))

    # Blocks and problems

    def show_block(self, block: str) -> None:
        """Show a block and select it."""
        self.canvas.show_block(block)
        if block in self.canvas.editor.project.blocks:
            self.canvas.selection.set([block])

    def leave_free(self, pixels: int) -> None:
        """So much of the foot of the canvas is covered: what is shown there goes above it."""
        self.canvas.sight.covered = pixels

    def uncover(self) -> None:
        """Scroll the block that is meant above what lies over the foot of the canvas."""
        canvas, block = self.canvas, self.canvas.selection.cursor
        if self.rooms.shown is not None:
            return  # what is shown of the canvas would take the place of the room
        rect = canvas.sight.view_rect_of(block)
        if rect is not None and rect.intersects(canvas.viewport().rect()):
            canvas.show_block(block)

    def fix(self, problem: Diagnostic) -> None:
        """Put a problem right as far as the program can, and say what it did."""
        label = problem.fix.label if problem.fix is not None else ""
        self.change(lambda: apply_fix(self.canvas.editor, problem), label)

    def change(self, change: Callable[[], str], what: Words) -> None:
        """Change the program in one step, and say ``what`` it did; ``change`` gives the block."""
        try:
            block = change()
        except EditRefused as refusal:
            self._messages.refuse(refusal.sentence, refusal.checklist)
            return
        project = self.canvas.editor.project
        page = project.page_of(block)
        if page == self.canvas.page:
            title = tr("Done: {what}", what=tr(what))
        else:
            title = tr(
                "Done on the page {page}: {what}", page=page_title(project, page), what=tr(what)
            )
        self.show_change(block, title)
        self.checks.start()

    def show_change(self, block: str, title: str) -> None:
        """Say what the last step did to a block, with Undo; no other page is shown for it."""
        is_seen = self.rooms.shown is None
        if is_seen and self.canvas.editor.project.page_of(block) == self.canvas.page:
            self.show_block(block)
        history = self.canvas.editor.history
        step = history.position

        def undo() -> None:
            if history.position == step:
                history.undo()

        self._messages.confirm(title, Answer(tr("Undo"), undo))

    def show_run_problem(self, problem: Diagnostic | None) -> None:
        """Show at its block why the program stopped, until it is run again or changed there."""
        if problem is not self._run_problem:
            self._run_problem = problem
            self._show_problems()

    def open_bubble(self, block: str) -> None:
        """Show what is not right at a block, beside its badge."""
        there = [problem for problem in self.problems.shown if problem.block == block]
        placed = self.canvas.page_layout.placed(block)
        if not there or placed is None:
            return
        rect = badge_rect(placed, self.canvas)
        camera, viewport = self.canvas.sight.camera, self.canvas.viewport()
        corner = camera.to_view(rect.x(), rect.y()).toPoint()
        size = (rect.size() * camera.scale).toSize()
        bubble = self.bubble = ProblemBubble(there, self)
        bubble.fix_asked.connect(self.fix)
        bubble.show_at(QRect(viewport.mapToGlobal(corner), size))

    def _show_problems(self) -> None:
        problems, stopped = self.checks.problems, self._run_problem
        if stopped is not None and stopped.block in self.canvas.editor.project.blocks:
            problems = [stopped, *problems]
        self.problems.show_problems(problems)
        self.panels.set_sign(self.problems, "circle-alert" if problems else "circle-check")
        before = self.canvas.problems.problems
        self.canvas.problems.show(problems)
        if self.canvas.problems.problems != before:
            self.canvas.viewport().update()

    def _on_problem_opened(self, problem: Diagnostic) -> None:
        if problem.block:
            self.show_block(problem.block)
        elif problem.page in self.canvas.editor.project.pages:
            self.canvas.show_page(problem.page)

    def _on_theme_changed(self) -> None:
        self.canvas.set_look(
            self._studio.look.theme, block_font(self._studio), is_mirrored=is_right_to_left()
        )
        scale = usual_scale(self._studio)
        if scale != self._usual_scale:
            self.canvas.sight.zoom(self.canvas.sight.camera.scale * scale / self._usual_scale)
            self._usual_scale = scale
        self.outline.refresh()
        self.helpers.refresh()

    def _on_words_changed(self) -> None:
        """Show the blocks in other words, before all that tells of them."""
        self.canvas.editor.use_language(self._studio.language)
        self.canvas.use_words(is_mirrored=is_right_to_left())
        self.outline.scheduleDelayedItemsLayout()
        self.code.live.use_language()
        self.checks.begin_again()

    def _on_palette_narrowed(self, is_narrow: bool) -> None:
        self._studio.settings.set_shown(NARROW_PALETTE, is_narrow)

    def _give_palette_room(self) -> None:
        """Let the palette be as wide as it wants; the canvas has the rest."""
        palette = self.helpers.palette
        is_fixed = palette.is_narrow
        width = palette.maximumWidth() if is_fixed else palette.sizeHint().width()
        self.panels.give_left(width, is_fixed=is_fixed)


def block_font(studio: Studio) -> QFont:
    """The font of the blocks, the same for everybody: places on a page are in its units."""
    dots_per_inch = studio.app.primaryScreen().logicalDotsPerInchY()
    return text_font(BLOCK_FONT_PIXELS * 72 / dots_per_inch, QFont.Weight.Medium)


def usual_scale(studio: Studio) -> float:
    """The zoom at which the words on blocks are as large as those of the window."""
    return QFontInfo(studio.app.font()).pixelSize() / BLOCK_FONT_PIXELS
