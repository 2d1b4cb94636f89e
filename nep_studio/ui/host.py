"""What a plugin sees of the window, and what a plugin is: neither knows the other's insides.

A plugin is a folder in ``ui/plugins`` whose package has one object ``plugin``. The window finds
the folders by themselves, asks each once for its ``Parts``, and puts them where they belong. They
stay as long as the window: in another language their words are told again, in place
(``nep_studio/ui/labels.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar

if TYPE_CHECKING:
    from PySide6.QtWidgets import QMenu, QStatusBar, QWidget

    from faults import Words
    from nep_studio.ui.actions import Actions, Keys
    from nep_studio.ui.canvas.editing.menu import Section
    from nep_studio.ui.services import Services
    from nep_studio.ui.workbench.side_panels import AreaName, OwnHistory
    from nep_studio.ui.workbench.workbench import Workbench

Shared = TypeVar("Shared")
MenuName = Literal["file", "edit", "view", "run", "robots", "help"]


class Host(Protocol):
    """The window, as far as a plugin may know it."""

    @property
    def services(self) -> Services:
        """The files, the messages, what runs, the settings and the look."""

    @property
    def widget(self) -> QWidget:
        """What dialogs lie over."""

    @property
    def workbench(self) -> Workbench:
        """Where the project is worked on: its canvas, its problems, its panels."""

    @property
    def actions(self) -> Actions:
        """All actions by name."""

    @property
    def menus(self) -> Mapping[str, QMenu]:
        """The menus of the menu bar by name."""

    @property
    def status_bar(self) -> QStatusBar:
        """The line at the lower edge, which is hidden as long as nobody shows it."""

    def show_panel(self, widget: QWidget) -> None:
        """Show a panel, on top of the others of its area."""

    def ask(self, command: str, *values: Any) -> Any:
        """Let another plugin do what it offers by this name; None when nobody offers it."""

    def shared(self, kind: type[Shared], make: Callable[[], Shared]) -> Shared:
        """The one object of a kind that several plugins share, made when one first asks for it."""


@dataclass(frozen=True)
class NewAction:
    """An action, its menu and its place there; without a menu it is in the palette of commands.

    ``words`` and ``tip`` are English templates: the window tells them, in each language. ``name``
    is its own among all actions, ``icon_name`` a picture in ``resources/icons``.
    It stands behind, or before, the action of the name ``after`` or ``before``, else at the
    end, in the ``order`` of the plugins.
    """

    name: str
    words: Words
    do: Callable[[], object]
    icon_name: str = ""
    keys: Keys | tuple[Keys, ...] = ()
    tip: Words = ""
    menu: MenuName | Literal[""] = ""
    after: str = ""
    before: str = ""


@dataclass(frozen=True)
class NewPanel:
    """A panel beside the canvas, or a page in its place; ``title`` is an English template.

    ``icon_name`` is a picture in ``resources/icons``. The widget's property ``help_page`` is the
    page of the help that F1 opens there. It hears nothing while it is hidden. A page with a
    ``history`` is asked when somebody undoes something while it is shown; beside one that
    ``has_own_robot`` the stage would show it a second time.
    """

    widget: QWidget
    title: Words
    icon_name: str
    area: AreaName
    is_shown: bool = False
    history: OwnHistory | None = None
    has_own_robot: bool = False


@dataclass(frozen=True)
class Parts:
    """What a plugin brings.

    ``menu_sections`` add entries to the menu of the canvas. ``commands`` are what others may ask
    for by name (``Host.ask``), as ``"<plugin>.<what>"``.
    """

    panel: NewPanel | None = None
    actions: Sequence[NewAction] = ()
    menu_sections: Sequence[Section] = ()
    commands: Mapping[str, Callable[..., object]] = field(default_factory=dict)


@dataclass(frozen=True)
class Plugin:
    """One panel or tool.

    ``make`` gives its parts for a window. ``order`` says where its tab and its menu entries stand
    among those of the others. ``modules`` of its package are loaded one at a time before ``make``
    is called, so that the window, which is there already, never waits long. The actions of one
    that ``needs_project`` can be used while a project is open.
    """

    name: str
    make: Callable[[Host], Parts]
    order: int = 1000
    modules: Sequence[str] = ()
    needs_project: bool = False
