"""Programs to operate on, and the promise that every operation keeps."""

from __future__ import annotations

from contextlib import contextmanager

from block_building import B, build

from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.program import Project


def say(text: str) -> B:
    return B("robot.say", {"text": text})


def rule(language, *blocks: B, name: str = "karate"):
    """An editor with one rule, and the ids of its chain."""
    editor = build(language, [B("event.gesture", {"gesture": name}), *blocks], variables=("x",))
    return editor, list(editor.project.pages["behaviour"][0].body)


@contextmanager
def one_step(editor):
    """What is done inside is one step of undo; undone and redone it gives the same bytes."""
    before, steps = to_bytes(editor.project), count_of_steps(editor)

    yield

    after = to_bytes(editor.project)
    assert count_of_steps(editor) == steps + 1
    assert editor.history.undo()
    assert to_bytes(editor.project) == before
    assert editor.history.redo()
    assert to_bytes(editor.project) == after
    assert_sound(editor)


def count_of_steps(editor) -> int:
    return len(editor.history._undo)


def assert_sound(editor) -> None:
    """Check that the program is one that could have been loaded from a file."""
    data = to_bytes(editor.project)
    loaded = from_bytes(data, "x.nep", editor.language)
    assert to_bytes(loaded) == data
    assert loaded.parents == editor.project.parents


def texts(project: Project, chain) -> list[str]:
    """What the blocks of a chain say, by their texts, or their types."""
    blocks = [project.blocks[block] for block in chain]
    return [str(block.fields.get("text", block.type)) for block in blocks]
