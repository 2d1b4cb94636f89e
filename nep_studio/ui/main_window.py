"""The main window: the start page or the workbench, with menus, toolbar and messages."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QResizeEvent
from PySide6.QtWidgets import QMainWindow, QStackedWidget, QToolBar, QWidget

from nep_studio import settings
from nep_studio.blocks.checks import Problem
from nep_studio.journal import recover
from nep_studio.ui.actions import Actions
from nep_studio.ui.actions_edit import add_edit_menu, update_edit_actions
from nep_studio.ui.actions_file import add_file_menu
from nep_studio.ui.actions_icons import fit_icons
from nep_studio.ui.actions_view import add_help_menu, add_toolbar, add_view_menu, size_toolbar
from nep_studio.ui.app import Studio
from nep_studio.ui.documents import Document
from nep_studio.ui.documents_choosing import FileChooser, SystemFileChooser
from nep_studio.ui.documents_files import Files
from nep_studio.ui.documents_opening import Opening
from nep_studio.ui.main_window_drops import project_in
from nep_studio.ui.main_window_help import (
    AboutDialog,
    ShortcutsDialog,
    on_the_canvas,
    shortcuts_of,
)
from nep_studio.ui.main_window_panels import AreaName, Panel
from nep_studio.ui.main_window_rooms import WITH_A_PROJECT, add_rooms
from nep_studio.ui.main_window_workbench import Workbench
from nep_studio.ui.messages import Answer, Message, Messages
from nep_studio.ui.messages_area import MessageArea
from nep_studio.ui.problems.looks import summary
from nep_studio.ui.running.actions import add_run_menu
from nep_studio.ui.running.control import RunControl
from nep_studio.ui.start_page import StartPage
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

FIRST_SIZE = (1280, 800)


class MainWindow(QMainWindow):
    """One window with at most one project.

    What is in it is made anew when the language changes; the project and its history stay.
    """

    def __init__(self, studio: Studio, chooser: FileChooser | None = None) -> None:
        super().__init__()
        self.studio = studio
        self.settings, self.look = studio.settings, studio.look
        self.messages = Messages(self)
        self.files = Files(
            lambda: studio.language,
            self.settings,
            self.messages,
            chooser or SystemFileChooser(),
            self,
        )
        self._opening_message: Message | None = None
        self._may_close = False
        self.running = RunControl(self)
        self.setAcceptDrops(True)
        self.resize(*FIRST_SIZE)
        self.restoreGeometry(self.settings.state("geometry"))
        self._build()
        self.files.document_changed.connect(self._on_document_changed)
        self.files.opening_changed.connect(self._on_opening_changed)
        studio.words_changed.connect(self._on_words_changed)
        self.look.theme_changed.connect(self._on_theme_changed)
        self._show_title()

    def _build(self) -> None:
        """Make all that has words in it."""
        self.pages = QStackedWidget()
        self.setCentralWidget(self.pages)
        self.workbench = Workbench(self.studio, self.messages, self)
        self.start_page = StartPage(self.studio, self.files)
        self.pages.addWidget(self.start_page)
        self.pages.addWidget(self.workbench)
        self.message_area = MessageArea(self.look, self.pages)
        self.messages.show_in(self.message_area)
        self.actions_by_name = Actions(self, self.look)
        self.menus = {
            "file": add_file_menu(self),
            "edit": add_edit_menu(self),
            "view": add_view_menu(self),
            "run": add_run_menu(self),
            "help": add_help_menu(self),
        }
        self.toolbar: QToolBar = add_toolbar(self)
        self.running.attach()
        add_rooms(self)
        self.workbench.problems_found.connect(self._on_problems_found)
        self.workbench.canvas.picture_requested.connect(self.export_picture)
        self.workbench.canvas.layout_changed.connect(self.update_actions)
        self.workbench.canvas.selection.changed.connect(self.update_actions)
        self._on_problems_found([])
        self.update_actions()
        fit_icons(self.pages)

    def start(self, path: Path | None) -> None:
        """Begin with a project, or with the start page; offer what was lost the last time."""
        self.workbench.restore(self.fontMetrics().height())
        if path is not None:
            self.files.open(path)
        self.offer_recovery()

    def add_side_panel(
        self, widget: QWidget, title: str, icon_name: str, area: AreaName, *, is_shown: bool = True
    ) -> Panel:
        """Add a panel beside the canvas: left, right or at the bottom."""
        return self.workbench.add_side_panel(widget, title, icon_name, area, is_shown=is_shown)

    def offer_recovery(self) -> None:
        """Offer work that was not saved when the program ended without warning."""
        found = recover(settings.journal_folder(), self.studio.language)
        if found:
            from nep_studio.ui.recovery import RecoveryDialog  # at a start without, not loaded

            RecoveryDialog(found, self.studio, self.files.restore, self).open()

    def flush(self) -> None:
        """Put all work on the disk."""
        if self.files.document is not None:
            self.files.document.flush()

    # What the actions ask for

    def open_settings(self) -> None:
        """Show the settings."""
        from nep_studio.ui.settings_dialog import SettingsDialog

        dialog = SettingsDialog(self.studio, self)
        dialog.reset_button.clicked.connect(self.reset_panels)
        dialog.open()

    def reset_panels(self) -> None:
        """Put the panels back to where they were at first."""
        self.settings.forget_window()
        self._rebuild()

    def export_picture(self) -> None:
        """Ask for a picture of the blocks."""
        document = self.files.document
        if document is not None:
            folder = document.path.parent if document.path else self.settings.last_folder
            from nep_studio.ui.picture.dialog import PictureDialog

            PictureDialog(self.workbench.canvas, folder, document.title, self).open()

    def show_problems(self) -> None:
        """Check now, and show the problems."""
        self.workbench.checks.start()
        self.workbench.panels.show(self.workbench.problems)

    def show_shortcuts(self) -> None:
        """Show what the keys do."""
        rows = [*shortcuts_of(self.actions_by_name.by_name.values()), *on_the_canvas()]
        ShortcutsDialog(rows, self).open()

    def show_about(self) -> None:
        """Say what this program is."""
        AboutDialog(self).open()

    def update_actions(self) -> None:
        """Let those actions be used that have something to do."""
        is_open = self.files.document is not None
        names = ("save", "save_as", "close", "check", "zoom_in", "zoom_out", "zoom_100", "zoom_fit")
        self.actions_by_name.enable(is_open, *names, *WITH_A_PROJECT)
        for panel in self.workbench.panels.all:
            panel.action.setEnabled(is_open)
        update_edit_actions(self)

    # What happens

    def _on_document_changed(self, document: Document | None) -> None:
        self.running.follow(document)
        self.pages.setCurrentIndex(0 if document is None else 1)  # first: it needs its size
        self.workbench.show_document(document)
        if document is not None:
            document.changed.connect(self._show_title)
            self.workbench.canvas.setFocus()
        self._show_title()
        self.update_actions()

    def _show_title(self) -> None:
        document = self.files.document
        self.setWindowTitle(f"{document.title}[*]" if document is not None else tr("Start"))
        self.setWindowModified(document is not None and document.is_modified)
        self.setWindowFilePath("" if document is None else str(document.path or ""))
        self.workbench.show_folder(document)
        can_compare = document is not None and document.path is not None and document.is_modified
        self.actions_by_name.enable(can_compare, "compare")

    def _on_problems_found(self, problems: Sequence[Problem]) -> None:
        document = self.files.document
        is_open = document is not None
        if document is not None and not document.project.blocks:
            problems = []  # that nothing happens yet is no news to somebody who begins
        check = self.actions_by_name["check"]
        worst = next(iter(problems), None)
        colour = "success" if worst is None else worst.severity
        sign = "circle-check" if worst is None else "triangle-alert"
        theme = self.look.theme
        check.setIcon(icon(sign, theme.colour(colour)) if is_open else icon(sign, theme))
        check.setIconText(summary(problems) if problems else tr("Check"))
        check.setToolTip(summary(problems))

    def _on_opening_changed(self, opening: Opening | None) -> None:
        if self._opening_message is not None:
            self.messages.withdraw(self._opening_message)
            self._opening_message = None
        if opening is not None:
            title = tr("Opening “{name}”…", name=opening.path.name)
            stop = Answer(tr("Cancel"), self.files.cancel_opening)
            self._opening_message = Message("info", title, answers=(stop,), is_busy=True)
            self.messages.tell(self._opening_message)

    def _on_theme_changed(self) -> None:
        size_toolbar(self.toolbar)
        fit_icons(self.pages)
        self._on_problems_found(self.workbench.checks.problems)

    def _on_words_changed(self) -> None:
        if self.files.document is not None:
            self.files.document.use_language(self.studio.language)
        self._rebuild()

    def _rebuild(self) -> None:
        """Make the contents of the window anew, and show the same place of the same project."""
        old, page = self.workbench, self.workbench.canvas.page
        camera, selected = old.canvas.camera, old.canvas.selection.ids
        old.retire()
        self.menuBar().clear()
        self.removeToolBar(self.toolbar)
        self.toolbar.deleteLater()
        self.actions_by_name.retire()
        self._build()
        self._on_document_changed(self.files.document)
        self.workbench.restore(self.fontMetrics().height())
        canvas = self.workbench.canvas
        if self.files.document is not None:
            canvas.show_page(page)
            canvas.selection.set(selected)
            canvas.zoom(camera.scale)
            if selected:
                canvas.show_block(selected[0])

    # Closing

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the words on the toolbar where there is room for them."""
        super().resizeEvent(event)
        size_toolbar(self.toolbar)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask what is to become of work that is not saved; then remember the window's shape."""
        document = self.files.document
        if not self._may_close and document is not None and document.is_modified:
            event.ignore()
            self.files.guard(self._close_now)
            return
        self._remember()
        super().closeEvent(event)

    def _close_now(self) -> None:
        self._may_close = True
        self.close()

    def _remember(self) -> None:
        self.settings.set_state("geometry", self.saveGeometry())
        self.workbench.panels.remember()
        self.settings.write()
        self.hide()  # what is running takes a moment to stop
        self.running.close()
        self.workbench.retire()
        if self.files.document is not None:
            self.files.document.close()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take a project that is dragged onto the window."""
        project_in(event)

    def dropEvent(self, event: QDropEvent) -> None:
        """Open a project that is dropped onto the window."""
        path = project_in(event)
        if path is not None:
            self.files.open(path)
