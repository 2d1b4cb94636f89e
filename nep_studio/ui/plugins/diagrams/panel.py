"""The panel Diagram: which diagram is shown, its tools, and what is first to be done."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtCore import QPoint, QSize, Qt
from PySide6.QtGui import QGuiApplication, QHideEvent, QShowEvent
from PySide6.QtWidgets import QComboBox, QMenu, QPushButton, QStackedWidget, QToolButton, QWidget

from faults.files import as_file_name, whole_file
from nep_studio.blocks.program import Project
from nep_studio.ui.edits import OpenProject
from nep_studio.ui.host import Host
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.drawing_board import ZOOM_STEP
from nep_studio.ui.widgets.forms import plain_label
from nep_studio.ui.widgets.layouts import Flow, FlowLayout, in_column, in_row
from nep_studio.ui.widgets.questions import Asking, ask_for_path, tell_not_saved
from nep_studio.ui.words import tr

from .changes import Changes
from .model import Diagram, Key, diagrams_of, diagrams_of_plans, statuses_of
from .picture import image_of, png_of, svg_of
from .view import DiagramView

PICTURES = {".svg": "SVG", ".png": "PNG"}
ICONS = {"states": "route", "tree": "git-branch", "plan": "list"}


class DiagramPage(QWidget):
    """Follows the open program, the canvas and what runs, while it is visible."""

    def __init__(self, host: Host) -> None:
        super().__init__()
        self._host, self._services = host, host.services
        self._canvas = host.workbench.canvas
        self._changes = Changes(self._canvas)
        self._diagrams: tuple[Diagram, ...] = ()
        self._plans: tuple[Diagram, ...] = ()
        self._folded: frozenset[str] = frozenset()
        self._project: Project | None = None
        self._is_watching = False
        self.view = DiagramView(self._services.look)
        self.choice = labelled(QComboBox(), name="Diagram")
        self.state_button = _tool("New state…")
        self.arrow_button = _tool("Arrow to…")
        self.arrow_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.arrow_button.setMenu(QMenu(self.arrow_button))
        self.larger_button, self.smaller_button = _tool("Zoom in"), _tool("Zoom out")
        self.fit_button, self.picture_button = _tool("Show all"), _tool("Save picture…")
        self.empty = _Empty()
        self._lay_out()
        self._connect()
        self._on_theme_changed()
        follow_words(self, self._on_words_changed)

    def _lay_out(self) -> None:
        fitting = QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        self.choice.setSizeAdjustPolicy(fitting)
        changing = (self.state_button, self.arrow_button)
        seeing = (self.smaller_button, self.larger_button, self.fit_button, self.picture_button)
        self.bar = QWidget()
        gap = self.fontMetrics().height() // 4
        tools = QWidget()
        tools.setLayout(FlowLayout(tools, gap, (*changing, *seeing)))
        in_column(self.choice, tools, of=self.bar, margins=gap, spacing=gap)
        self.views = QStackedWidget()
        self.views.addWidget(self.empty)
        self.views.addWidget(self.view)
        in_column(self.bar, (self.views, 1), of=self, margins=0, spacing=0)

    def _connect(self) -> None:
        view = self.view
        self._open = OpenProject(self._services.files, self)
        self._open.changed.connect(self._on_changed)
        self._canvas.selection.changed.connect(self._on_selection_changed)
        self._services.look.theme_changed.connect(self._on_theme_changed)
        self.choice.activated.connect(self._on_chosen)
        view.chosen.connect(self._on_block_chosen)
        view.fold_wanted.connect(self.fold)
        view.arrow_wanted.connect(self.add_arrow)
        view.rename_wanted.connect(self._on_rename_wanted)
        view.delete_wanted.connect(self.delete)
        view.copy_wanted.connect(self.copy_picture)
        view.menu_wanted.connect(self._on_menu_wanted)
        self.state_button.clicked.connect(lambda: self.ask_for_state())
        self.arrow_button.menu().aboutToShow.connect(self._fill_arrow_menu)
        self.larger_button.clicked.connect(lambda: view.zoom(ZOOM_STEP))
        self.smaller_button.clicked.connect(lambda: view.zoom(1 / ZOOM_STEP))
        self.fit_button.clicked.connect(view.fit)
        self.picture_button.clicked.connect(self._on_picture_asked)
        self.empty.state_button.clicked.connect(lambda: self.ask_for_state())
        self.empty.tree_button.clicked.connect(self.add_tree)

    # What is shown

    @property
    def diagram(self) -> Diagram | None:
        """The one that is shown."""
        return self.view.diagram if self._diagrams else None

    @property
    def _machine(self) -> str:
        """The machine of the diagram that is shown, else the usual one."""
        diagram = self.diagram
        return diagram.key if diagram is not None and diagram.kind == "states" else ""

    def refresh(self) -> None:
        """Draw the program as it is now."""
        editor = self._open.editor
        if editor is None:
            self._diagrams = self._plans = ()
        else:
            self._plans = self._plans_now()
            drawn = diagrams_of(editor.project, editor.language, self._folded)
            self._diagrams = (*drawn, *self._plans)
        shown = self.view.diagram.id
        place = next((i for i, one in enumerate(self._diagrams) if one.id == shown), 0)
        self.choice.clear()
        for one in self._diagrams:
            self.choice.addItem(icon(ICONS[one.kind], self._services.look.theme), one.title)
        self.choice.setCurrentIndex(place if self._diagrams else -1)
        self.views.setCurrentWidget(self.view if self._diagrams else self.empty)
        self.empty.set_open(is_open=self._services.document is not None)
        self.bar.setVisible(bool(self._diagrams))
        if self._diagrams:
            self._show(self._diagrams[place])

    def _show(self, diagram: Diagram) -> None:
        self.view.show_diagram(diagram)
        self.choice.setCurrentIndex(self._diagrams.index(diagram))
        has_states = diagram.kind == "states"
        self.arrow_button.setVisible(has_states)
        self._show_run()

    def fold(self, part: str) -> None:
        """Fold a part of a tree away, or show it again."""
        self._folded ^= {part}
        self.refresh()

    def showEvent(self, event: QShowEvent) -> None:
        """Follow the program."""
        super().showEvent(event)
        if not self._is_watching:
            self._is_watching = True
            self._services.runner.arrived.connect(self._show_run)
            self._services.runner.state_changed.connect(self._show_run)
        self.refresh()
        self._on_selection_changed()

    def hideEvent(self, event: QHideEvent) -> None:
        """Look at nothing."""
        super().hideEvent(event)
        if self._is_watching:
            self._is_watching = False
            self._services.runner.arrived.disconnect(self._show_run)
            self._services.runner.state_changed.disconnect(self._show_run)

    def _show_run(self) -> None:
        """Show where the program is; it is asked at most as often as messages are told of."""
        if self._plans != self._plans_now():
            self.refresh()  # which shows the statuses too
            return
        diagram, marks = self.diagram, self._services.running.stage.marks
        if diagram is None:
            return
        if diagram.kind == "tree":
            self.view.show_statuses(marks.nodes)
        elif diagram.kind == "plan":
            self.view.show_statuses(statuses_of(marks.plans[diagram.key]))
        else:
            now = marks.modes.get(diagram.key)
            self.view.show_statuses({now: "running"} if now else {})

    def _plans_now(self) -> tuple[Diagram, ...]:
        """What the program has planned since it began."""
        editor, marks = self._open.editor, self._services.running.stage.marks
        if editor is None or not marks.plans:
            return ()
        plans = marks.plans.values()
        return diagrams_of_plans(plans, marks.code, editor.project, editor.language)

    def _on_changed(self) -> None:
        document = self._services.document
        project = document.project if document is not None else None
        if project is not self._project:
            self._project, self._folded = project, frozenset()
        if self.isVisible():
            self.refresh()

    def _on_words_changed(self) -> None:
        if self.isVisible():
            self.refresh()

    def _on_chosen(self, place: int) -> None:
        if 0 <= place < len(self._diagrams):
            self._show(self._diagrams[place])
            self.view.fit()

    # The same block on the canvas and here

    def _on_block_chosen(self, block: str) -> None:
        self._host.workbench.show_block(block)

    def _on_selection_changed(self) -> None:
        """Choose here what is chosen on the canvas, on another diagram if it is there."""
        if not self.isVisible() or not self._diagrams:
            return
        project, block = self._canvas.editor.project, self._canvas.selection.cursor
        shown = self.view.diagram
        chosen = self.view.selected
        if chosen is not None and self.view.block_of(chosen) == block:
            return  # a state without blocks of its own is shown by another one
        while block in project.blocks:
            for one in (shown, *self._diagrams):
                if block in one.keys:
                    if one is not shown:
                        self._show(one)
                    self.view.show_block(block)
                    return
            block = _outer(project, block)

    # Changes

    def ask_for_state(self) -> Asking:
        """Ask for the name of a new state, and add it."""
        name = self._changes.free_name(self._machine)
        place = self.state_button if self.bar.isVisible() else self.empty.state_button
        return self._ask(
            tr("What is the new state called?"), tr("Add"), name, self.add_state, place
        )

    def add_state(self, name: str) -> None:
        """Add a state; raises EditRefused."""
        chosen = self.view.selected
        near = self.view.block_of(chosen) if chosen is not None and self._diagrams else ""
        block = self._changes.add_state(name, self._machine, near)
        self._show_new(block)

    def add_arrow(self, start: str, end: str) -> None:
        """Let the program go from a state to another one when all is done."""
        item = self.view.item_of(("box", start))
        near = item.block if item is not None else ""
        self._attempt(lambda: self._changes.add_arrow(start, end, self._machine, near))

    def add_tree(self) -> None:
        """Begin a behaviour tree."""
        self._attempt(self._changes.add_tree)

    def rename(self, old: str, new: str) -> None:
        """Give a state another name in all blocks; raises EditRefused."""
        self._changes.rename_state(self._machine, old, new)
        self.refresh()
        self.view.select(("box", new.strip()))

    def delete(self, key: Key) -> None:
        """Delete an arrow with its block, or a state with its arrows."""
        item = self.view.item_of(key)
        if key[0] == "arrow":
            change = self._changes.delete_arrow(key[1])
        elif item is not None and item.shape == "state":
            change = self._changes.delete_state(self._machine, item.key)
        else:
            return
        if self._canvas.attempt(change):
            self.refresh()

    def _attempt(self, change: Callable[[], str]) -> None:
        made: list[str] = []
        if self._canvas.attempt(lambda: made.append(change())):
            self._show_new(made[0])

    def _show_new(self, block: str) -> None:
        self.refresh()
        found = next((one for one in self._diagrams if block in one.keys), None)
        if found is not None:
            self._show(found)
            self.view.show_block(block)
        self._host.workbench.show_block(block)

    def _on_rename_wanted(self, key: Key) -> None:
        answer = partial(self.rename, key[1])
        rect = self.view.rects()[key]
        place = self.view.mapToGlobal(self.view.in_widget(rect.bottomLeft()).toPoint())
        self._ask(tr("What is the state called?"), tr("Rename"), key[1], answer, place)

    def _ask(
        self,
        words: str,
        yes: str,
        name: str,
        answer: Callable[[str], None],
        place: QWidget | QPoint,
    ) -> Asking:
        if isinstance(place, QWidget):
            place = place.mapToGlobal(place.rect().bottomLeft())
        asking = Asking(self, self._services.look.theme, words, yes, answer, name)
        asking.show_at(place)
        return asking

    # Menus

    def menu_of(self, key: Key | None) -> QMenu:
        """What can be done with what is at a place."""
        menu, item = QMenu(self.view), self.view.item_of(key)
        if key is not None and self.view.block_of(key):
            self._add(menu, "blocks", tr("Show the block"), lambda: self.view.open(key))
        if item is not None and item.shape == "state":
            arrows = menu.addMenu(icon("arrow-right", self._services.look.theme), tr("Arrow to"))
            self._fill(arrows, item.key)
            self._add(menu, "pencil", tr("Rename…"), lambda: self.view.rename_wanted.emit(key))
        if item is not None and item.can_fold:
            words = tr("Unfold") if item.hidden else tr("Fold")
            self._add(menu, "fold-vertical", words, lambda: self.fold(item.key))
        if key is not None and (key[0] == "arrow" or (item and item.shape == "state")):
            self._add(menu, "trash-2", tr("Delete"), lambda: self.delete(key))
        if key is None:
            self._add(menu, "plus", tr("New state…"), self.ask_for_state)
            self._add(menu, "copy", tr("Copy as a picture"), self.copy_picture)
        return menu

    def _on_menu_wanted(self, key: Key | None, place: QPoint) -> None:
        menu = self.menu_of(key)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(place)

    def _fill_arrow_menu(self) -> None:
        menu, item = self.arrow_button.menu(), self.view.item_of(self.view.selected)
        menu.clear()
        if item is None or item.shape != "state":
            menu.addAction(tr("Choose a state first.")).setEnabled(False)
        else:
            self._fill(menu, item.key)

    def _fill(self, menu: QMenu, start: str) -> None:
        for item in self.view.diagram.items:
            if item.shape == "state":
                action = menu.addAction(item.title.replace("&", "&&"))
                action.triggered.connect(partial(self.add_arrow, start, item.key))

    def _add(self, menu: QMenu, sign: str, words: str, do: Callable[[], object]) -> None:
        action = menu.addAction(icon(sign, self._services.look.theme), words)
        action.triggered.connect(lambda: do())

    # Pictures

    def copy_picture(self) -> None:
        """Put a picture of the diagram on the clipboard."""
        image = image_of(self.view.shapes, self._services.look.theme, self.view.font())
        QGuiApplication.clipboard().setImage(image)
        self._services.messages.confirm(tr("The picture is on the clipboard."))

    def save_picture(self, path: Path) -> None:
        """Write a picture of the diagram; its kind is that of the file's name."""
        shapes, theme, font = self.view.shapes, self._services.look.theme, self.view.font()
        if path.suffix.lower() == ".svg":
            data = svg_of(shapes, theme, font, self.view.diagram.title)
        else:
            data = png_of(shapes, theme, font)
        try:
            with whole_file(path) as file:
                file.write(data)
        except OSError as error:
            why = error.strerror or str(error)
            tell_not_saved(self._services.messages, str(path), why)
            return
        self._services.messages.confirm(tr("Saved “{name}”.", name=path.name))

    def _on_picture_asked(self) -> None:
        name = as_file_name(self.view.diagram.title)
        start = self._services.settings.last_folder / f"{name}.png"
        kinds = (tr("Pictures (*.png)"), tr("Pictures, sharp at any size (*.svg)"))
        ask_for_path(self._host.widget, tr("Save picture"), start, self.save_picture, "save", kinds)

    def _on_theme_changed(self) -> None:
        icons = {
            self.state_button: "plus",
            self.arrow_button: "arrow-right",
            self.larger_button: "zoom-in",
            self.smaller_button: "zoom-out",
            self.fit_button: "maximize",
            self.picture_button: "image",
        }
        for button, name in icons.items():
            button.setIcon(icon(name, self._services.look.theme))
        side = self.fontMetrics().height()
        self.choice.setIconSize(QSize(side, side))


class _Empty(QWidget):
    """What stands here while the program has neither states nor trees."""

    def __init__(self) -> None:
        super().__init__()
        words = plain_label(alignment=Qt.AlignmentFlag.AlignCenter)
        words.setProperty("role", "hint")
        labelled(
            words,
            text="Here the states and the behaviour trees of the program are drawn: which there "
            "are, and what leads where. What is changed here is changed in the blocks.",
        )
        self.state_button = labelled(QPushButton(), text="Add a state…")
        self.state_button.setProperty("kind", "primary")
        self.tree_button = labelled(QPushButton(), text="Add a behaviour tree")
        buttons = QWidget()
        flow = Flow(buttons, widgets=(self.state_button, self.tree_button))
        buttons.setLayout(flow)
        in_column(1, words, in_row(1, buttons, 1), 2, of=self)

    def set_open(self, *, is_open: bool) -> None:
        """Only in a program can something be added."""
        self.state_button.setEnabled(is_open)
        self.tree_button.setEnabled(is_open)


def _tool(words: str) -> QToolButton:
    return labelled(explained(QToolButton(), words), text=words)


def _outer(project: Project, block: str) -> str:
    """The block around a block, or the first of its stack."""
    parent = project.parents[block]
    if parent.owner in project.blocks:
        return parent.owner
    first = project.stacks[parent.owner].body[0]
    return first if first != block else ""
