"""Makes what the first page does not need, a part at a time, or at once when it is needed."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QTimer, Signal

from nep_studio.ui.actions_icons import fit_icons
from nep_studio.ui.running.actions import follow_running

if TYPE_CHECKING:
    from nep_studio.ui.help.desk import HelpDesk
    from nep_studio.ui.main_window import MainWindow
    from nep_studio.ui.main_window_workbench import Workbench
    from nep_studio.ui.running.control import RunControl

MODULES = (
    "nep_studio.blocks.program",
    "nep_studio.blocks.definitions",
    "nep_studio.blocks.editor",
    "nep_studio.studio_language",
    "nep_studio.journal",
    "nep_studio.blocks.checks",
    "nep_studio.ui.documents_opening",
    "nep_studio.blocks.generate.program",
    "nep_studio.plan",
    "nep_studio.blocks.typing_in.vocabulary",
    "nep_studio.ui.canvas.commands",
    "nep_studio.ui.canvas.page",
    "nep_studio.ui.canvas.context_menu",
    "nep_studio.ui.canvas.dropping_in",
    "nep_studio.ui.canvas.fields.editors",
    "nep_studio.ui.canvas.canvas",
    "nep_studio.ui.code_pane.pane",
    "nep_studio.ui.palette.palette",
    "nep_studio.ui.main_window_workbench",
    "nep_studio.session",
    "nep_studio.ui.running.control",
    "nep_studio.help.examples",
    "nep_studio.ui.help.book",
    "nep_studio.ui.help.panel",
    "nep_studio.ui.panels.cues.panel",
    "nep_studio.ui.panels.nodes.panel",
    "nep_studio.ui.panels.network.panel",
    "nep_studio.ui.panels.robots.panel",
    "nep_studio.ui.show.mode",
    "nep_studio.ui.tour.tour",
    "nep_studio.ui.study.adding",
    "nep_studio.ui.main_window_rooms",
)
"""What the parts are made of, in an order in which none of them takes long to load."""


class Later(QObject):
    """The workbench and what stands around it, made by one step after the other.

    What runs the project is made once; the rest again each time that the window is made anew.
    ``completed`` comes when all is there.
    """

    completed = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._steps: Iterator[None] = iter(())
        self._is_working = False
        self._is_unfinished = False
        self.is_laid_out = False
        """Whether the panels are to have the sizes that the person gave them."""
        self.made_workbench: Workbench | None = None
        self.made_running: RunControl | None = None
        self.desk: HelpDesk | None = None
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

    @property
    def workbench(self) -> Workbench:
        """The workbench; when it is not there yet, all is made now."""
        if self.made_workbench is None:
            self.finish()
        assert self.made_workbench is not None
        return self.made_workbench

    @property
    def running(self) -> RunControl:
        """What runs the project, made when somebody first asks."""
        if self.made_running is None:
            from nep_studio.ui.running.control import RunControl

            self.made_running = RunControl(self._window)
        return self.made_running

    @property
    def help_desk(self) -> HelpDesk:
        """Who answers what is asked of the help."""
        self.finish()
        assert self.desk is not None
        return self.desk

    def begin(self) -> None:
        """Let everything be made anew, once it is needed."""
        self.made_workbench = None
        self._steps, self._is_unfinished = self._make(), True

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
        from nep_studio.ui.main_window_rooms import WITH_A_PROJECT

        self._window.actions_by_name.enable(is_open, *WITH_A_PROJECT)
        for panel in self.workbench.panels.all:
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
        from nep_studio.ui.main_window_rooms import add_rooms
        from nep_studio.ui.main_window_workbench import Workbench

        window = self._window
        _ = window.studio.language
        yield
        workbench = self.made_workbench = Workbench(window.studio, window.messages, window.pages)
        window.pages.addWidget(workbench)
        yield
        self.running.attach()
        follow_running(window)
        yield from add_rooms(window)
        fit_icons(workbench)
        if self.is_laid_out:
            workbench.restore(window.fontMetrics().height())
