"""Finds the plugins, shows each the window as a ``Host``, and puts its parts where they belong."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, cast

from PySide6.QtWidgets import QMenu, QStatusBar, QWidget

from nep_studio.ui import plugins
from nep_studio.ui.host import NewAction, NewPanel, Parts, Plugin, Shared

if TYPE_CHECKING:
    from nep_studio.ui.actions import Actions
    from nep_studio.ui.services import Services
    from nep_studio.ui.workbench.workbench import Workbench

    from .main_window import MainWindow


class WindowHost:
    """What the plugins see of a window: see ``Host``."""

    services: Services
    """The files, the messages, what runs, the settings and the look."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._shared: dict[type, object] = {}
        self._commands: dict[str, Callable[..., object]] = {
            "start_page.tour_taken": lambda: window.start_page.tour_offer.hide()
        }
        self.with_a_project: list[str] = []
        """The actions of plugins that need an open project."""

    @property
    def widget(self) -> QWidget:
        """What dialogs lie over."""
        return self._window

    @cached_property
    def workbench(self) -> Workbench:
        """Where the project is worked on, made now if it is not there yet."""
        return self._window.workbench

    @cached_property
    def actions(self) -> Actions:
        """All actions by name."""
        return self._window.actions_by_name

    @property
    def menus(self) -> Mapping[str, QMenu]:
        """The menus of the menu bar by name."""
        return self._window.menus

    @property
    def status_bar(self) -> QStatusBar:
        """The line at the lower edge."""
        return self._window.statusBar()

    def show_panel(self, widget: QWidget) -> None:
        """Show a panel, on top of the others of its area."""
        self.workbench.panels.show(widget)

    def ask(self, command: str, *values: Any) -> Any:
        """Do what a plugin offers by this name; all plugins are made now if it is not known yet."""
        if command not in self._commands:
            self._window.lazy.finish()
        do = self._commands.get(command)
        return None if do is None else do(*values)

    def shared(self, kind: type[Shared], make: Callable[[], Shared]) -> Shared:
        """The one object of a kind, made when it is first asked for."""
        if kind not in self._shared:
            self._shared[kind] = make()
        return cast("Shared", self._shared[kind])

    # What the window does with what plugins bring

    def take(self, plugin: Plugin, parts: Parts) -> None:
        """Put the parts of a plugin into the window."""
        if parts.panel is not None:
            self._add_panel(parts.panel)
        for new in parts.actions:
            self._add_action(new)
            if plugin.needs_project:
                self.with_a_project.append(new.name)
        self.workbench.canvas.menu_sections += parts.menu_sections
        self._commands |= parts.commands

    def _add_panel(self, new: NewPanel) -> None:
        panels = self.workbench.panels
        panels.add(new.widget, new.title, new.icon_name, new.area, is_shown=new.is_shown)
        if new.has_own_robot:
            panels.rooms.with_own_robot.add(new.widget)
        if new.history is not None:
            panels.rooms.histories[new.widget] = new.history
            new.history.history_changed.connect(self._window.update_actions)

    def _add_action(self, new: NewAction) -> None:
        action = self.actions.add(
            new.name, new.words, new.do, icon_name=new.icon_name, keys=new.keys, tip=new.tip
        )
        if not new.menu:
            return
        menu = self.menus[new.menu]
        entries = menu.actions()
        names = [entry.objectName() for entry in entries]
        place = len(entries)
        if new.before and new.before in names:
            place = names.index(new.before)
        elif new.after and new.after in names:
            place = names.index(new.after) + 1
        if place < len(entries):
            menu.insertAction(entries[place], action)
        else:
            menu.addAction(action)


def names_of_plugins() -> list[str]:
    """The packages in the folder of plugins, wherever that is; in a frozen program, too."""
    return [found.name for found in pkgutil.iter_modules(plugins.__path__) if found.ispkg]


def add_plugins(host: WindowHost) -> Iterator[None]:
    """Add all plugins in their order: a little at each step."""
    found: list[Plugin] = []
    for name in names_of_plugins():
        found.append(import_module(f"{plugins.__name__}.{name}").plugin)
        yield
    for plugin in sorted(found, key=lambda one: (one.order, one.name)):
        for module in plugin.modules:
            import_module(f"{plugins.__name__}.{plugin.name}.{module}")
            yield
        host.take(plugin, plugin.make(host))
        yield
