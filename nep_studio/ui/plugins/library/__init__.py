"""The library of a person: own blocks that they keep, share as a pack, and take in from others."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar
from uuid import uuid4

from PySide6.QtCore import QObject, QTimer

from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.operations.packing import Updated, copies, is_outdated, mark, update
from nep_studio.blocks.packs import ENDING, Pack
from nep_studio.blocks.procedures import DEFINE, procedure_of
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from pathlib import Path

    from nep_studio.blocks.editor import Editor
    from nep_studio.project.library import Library
    from nep_studio.ui.canvas.host import CanvasHost


Done = TypeVar("Done")

MY_BLOCKS = "my"
"""The drawer of the palette with the person's own blocks."""


def make(host: Host) -> Parts:
    """The actions, in the File menu, and what the menu of an own block offers."""
    kit = LibraryKit(host)
    actions = [
        NewAction(
            "share_blocks",
            "Share these blocks…",
            kit.share,
            "share-2",
            tip="Make a file of your own blocks that others can add to their library.",
            menu="file",
            after="copy_python",
        ),
        NewAction(
            "add_pack",
            "Add a block pack…",
            kit.choose_pack,
            "puzzle",
            tip="Take blocks that somebody shared into your library.",
            menu="file",
            after="share_blocks",
        ),
    ]
    return Parts(actions=actions, menu_sections=[kit.section])


class LibraryKit(QObject):
    """What the actions do; tells when the library has newer blocks than the project."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.actions)
        self._host = host
        self._messages = host.services.messages
        self._told: dict[str, Message] = {}
        """What was told of the project that is open, by pack."""
        self._soon = QTimer(self, singleShot=True, interval=0)
        """What is told of another project comes when what was told of the last one has gone."""
        self._soon.timeout.connect(self._look)
        files = host.services.files
        files.openers[ENDING] = self.take_in
        files.document_changed.connect(self._on_document_changed)

    @property
    def library(self) -> Library:
        """The packs of the person; the palette shows them, too."""
        return self._host.workbench.helpers.palette.library

    @property
    def _editor(self) -> Editor:
        return self._host.workbench.canvas.editor

    # Keep

    def section(self, canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of the header of an own block offers besides."""
        block_type = place.hit.placed.box.type if place.hit is not None else ""
        own, project = procedure_of(block_type), canvas.editor.project
        if not block_type.startswith(DEFINE) or own not in project.procedures:
            return []
        entries = [
            MenuEntry("keep_own_block", tr("Keep in my library"), lambda: self.keep(own), "star"),
            MenuEntry("share_own_block", tr("Share…"), lambda: self.share(own), "share-2"),
        ]
        origin = project.procedures[own].origin
        pack = self.library.pack(origin.pack, canvas.editor.language) if origin else None
        if pack is not None and is_outdated(project, pack):
            version = pack.about.version
            words = tr("Update to version {version}", version=version)
            renew = MenuEntry("update_own_block", words, lambda: self.update(pack), "refresh-cw")
            return [*entries, renew]
        return entries

    def keep(self, own: str) -> None:
        """Keep an own block of the project in the library, with all that it needs."""
        editor = self._editor

        def do() -> Pack:
            pack = self.library.keep_block(editor.project, editor.language, own, new_pack_id())
            with editor.transaction("keep an own block"):
                mark(editor, pack, [own])
            return pack

        if (pack := self._attempt(do)) is not None:
            self._tell_kept(pack)

    def _tell_kept(self, pack: Pack) -> None:
        self._show_library()
        title, version = pack.title, pack.about.version
        words = tr(
            "“{title}” is in your library, as version {version}.", title=title, version=version
        )
        self._messages.confirm(words, Answer(tr("Show it"), self._open_drawer))

    # Share and take in

    def share(self, own: str = "") -> None:
        """Ask which own blocks are shared, and what is told of them."""
        from .dialog import ShareDialog

        if self._host.services.document is None or not self._editor.project.procedures:
            self._messages.refuse(
                tr("There are no blocks of your own to share."),
                (tr("Open a project that has some, or make one: in the palette, My blocks."),),
            )
            return
        host = self._host
        services = host.services
        dialog = ShareDialog(
            self._editor, self.library, services.settings, services.look.theme, own, host.widget
        )
        dialog.shared.connect(self._on_shared)
        services.studio.words_changed.connect(dialog.reject)  # it speaks the one before
        dialog.open()

    def _on_shared(self, pack: Pack, path: Path) -> None:
        self._show_library()
        words = tr("“{title}” is shared in the file {name}.", title=pack.title, name=path.name)
        self._messages.confirm(words)

    def choose_pack(self) -> None:
        """Ask for the file of a pack."""
        folder = self._host.services.settings.last_folder
        kinds = (tr("Block packs") + f" (*{ENDING})", tr("All files (*)"))
        title = tr("Add a block pack")
        ask_for_path(self._host.widget, title, folder, self.take_in, "open", kinds)

    def take_in(self, path: Path) -> None:
        """Put the pack of a file into the library, and tell what is in it."""
        language = self._host.services.language
        pack = self._attempt(lambda: self.library.take_in(path, language))
        if pack is None:
            return
        self._show_library()
        is_open = self._host.services.document is not None
        show = Answer(tr("Show them"), self._open_drawer, "primary")
        title = tr("“{title}” is in your library", title=pack.title)
        told = " ".join(told_of(pack, self._host))
        answers = (show,) if is_open else ()
        self._messages.tell(Message("success", title, told, answers=answers, outlives_project=True))
        self._look()

    def _show_library(self) -> None:
        self._host.workbench.helpers.palette.fill()

    def _open_drawer(self) -> None:
        palette = self._host.workbench.helpers.palette
        self._host.show_panel(palette)
        palette.open_drawer(MY_BLOCKS)

    # Newer versions

    def _on_document_changed(self, _document: object) -> None:
        self._told.clear()
        self._soon.start()

    def _look(self) -> None:
        """Tell of each pack of which the library has a newer version than the project."""
        document = self._host.services.document
        if document is None or not any(o.origin for o in document.project.procedures.values()):
            return
        editor = document.editor
        for pack in self.library.packs(editor.language):
            if is_outdated(editor.project, pack):
                self._tell_newer(editor, pack)

    def _tell_newer(self, editor: Editor, pack: Pack) -> None:
        if (before := self._told.get(pack.about.id)) is not None:
            self._messages.withdraw(before)
        old = min(one.origin.version for one in copies(editor.project, pack) if one.origin)
        title = tr("This project uses version {old} of “{title}”", old=old, title=pack.title)
        sentence = tr("Version {new} is in your library.", new=pack.about.version)
        renew = Answer(tr("Update"), lambda: self.update(pack), "primary")
        message = Message("info", title, sentence, answers=(renew,))
        self._told[pack.about.id] = message
        self._messages.tell(message)

    def update(self, pack: Pack) -> None:
        """Let the copies in the project be as the library has them; a person has asked for it."""
        editor = self._editor
        done = self._attempt(lambda: update(editor, pack))
        if (told := self._told.pop(pack.about.id, None)) is not None:
            self._messages.withdraw(told)
        if done is not None:
            self._tell_updated(pack, done)

    def _tell_updated(self, pack: Pack, done: Updated) -> None:
        history = self._editor.history
        step = history.position
        undo = Answer(tr("Undo"), lambda: history.position == step and history.undo())
        version = pack.about.version
        title = tr(
            "The blocks of “{title}” are version {version} now", title=pack.title, version=version
        )
        steps = tuple(self._to_look_at(done))
        if not steps:
            self._messages.confirm(title, undo)
            return
        show = Answer(tr("Show them"), lambda: self._show_calls(done.to_look_at), "primary")
        answers = (show, undo) if done.to_look_at else (undo,)
        self._messages.tell(Message("warning", title, "", steps, answers=answers))

    def _to_look_at(self, done: Updated) -> list[str]:
        steps = []
        if count := len(done.to_look_at):
            steps.append(
                count_words(
                    count,
                    "1 block that uses them has other places now: look at what is in them.",
                    "{n} blocks that use them have other places now: look at what is in them.",
                )
            )
        steps += [
            tr("“{block}” is in it no more, and stays as it was.", block=b) for b in done.left
        ]
        return steps

    def _show_calls(self, calls: tuple[str, ...]) -> None:
        canvas = self._host.workbench.canvas
        there = [call for call in calls if call in canvas.editor.project.blocks]
        if there:
            canvas.show_block(there[0])
            page = canvas.editor.project.page_of(there[0])
            canvas.selection.set(
                [one for one in there if canvas.editor.project.page_of(one) == page]
            )

    def _attempt(self, do: Callable[[], Done]) -> Done | None:
        """Do what may be refused, and tell that."""
        try:
            return do()
        except BlocksError as error:
            self._messages.tell_error(error)
            return None


def told_of(pack: Pack, host: Host) -> list[str]:
    """What a person should know of a pack that came in, in sentences."""
    from nep_studio.project.trust import python_concerns

    about = pack.about
    count = len(about.offers)
    told = [count_words(count, "It has 1 block for you.", "It has {n} blocks for you.")]
    if about.author:
        told.append(tr("It is by {author}.", author=about.author))
    if about.licence:
        told.append(tr("Its licence: {licence}.", licence=about.licence))
    if any(python_concerns(pack.project, host.services.language)):
        told.append(
            tr("There is Python in it: before that runs for the first time, you are asked.")
        )
    return told


def new_pack_id() -> str:
    """The id of a new pack, which no other has."""
    return uuid4().hex


plugin = Plugin("library", make, order=95)
