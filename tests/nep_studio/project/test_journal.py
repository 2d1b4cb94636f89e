"""The journal of edits: a program that is killed loses nothing that a person did."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetExtra, SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.places import InBody
from nep_studio.blocks.program import Project
from nep_studio.project import journal as journal_module
from nep_studio.project.journal import Journal, recover
from nep_studio.run.installation import studio_language

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="kills with SIGKILL")


@pytest.fixture(scope="module")
def language():
    return studio_language()


@pytest.fixture
def editor(language):
    return Editor(Project("Greeting"), language)


def add_blocks(editor, count=1):
    return [
        editor.create("robot.say", editor.new_stack("behaviour", 10 * n, 20)) for n in range(count)
    ]


def abandon(journal):
    """Let go of a journal as a dead process does."""
    journal.close(keep=True)


CHILD = """
import sys
from pathlib import Path
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.program import Project
from nep_studio.project.journal import Journal
from nep_studio.run.installation import studio_language

editor = Editor(Project("Killed"), studio_language())
journal = Journal(Path(sys.argv[1]), editor, Path("somewhere.nep"))
number = 0
while True:
    block = editor.create("robot.say", editor.new_stack("behaviour", 0, 0))
    editor.apply(SetField(block, "text", f"number {number}"))
    if number % 5 == 4:
        editor.history.undo()
        editor.history.redo()
    number += 1
    sys.stdout.write(f"{number}\\n")
    sys.stdout.flush()
"""


def test_a_killed_program_loses_nothing(tmp_path, language):
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    with child:
        told = 0
        while told < 1200:
            told = int(child.stdout.readline())
        assert recover(tmp_path, language) == []
        os.kill(child.pid, signal.SIGKILL)
        told = max([told, *(int(line) for line in child.stdout if line.endswith("\n"))])

    (work,) = recover(tmp_path, language)

    assert (work.name, work.path) == ("Killed", Path("somewhere.nep"))
    texts = {block.fields["text"] for block in work.project.blocks.values()}
    assert {f"number {n}" for n in range(told)} <= texts
    assert len(work.project.blocks) <= told + 1
    work.discard()
    assert recover(tmp_path, language) == []


def test_undo_redo_and_refused_steps_are_played_again_as_they_were(tmp_path, editor, language):
    journal = Journal(tmp_path, editor)
    first, second = add_blocks(editor, 2)
    editor.apply(SetField(first, "text", "Hi"))
    editor.history.undo()
    with pytest.raises(EditRefused), editor.transaction("refused"):
        editor.apply(SetField(second, "text", "never"))
        editor.create("robot.say", InBody(first, "do", 0))
    editor.history.redo()
    editor.apply(SetField(first, "text", "Hello you"))
    abandon(journal)

    (work,) = recover(tmp_path, language)

    assert to_bytes(work.project) == to_bytes(editor.project)


def test_a_line_that_was_not_finished_is_left_out(tmp_path, editor, language):
    journal = Journal(tmp_path, editor)
    add_blocks(editor)
    before = to_bytes(editor.project)
    add_blocks(editor)
    abandon(journal)
    (edits,) = journal.folder.glob("*.edits")
    data = edits.read_bytes()
    last = data.rindex(b"\n", 0, -1) + 1

    for end in range(last + 1, len(data) - 1, 13):
        edits.write_bytes(data[:end])

        (work,) = recover(tmp_path, language)

        assert to_bytes(work.project) == before


UNREADABLE = [b"[" * 100_000, b'"\xff"', b'[{"type":' + b"[" * 100_000, b"[\xff]"]


@pytest.mark.parametrize("bad", UNREADABLE, ids=["deep", "no UTF-8", "deep inside", "no text"])
def test_a_step_that_no_decoder_can_read_ends_what_is_offered(tmp_path, editor, language, bad):
    journal = Journal(tmp_path, editor)
    add_blocks(editor)
    abandon(journal)
    (edits,) = journal.folder.glob("*.edits")
    edits.write_bytes(edits.read_bytes() + bad + b"\n")
    strange = tmp_path / "1-strange"
    strange.mkdir()
    (strange / "about.json").write_bytes(bad)

    (work,) = recover(tmp_path, language)

    assert to_bytes(work.project) == to_bytes(editor.project)


def test_the_journal_of_a_running_window_is_not_offered(tmp_path, editor, language):
    journal = Journal(tmp_path, editor)
    add_blocks(editor)

    assert recover(tmp_path, language) == []
    journal.close()
    assert list(tmp_path.iterdir()) == []


def test_a_saved_project_leaves_nothing_to_recover_until_it_is_changed(tmp_path, editor, language):
    journal = Journal(tmp_path, editor)
    add_blocks(editor)
    journal.saved(tmp_path / "greeting.nep")
    abandon(journal)

    assert recover(tmp_path, language) == []
    assert list(tmp_path.glob("*-*")) == []


def test_a_snapshot_is_made_every_so_many_steps(tmp_path, editor, language, monkeypatch):
    monkeypatch.setattr(journal_module, "STEPS_PER_SNAPSHOT", 5)
    journal = Journal(tmp_path, editor)

    for count in range(1, 14):
        add_blocks(editor)
        journal.flush()
        (snapshot,) = journal.folder.glob("*.nep")
        loaded = from_bytes(snapshot.read_bytes(), "x", language)
        assert count - len(loaded.blocks) <= 5
    abandon(journal)

    (work,) = recover(tmp_path, language)
    assert to_bytes(work.project) == to_bytes(editor.project)


def test_a_snapshot_is_made_when_the_edits_are_long(tmp_path, editor, language, monkeypatch):
    monkeypatch.setattr(journal_module, "BYTES_PER_SNAPSHOT", 2_000)
    journal = Journal(tmp_path, editor)

    for number in range(8):
        editor.apply(SetExtra("cues", f"{number}" * 900), "keep")
    sizes = [path.stat().st_size for path in journal.folder.glob("*.edits")]
    abandon(journal)
    [work] = recover(tmp_path, language)

    assert len(sizes) == 1 and sizes[0] < 4_000
    assert work.project.extra["cues"] == "7" * 900


def test_a_recovered_project_that_is_open_again_stays_recoverable(tmp_path, editor, language):
    add_blocks(editor, 3)
    journal = Journal(tmp_path, editor, unsaved=True)
    abandon(journal)

    (work,) = recover(tmp_path, language)

    assert len(work.project.blocks) == 3


def test_a_journal_that_cannot_be_read_is_left_alone_and_told(tmp_path, editor, language, caplog):
    journal = Journal(tmp_path, editor)
    add_blocks(editor)
    abandon(journal)
    (snapshot,) = journal.folder.glob("*.nep")
    snapshot.write_bytes(b"{")

    assert recover(tmp_path, language) == []

    assert snapshot.exists()
    assert "cannot be read" in caplog.text
    assert recover(tmp_path / "nowhere", language) == []


def test_a_full_disk_is_told_and_does_not_stop_the_work(tmp_path, editor, monkeypatch, caplog):
    journal = Journal(tmp_path, editor)

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "write", full)
    add_blocks(editor)
    monkeypatch.undo()

    assert "No space" in journal.error and "No space" in caplog.text
    assert len(editor.project.blocks) == 1
    journal.close()


def test_a_step_that_fits_only_in_part_is_left_out_whole(tmp_path, editor, language):
    journal = Journal(tmp_path, editor)
    add_blocks(editor, 1)
    with editor.transaction("two"):
        block = add_blocks(editor, 1)[0]
        editor.apply(SetField(block, "text", "hello"))
    before_step = [b.id for b in editor.project.blocks.values()][:1]
    abandon(journal)
    (edits,) = journal.folder.glob("*.edits")
    first, second = edits.read_bytes().splitlines()
    broken = second.replace(b'"block":"' + block.encode(), b'"block":"b999')
    assert broken != second
    edits.write_bytes(first + b"\n" + broken + b"\n")

    (work,) = recover(tmp_path, language)

    assert list(work.project.blocks) == before_step


def test_a_folder_that_is_no_journal_is_left_alone(tmp_path, language):
    folder = tmp_path / "1-1"
    folder.mkdir()
    (folder / "about.json").write_text('{"name": "x", "path": "", "unsaved": true}')

    assert recover(tmp_path, language) == []
    assert folder.exists()
