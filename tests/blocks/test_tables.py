"""Tables: the Python that their blocks make, what it does, and blocks again."""

from __future__ import annotations

import pytest
from block_building import B, build, held, read_program, share_variables

from nep_core.errors import ValueRefused
from nep_core.program.tables import change_at, has_key, names_in, set_at, table_of, value_at
from nep_core.program.values import as_text, is_same, length_of, list_with
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from nodes.cognitive.failures import failure_of

NAMES = ("out", "ages", "who", "n")
OUT, AGES, WHO, NUMBER = (f"v{number}" for number in range(1, 5))


def get(variable):
    return B("variable.get", {"variable": variable})


def slots(block_type, /, **values):
    """A block whose slots hold values or blocks."""
    block = B(block_type)
    for key, value in values.items():
        (block.inputs if isinstance(value, B) else block.fields)[key] = value
    return block


def put(variable, value):
    block = slots("variable.set", value=value)
    block.fields["variable"] = variable
    return block


def table(*entries):
    """A block of a table with keys and values."""
    block = B("table.create", groups={"entry": len(entries)})
    for number, entry in enumerate(entries, 1):
        for name, value in zip(("key", "value"), entry, strict=True):
            (block.inputs if isinstance(value, B) else block.fields)[f"{name}.{number}"] = value
    return block


def listed(*items):
    block = B("list.create", groups={"item": len(items)})
    for number, item in enumerate(items, 1):
        (block.inputs if isinstance(item, B) else block.fields)[f"item.{number}"] = item
    return block


def at(key, inside=None):
    return slots("table.get", table=inside or get(AGES), key=key)


def change(key, amount=1):
    return slots("table.change", table=get(AGES), key=key, amount=amount)


def name_with(extreme, inside=None):
    return B("table.name_with", {"extreme": extreme}, {"table": inside or get(AGES)})


TRUE = B("logic.truth", {"truth": "true"})
ANNA_AND_BEN = put(AGES, table(("Anna", 3), ("Ben", 5)))


def written(language, *chain, shared=False):
    """The program of a rule; its Python becomes blocks, and the same Python again."""
    editor = build(language, [B("event.started"), *chain], variables=NAMES)
    if shared:
        share_variables(editor)
    text = generate_program(editor.project, language).text
    read = read_program(text, language, Project())
    assert generate_program(read, language).text == text
    assert not [block for block in read.blocks.values() if block.type.startswith("code.")]
    return text


def lines(language, *chain):
    body = written(language, *chain).split("def when_started():\n")[1].split("\n\n\n")[0]
    return [line[4:] for line in body.splitlines()]


def run(language, *chain):
    """What the variables hold after a rule."""
    text = written(language, *chain, shared=True)
    return held(started(text))


def started(text):
    """The names of a program after its rule."""
    names = {}
    exec(compile(text.replace("\nbehavior.run()\n", "\n"), "program.py", "exec"), names)
    names["when_started"]()
    return names


@pytest.mark.parametrize(
    ("block", "line"),
    [
        (put(OUT, at("Anna")), 'out = ages["Anna"]'),
        (
            put(OUT, slots("table.get_or", table=get(AGES), key="Emma", otherwise=0)),
            'out = ages.get("Emma", 0)',
        ),
        (put(OUT, slots("table.has", table=get(AGES), key="Anna")), 'out = "Anna" in ages'),
        (put(OUT, slots("table.names", table=get(AGES))), "out = list(ages)"),
        (put(OUT, slots("table.values", table=get(AGES))), "out = list(ages.values())"),
        (put(OUT, name_with("max")), "out = max(ages, key=ages.get)"),
        (put(OUT, name_with("min")), "out = min(ages, key=ages.get)"),
        (put(OUT, slots("table.length", table=get(AGES))), "out = len(ages)"),
        (put(OUT, slots("table.is_empty", table=get(AGES))), "out = len(ages) == 0"),
        (put(OUT, slots("table.copy", table=get(AGES))), "out = dict(ages)"),
        (slots("table.set", table=get(AGES), key="Anna", value=4), 'ages["Anna"] = 4'),
        (slots("table.take", table=get(AGES), key="Anna"), 'del ages["Anna"]'),
        (change("Anna"), 'ages["Anna"] = ages.get("Anna", 0) + 1'),
    ],
)
def test_a_block_of_tables_is_one_plain_line(language, block, line):
    assert lines(language, ANNA_AND_BEN, block) == ['ages = {"Anna": 3, "Ben": 5}', line]


def test_votes_are_counted_and_told(language):
    votes = [put(AGES, table()), change("red"), change("blue"), change("red")]

    after = run(language, *votes, put(OUT, slots("text.join", **{"item.1": get(AGES)})))

    assert after["out"] == "red: 2, blue: 1"


def test_a_table_is_gone_through_by_its_names(language):
    loop = B("control.for_each", {"variable": WHO}, {"list": slots("table.names", table=get(AGES))})
    loop.bodies = {"do": [slots("variable.change", amount=at(get(WHO)))]}
    loop.bodies["do"][0].fields["variable"] = NUMBER

    assert run(language, ANNA_AND_BEN, put(NUMBER, 0), loop)["n"] == 8
    assert "for who in ages:" in lines(language, ANNA_AND_BEN, put(NUMBER, 0), loop)


def test_a_variable_that_a_block_takes_for_a_table_begins_as_an_empty_one(language):
    assert "\nprogram = Variables(ages={})\n" in written(language, change("Anna"))
    assert run(language, change("Anna"))["ages"] == {"Anna": 1}


def test_lists_and_tables_in_each_other_are_plain_places(language):
    people = put(AGES, listed(table(("name", "Anna"), ("points", listed(1, 2)))))
    first = slots("list.get", number=1, list=get(AGES))
    points = slots("list.get", number=2, list=at("points", first))
    numbers = put(WHO, listed(listed(1, 2), listed(3, 4)))
    inner = slots("list.get", number=1, list=slots("list.get", number=2, list=get(WHO)))
    rows = slots("list.set", number=1, list=slots("list.get", number=2, list=get(WHO)), value=9)

    assert lines(language, people, put(OUT, at("name", first)))[1] == 'out = ages[0]["name"]'
    assert run(language, people, put(OUT, points))["out"] == 2
    assert lines(language, numbers, put(OUT, inner), rows)[1:] == [
        "out = who[1][0]",
        "who[1][0] = 9",
    ]


def test_of_names_with_the_same_value_the_first_that_was_put_in_is_given(language):
    equal = put(AGES, table(("Anna", 3), ("Ben", 5), ("Emma", 5.0), ("Clara", 3)))
    texts = put(AGES, table(("Anna", "tea"), ("Ben", "milk"), (2, "Tee")))

    assert run(language, equal, put(OUT, name_with("max")))["out"] == "Ben"
    assert run(language, equal, put(OUT, name_with("min")))["out"] == "Anna"
    assert run(language, texts, put(OUT, listed(name_with("max"), name_with("min"))))["out"] == [
        "Anna",
        2,
    ]


def test_the_name_of_a_value_is_asked_of_a_function_where_python_does_something_else(language):
    truths = put(AGES, table((TRUE, 1), ("Anna", 3), (1, 0)))
    inner = put(WHO, listed(table(("Anna", 3), ("Ben", 5))))
    first = slots("list.get", number=1, list=get(WHO))

    assert lines(language, truths, put(OUT, name_with("max")))[1:] == [
        "out = name_with_largest(ages)"
    ]
    after = run(language, truths, put(OUT, listed(name_with("max"), name_with("min"))))["out"]
    assert after == ["Anna", 1] and after[1] is not True
    assert run(language, put(AGES, table((TRUE, 1))), put(OUT, name_with("min")))["out"] is True
    assert lines(language, inner, put(OUT, name_with("min", first)))[1:] == [
        "out = name_with_smallest(who[0])"
    ]
    assert run(language, inner, put(OUT, name_with("min", first)))["out"] == "Anna"


@pytest.mark.parametrize(
    "winner",
    [
        "max(votes, key=votes.get)",
        "max(votes.keys(), key=votes.get)",
        "max(votes, key=lambda name: votes[name])",
    ],
)
def test_the_winner_as_pupils_write_it_becomes_the_block(language, winner):
    text = PUPILS.format(winner)

    read = read_program(text, language, Project())

    types = [block.type for block in read.blocks.values()]
    assert "table.name_with" in types and not [one for one in types if one.startswith("code.")]
    assert "    winner = max(votes, key=votes.get)\n" in generate_program(read, language).text


@pytest.mark.parametrize(
    "winner",
    [
        "max(votes, key=lambda name: -votes[name])",
        "max(votes, key=lambda name, other=1: votes[name])",
        "max(votes, key=lambda votes: votes[votes])",
        "max(votes, key=votes.get, default=0)",
        "max(votes, key=len)",
        "max(sorted(votes), key=votes.get)",
    ],
)
def test_what_only_looks_like_the_winner_stays_python(language, winner):
    text = PUPILS.format(winner)

    read = read_program(text, language, Project())

    assert not [one for one in read.blocks.values() if one.type == "table.name_with"]
    assert winner in generate_program(read, language).text


PUPILS = """
from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("Votes")


@behavior.when_started
def vote():
    votes = {{"Anna": 3, "Ben": 5}}
    winner = {}
    nao.say(winner)


behavior.run()
"""


def test_one_is_another_key_than_true_and_two_is_the_same_as_a_fraction(language):
    half = B("math.arithmetic", {"operation": "divide", "a": 4, "b": 2})
    after = run(
        language,
        put(AGES, table((1, "one"), (TRUE, "yes"), (2, "two"))),
        put(OUT, listed(at(1), at(TRUE), at(half), slots("table.names", table=get(AGES)))),
        put(WHO, slots("text.join", **{"item.1": get(AGES)})),
    )

    assert after["out"] == ["one", "yes", "two", [1, True, 2]] and after["out"][3][1] is True
    assert after["who"] == "1: one, true: yes, 2: two"


def test_a_truth_is_one_key_however_it_is_asked_for(language):
    votes = put(AGES, table((TRUE, 1), ("Anna", 3)))
    whoever = put(WHO, table(("key", TRUE)))
    asked = put(OUT, at(slots("table.get", table=get(WHO), key="key")))

    assert run(language, votes, change(TRUE), put(OUT, at(TRUE)))["out"] == 2
    assert run(language, votes, whoever, asked)["out"] == 1
    names = run(language, votes, change(TRUE), put(OUT, slots("table.names", table=get(AGES))))
    assert names["out"] == [True, "Anna"]


def test_a_number_is_a_plain_key_in_any_program(language):
    blocks = [put(AGES, table((1, "one"))), change(2, 5), put(OUT, at(1)), put(WHO, at(TRUE))]

    assert lines(language, *blocks)[:3] == [
        'ages = {1: "one"}',
        "ages[2] = ages.get(2, 0) + 5",
        "out = ages[1]",
    ]
    with pytest.raises(ValueRefused):
        run(language, *blocks)


def test_own_blocks_take_tables(language):
    editor = Editor(Project(), language)
    given = editor.new_parameter("ages", "table")
    own = editor.add_procedure(["count", given], gives_value=False)
    ages = editor.add_variable("ages")
    inner = slots("table.change", table=B(f"my.parameter.{own}.{given.id}"), key="Anna", amount=1)
    call = slots(f"my.call.{own}", **{given.id: get(ages)})
    build(language, [B(f"my.define.{own}"), inner], editor=editor)
    build(language, [B("event.started"), put(ages, table(("Anna", 3))), call], editor=editor)
    share_variables(editor)
    text = generate_program(editor.project, language).text

    assert held(started(text))["ages"] == {"Anna": 4}
    assert generate_program(read_program(text, language, Project()), language).text == text


def test_what_two_rules_add_at_the_same_time_is_whole(language):
    rules = [[B("event.started"), change("red")], [B("event.gesture"), change("red")]]
    editor = build(language, *rules, variables=NAMES)

    text = generate_program(editor.project, language).text

    assert text.count('with at_once: program.ages["red"] = program.ages.get("red", 0) + 1') == 2


@pytest.mark.parametrize(
    ("chain", "sentence"),
    [
        ([ANNA_AND_BEN, put(OUT, at("Emma"))], "has nothing at"),
        ([ANNA_AND_BEN, slots("table.take", table=get(AGES), key="Emma")], "has nothing at"),
        ([put(AGES, table()), put(OUT, at(listed(1)))], "Nothing can be kept under"),
        ([put(AGES, table()), put(OUT, name_with("max"))], "The table “ages” is empty"),
        ([put(WHO, table((TRUE, 1))), put(AGES, table()), put(OUT, name_with("min"))],
         "The table is empty"),
        ([put(AGES, table(("Anna", 3), ("Ben", "x"))), put(OUT, name_with("max"))],
         "It cannot be told which is larger"),
        ([put(AGES, table(("Anna", TRUE))), put(OUT, name_with("max"))],
         "It cannot be told which is larger"),
        ([put(WHO, 5), put(OUT, name_with("max", get(WHO)))], "A table belongs"),
        ([put(WHO, 5), put(OUT, at("x", get(WHO)))], "A table belongs"),
        ([put(WHO, B("event.told_value")), put(OUT, at("x", get(WHO)))], "no table here"),
        ([put(WHO, listed(1)), put(OUT, slots("table.length", table=get(WHO)))], "A table belongs"),
        ([ANNA_AND_BEN, slots("table.set", table=get(AGES), key="Anna", value="x"), change("Anna")],
         "cannot be worked out"),
        ([put(AGES, table()), slots("table.set", table=get(AGES), key="me", value=get(AGES)),
          put(OUT, slots("text.join", **{"item.1": get(AGES)}))], "goes too deep"),
    ],
)  # fmt: skip
def test_what_goes_wrong_is_a_sentence_with_what_to_do(language, tmp_path, chain, sentence):
    editor = build(language, [B("event.started"), *chain], variables=NAMES)
    text = generate_program(editor.project, language).text.replace("\nbehavior.run()\n", "\n")
    file, names = tmp_path / "program.py", {}
    file.write_text(text, encoding="utf-8")
    exec(compile(text, str(file), "exec"), names)

    with pytest.raises((ValueRefused, LookupError, TypeError, ValueError)) as error:
        names["when_started"]()

    failure = failure_of(error.value)
    assert sentence in str(failure) and failure.checklist


def test_functions_keep_one_and_true_apart_and_refuse_what_is_no_key():
    kept = table_of(1, "one", True, "yes", 1.0, "again")

    assert names_in(kept) == [1, True] and value_at(kept, 1) == "again"
    assert has_key(kept, True) and not has_key(kept, False)
    assert as_text(kept) == "1: again, true: yes" and length_of(kept) == 2
    change_at(kept, "n", 2)
    assert value_at(kept, "n") == 2 and value_at(kept, "m", 7) == 7
    with pytest.raises(ValueRefused):
        set_at(kept, [1], 2)


def test_tables_are_equal_whatever_their_order_but_not_one_and_true():
    assert is_same({"a": 1, "b": [2]}, {"b": [2.0], "a": 1})
    assert not is_same({"a": 1}, {"a": True}) and not is_same({"a": 1}, {"b": 1})
    assert not is_same({}, []) and not is_same(table_of(1, 2), table_of(True, 2))


def test_a_table_that_is_repeated_is_copied_for_each_place():
    first, second = list_with({"a": 1}, 2)

    assert first == second and first is not second


def test_what_is_surely_no_table_is_asked_and_changed_in_words_that_say_so(language):
    setting = slots("table.set", table=get(AGES), key="Anna", value=3)

    text = written(language, put(AGES, listed(1, 2)), setting, put(OUT, at("Anna")))

    assert 'set_at(ages, "Anna", 3)' in text and 'value_at(ages, "Anna")' in text
