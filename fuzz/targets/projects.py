"""What strangers send: a project, a picture with one inside, and somebody's Python."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fuzz.formats import png_changed, python_changed
from fuzz.mutations import json_changed
from fuzz.target import SEEDS, Feed, Target
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project


def _language() -> Language:
    from nep_studio.run.installation import studio_language

    return studio_language()


def _looked_at(project: Project, language: Language, folder: Path) -> None:
    """What the window does with a project that was opened: shows, checks, saves it, writes it."""
    from nep_studio.blocks.errors import BlocksError
    from nep_studio.blocks.files import from_bytes, to_bytes
    from nep_studio.blocks.generate.program import generate_program
    from nep_studio.blocks.own_animations import own_animations
    from nep_studio.blocks.own_gestures import own_gestures, own_recordings
    from nep_studio.project.kept_files import recogniser_file, take_files
    from nep_studio.project.surroundings import kept_things
    from nep_studio.run.installation import all_problems

    kept_things(project)
    own_animations(project)
    own_gestures(project)
    own_recordings(project)
    recogniser_file(project)
    take_files(project)
    assert all(isinstance(block_type, str) for block_type in project.first_blocks)
    saved = to_bytes(project)
    again = from_bytes(saved, "again.nep", language)
    assert to_bytes(again) == saved, "saved and opened again, it is another project"
    all_problems(project, language, folder)
    try:
        text = generate_program(project, language).text
    except BlocksError:
        return
    compile(text, "program", "exec", dont_inherit=True)


@contextmanager
def nep(folder: Path) -> Iterator[Feed]:
    """A project's file."""
    from nep_studio.blocks.files import load

    language, path = _language(), folder / "project.nep"

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        _looked_at(load(path, language), language, folder)

    yield feed


@contextmanager
def pack(folder: Path) -> Iterator[Feed]:
    """A pack of own blocks: taken into a library, used in a project, and updated there."""
    from nep_studio.blocks.editor import Editor
    from nep_studio.blocks.errors import EditRefused
    from nep_studio.blocks.operations.copying import bring_definitions
    from nep_studio.blocks.operations.packing import definitions_in, is_outdated, update
    from nep_studio.blocks.packs import from_bytes, to_bytes
    from nep_studio.project.library import read_pack

    language, path = _language(), folder / "blocks.nepblocks"
    usual = from_bytes((SEEDS / "pack" / "wave.nepblocks").read_bytes(), "wave", language)

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        read = read_pack(path, language)
        assert to_bytes(from_bytes(to_bytes(read), "again", language)) == to_bytes(read)
        editor = Editor(Project("Uses them"), language)
        for one in (usual, read):
            with contextlib.suppress(EditRefused):  # too many own blocks, or too far outside
                bring_definitions(editor, definitions_in(one, language, one.about.offers))
                if is_outdated(editor.project, read):
                    update(editor, read)
        _looked_at(editor.project, language, folder)

    yield feed


@contextmanager
def png(folder: Path) -> Iterator[Feed]:
    """A picture with a project inside: PNG or SVG."""
    from nep_studio.blocks.files import from_bytes
    from nep_studio.project.picture_files import project_bytes_from

    language, path = _language(), folder / "picture"

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        found = project_bytes_from(path)
        if found is not None:
            from_bytes(found, "picture.png", language)

    yield feed


@contextmanager
def python(folder: Path) -> Iterator[Feed]:
    """Somebody's Python, applied to an empty project and to one that says it almost."""
    from nep_studio.blocks.files import from_bytes, to_bytes
    from nep_studio.blocks.from_python.reading import scratch_of
    from nep_studio.blocks.from_python.updating import update_from_python
    from nep_studio.blocks.generate.program import generate_program

    language = _language()
    based = from_bytes((SEEDS / "nep" / "karate.nep").read_bytes(), "karate.nep", language)
    bases = (Project("Empty"), based)

    def feed(data: bytes) -> None:
        text = data.decode(errors="surrogateescape")
        refused: list[Exception] = []
        for base in bases:
            editor = scratch_of(base, language)
            try:
                update_from_python(editor, text)
            except FaultError as error:
                refused.append(error)
                continue
            from_bytes(to_bytes(editor.project), "p.nep", language)
            compile(generate_program(editor.project, language).text, "p", "exec", dont_inherit=True)
        if refused:
            raise refused[0]

    from faults import FaultError

    yield feed


TARGETS = {
    one.name: one
    for one in (
        Target("nep", nep, json_changed),
        Target("pack", pack, json_changed),
        Target("png", png, png_changed),
        Target("python", python, python_changed),
    )
}
