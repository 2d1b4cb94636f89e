"""Files that are cut, damaged, hostile or of another kind: each refused with its place."""

from __future__ import annotations

import json

import pytest
from block_building import changed_karate, karate
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.errors import ProjectFileError
from nep_studio.blocks.files import from_bytes, to_bytes


def refusal(data: bytes, language) -> str:
    with pytest.raises(ProjectFileError) as refused:
        from_bytes(data, "karate.nep", language)
    assert str(refused.value.sentence).startswith("karate.nep ")
    assert refused.value.checklist
    return str(refused.value.sentence)


def test_a_file_cut_off_anywhere_is_refused(language):
    data = to_bytes(karate(language).project)

    for length in range(0, len(data) - 2, 7):
        assert "karate.nep" in refusal(data[:length], language)


@given(st.data())
def test_a_file_with_damaged_bytes_is_refused_or_is_a_program(language, data):
    content = bytearray(to_bytes(karate(language).project))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))

    try:
        project = from_bytes(bytes(content), "karate.nep", language)
    except ProjectFileError as refused:
        assert str(refused.sentence).startswith("karate.nep ")
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
        (at_top("version", "1"), "at version: a whole number belongs here, not a text"),
        (at_top("version", None), "at version: a whole number belongs here, not nothing"),
        (at_top("name", "x\nimport os"), "the project's name: This text must be one line"),
        (at_top("pages", {"somewhere": []}), "there is no page “somewhere”"),
        (at_top("pages", []), "at pages: a group of values belongs here, not a list"),
        (at_top("blocks", {}), "at blocks: a list belongs here, not a group of values"),
        (at_top("variables", [{"id": "v1", "name": ""}]), "A name needs at least one letter"),
        (at_top("variables", [{"id": "v1", "name": "a"}] * 2), "this id is there twice"),
        (at_top("variables", [{"id": f"v{n}", "name": f"n{n}"} for n in range(1001)]), "too many"),
        (
            at_top("variables", [{"id": "v1", "name": "a"}, {"id": "v2", "name": "a"}]),
            "“a” already",
        ),
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
        (set_in("robot.do", "fields", {"posture": None}), "belongs here, not nothing"),
        (set_in("robot.do", "disabled", "yes"), "at disabled: yes or no belongs here, not a text"),
        (set_in("robot.do", "comment", 5), "at comment: a text belongs here, not a whole number"),
        (set_in("variable.change", "fields", {"amount": 1e300}), "number is too large"),
        (set_in("robot.do", "new", json.loads("[" * 200 + "]" * 200)), "nested too deep"),
    ],
)
def test_what_is_wrong_with_a_file_is_told_with_its_place(language, change, told):
    assert told in refusal(changed_karate(language, change), language)


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
        (b'{"format": ', "ends too early"),
        (b'{"format": "nep-st', "ends too early"),
        (b'\xef\xbb\xbf{"format": "\xe3\x81', "ends too early"),
        (b'{"format": "\\u30', "ends too early"),
        (b'{"format": nep}', "this is not how a project is written"),
        (b"PK\x03\x04", "this is not how a project is written"),
        (b"\x89PNG\r\n", "this is not how a project is written"),
        (b"print('hello')", "this is not how a project is written"),
        (b"[]", "is not a NEP Studio project"),
        (b"null", "is not a NEP Studio project"),
        (b'{"format": "nep-studio-project"}', "is missing"),
        (b'"\xed\xa0\x80"', "not text in UTF-8"),
        (b"[" * 1_000_000, "nested too deep"),
        (b'{"a":' * 1_000_000, "nested too deep"),
        (b'{"format": "nep-studio-project", "version": 1e400}', "too large"),
    ],
)
def test_files_of_another_kind_are_refused(language, data, told):
    assert told in refusal(data, language)


def test_shapes_that_no_hand_could_make_are_refused(language):
    plain = {"format": "nep-studio-project", "version": 2, "name": "x"}

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
