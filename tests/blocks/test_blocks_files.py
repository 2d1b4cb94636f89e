"""Project files: the same bytes each time, nothing lost, and kind words for whatever is wrong."""

from __future__ import annotations

import json
import os
import sys

import pytest
from block_building import B, build, changed_karate, karate

from nep_studio.blocks.checks import check
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.errors import CodeRefused, ProjectFileError
from nep_studio.blocks.files import LARGEST_BYTES, from_bytes, load, save, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence

pytestmark = pytest.mark.long


def test_a_project_is_loaded_as_it_was_saved(language, tmp_path):
    project = karate(language).project
    path = tmp_path / "karate.nep"

    save(project, path)
    loaded = load(path, language)

    assert path.read_bytes() == to_bytes(project) == to_bytes(loaded)
    assert loaded.parents == project.parents and loaded.blocks == project.blocks
    assert loaded.new_id("b") not in project.blocks | project.stacks
    assert os.listdir(tmp_path) == ["karate.nep"]


@pytest.mark.parametrize(
    ("again", "groups", "fields"),
    [
        ("ignore", {"repeated": 0}, {"gesture": "karate"}),
        ("queue", {"repeated": 1}, {"gesture": "karate", "again.1": "queue"}),
    ],
)
def test_a_value_from_before_its_part_could_be_folded_unfolds_it_unless_it_is_usual(
    language, again, groups, fields
):
    hat = build(language, [B("event.gesture")]).project
    old = to_bytes(hat).replace(b'{"gesture":', b'{"again":"%s","gesture":' % again.encode())

    project = from_bytes(old, "old.nep", language)

    [block] = project.blocks.values()
    assert block.groups == groups and block.fields == fields
    assert from_bytes(to_bytes(project), "new.nep", language).blocks == project.blocks


def test_a_small_change_changes_one_line(language):
    editor = karate(language)
    before = to_bytes(editor.project).splitlines()
    editor.apply(RenameProject("Another name"))

    after = to_bytes(editor.project).splitlines()

    assert len(before) == len(after)
    assert sum(a != b for a, b in zip(before, after, strict=True)) == 1


def test_saving_does_not_lose_the_old_file_when_it_fails(language, tmp_path, monkeypatch):
    project = karate(language).project
    path = tmp_path / "karate.nep"
    save(project, path)
    before = path.read_bytes()
    project.name = "New"

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(ProjectFileError, match="no space left on device") as refused:
        save(project, path)

    assert "unchanged" in str(refused.value.sentence)
    assert path.read_bytes() == before and os.listdir(tmp_path) == ["karate.nep"]


def test_saving_into_a_folder_that_is_not_there_says_so(language, tmp_path):
    with pytest.raises(ProjectFileError, match=r"x\.nep could not be saved"):
        save(Project(), tmp_path / "nowhere" / "x.nep")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such links and modes")
def test_saving_keeps_links_and_modes(language, tmp_path):
    target, link = tmp_path / "target.nep", tmp_path / "link.nep"
    save(Project("old"), target)
    target.chmod(0o640)
    link.symlink_to(target)

    save(Project("new"), link)

    assert link.is_symlink() and load(target, language).name == "new"
    assert target.stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(sys.platform == "win32", reason="Windows lets few people make links")
def test_saving_in_a_strangers_folder_follows_no_link_that_waits_there(language, tmp_path):
    diary = tmp_path / "diary"
    diary.write_text("mine")
    folder = tmp_path / "gift"
    folder.mkdir()
    for number in (os.getpid(), os.getppid()):
        (folder / f".gift.nep.{number}.new").symlink_to(diary)

    save(Project("saved"), folder / "gift.nep")

    assert diary.read_text() == "mine"
    assert load(folder / "gift.nep", language).name == "saved"


def test_a_name_of_any_length_can_be_saved_again(language, tmp_path):
    path = tmp_path / f"{'ü' * 125}.nep"
    path.write_text("old")

    save(Project("new"), path)

    assert load(path, language).name == "new"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="nothing stops root")
def test_a_file_that_its_owner_protects_is_not_written_over(language, tmp_path):
    path = tmp_path / "master.nep"
    save(Project("the teacher's"), path)
    path.chmod(0o444)

    with pytest.raises(ProjectFileError, match="permission denied"):
        save(Project("mine"), path)

    assert load(path, language).name == "the teacher's"


def test_files_that_are_not_there_or_no_files_are_told(language, tmp_path):
    with pytest.raises(ProjectFileError, match=r"no\.nep cannot be opened: no such file"):
        load(tmp_path / "no.nep", language)
    with pytest.raises(ProjectFileError, match="is not a file"):
        load(tmp_path, language)


def test_a_huge_file_is_refused_before_it_is_read_as_json(language, tmp_path):
    path = tmp_path / "huge.nep"
    with path.open("wb") as file:
        file.truncate(LARGEST_BYTES + 1)

    with pytest.raises(ProjectFileError, match=r"huge\.nep is too large: more than 60 MB"):
        load(path, language)


def test_blocks_of_an_unknown_type_are_kept_with_everything_that_is_in_them(language):
    strange = {
        "id": "b90",
        "type": "pack.sing",
        "fields": {"song": None, "notes": [1, {"deep": 2.5}]},
        "groups": {"verse": 7},
        "inputs": {"loud": "b91"},
        "bodies": {"chorus": ["b92"]},
        "comment": "from next year",
        "new": {"key": True},
    }

    def change(data, blocks):
        data["blocks"] += [
            strange,
            {"id": "b91", "type": "pack.loudness"},
            {"id": "b92", "type": "robot.do", "colour_of_next_year": [1]},
        ]
        data["pages"]["behaviour"][0]["body"].append("b90")

    project = from_bytes(changed_karate(language, change), "karate.nep", language)

    saved = {block["id"]: block for block in json.loads(to_bytes(project))["blocks"]}
    assert saved["b90"] == strange
    assert saved["b92"]["colour_of_next_year"] == [1]
    unknown = [p for p in check(project, language) if p.kind == "unknown_block"]
    assert [p.block for p in unknown] == ["b90", "b91"]
    assert sentence(project, language, "b90") == "unknown block pack.sing"
    with pytest.raises(CodeRefused, match=r"does not know the block “pack\.sing”"):
        generate_program(project, language)


def test_a_chain_of_ten_thousand_nested_blocks_is_read_and_told_not_crashed_on(language):
    count = 10_000
    blocks = [{"id": "b0", "type": "event.started"}]
    blocks += [
        {"id": f"b{n}", "type": "control.forever", "bodies": {"do": [f"b{n + 1}"]}}
        for n in range(1, count)
    ]
    blocks.append({"id": f"b{count}", "type": "control.wait"})
    stack = {"id": "s1", "x": 0, "y": 0, "body": ["b0", "b1"]}
    plain = {"format": "nep-studio-project", "version": 2, "name": "x"}
    data = json.dumps({**plain, "pages": {"behaviour": [stack]}, "blocks": blocks}).encode()

    project = from_bytes(data, "deep.nep", language)

    assert to_bytes(from_bytes(to_bytes(project), "x.nep", language)) == to_bytes(project)
    assert "too_deep" in [problem.kind for problem in check(project, language)]
    with pytest.raises(CodeRefused, match="too deep"):
        generate_program(project, language)


def test_values_plugged_into_each_other_a_thousand_times_are_read_and_told(language):
    value = B("logic.truth")
    editor = build(language, [B("event.started"), B("control.while", inputs={"condition": value})])
    data = json.loads(to_bytes(editor.project))
    blocks = {block["id"]: block for block in data["blocks"]}
    innermost = next(b for b in blocks.values() if b["type"] == "logic.truth")
    innermost.update(type="logic.not", fields={}, inputs={"a": "n0"})
    data["blocks"] += [
        {"id": f"n{n}", "type": "logic.not", "inputs": {"a": f"n{n + 1}"}} for n in range(1000)
    ]
    data["blocks"].append({"id": "n1000", "type": "logic.truth"})

    project = from_bytes(json.dumps(data).encode(), "deep.nep", language)

    assert "too_deep" in [problem.kind for problem in check(project, language)]
    with pytest.raises(CodeRefused, match="too deep"):
        generate_program(project, language)
