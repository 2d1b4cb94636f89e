"""What stands on the floor around the robots on the screen, and tells the robots of it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.wire.messages import SURROUNDINGS, Surroundings, Thing
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.project.surroundings import KEY, MOST_THINGS, kept_things, replaced, to_keep
from nep_studio.ui.edits import OpenProject
from nep_studio.ui.host import Host
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.document_files import Files

OFTEN_MS = 100
"""While something is dragged, robots are told where it is so often."""


class Floor(QObject):
    """Things that the project keeps, and visitors, who only come for a moment.

    ``changed`` tells that they are others, or elsewhere.
    """

    changed = Signal()

    def __init__(self, files: Files, runner: Runner, parent: QObject) -> None:
        super().__init__(parent)
        self._runner = runner
        self._kept: list[Thing] = []
        self._kept_of: object = None
        """The project that keeps them, and how often what it keeps had changed then."""
        self._visitors: dict[str, Thing] = {}
        self._held: Thing | None = None
        self._has_told = False
        self._told: list[Thing] = []
        self._project = OpenProject(files, self)
        self._soon = QTimer(self, singleShot=True, interval=OFTEN_MS)
        self._soon.timeout.connect(self._tell)
        self._project.changed.connect(self._on_project_changed)
        files.document_changed.connect(self._on_document_changed)
        runner.connected.connect(self._on_connected)
        self._on_project_changed()

    @property
    def has_room(self) -> bool:
        """Whether there is a project that can keep one thing more."""
        return self._project.editor is not None and len(self._kept) < MOST_THINGS

    @property
    def things(self) -> list[Thing]:
        """All that stands there now, where it is now."""
        there = [*self._kept, *self._visitors.values()]
        return replaced(there, self._held) if self._held is not None else there

    def find(self, thing_id: str) -> Thing | None:
        """The thing of an id."""
        return next((thing for thing in self.things if thing.id == thing_id), None)

    # What the project keeps

    def add(self, thing: Thing) -> None:
        """Keep a new thing."""
        self._keep([*self._kept, thing], tr("place a thing"))

    def change(self, thing: Thing, label: str = "") -> None:
        """Keep a thing as it is from now on; a visitor is only shown so."""
        self._held = None
        if thing.id in self._visitors:
            self.show(thing)
        else:
            self._keep(replaced(self._kept, thing), label or tr("change a thing"))

    def remove(self, thing_id: str) -> None:
        """Take a thing away."""
        self._held = None
        if thing_id in self._visitors:
            self.hide(thing_id)
        else:
            left = [thing for thing in self._kept if thing.id != thing_id]
            self._keep(left, tr("take a thing away"))

    def hold(self, thing: Thing) -> None:
        """Show a thing where it is dragged to, before it is put down there."""
        self._held = thing
        self._on_things_changed()

    # Visitors

    def show(self, visitor: Thing) -> None:
        """Let something be there that the project does not keep, or be elsewhere."""
        self._visitors[visitor.id] = visitor
        self._on_things_changed()

    def hide(self, visitor_id: str) -> None:
        """Let a visitor go."""
        if self._visitors.pop(visitor_id, None) is not None:
            self._on_things_changed()

    # What happens

    def _keep(self, things: Iterable[Thing], label: str) -> None:
        editor = self._project.editor
        if editor is None:
            return
        kept = list(things)
        if kept != self._kept:
            editor.apply(SetExtra(KEY, to_keep(kept)), label)
        self._on_project_changed()

    def _on_project_changed(self) -> None:
        editor = self._project.editor
        of = None if editor is None else (editor.project, editor.project.extra_revision)
        if of == self._kept_of:
            return
        self._kept_of = of
        kept = kept_things(editor.project) if editor is not None else []
        if kept != self._kept:
            self._kept, self._held = kept, None
            self._on_things_changed()

    def _on_document_changed(self, _document: object) -> None:
        self._visitors.clear()
        self._on_things_changed()  # also that there is a project, or none, is news

    def _on_things_changed(self) -> None:
        self.changed.emit()
        if not self._soon.isActive():
            self._soon.start()

    def _on_connected(self) -> None:
        self._has_told, self._told = False, []
        self._tell()

    def _tell(self) -> None:
        """Tell the robots, unless they know; of nothing only when there was something."""
        things = self.things
        if things == self._told and (self._has_told or not things):
            return
        if self._runner.send(SURROUNDINGS, Surroundings(things=things)):
            self._has_told, self._told = True, things


def floor_of(host: Host) -> Floor:
    """The one floor, made when it is first asked for."""
    files, runner = host.services.files, host.services.runner
    return host.shared(Floor, lambda: Floor(files, runner, runner))
