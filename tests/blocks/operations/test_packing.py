"""Own blocks as packs: out of a project into a file, into another project, and newer ones there."""

from __future__ import annotations

import json

import pytest
from block_building import B, add, build
from msgspec.structs import replace

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.errors import EditRefused, PackError
from nep_studio.blocks.files import from_bytes as project_from
from nep_studio.blocks.files import to_bytes as project_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.animations import keep_animation
from nep_studio.blocks.operations.copying import Clip, paste
from nep_studio.blocks.operations.packing import (
    definitions_in,
    is_outdated,
    mark,
    needed,
    packed,
    update,
)
from nep_studio.blocks.own_animations import JointKeys, OwnAnimation, own_animations
from nep_studio.blocks.packs import About, Pack, from_bytes, to_bytes
from nep_studio.blocks.places import InStack
from nep_studio.blocks.procedures import CALL, header_of, title
from nep_studio.blocks.program import Parameter, Project
from nep_studio.blocks.text import sentence
from nep_studio.run.installation import studio_language

SMILE = About("smile1", author="Ada", licence="CC BY 4.0")


@pytest.fixture
def author(language: Language) -> Editor:
    """A project with “greet (who)”, which calls “count” and plays the variable “greeted”."""
    editor = Editor(Project("Hello"), language)
    variable = editor.add_variable("greeted")
    count = editor.add_procedure(["count"])
    who = editor.new_parameter("who", "text")
    greet = editor.add_procedure(["greet", who])
    editor.add_procedure(["other"], place=editor.new_stack("behaviour", 0, 900))
    build(
        language,
        [B(f"my.define.{greet}"), B("robot.say", {}, {"text": said(greet, who)}), call(count)],
        [B(f"my.define.{count}"), B("variable.change", {"variable": variable})],
        editor=editor,
    )
    return editor


def said(own: str, parameter: Parameter) -> B:
    return B(f"my.parameter.{own}.{parameter.id}")


def call(own: str, **fields: str) -> B:
    return B(CALL + own, dict(fields))


def own_named(editor: Editor, words: str) -> str:
    return next(own.id for own in editor.project.procedures.values() if title(own) == words)


def share(editor: Editor, about: About = SMILE, *titles: str) -> Pack:
    chosen = [own_named(editor, words) for words in titles or ("greet (who)",)]
    pack = packed(editor.project, editor.language, chosen, about, "Smile")
    mark(editor, pack, chosen)
    return pack


def use(editor: Editor, pack: Pack, block: str, **fields: str) -> str:
    """Take a block of a pack into a project, as the palette does, and call it."""
    one = build(editor.language, editor=Editor(Project(), editor.language))
    one.project.procedures[block] = pack.from_here(pack.project.procedures[block])
    one.project.touch_procedures()
    build(editor.language, [call(block, **fields)], editor=one)
    clip = Clip(one.project, definitions_in(pack, editor.language, [block]))
    return paste(editor, clip, "behaviour", 40.0, 40.0)[0]


def again(pack: Pack, language: Language) -> Pack:
    return from_bytes(to_bytes(pack), "smile.nepblocks", language)


def test_a_pack_has_what_its_blocks_need_and_nothing_else(author):
    pack = share(author)

    assert needed(author.project, [own_named(author, "greet (who)")]) == list(
        pack.project.procedures
    )
    assert [title(own) for own in pack.project.procedures.values()] == ["count", "greet (who)"]
    assert [title(own) for own in pack.offered] == ["greet (who)"]
    assert [variable.name for variable in pack.project.variables] == ["greeted"]
    assert len(pack.project.stacks) == 2


def test_a_pack_is_the_same_after_it_was_written_and_read(author, language):
    pack = share(author)

    read = again(pack, language)

    assert read.about == pack.about
    assert to_bytes(read) == to_bytes(pack)
    assert author.project.blocks.keys() > pack.project.blocks.keys(), "the author's are their own"


def test_a_block_of_a_pack_runs_in_another_project(author, language):
    pack = again(share(author), language)
    other = Editor(Project("Other"), language)
    build(language, [B("event.started")], editor=other)

    new = use(other, pack, pack.about.offers[0], **{pack.offered[0].parts[1].id: "Ada"})

    own = own_named(other, "greet (who)")
    assert other.project.blocks[new].type == CALL + own
    assert header_of(other.project, own) and header_of(other.project, own_named(other, "count"))
    assert other.project.procedures[own].origin == pack.offered[0].origin
    assert "nao.say(who)" in generate_program(other.project, other.language).text
    assert "defined_twice" not in {one.kind for one in check(other.project, other.language)}
    other.history.undo()
    assert not other.project.procedures
    assert not other.project.variables


def test_a_second_use_brings_no_second_definition(author, language):
    pack = again(share(author), language)
    other = Editor(Project("Other"), language)

    first, second = (use(other, pack, pack.about.offers[0]) for _ in range(2))

    assert other.project.blocks[first].type == other.project.blocks[second].type
    assert len(other.project.procedures) == 2
    assert len(other.project.stacks) == 4


def test_an_own_block_of_the_same_name_stays_what_it_is(author, language):
    pack = again(share(author), language)
    other = Editor(Project("Other"), language)
    who = other.new_parameter("who", "text")
    other.add_procedure(["greet", who], place=other.new_stack("behaviour", 0, 0))

    new = use(other, pack, pack.about.offers[0])

    assert sorted(map(title, other.project.procedures.values())) == [
        "count",
        "greet (who)",
        "greet 2 (who)",
    ]
    assert other.project.blocks[new].type == CALL + own_named(other, "greet 2 (who)")


def test_stacks_of_a_pack_lie_below_what_is_there(author, language):
    pack = again(share(author), language)
    other = Editor(Project("Other"), language)
    build(language, [B("event.started"), *(B("robot.say") for _ in range(20))], editor=other)

    use(other, pack, pack.about.offers[0])

    headers = [s.y for s in other.project.stacks.values() if len(s.body) > 1 and s.y > 100]
    assert len(headers) == 2
    assert min(headers) > 21 * 40


def test_where_a_copy_is_from_is_kept_in_the_file(author, language):
    pack = share(author)
    other = Editor(Project("Other"), language)
    use(other, pack, pack.about.offers[0])

    saved = project_bytes(other.project)
    entry = next(one for one in json.loads(saved)["procedures"] if one["parts"][0] == "greet")

    assert entry["origin"] == {"pack": "smile1", "block": pack.about.offers[0], "title": "Smile"}
    assert project_bytes(project_from(saved, "p.nep", language)) == saved


def test_keys_of_an_own_block_that_nobody_knows_are_kept(author, language):
    file = json.loads(project_bytes(author.project))
    file["procedures"][0] |= {"colour": {"of": ["later"]}, "extra": 1}

    read = project_from(json.dumps(file).encode(), "p.nep", language)

    assert json.loads(project_bytes(read))["procedures"][0] == file["procedures"][0]


def as_python(pack: Pack, language: Language) -> str:
    return generate_program(pack.project, language).text


def test_out_of_a_project_that_used_it_a_pack_is_the_same(author, language):
    first = again(share(author), language)
    other = Editor(Project("Other"), language)
    build(language, [B("event.started"), B("robot.say")], editor=other)
    use(other, first, first.about.offers[0])

    own = own_named(other, "greet (who)")
    second = packed(other.project, other.language, [own], first.about, "Smile")

    assert second.about == first.about
    known = second.project.procedures
    assert {one.id: title(one) for one in known.values() if one.id in first.about.offers} == {
        one.id: title(one) for one in first.offered
    }
    assert known == first.project.procedures
    assert as_python(second, language) == as_python(first, language)


def test_an_animation_that_a_block_plays_comes_along(author, language):
    joints = {"HeadYaw": JointKeys((0.5, 1.0), (0.2, 0.0))}
    name = keep_animation(author, OwnAnimation("Nod to me", joints))
    play = B("robot.play", {"animation": name})
    header = author.project.stack_of(header_of(author.project, own_named(author, "count")))
    add(author, play, InStack(header.id, 1))
    other = Editor(Project("Other"), language)
    pack = again(share(author), language)

    use(other, pack, pack.about.offers[0])

    assert own_animations(other.project)[name].title == "Nod to me"


# A newer version


def second_version(author: Editor) -> Pack:
    """The author lets “greet” say something else, and share it as version 2."""
    say = next(b for b in author.project.blocks.values() if b.type == "robot.say")
    author.apply(SetField(say.id, "gesture", "explain"))
    return share(author, About("smile1", 2))


def test_a_newer_version_takes_the_place_of_the_copy_in_one_step(author, language):
    first = again(share(author), language)
    other = Editor(Project("Other"), language)
    parameter = first.offered[0].parts[1].id
    new = use(other, first, first.about.offers[0], **{parameter: "Ada"})
    own = own_named(other, "greet (who)")
    header = other.project.stack_of(header_of(other.project, own))
    place, before = (header.x, header.y), project_bytes(other.project)
    second = again(second_version(author), language)
    assert is_outdated(other.project, second)

    done = update(other, second)

    assert done.blocks and not done.to_look_at and not done.left
    assert not is_outdated(other.project, second)
    assert other.project.blocks[new].fields == {parameter: "Ada"}
    assert other.project.procedures[own].origin.version == 2
    stack = other.project.stack_of(header_of(other.project, own))
    assert (stack.x, stack.y) == place
    assert "explain" in [b.fields.get("gesture") for b in other.project.blocks.values()]
    assert len(other.project.procedures) == 2
    other.history.undo()
    assert project_bytes(other.project) == before


def test_calls_that_lose_a_value_are_told(author, language):
    first = again(share(author), language)
    other = Editor(Project("Other"), language)
    old = first.offered[0].parts[1].id
    new = use(other, first, first.about.offers[0], **{old: "Ada"})
    greet = own_named(author, "greet (who)")
    times = author.new_parameter("times", "number")
    pill = next(b for b in author.project.blocks.values() if b.type.startswith("my.parameter."))
    author.apply(DeleteBlocks(pill.id))
    author.change_procedure(greet, ["greet", times, "times"], gives_value=False)
    second = again(share(author, About("smile1", 2), "greet (times) times"), language)

    done = update(other, second)

    assert done.to_look_at == (new,)
    assert old not in other.project.blocks[new].fields
    assert title(other.project.procedures[own_named(other, "greet (times) times")])


def test_a_block_that_a_newer_version_has_not_stays_and_is_told(author, language):
    first = again(share(author, SMILE, "greet (who)", "other"), language)
    other = Editor(Project("Other"), language)
    for block in first.about.offers:
        use(other, first, block)
    second = again(share(author, About("smile1", 2)), language)

    done = update(other, second)

    assert done.left == ("other",)
    assert own_named(other, "other")
    assert not is_outdated(other.project, second)


def test_there_is_no_update_without_an_older_copy(author, language):
    pack = share(author)

    with pytest.raises(EditRefused, match="no older blocks"):
        update(Editor(Project(), language), pack)


# Other languages, and help


def test_an_own_block_speaks_the_languages_that_its_pack_brings(author, language):
    german = studio_language("de")
    own = author.project.procedures[own_named(author, "greet (who)")]
    parameter = own.parts[1].id
    place = "{" + parameter + "}"
    said_otherwise = {"de": f"{place} begrüßen", "en": f"please greet {place}"}
    author.replace_procedure(replace(own, sentences=said_otherwise))
    pack = share(author)
    other = Editor(Project("Other"), german)

    new = use(other, again(pack, german), pack.about.offers[0], **{parameter: "Ada"})

    assert sentence(other.project, german, new) == "Ada begrüßen"
    english = Editor(project_from(project_bytes(other.project), "p.nep", language), language)
    assert sentence(english.project, language, new) == "please greet Ada", (
        "also where it is English"
    )
    other.change_procedure(
        own_named(other, "greet (who)"),
        ["welcome", *other.project.procedures[own_named(other, "greet (who)")].parts[1:]],
        gives_value=False,
    )
    assert sentence(other.project, german, new) == "welcome Ada", "the old words are gone"


# Packs that cannot be used


def changed(pack: Pack, **keys: object) -> bytes:
    file = json.loads(to_bytes(pack))
    for key, value in keys.items():
        where, _, inside = key.partition("__")
        if inside:
            file[where][inside] = value
        else:
            file[where] = value
    return json.dumps(file).encode()


DEEP = b"[" * 5000 + b"]" * 5000


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"block_pack": {}}, "“id” is missing"),
        ({"block_pack": "x"}, "belongs here"),
        ({"block_pack__id": "../x"}, "small letters"),
        ({"block_pack__version": 0}, "whole number"),
        ({"block_pack__author": "A\nB"}, "line"),
        ({"block_pack__licence": "x" * 300}, "200 letters"),
        ({"block_pack__offers": []}, "must name its blocks"),
        ({"block_pack__offers": ["p99"]}, "not in it"),
        ({"blocks": [], "pages": {}}, "must be defined in it, once"),
    ],
)
def test_what_is_wrong_with_a_pack_is_told_with_what_to_do(author, language, keys, told):
    with pytest.raises(PackError) as refused:
        from_bytes(changed(share(author), **keys), "smile.nepblocks", language)

    assert told in str(refused.value.sentence)
    assert refused.value.checklist


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "ends too early"),
        (b"PK\x03\x04", "cannot be read"),
        (DEEP, "too deep"),
        (b"{}", "not a NEP Studio project"),
        (b" " * 4_000_001, "too large"),
    ],
)
def test_a_file_that_is_no_pack_is_told(language, data, told):
    with pytest.raises(PackError) as refused:
        from_bytes(data, "smile.nepblocks", language)

    assert told in str(refused.value.sentence)
    assert any("nepblocks" in str(step) for step in refused.value.checklist)


def test_a_project_is_no_pack(author, language):
    with pytest.raises(PackError, match="is no pack of blocks"):
        from_bytes(project_bytes(author.project), "p.nep", language)


def test_a_block_that_is_not_known_is_named(author, language):
    file = json.loads(to_bytes(share(author)))
    next(b for b in file["blocks"] if b["type"] == "robot.say")["type"] = "dance.tango"

    with pytest.raises(PackError, match=r"dance\.tango"):
        from_bytes(json.dumps(file).encode(), "smile.nepblocks", language)


def test_a_block_inside_itself_is_refused(author, language):
    file = json.loads(to_bytes(share(author)))
    stack = file["pages"]["behaviour"][0]
    stack["body"].append(stack["body"][-1])

    with pytest.raises(PackError, match="two places"):
        from_bytes(json.dumps(file).encode(), "smile.nepblocks", language)


def test_blocks_of_a_rule_do_not_belong_into_a_pack(author, language):
    file = json.loads(to_bytes(share(author)))
    file["blocks"].append({"id": "b999", "type": "event.started"})
    file["pages"]["behaviour"].append({"id": "s999", "x": 0, "y": 0, "body": ["b999"]})

    with pytest.raises(PackError, match="in no definition"):
        from_bytes(json.dumps(file).encode(), "smile.nepblocks", language)


def test_an_own_block_without_a_definition_cannot_be_shared(language):
    editor = Editor(Project(), language)
    own = editor.add_procedure(["nothing"])

    with pytest.raises(PackError, match="no “define” block"):
        packed(editor.project, editor.language, [own], SMILE, "Nothing")


def test_a_block_that_lost_its_value_cannot_be_shared(author):
    author.change_procedure(own_named(author, "greet (who)"), ["greet"], gives_value=False)

    with pytest.raises(PackError, match="not like this any more"):
        share(author, SMILE, "greet")


def test_two_blocks_with_the_same_words_cannot_be_shared(language):
    editor = Editor(Project(), language)
    own = [
        editor.add_procedure(["wave"], place=editor.new_stack("behaviour", 0, 100 * n))
        for n in range(2)
    ]

    with pytest.raises(PackError, match="called “wave”"):
        packed(editor.project, editor.language, own, SMILE, "Wave")
