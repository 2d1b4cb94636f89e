"""The menu of a block, of a note and of the canvas, made of sections to which others can add."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QMenu

from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.operations.copying import delete
from nep_studio.blocks.operations.finding import definition_of, subjects_of
from nep_studio.blocks.operations.moving import set_aside, why_not_enclose
from nep_studio.blocks.operations.selection import Run, members, run_from, runs
from nep_studio.blocks.operations.wrapping import unwrap, why_not_wrap, wrap
from nep_studio.blocks.program import Block
from nep_studio.ui.canvas.layout.page import Hit
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.words import count_words, tr

from .notes import edit_note

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


# The lines of a menu, and what a menu is about.


def _nothing() -> None:
    """A line that opens a menu of its own does nothing itself."""


@dataclass(frozen=True)
class MenuEntry:
    """One line of a menu; ``entries`` make it a menu of its own, ``shortcut`` is only shown."""

    id: str
    label: str
    run: Callable[[], object] = _nothing
    icon: str = ""
    is_enabled: bool = True
    shortcut: str = ""
    entries: tuple[MenuEntry, ...] = ()


@dataclass(frozen=True)
class MenuPlace:
    """What a menu is about: a block that was hit, a note, or neither, and the point of the page."""

    hit: Hit | None
    at: QPointF
    note: str = ""


Section = Callable[["CanvasHost", MenuPlace], list[MenuEntry]]
"""Gives some entries of a menu; a line separates them from the others. No entries, no section."""


# What the menus of blocks, of notes and of the canvas offer.

BESIDE = 40.0
"""How far beside its stack a block is put that is taken out of it."""


def clipboard(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Copies of the selected blocks."""
    commands = canvas.commands
    return [
        MenuEntry("duplicate", tr("Duplicate"), commands.duplicate, "copy-plus", True, "Ctrl+D"),
        MenuEntry("copy", tr("Copy"), commands.copy, "copy", True, "Ctrl+C"),
        MenuEntry("cut", tr("Cut"), commands.cut, "scissors", True, "Ctrl+X"),
    ]


def structure(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Take the block out, put a block around it, or take one away from around others."""
    block = _block(canvas, place)
    definition = canvas.editor.language.definitions.get(block.type)
    entries = [
        MenuEntry("extract", tr("Take out alone"), lambda: _extract(canvas, block.id), "unlink"),
        MenuEntry("wrap", tr("Put inside"), is_enabled=_can_wrap(canvas), entries=_wraps(canvas)),
    ]
    if definition is not None and definition.shape == "c" and any(block.bodies.values()):
        entries.append(
            MenuEntry(
                "unwrap", tr("Remove, keep what is inside"), lambda: _unwrap(canvas, block.id)
            )
        )
    return [*entries, *(_unfolding(canvas, block, definition) if definition is not None else ())]


def _unfolding(canvas: CanvasHost, block: Block, definition: Definition) -> list[MenuEntry]:
    """What the plus and the minus inside the block do, also without a mouse."""
    press, entries = canvas.fields.press_button, []
    for group in definition.groups.values():
        count, words = block.groups.get(group.name, 0), group.in_words
        if block.collapsed or not words:
            continue
        if count < group.maximum:
            add = partial(press, block.id, "add", group.name, count + 1)
            label = tr("Add “{words}”", words=words)
            entries.append(MenuEntry(f"add.{group.name}", label, add, "plus"))
        elif group.maximum == 1:
            leave = partial(press, block.id, "remove", group.name, 1)
            label = tr("Leave out “{words}”", words=words)
            entries.append(MenuEntry(f"remove.{group.name}", label, leave, "minus"))
    return entries


def flags(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Switch off, fold, and comment."""
    block, commands = _block(canvas, place), canvas.commands
    open_comment = canvas.fields.open_comment
    off = tr("Switch on") if block.disabled else tr("Switch off")
    fold = tr("Unfold") if block.collapsed else tr("Fold")
    fold_icon = "unfold-vertical" if block.collapsed else "fold-vertical"
    comment = tr("Edit comment") if block.comment else tr("Add comment")
    return [
        MenuEntry("disable", off, lambda: commands.toggle("disabled"), "power", True, "Ctrl+E"),
        MenuEntry(
            "collapse", fold, lambda: commands.toggle("collapsed"), fold_icon, True, "Ctrl+M"
        ),
        MenuEntry("comment", comment, lambda: open_comment(block.id), "message-square"),
    ]


def finding(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Where what the block names is used and defined, and the page of help."""
    block = _block(canvas, place)
    project, language = canvas.editor.project, canvas.editor.language
    definition = language.definitions.get(block.type)
    entries = []
    subjects = subjects_of(project, language, block.id)
    if subjects:
        where = definition_of(project, language, subjects[0])
        entries.append(
            MenuEntry(
                "uses", tr("Find all uses"), lambda: canvas.news.uses_requested.emit(subjects[0])
            )
        )
        if where is not None and where != block.id:
            entries.append(
                MenuEntry("definition", tr("Go to its definition"), lambda: _go(canvas, where))
            )
    if definition is not None:
        help_page = definition.help
        entries.append(
            MenuEntry(
                "help",
                tr("Help"),
                lambda: canvas.news.help_requested.emit(help_page),
                "circle-question-mark",
            )
        )
    return entries


def deleting(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Delete the selected blocks, or the block with all below it."""
    block, project = _block(canvas, place), canvas.editor.project
    count = len(canvas.selection.ids)
    label = count_words(count, "Delete this block", "Delete {n} blocks")
    entries = [MenuEntry("delete", label, canvas.commands.delete, "trash-2", True, "Del")]
    below = run_from(project, block.id)
    if count == 1 and below.count > 1:
        entries.append(
            MenuEntry(
                "delete_below",
                tr("Delete this and all below"),
                lambda: _delete_run(canvas, below),
                "trash-2",
            )
        )
    return entries


def history(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Undo and redo."""
    steps, commands = canvas.editor.history, canvas.commands
    undo = tr("Undo: {step}", step=tr(steps.undo_label)) if steps.undo_label else tr("Undo")
    redo = tr("Redo: {step}", step=tr(steps.redo_label)) if steps.redo_label else tr("Redo")
    return [
        MenuEntry("undo", undo, commands.undo, "undo-2", bool(steps.undo_label), "Ctrl+Z"),
        MenuEntry("redo", redo, commands.redo, "redo-2", bool(steps.redo_label), "Ctrl+Shift+Z"),
    ]


def insertion(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Paste or write here."""
    at, commands = place.at, canvas.commands
    return [
        MenuEntry(
            "paste", tr("Paste"), lambda: commands.paste(at), "clipboard-paste", True, "Ctrl+V"
        ),
        MenuEntry("add_note", tr("Add a note"), lambda: _add_note(canvas, at), "sticky-note"),
    ]


def note(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """Write in a note, or delete it."""
    notes, note_id = canvas.notes, place.note
    return [
        MenuEntry("edit_note", tr("Write"), lambda: edit_note(canvas, note_id), "pencil"),
        MenuEntry(
            "delete_note",
            tr("Delete this note"),
            lambda: canvas.attempt(lambda: notes.delete(note_id)),
            "trash-2",
            True,
            "Del",
        ),
    ]


def arranging(canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
    """The whole page: select, tidy, look at all of it, make a picture of it."""
    commands, has_blocks = canvas.commands, bool(canvas.page_layout.chains)
    everything = tr("Select everything")
    return [
        MenuEntry("select_all", everything, commands.select_all, "", has_blocks, "Ctrl+A"),
        MenuEntry("tidy", tr("Tidy up"), commands.tidy, "sparkles", has_blocks),
        MenuEntry(
            "columns", tr("Put into columns"), lambda: commands.tidy(columns=True), "", has_blocks
        ),
        MenuEntry("fit", tr("Show everything"), canvas.sight.fit, "maximize", has_blocks),
        MenuEntry(
            "picture",
            tr("Save as picture"),
            lambda: canvas.news.picture_requested.emit(),
            "image",
            has_blocks,
        ),
    ]


BLOCK_SECTIONS: tuple[Section, ...] = (clipboard, structure, flags, finding, deleting)
NOTE_SECTIONS: tuple[Section, ...] = (note,)
PAGE_SECTIONS: tuple[Section, ...] = (history, insertion, arranging)


def _block(canvas: CanvasHost, place: MenuPlace) -> Block:
    assert place.hit is not None
    return canvas.editor.project.blocks[place.hit.block]


def _can_wrap(canvas: CanvasHost) -> bool:
    ids = canvas.selection.ids
    return bool(ids) and why_not_wrap(canvas.editor, ids) is None


def _wraps(canvas: CanvasHost) -> tuple[MenuEntry, ...]:
    """The C blocks of the page; those that nothing may follow only where nothing does."""
    editor, ids = canvas.editor, canvas.selection.ids
    chosen = runs(editor.project, ids)
    kind = editor.project.kind_of_page(canvas.page_layout.page)
    return tuple(
        MenuEntry(
            f"wrap.{each.id}",
            _said(each.parts),
            partial(_wrap, canvas, each.id),
            is_enabled=len(chosen) == 1 and not why_not_enclose(editor, each.id, chosen[0]),
        )
        for each in editor.language.definitions.values()
        if each.shape == "c" and each.page == kind
    )


def _said(parts: tuple[object, ...]) -> str:
    """The words of a sentence, with an ellipsis for each slot, up to the first body."""
    words = []
    for part in parts:
        if isinstance(part, Slot) and part.kind.name == "body":
            break
        if isinstance(part, str):
            words.append(part)
        elif isinstance(part, Slot):
            words.append("…")
    return " ".join(words) or "…"


def _wrap(canvas: CanvasHost, block_type: str) -> None:
    made: list[str] = []
    ids = canvas.selection.ids
    if canvas.attempt(lambda: made.append(wrap(canvas.editor, ids, block_type))):
        canvas.selection.set(made)


def _unwrap(canvas: CanvasHost, block: str) -> None:
    left: list[str] = []
    if canvas.attempt(lambda: left.extend(unwrap(canvas.editor, block))):
        canvas.selection.set(left)


def _extract(canvas: CanvasHost, block: str) -> None:
    """Put a block alone beside its stack; what is below it moves up."""
    index, stack = canvas.page_layout.index, canvas.editor.project.stack_of(block).id
    x, y = canvas.page_layout.corners([block]).get(block, (0.0, 0.0))
    if stack in index.rects:
        rect = index.rects[stack]
        x = rect.x - BESIDE if canvas.look.measures.is_mirrored else rect.right + BESIDE
    if canvas.attempt(lambda: set_aside(canvas.editor, Run(block, 1), (x, y))):
        canvas.selection.set([block])
        canvas.show_block(block)


def _add_note(canvas: CanvasHost, at: QPointF) -> None:
    made: list[str] = []
    if canvas.attempt(lambda: made.append(canvas.notes.add(at.x(), at.y()))):
        edit_note(canvas, made[0])


def _delete_run(canvas: CanvasHost, run: Run) -> None:
    ids = members(canvas.editor.project, run)
    canvas.attempt(lambda: canvas.news.blocks_deleted.emit(delete(canvas.editor, ids)))


def _go(canvas: CanvasHost, block: str) -> None:
    canvas.show_block(block)
    canvas.selection.set([block])


def menu_for(
    canvas: CanvasHost, hit: Hit | None, at: QPointF, sections: Iterable[Section]
) -> QMenu:
    """The menu of what was hit; the ``sections`` of others come last."""
    note = canvas.notes.hit(at) if hit is None else None
    place = MenuPlace(hit, at, note.id if note is not None else "")
    own = BLOCK_SECTIONS if hit is not None else NOTE_SECTIONS if note else PAGE_SECTIONS
    menu = QMenu(canvas.area)
    for section in (*own, *sections):
        entries = section(canvas, place)
        if entries and not menu.isEmpty():
            menu.addSeparator()
        for entry in entries:
            add(menu, entry, canvas)
    return menu


def add(menu: QMenu, entry: MenuEntry, canvas: CanvasHost) -> None:
    """Put an entry into a menu; the action's object name is the entry's id."""
    if entry.entries:
        inner = menu.addMenu(entry.label)
        for each in entry.entries:
            add(inner, each, canvas)
        action = inner.menuAction()
    else:
        action = menu.addAction(f"{entry.label}\t{entry.shortcut}".rstrip("\t"))
        action.triggered.connect(lambda: entry.run())
    action.setObjectName(entry.id)
    action.setEnabled(entry.is_enabled)
    if entry.icon:
        action.setIcon(icon(entry.icon, canvas.look.theme))
