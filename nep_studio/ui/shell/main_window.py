"""The main window: the start page or the workbench, with menus, toolbar and messages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property, partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, TypeGuard

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QCloseEvent,
    QDragEnterEvent,
    QDropEvent,
    QKeyEvent,
    QResizeEvent,
    QShowEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import (
    QAbstractSlider,
    QAbstractSpinBox,
    QComboBox,
    QMainWindow,
    QScrollBar,
    QStackedWidget,
    QTabBar,
    QToolBar,
    QWidget,
)

from nep_studio.ui.actions import Actions
from nep_studio.ui.document_files import PICTURES, SUFFIX, FileChooser, Files
from nep_studio.ui.labels import follow_words
from nep_studio.ui.message_cards import MessageArea
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.running.actions import fill_run_menu, follow_running
from nep_studio.ui.services import Services, Studio
from nep_studio.ui.theme.icons import fit_icons
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.words import tr

from .dialogs import offer_recovery, open_settings
from .menus import (
    add_edit_menu,
    add_file_menu,
    add_help_menu,
    add_language_of_program,
    add_menu,
    add_toolbar,
    add_view_menu,
    dress_toolbar,
    size_toolbar,
    style_check,
    update_edit_actions,
)
from .plugin_host import WindowHost
from .start_page import StartPage

if TYPE_CHECKING:
    from nep_studio.blocks.checks.diagnostic import Diagnostic
    from nep_studio.ui.documents import Document, Opening
    from nep_studio.ui.running.control import RunControl
    from nep_studio.ui.workbench.workbench import Workbench


# Makes what the first page does not need, a part at a time, or at once when it is needed.

MODULES = (
    "nep_studio.blocks.program",
    "nep_studio.blocks.definitions",
    "nep_studio.blocks.edit_rules",
    "nep_studio.blocks.generate.expressions",
    "nep_studio.blocks.generate.program",
    "nep_studio.blocks.editor",
    "nep_studio.run.installation",
    "nep_studio.project.journal",
    "nep_studio.blocks.checks",
    "nep_studio.ui.documents",
    "nep_studio.run.plan",
    "nep_studio.ui.canvas.editing.commands",
    "nep_studio.ui.canvas.layout.page",
    "nep_studio.ui.canvas.editing.menu",
    "nep_studio.ui.canvas.fields.editors",
    "nep_studio.ui.canvas.canvas",
    "nep_studio.ui.workbench.code",
    "nep_studio.ui.workbench.palette.palette",
    "nep_studio.ui.workbench.workbench",
    "nep_studio.run.controller",
    "nep_studio.ui.running.control",
    "nep_studio.help.texts",
    "nep_studio.ui.shell.command_palette",
)
"""What the workbench is made of, in an order in which none of them takes long to load."""


class LazyInitialiser(QObject):
    """The workbench and what stands around it, made by one step after the other.

    ``completed`` comes when all is there.
    """

    completed = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._steps = self._make()
        self._is_working = False
        self._is_unfinished = True
        self.is_laid_out = False
        """Whether the panels are to have the sizes that the person gave them."""
        self.made_workbench: Workbench | None = None
        self._turns = QTimer(self, interval=0)
        self._turns.timeout.connect(self.step)

    @property
    def is_done(self) -> bool:
        """Whether everything is made."""
        return not self._is_unfinished and self.made_workbench is not None

    @property
    def is_waiting(self) -> bool:
        """Whether it looks for something to make at each turn of the event loop."""
        return self._turns.isActive()

    def go_on_after_paint(self) -> None:
        """Make a step at each turn of the event loop, once the window has been painted."""
        self._window.installEventFilter(self)

    def finish(self) -> None:
        """Make all that is left now."""
        while self._is_unfinished and not self._is_working:
            self.step()

    def trigger(self, name: str) -> None:
        """Do what an action does that may not be there yet."""
        self.finish()
        self._window.actions_by_name[name].trigger()

    def enable(self, is_open: bool) -> None:
        """Let what is made be used or not, as a project is open or not."""
        if not self.is_done:
            return
        self._window.actions_by_name.enable(is_open, *self._window.host.with_a_project)
        for panel in self._window.workbench.panels.all:
            panel.action.setEnabled(is_open)

    def stop(self) -> None:
        """Make no more."""
        self._is_unfinished = False
        self._turns.stop()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Begin when the window has been painted."""
        if event.type() == QEvent.Type.Paint:
            watched.removeEventFilter(self)
            self._turns.start()
        return super().eventFilter(watched, event)

    def step(self) -> None:
        """Make one step."""
        if self._is_working:
            return
        if not self._is_unfinished:
            self._turns.stop()
            return
        self._is_working = True
        try:
            is_over = next(self._steps, "over") == "over"
        except Exception:
            self.stop()  # a step that failed cannot be made a second time
            raise
        finally:
            self._is_working = False
        if is_over:
            self.stop()
            self._window.follow_workbench()
            self.completed.emit()

    def _make(self) -> Iterator[None]:
        for name in MODULES:
            import_module(name)
            yield
        from nep_studio.ui.workbench.workbench import Workbench

        from .command_palette import add_command_palette
        from .plugin_host import add_plugins

        window = self._window
        _ = window.studio.language
        yield
        workbench = self.made_workbench = Workbench(window.studio, window.messages, window.pages)
        window.pages.addWidget(workbench)
        yield
        window.running.attach()
        follow_running(window.host, window.toolbar)
        yield from add_plugins(window.host)
        add_command_palette(window)
        fit_icons(workbench)
        if self.is_laid_out:
            workbench.restore(window.fontMetrics().height())


# What holds for the pointer everywhere: projects are dropped anywhere, the wheel only scrolls.


def project_in(event: QDropEvent, opened: Files) -> Path | None:
    """The project, or else what can be opened, among what is dragged; the event is then taken."""
    endings = (SUFFIX, *PICTURES, *opened.openers)
    files = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
    found = next((file for file in files if file.suffix.lower() in endings), None)
    if found is not None:
        event.acceptProposedAction()
    return found


VALUES = (QAbstractSlider, QAbstractSpinBox, QComboBox, QTabBar)
"""What Qt lets the wheel change wherever it stops."""


HEARD = (QWheelEvent, QDragEnterEvent, QShowEvent)


class PointerRules(QObject):
    """Hears what goes to any widget of the program, before the widget does.

    The wheel changes no value that has not the focus: what is around it scrolls. A project that
    is dropped on a part of the window, a line to type in too, is the window's.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        window.studio.app.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Pass on what is not for this widget to those around it."""
        # every event comes by here: all but these few are let go at once
        if not isinstance(event, HEARD):
            return False
        if isinstance(event, QShowEvent):
            _take_no_focus_by_wheel(watched)
            return False
        if isinstance(event, QWheelEvent):
            is_passed_on = _is_value(watched) and not watched.hasFocus()
        else:
            is_passed_on = (
                self._is_inside(watched) and project_in(event, self._window.files) is not None
            )
        if is_passed_on:
            event.ignore()  # then Qt asks the widget around it
        return is_passed_on

    def _is_inside(self, part: QObject) -> bool:
        window = self._window
        return isinstance(part, QWidget) and part.window() is window and part is not window


def _is_value(widget: QObject) -> TypeGuard[QWidget]:
    return isinstance(widget, VALUES) and not isinstance(widget, QScrollBar)


def _take_no_focus_by_wheel(widget: QObject) -> None:
    """Qt gives it before anybody hears of the wheel."""
    if _is_value(widget) and widget.focusPolicy() == Qt.FocusPolicy.WheelFocus:
        widget.setFocusPolicy(Qt.FocusPolicy.StrongFocus)


FIRST_SIZE = QSize(1280, 800)

FRAME = QSize(0, 40)
"""What the title of a window takes of the screen."""


class MainWindow(QMainWindow):
    """One window with at most one project.

    With ``is_gradual`` the first page is there first: the workbench and what stands around it
    are made after that has been painted, or when they are needed.
    """

    def __init__(
        self, studio: Studio, chooser: FileChooser | None = None, *, is_gradual: bool = False
    ) -> None:
        super().__init__()
        self.studio = studio
        self.settings, self.look = studio.settings, studio.look
        self.host = WindowHost(self)
        self.services = self.host.services = Services(studio, self, self._make_running, chooser)
        self.messages, self.files = self.services.messages, self.services.files
        self._opening_message: Message | None = None
        self._may_close = False
        self._shown_problems: tuple[object, ...] = ()
        self.lazy = LazyInitialiser(self)
        self.setAcceptDrops(True)
        self.resize(FIRST_SIZE.boundedTo(room_around(None).size() - FRAME))
        self.restoreGeometry(self.settings.state("geometry"))
        self._build()
        if is_gradual:
            self.start_page.wait_with_pictures()
            self.lazy.go_on_after_paint()
        else:
            self.lazy.finish()
        self.files.document_changed.connect(self._on_document_changed)
        self.files.opening_changed.connect(self._on_opening_changed)
        self.look.theme_changed.connect(self._on_theme_changed)
        follow_words(self, self._say)

    @cached_property
    def workbench(self) -> Workbench:
        """Where the project is worked on; made when it is first asked for."""
        if self.lazy.made_workbench is None:
            self.lazy.finish()
        assert self.lazy.made_workbench is not None
        return self.lazy.made_workbench

    @cached_property
    def running(self) -> RunControl:
        """What runs the project; made when it is first asked for."""
        return self.services.running

    def _make_running(self) -> RunControl:
        from nep_studio.ui.running.control import RunControl

        return RunControl(self.host)

    def _build(self) -> None:
        """Make what is there from the first: the first page, the menus, the toolbar."""
        self.pages = QStackedWidget()
        self.setCentralWidget(self.pages)
        self.start_page = StartPage(self.studio, self.files)
        self.pages.addWidget(self.start_page)
        self.start_page.try_requested.connect(lambda path: self.running.try_example(path))
        self.start_page.tour_requested.connect(lambda: self.lazy.trigger("tour"))
        self.message_area = MessageArea(self.look, self.pages)
        self.messages.show_in(self.message_area)
        self.actions_by_name = Actions(self, self.look)
        self.menus = {
            "file": add_file_menu(self),
            "edit": add_edit_menu(self),
            "view": add_view_menu(self),
            "run": add_menu(self, "&Run"),
            "robots": add_menu(self, "R&obots"),
        }
        fill_run_menu(self.menus["run"], self.host)
        add_language_of_program(self.menus["run"], self)
        self.menus["help"] = add_help_menu(self)
        self.toolbar: QToolBar = add_toolbar(self)
        self.toolbar.hide()  # nothing of it has anything to do before a project is open
        fit_icons(self.pages)

    def follow_workbench(self) -> None:
        """Follow the workbench, now that it and all around it are made."""
        workbench = self.workbench
        PointerRules(self)  # it hears every event: none while all is made
        workbench.checks.found.connect(self._on_problems_found)
        workbench.canvas.news.picture_requested.connect(lambda: self.host.ask("exporting.picture"))
        workbench.canvas.news.layout_changed.connect(partial(update_edit_actions, self))
        workbench.canvas.selection.changed.connect(partial(update_edit_actions, self))
        workbench.rooms.changed.connect(partial(update_edit_actions, self))
        self.message_area.lie_over(workbench.canvas.viewport())
        self.message_area.covers.connect(workbench.leave_free)
        self.message_area.shown.connect(workbench.uncover)
        self.update_actions()
        self.start_page.paint_pictures()

    def start(self, path: Path | None) -> None:
        """Begin with a project, or with the start page; offer what was lost the last time."""
        self.lazy.is_laid_out = True
        if self.lazy.is_done:
            self.workbench.restore(self.fontMetrics().height())
        is_project = path is None or path.suffix.lower() in (SUFFIX, *PICTURES)
        if path is not None and not is_project and not self.lazy.is_done:
            once = Qt.ConnectionType.SingleShotConnection  # who opens it is there only then
            self.lazy.completed.connect(lambda: self.files.open(path), once)
        elif path is not None:
            self.files.open(path)
        self.offer_recovery()

    def offer_recovery(self) -> None:
        """Offer work that was not saved when the program ended without warning."""
        offer_recovery(self)

    def flush(self) -> None:
        """Put all work on the disk."""
        if self.files.document is not None:
            self.files.document.flush()

    # What the actions ask for

    def open_settings(self) -> None:
        """Show the settings."""
        open_settings(self)

    def reset_panels(self) -> None:
        """Put the panels back to where they were at first."""
        self.settings.forget_window()
        self.workbench.reset(self.fontMetrics().height())
        self.actions_by_name["minimap"].setChecked(self.settings.is_minimap_shown)

    def show_problems(self) -> None:
        """Check now, and show the problems."""
        self.workbench.checks.ask()
        self.workbench.checks.start()
        self.workbench.panels.show(self.workbench.problems)

    def update_actions(self) -> None:
        """Let those actions be used that have something to do."""
        is_open = self.files.document is not None
        names = ("save", "save_as", "close", "check")
        self.actions_by_name.enable(is_open, *names)
        self.lazy.enable(is_open)
        update_edit_actions(self)

    # What happens

    def _on_document_changed(self, document: Document | None) -> None:
        self.lazy.finish()
        self.messages.leave_project()
        self.running.follow(document)
        self.toolbar.setVisible(document is not None)
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
        can_compare = document is not None and document.path is not None and document.is_modified
        self.actions_by_name.enable(can_compare, "compare")

    def _on_problems_found(self, problems: Sequence[Diagnostic]) -> None:
        document = self.files.document
        is_open = document is not None
        worst = problems[0].severity if problems else ""
        shown = (len(problems), worst, is_open, self.look.theme)
        if shown == self._shown_problems:
            return  # as after most keys: nothing has changed on the toolbar
        self._shown_problems = shown
        style_check(self.actions_by_name["check"], problems, self.look.theme, is_open=is_open)
        size_toolbar(self.toolbar)

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
        fit_icons(self.pages)
        self._show_check()

    def _show_check(self) -> None:
        self._on_problems_found(self.workbench.checks.problems if self.lazy.is_done else [])
        dress_toolbar(self.toolbar)

    def _say(self) -> None:
        """Tell what depends on more than the language."""
        self._show_title()
        self.update_actions()
        self._shown_problems = ()
        self._show_check()

    # Closing

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the words on the toolbar where there is room for them."""
        super().resizeEvent(event)
        size_toolbar(self.toolbar)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc closes the newest message, where it means nothing else."""
        if event.key() != Qt.Key.Key_Escape or not self.message_area.close_newest():
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask what is to become of work that is not saved; then remember the window's shape."""
        document = self.files.document
        if not self._may_close and document is not None and document.is_modified:
            event.ignore()
            self.files.guard(self.close_now)
            return
        self.settings.set_state("geometry", self.saveGeometry())
        is_complete = self.lazy.is_done
        self.lazy.stop()
        if is_complete:
            self.workbench.panels.remember()
        self.settings.write()
        self.hide()  # what is running takes a moment to stop
        if self.services.made_running is not None:
            self.running.close()
        if is_complete:
            self.workbench.retire()
        if self.files.document is not None:
            self.files.document.close()
        super().closeEvent(event)

    def close_now(self) -> None:
        """Close without asking."""
        self._may_close = True
        self.close()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take a project that is dragged onto the window."""
        project_in(event, self.files)

    def dropEvent(self, event: QDropEvent) -> None:
        """Open a project that is dropped onto the window."""
        path = project_in(event, self.files)
        if path is not None:
            self.files.open(path)
