"""Project files: the same bytes each time, nothing lost, and kind words for whatever is wrong."""

from __future__ import annotations

import json
import os
import sys

import pytest
from block_building import B, build, karate
from hypothesis import given, settings
from hypothesis import strategies as st

from nep_studio.blocks.checks import check
from nep_studio.blocks.edits import RenameProject
from nep_studio.blocks.errors import CodeRefused, ProjectFileError
from nep_studio.blocks.files import LARGEST_BYTES, load, save
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from nep_studio.blocks.reading import from_bytes
from nep_studio.blocks.text import sentence
from nep_studio.blocks.writing import to_bytes


def refusal(data: bytes, language) -> str:
    with pytest.raises(ProjectFileError) as refused:
        from_bytes(data, "karate.nep", language)
    assert refused.value.sentence.startswith("karate.nep ")
    assert refused.value.checklist
    return refused.value.sentence


def changed(language, change) -> bytes:
    """The karate file with something changed in its JSON."""
    data = json.loads(to_bytes(karate(language).project))
    change(data, {block["id"]: block for block in data["blocks"]})
    return json.dumps(data, indent=1).encode()


def test_a_project_is_loaded_as_it_was_saved(language, tmp_path):
    project = karate(language).project
    path = tmp_path / "karate.nep"

    save(project, path)
    loaded = load(path, language)

    assert path.read_bytes() == to_bytes(project) == to_bytes(loaded)
    assert loaded.parents == project.parents and loaded.blocks == project.blocks
    assert loaded.new_id("b") not in project.blocks | project.stacks
    assert os.listdir(tmp_path) == ["karate.nep"]


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

    assert "unchanged" in refused.value.sentence
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


def test_files_that_are_not_there_or_no_files_are_told(language, tmp_path):
    with pytest.raises(ProjectFileError, match=r"no\.nep cannot be opened: no such file"):
        load(tmp_path / "no.nep", language)
    with pytest.raises(ProjectFileError, match="is not a file"):
        load(tmp_path, language)


def test_a_huge_file_is_refused_before_it_is_read_as_json(language, tmp_path):
    path = tmp_path / "huge.nep"
    with path.open("wb") as file:
        file.truncate(LARGEST_BYTES + 1)

    with pytest.raises(ProjectFileError, match=r"huge\.nep is too large: more than 20 MB"):
        load(path, language)


def test_a_file_cut_off_anywhere_is_refused(language):
    data = to_bytes(karate(language).project)

    for length in range(0, len(data) - 2, 7):
        assert "karate.nep" in refusal(data[:length], language)


@settings(max_examples=200, deadline=None)
@given(st.data())
def test_a_file_with_damaged_bytes_is_refused_or_is_a_program(language, data):
    content = bytearray(to_bytes(karate(language).project))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))

    try:
        project = from_bytes(bytes(content), "karate.nep", language)
    except ProjectFileError as refused:
        assert refused.sentence.startswith("karate.nep ")
    else:
        assert to_bytes(from_bytes(to_bytes(project), "x.nep", language)) == to_bytes(project)


def loop(data, blocks):
    data["blocks"] += [
        {"id": "b90", "type": "control.forever", "bodies": {"do": ["b91"]}},
        {"id": "b91", "type": "control.forever", "bodies": {"do": ["b90"]}},
    ]


def two_parents(data, blocks):
    data["pages"]["behaviour"][0]["body"].append(data["pages"]["behaviour"][1]["body"][1])


def set_in(block_type, key, value):
    def change(data, blocks):
        block = next(b for b in blocks.values() if b["type"] == block_type)
        block[key] = {**block.get(key, {}), **value} if isinstance(value, dict) else value

    return change


def at_top(key, value):
    def change(data, blocks):
        data[key] = value

    return change


def add_block(entry):
    def change(data, blocks):
        data["blocks"].append(entry)

    return change


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (at_top("format", "scratch"), "is not a NEP Studio project"),
        (at_top("version", 99), "was saved by a newer NEP Studio"),
        (at_top("version", "1"), "at version: Expected int, got str"),
        (at_top("version", None), "at version: Expected int, got null"),
        (at_top("name", "x\nimport os"), "the project's name: This text must be one line"),
        (at_top("pages", {"somewhere": []}), "there is no page “somewhere”"),
        (at_top("pages", []), "at pages: Expected object, got array"),
        (at_top("blocks", {}), "at blocks: Expected array, got object"),
        (at_top("variables", [{"id": "v1", "name": ""}]), "A name needs at least one letter"),
        (at_top("variables", [{"id": "v1", "name": "a"}] * 2), "this id is there twice"),
        (loop, "block b90: the block is inside itself"),
        (two_parents, "the block is in two places"),
        (add_block({"id": "b90", "type": "robot.do"}), "block b90: the block is in no stack"),
        (add_block({"id": "b 90", "type": "robot.do"}), "'b 90' is not an id"),
        (add_block({"id": "b90"}), "needs an id and a type"),
        (add_block({"id": "b90", "type": "x\ny"}), "type is not a name"),
        (add_block({"id": "b3", "type": "robot.do"}), "b3: this id is there twice"),
        (set_in("control.together", "bodies", {"do.1": ["b77"]}), "“b77” is named by"),
        (set_in("control.together", "bodies", {"do.3": ["b3"]}), "in two places"),
        (set_in("control.together", "groups", {"part": 1}), "is there 1 times: 2 to 20 can be"),
        (set_in("control.together", "groups", {"part": 10**6}), "is there 1000000 times"),
        (set_in("control.together", "groups", {"other": 2}), "has no part “other”"),
        (set_in("robot.do", "fields", {"posture": 5}), "“posture”: A text is needed here"),
        (set_in("robot.do", "fields", {"wings": "x"}), "has no field “wings”"),
        (set_in("robot.do", "fields", {"posture": None}), "Expected "),
        (set_in("robot.do", "disabled", "yes"), "at disabled: Expected bool, got str"),
        (set_in("robot.do", "comment", 5), "at comment: Expected str, got int"),
        (set_in("variable.change", "fields", {"amount": 1e300}), "number is too large"),
        (set_in("robot.do", "new", json.loads("[" * 200 + "]" * 200)), "nested too deep"),
    ],
)
def test_what_is_wrong_with_a_file_is_told_with_its_place(language, change, told):
    assert told in refusal(changed(language, change), language)


def test_the_line_of_a_wrong_block_is_told(language):
    data = to_bytes(karate(language).project).replace(b'"posture_stand"', b"12")
    line = next(n for n, text in enumerate(data.splitlines(), 1) if b"posture" in text)

    assert f"at line {line}, block b4: “posture”" in refusal(data, language)


@pytest.mark.parametrize("number", ["1e400", "-1e400", "9" * 400])
def test_numbers_without_end_are_refused_with_their_line(language, number):
    data = to_bytes(karate(language).project).replace(b'"amount":1', b'"amount":' + number.encode())
    line = next(n for n, text in enumerate(data.splitlines(), 1) if b"amount" in text)

    told = refusal(data, language)
    assert f"at line {line}" in told and "too large" in told


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity", "nan"])
def test_numbers_that_json_does_not_have_are_refused_with_their_line(language, word):
    data = to_bytes(karate(language).project).replace(b'"amount":1', b'"amount":' + word.encode())
    line = next(n for n, text in enumerate(data.splitlines(), 1) if b"amount" in text)

    assert f"at line {line}: this is not how" in refusal(data, language)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "ends too early"),
        (b"PK\x03\x04", "this is not how a project is written"),
        (b"\x89PNG\r\n", "this is not how a project is written"),
        (b"print('hello')", "this is not how a project is written"),
        (b"[]", "is not a NEP Studio project"),
        (b"null", "is not a NEP Studio project"),
        (b'{"format": "nep-studio-project"}', "missing required field"),
        (b'"\xed\xa0\x80"', "not text in UTF-8"),
        (b"[" * 1_000_000, "nested too deep"),
        (b'{"a":' * 1_000_000, "nested too deep"),
        (b'{"format": "nep-studio-project", "version": 1e400}', "too large"),
    ],
)
def test_files_of_another_kind_are_refused(language, data, told):
    assert told in refusal(data, language)


def test_shapes_that_no_hand_could_make_are_refused(language):
    plain = {"format": "nep-studio-project", "version": 1, "name": "x"}

    def told(*blocks, body):
        entry = {**plain, "pages": {"behaviour": [{"id": "s1", "x": 0, "y": 0, "body": body}]}}
        return refusal(json.dumps({**entry, "blocks": blocks}).encode(), language)

    hat, do = {"id": "b1", "type": "event.started"}, {"id": "b2", "type": "robot.do"}
    text = {"id": "b3", "type": "text.text"}
    say = {"id": "b4", "type": "robot.say", "inputs": {"text": "b2"}}
    walk = {"id": "b4", "type": "robot.walk", "inputs": {"forward": "b3"}}
    assert "goes above it" in told(hat, do, body=["b2", "b1"])
    assert "goes into a slot" in told(hat, text, body=["b1", "b3"])
    assert "goes into a slot" in told(do, text, body=["b3", "b2"])
    assert "Only a block that gives a value" in told(do, say, body=["b4"])
    assert "needs a number" in told(text, walk, body=["b4"])


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

    project = from_bytes(changed(language, change), "karate.nep", language)

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
    plain = {"format": "nep-studio-project", "version": 1, "name": "x"}
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
