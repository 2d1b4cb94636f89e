"""What the help card says about a block: its kind, its places, its Python."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from itertools import islice

from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.slots import RESULTS
from nep_studio.blocks.text import sentence
from nep_studio.ui.canvas.fields.editors import hint_of
from nep_studio.ui.words import tr

from .palette.entries import Stock, does, python

MOST_CHOICES = 8
MOST_INSIDE = 200
"""A block with more blocks inside shows the Python of a fresh one: that is soon made and read."""


def card_text(editor: Editor, block_id: str) -> str:
    """All about a block, as rich text."""
    project, language = editor.project, editor.language
    definition = language.definitions[project.blocks[block_id].type]
    parts = [f"<h3>{escape(sentence(project, language, block_id))}</h3>"]
    parts += [f"<p>{escape(text)}</p>" for text in _about(definition)]
    places = "".join(f"<li>{escape(words)}</li>" for words in _places(editor, block_id))
    if places:
        parts.append(f"<p>{escape(tr('Its places:'))}</p><ul>{places}</ul>")
    code = _python(editor, block_id)
    if code:
        parts.append(f"<p>{escape(tr('In Python:'))}</p>")
        parts.append(f"<pre dir='ltr' style='white-space: pre-wrap'>{escape(code)}</pre>")
    return "".join(parts)


def _about(definition: Definition) -> Iterator[str]:
    yield from (text for text in does(definition) if text)
    yield shape_words(definition)
    flags = {
        "in_loop": tr("It belongs inside a loop."),
        "stands": tr("The robot must stand for it."),
        "stands_up": tr("The robot stands afterwards."),
        "rests": tr("The robot rests afterwards, and cannot move until it wakes up."),
        "silent": tr("It is for people who read the program: the robot does nothing."),
    }
    yield from (told for flag, told in flags.items() if flag in definition.flags)
    yield tr("Blocks like this are in “{category}”.", category=definition.category.title)


def shape_words(definition: Definition) -> str:
    """What such blocks are for, by their shape."""
    if definition.is_last:
        return tr("It ends what is above it: no block comes after it.")
    if definition.shape == "reporter":
        result = tr(RESULTS[definition.result or "any"])
        return tr("It is a value to put into a place of another block: {result}.", result=result)
    return {
        "hat": tr("It begins a stack: the blocks below it belong to it."),
        "c": tr("It holds other blocks, and decides when or how often they run."),
        "boolean": tr("It answers yes or no, in a place with the same pointed shape."),
    }.get(definition.shape, tr("It is one step: when it is done, the block below it follows."))


def _places(editor: Editor, block_id: str) -> Iterator[str]:
    """Each place once, with what it takes."""
    block = editor.project.blocks[block_id]
    definition = editor.language.definitions[block.type]
    told: set[str] = set()
    for key, slot in definition.keys(block.groups):
        if slot.name not in told:
            told.add(slot.name)
            choices = list(editor.language.choices_of(slot, block, key).values())
            yield _place(slot, choices)


def _place(slot: Slot, choices: list[str]) -> str:
    if not choices:
        return hint_of(slot)
    shown = ", ".join(choices[:MOST_CHOICES])
    more = ", …" if len(choices) > MOST_CHOICES else ""
    return f"{hint_of(slot)} ({shown}{more})"


def _python(editor: Editor, block_id: str) -> str:
    project = editor.project
    inside = project.within([block_id])
    if next(islice(inside, MOST_INSIDE, None), None) is None:
        return python(project, editor.language, block_id)
    stock = Stock(editor)
    return python(stock.project, stock.language, stock.sample(project.blocks[block_id].type))
