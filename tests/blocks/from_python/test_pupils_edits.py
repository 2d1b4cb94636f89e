"""Python as a class writes it comes back as blocks: most of it wholly, and all of it as it was."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from tests.blocks.from_python.pupils_edits import EDITS, EXAMPLES, HELD_OUT
from tests.blocks.from_python.python_traces import trace_of

FOLDER = Path(__file__).parents[3] / "resources/examples"
CODE = {"code.lines", "code.value", "code.program"}
WANTED = 0.85
"""Of all edits, so many become blocks wholly."""
FLOORS = {"texts": 0.6, "numbers": 0.65, "names": 0.7, "stays": 0.0}
"""Of each sort so many at least; 0.8 of the others."""

HEAD = "from nep_core import Behavior, Robot, wait\n"
MADE = 'nao = Robot("NAO")\nbehavior = Behavior("T")\n'
RULE = "@behavior.when_started\ndef when_started():\n"


def program(edit: str) -> str:
    """The program of a pupil: imports on top, then what is outside of the rule, then the rule."""
    above, _, rule = edit.rpartition("\n---\n")
    lines = above.split("\n")
    imports = [line for line in lines if line.startswith(("import ", "from "))]
    outside = "\n".join(line for line in lines if line not in imports).strip("\n")
    gap = "\n\n" if outside.startswith(("def ", "class ")) else ""
    body = textwrap.indent(rule, "    ")
    top = "".join(f"{line}\n" for line in imports)
    return f"{top}{HEAD}\n{MADE}{gap}{outside}\n\n\n{RULE}{body}\n\n\nbehavior.run()\n"


def example(language, stem: str) -> Editor:
    path = FOLDER / f"{stem}.nep"
    return Editor(from_bytes(path.read_bytes(), path.name, language), language)


def edited(language, stem: str, old: str, new: str) -> tuple[Editor, str]:
    """An example, and its Python with something else in a place."""
    editor = example(language, stem)
    text = generate_program(editor.project, language).text
    assert old in text
    text = text.replace(old, new, 1)
    is_missing = "wait(" in text and not re.search(r"import .*\bwait\b", text)
    return editor, text.replace("Robot", "Robot, wait", 1) if is_missing else text


def done(text: str, monkeypatch) -> list[str]:
    """What a program does; a pause is one however it is called, and fractions are told short."""
    text = text.replace("from time import sleep\n", "from nep_core import wait as sleep\n")
    text = text.replace("import time\n", "import nep_core as time\n")
    text = text.replace("time.sleep(", "time.wait(")
    shown = trace_of(text, monkeypatch)
    return [re.sub(r"\d+\.\d+", lambda n: f"{float(n[0]):.10g}", line) for line in shown]


def is_all_blocks(language, editor: Editor, text: str, monkeypatch) -> bool:
    """Whether a text becomes blocks wholly; it must do the same in any case, and stay so."""
    before = set(editor.project.blocks)
    was = done(text, monkeypatch)
    assert not any("Error" in line for line in was), text

    update_from_python(editor, text)

    made = generate_program(editor.project, language).text
    compile(made, "program.py", "exec")
    assert done(made, monkeypatch) == was
    saved = to_bytes(editor.project)
    update_from_python(editor, made)
    assert to_bytes(editor.project) == saved
    new = [block for block in editor.project.blocks.values() if block.id not in before]
    return not any(block.type in CODE for block in new)


def kept_of(language, edits: dict[str, list[str]], monkeypatch) -> dict[str, list[str]]:
    """The edits of each sort of which something stays Python."""
    return {
        sort: [
            one
            for one in texts
            if not is_all_blocks(
                language, Editor(Project("T"), language), program(one), monkeypatch
            )
        ]
        for sort, texts in edits.items()
    }


def told(kept: dict[str, list[str]]) -> str:
    return "\n\n".join(f"{sort}:\n{one}" for sort, texts in kept.items() for one in texts)


def test_most_of_what_pupils_write_becomes_blocks(language, monkeypatch):
    kept = kept_of(language, EDITS, monkeypatch)
    kept["examples"] = [
        new
        for stem, old, new in EXAMPLES
        if not is_all_blocks(language, *edited(language, stem, old, new), monkeypatch)
    ]

    counts = {sort: len(texts) for sort, texts in EDITS.items()} | {"examples": len(EXAMPLES)}
    for sort, count in counts.items():
        assert count - len(kept[sort]) >= FLOORS.get(sort, 0.8) * count, told(kept)
    every = sum(counts.values())
    assert every - sum(map(len, kept.values())) >= WANTED * every, told(kept)


def test_most_of_what_another_class_writes_becomes_blocks(language, monkeypatch):
    kept = kept_of(language, HELD_OUT, monkeypatch)

    every = sum(map(len, HELD_OUT.values()))
    assert every - sum(map(len, kept.values())) >= WANTED * every, told(kept)


def test_there_are_enough_edits():
    assert sum(map(len, EDITS.values())) + len(EXAMPLES) >= 150
    assert sum(map(len, HELD_OUT.values())) >= 50
