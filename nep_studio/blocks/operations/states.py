"""Adds, renames and deletes the states of a program and what leads from one to another."""

from __future__ import annotations

import itertools

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.places import InStack
from nep_studio.blocks.states import (
    BEGINS,
    DONE,
    GO,
    TRANSITIONS,
    Machine,
    machine_of,
    machines_of,
    modes_of,
)

from .moving import Point
from .wrapping import add_part

TREE, TREE_BEGINNING = "tree.tree", "tree.sequence"
MACHINE = "machine.1"


def free_state_name(editor: Editor, machine: str) -> str:
    """A name that no state of a machine has yet, such as "waiting 2"."""
    usual = str(editor.language.definitions[BEGINS].beginning("state"))
    names = itertools.chain([usual], (f"{usual} {number}" for number in itertools.count(2)))
    taken = _states(editor, machine)
    return next(name for name in names if name not in taken)


def add_state(editor: Editor, name: str, machine: str, page: str, at: Point) -> str:
    """Add what begins with a state, as one step; gives the block. Raises EditRefused.

    The first state of a machine is the one in which the program begins.
    """
    name = _checked(editor, name, machine, is_new=False)
    known = next((one for one in _machines(editor) if one.name == machine), None)
    if known is not None and known.states.get(name):
        raise EditRefused(_TWICE, checklist=(_OTHER_NAME,), name=name)
    with editor.transaction("add a state"):
        block = editor.create(BEGINS, editor.new_stack(page, *at))
        editor.apply(SetField(block, "state", name))
        if known is None or not known.first:
            add_part(editor, block, "first")
        _name_machine(editor, block, machine)
    return block


def add_arrow(editor: Editor, start: str, end: str, machine: str, page: str, at: Point) -> str:
    """Let the program go from a state to another one when all is done, as one step.

    Gives the block. Raises EditRefused.
    """
    with editor.transaction("add an arrow"):
        block = editor.create(DONE, editor.new_stack(page, *at))
        editor.apply(SetField(block, "state", start))
        editor.apply(SetField(block, "target", end))
        _name_machine(editor, block, machine)
    return block


def rename_state(editor: Editor, machine: str, old: str, new: str) -> None:
    """Give a state another name in all blocks of the program, as one step; raises EditRefused."""
    new = _checked(editor, new, machine, is_new=new.strip() != old)
    if new == old:
        return
    project, language = editor.project, editor.language
    with editor.transaction("rename a state"):
        for block in list(project.blocks.values()):
            if machine_of(project, language, block) != machine:
                continue
            for key, name in list(modes_of(project, language, block)):
                if name == old:
                    editor.apply(SetField(block.id, key, new))


def delete_arrow(editor: Editor, block_id: str) -> None:
    """Delete what leads to a state: a transition with its blocks, or "go to the state" alone."""
    block = editor.project.blocks.get(block_id)
    if block is None or block.type not in (*TRANSITIONS, GO):
        raise EditRefused("This arrow is not there any more.", checklist=("Choose another arrow.",))
    count = 1 if block.type == GO else len(editor.project.stack_of(block_id).body)
    editor.apply(DeleteBlocks(block_id, count), "delete an arrow")


def delete_state(editor: Editor, machine: str, name: str) -> None:
    """Delete a state: what begins with it, and the transitions from and to it, as one step.

    Other rules that go to it or ask for it stay as they are. Raises EditRefused.
    """
    project, language = editor.project, editor.language
    with editor.transaction("delete a state"):
        for block in list(project.blocks.values()):
            is_hat = block.type == BEGINS or block.type in TRANSITIONS
            if not is_hat or machine_of(project, language, block) != machine:
                continue
            if name in dict(modes_of(project, language, block)).values():
                editor.apply(DeleteBlocks(block.id, len(project.stack_of(block.id).body)))


def add_tree(editor: Editor, page: str, at: Point) -> str:
    """Begin a behaviour tree, as one step; gives its first block. Raises EditRefused."""
    with editor.transaction("add a behaviour tree"):
        place = editor.new_stack(page, *at)
        block = editor.create(TREE, place)
        editor.create(TREE_BEGINNING, InStack(place.stack, 1))
    return block


_TWICE = "There is a state “{name}” already."
_OTHER_NAME = "Give each state a name of its own."


def _checked(editor: Editor, name: str, machine: str, *, is_new: bool) -> str:
    """A name without spaces around it, if a state can have it."""
    name = name.strip()
    if not name:
        raise EditRefused("A state needs a name.", checklist=("Write its name.",))
    if is_new and name in _states(editor, machine):
        raise EditRefused(_TWICE, checklist=(_OTHER_NAME,), name=name)
    return name


def _machines(editor: Editor) -> tuple[Machine, ...]:
    return machines_of(editor.project, editor.language)


def _states(editor: Editor, machine: str) -> set[str]:
    """The names of the states of a machine, those of blocks that are switched off too."""
    project, language = editor.project, editor.language
    return {
        name
        for block in project.blocks.values()
        if machine_of(project, language, block) == machine
        for _, name in modes_of(project, language, block)
    }


def _name_machine(editor: Editor, block: str, machine: str) -> None:
    if machine:
        add_part(editor, block, "machine")
        editor.apply(SetField(block, MACHINE, machine))
