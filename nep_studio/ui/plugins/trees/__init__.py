"""Behaviour trees from files of BehaviorTree.CPP and into them, in the File menu."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from faults import Text, reason_of
from faults.files import as_file_name, whole_file
from nep_studio.blocks.errors import BlocksError
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.messages import Message
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import tr

SUFFIX = ".xml"


def choose_import(host: Host) -> None:
    """Ask for a file of behaviour trees, and make blocks of it."""
    if host.services.document is not None:
        title, folder = tr("Import a behaviour tree"), host.services.settings.last_folder
        kinds = (tr("Behaviour trees (*.xml *.btproj)"), tr("All files (*)"))
        ask_for_path(host.widget, title, folder, partial(import_file, host), kinds=kinds)


def import_file(host: Host, path: Path) -> bool:
    """Make blocks of a file, on the page that is shown; whether that went well, which is told."""
    from nep_studio.blocks.tree_files.elements import read_file
    from nep_studio.blocks.tree_files.reading import import_trees

    document, messages = host.services.document, host.services.messages
    if document is None:
        return False
    shown = host.workbench.canvas.page_layout.page
    is_behaviour = document.project.kind_of_page(shown) == "behaviour"
    try:
        root = read_file(path)
        made = import_trees(document.editor, root, shown if is_behaviour else "behaviour")
    except OSError as error:
        title, steps = tr("The file could not be read"), (tr("Choose another file."),)
        _tell_disk(host, title, steps, error)
        return False
    except BlocksError as error:
        messages.tell_error(error)
        return False
    host.workbench.canvas.show_block(made.trees[0])
    _tell_done(host, tr("Imported “{name}”.", name=path.name), made.told)
    return True


def choose_export(host: Host) -> None:
    """Ask where the behaviour trees are to be saved, and save them there."""
    document = host.services.document
    if document is not None:
        settings = host.services.settings
        folder = document.folder if document.path is not None else settings.last_folder
        start = folder / f"{as_file_name(document.title)}{SUFFIX}"
        title = tr("Export the behaviour trees")
        ask_for_path(host.widget, title, start, partial(export_file, host), "save", _kinds())


def export_file(host: Host, path: Path) -> bool:
    """Write the trees of the open project; whether that went well, which is told."""
    from nep_studio.blocks.tree_files.writing import export_trees

    document = host.services.document
    if document is None:
        return False
    try:
        made = export_trees(document.project, document.editor.language)
        with whole_file(path) as file:
            file.write(made.text.encode())
    except OSError as error:
        steps = (tr("Is there room on the disk?"), tr("Choose another folder."))
        _tell_disk(host, tr("The file could not be written"), steps, error)
        return False
    except BlocksError as error:
        host.services.messages.tell_error(error)
        return False
    _tell_done(host, tr("Exported “{name}”.", name=path.name), made.told)
    return True


def _kinds() -> tuple[str, ...]:
    return tr("Behaviour trees (*.xml)"), tr("All files (*)")


def _tell_done(host: Host, words: str, told: tuple[Text, ...]) -> None:
    """Tell that it is done, with what is not the same on the other side."""
    if not told:
        host.services.messages.confirm(words)
        return
    steps = tuple(map(tr, told))
    sentence = tr("Not everything could be taken over:")
    host.services.messages.tell(Message("warning", words, sentence, steps))


def _tell_disk(host: Host, title: str, steps: tuple[str, ...], error: OSError) -> None:
    sentence = tr("The computer says: {reason}.", reason=tr(reason_of(error)))
    host.services.messages.tell(Message("error", title, sentence, steps, str(error)))


def make(host: Host) -> Parts:
    """The two actions."""
    actions = [
        NewAction(
            "import_trees",
            "Import a behaviour tree…",
            lambda: choose_import(host),
            "list-tree",
            menu="file",
            after="copy_python",
        ),
        NewAction(
            "export_trees",
            "Export the behaviour trees…",
            lambda: choose_export(host),
            "list-tree",
            menu="file",
            after="import_trees",
        ),
    ]
    return Parts(actions=actions)


plugin = Plugin("trees", make, order=95, needs_project=True)
