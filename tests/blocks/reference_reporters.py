"""What each block that gives a value means: the reference interpreter's second half."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING

from reference_values import (
    ARITHMETIC,
    COMPARISONS,
    FUNCTIONS,
    OF_LIST,
    PROPERTIES,
    GivenUp,
    Table,
    Value,
    Wrong,
    divisor_of,
    equal,
    is_yes,
    items_of,
    kind,
    less,
    number,
    number_in,
    numbers_of,
    place,
    rounded,
    table,
    told,
    whole,
)

from nep_studio.blocks.program import Block

if TYPE_CHECKING:
    from reference_interpreter import Interpreter


def _join(run: Interpreter, block: Block) -> Value:
    count = block.groups.get("item", 0)
    return "".join(told(run.slot(block, f"item.{n}")) for n in range(1, count + 1))


def _junction(run: Interpreter, block: Block) -> Value:
    keys = ["a", "b", *(f"c.{n}" for n in range(1, block.groups.get("more", 0) + 1))]
    if run._choice(block, "junction") == "and":
        return all(is_yes(run.slot(block, key)) for key in keys)
    return any(is_yes(run.slot(block, key)) for key in keys)


def _compare(run: Interpreter, block: Block) -> Value:
    a, b = run.slot(block, "a"), run.slot(block, "b")
    return COMPARISONS[run._choice(block, "comparison")](a, b)


def _round(run: Interpreter, block: Block) -> Value:
    value = number(run.slot(block, "number"))
    ways = {"nearest": rounded, "up": math.ceil, "down": math.floor}
    return ways[run._choice(block, "way")](value)


def _constrain(run: Interpreter, block: Block) -> Value:
    value, low, high = (number(run.slot(block, key)) for key in ("number", "low", "high"))
    larger = low if value < low else value
    return high if larger > high else larger


def _arithmetic(run: Interpreter, block: Block) -> Value:
    a, b = number(run.slot(block, "a")), number(run.slot(block, "b"))
    return ARITHMETIC[run._choice(block, "operation")](a, b)


def _random(run: Interpreter, block: Block) -> Value:
    low, high = rounded(run.slot(block, "low")), rounded(run.slot(block, "high"))
    if low != high:
        raise GivenUp  # nobody can judge chance
    return low


def _random_item(run: Interpreter, block: Block) -> Value:
    items = items_of(run.slot(block, "list"))
    if not items:
        raise Wrong("no items")
    if not all(equal(item, items[0]) for item in items):
        raise GivenUp
    return items[0]


def _length(value: Value) -> int:
    return len(value) if isinstance(value, list | Table) else len(told(value))


def _letter(run: Interpreter, block: Block) -> Value:
    wanted, text = run.slot(block, "number"), str(run.slot(block, "text"))
    return text[place(wanted, "start", len(text))]


def _case(run: Interpreter, block: Block) -> Value:
    text, case = str(run.slot(block, "text")), run._choice(block, "case")
    if case != "title":
        return text.upper() if case == "upper" else text.lower()
    return re.sub(r"\S+", lambda word: word[0][0].upper() + word[0][1:].lower(), text)


def _replace(run: Interpreter, block: Block) -> Value:
    text, new, part = (str(run.slot(block, key)) for key in ("text", "new", "part"))
    return text.replace(part, new) if part else text


def _find_in_text(run: Interpreter, block: Block) -> Value:
    part, text = str(run.slot(block, "part")), str(run.slot(block, "text"))
    return text.find(part) + 1


def _filled(run: Interpreter, block: Block) -> Value:
    item, times = run.slot(block, "item"), rounded(run.slot(block, "times"))
    if times > 500:
        raise GivenUp
    if isinstance(item, list | Table):
        return [item.copy() for _ in range(times)]
    return [item] * times


def _contains(run: Interpreter, block: Block) -> Value:
    items, item = items_of(run.slot(block, "list")), run.slot(block, "item")
    return any(equal(item, one) for one in items)


def _find(run: Interpreter, block: Block) -> Value:
    item, items = run.slot(block, "item"), items_of(run.slot(block, "list"))
    return next((n for n, one in enumerate(items, 1) if equal(item, one)), 0)


def item_at(run: Interpreter, block: Block) -> tuple[list, int]:
    wanted, items = run.slot(block, "number"), items_of(run.slot(block, "list"))
    return items, place(wanted, run._choice(block, "end"), len(items))


def _get(run: Interpreter, block: Block) -> Value:
    items, index = item_at(run, block)
    return items[index]


def _take(run: Interpreter, block: Block) -> Value:
    items, index = item_at(run, block)
    return items.pop(index)


def _part(run: Interpreter, block: Block) -> Value:
    first, last = run.slot(block, "first"), run.slot(block, "last")
    items = items_of(run.slot(block, "list"))
    first, last = whole(first), whole(last)
    return [item for n, item in enumerate(items, 1) if first <= n <= last]


def _sorted(run: Interpreter, block: Block) -> Value:
    items = items_of(run.slot(block, "list"))
    kinds = {kind(item) for item in items}
    if len(kinds) > 1 or not kinds <= {"number", "text"}:
        raise Wrong("not to be sorted")
    return sorted(items, reverse=run._choice(block, "order") == "down")


def _split(run: Interpreter, block: Block) -> Value:
    text, mark = str(run.slot(block, "text")), str(run.slot(block, "mark"))
    return text.split(mark) if mark else list(text)


def _joined(run: Interpreter, block: Block) -> Value:
    items, mark = items_of(run.slot(block, "list")), str(run.slot(block, "mark"))
    return mark.join(map(told, items))


def _table(run: Interpreter, block: Block) -> Value:
    made = Table()
    numbers = range(1, block.groups.get("entry", 0) + 1)
    for key, value in [
        (run.slot(block, f"key.{n}"), run.slot(block, f"value.{n}")) for n in numbers
    ]:
        made.put(key, value)
    return made


def _at_key(run: Interpreter, block: Block) -> Value:
    held = table(run.slot(block, "table"))
    return held.at(run.slot(block, "key"))


def _at_key_or(run: Interpreter, block: Block) -> Value:
    held, key = table(run.slot(block, "table")), run.slot(block, "key")
    otherwise = run.slot(block, "otherwise")
    return otherwise if held.place(key) is None else held.at(key)


def _has_key(run: Interpreter, block: Block) -> Value:
    held = table(run.slot(block, "table"))
    return held.place(run.slot(block, "key")) is not None


def _name_with(run: Interpreter, block: Block) -> Value:
    held = table(run.slot(block, "table"))
    kinds = {kind(value) for value in held.values}
    if len(kinds) != 1 or not kinds <= {"number", "text"}:
        raise Wrong("not to be compared")
    best = 0
    for at, one in enumerate(held.values):
        other = held.values[best]
        if less(other, one) if run._choice(block, "extreme") == "max" else less(one, other):
            best = at
    return held.keys[best]


# Facts


def _fact(run: Interpreter, block: Block) -> list[Value]:
    values = [run.slot(block, f"value.{n}") for n in range(1, block.groups.get("of", 0) + 1)]
    return [run.slot(block, "fact"), *values]


def asked_fact(run: Interpreter, block: Block) -> list[Value]:
    name, *values = _fact(run, block)
    if not str(name).strip() or any(kind(value) in ("list", "table") for value in values):
        raise Wrong("no fact")
    return [str(name).strip(), *values]


def is_true(run: Interpreter, block: Block) -> bool:
    fact = asked_fact(run, block)
    return any(equal(fact, other) for other in run.facts)


REPORTERS: dict[str, Callable[[Interpreter, Block], Value]] = {
    "plan.fact": _fact,
    "plan.is_true": is_true,
    "variable.get": lambda run, block: run.get(str(block.fields["variable"])),
    "math.number": lambda run, block: number(run.slot(block, "number")),
    "math.arithmetic": _arithmetic,
    "math.function": lambda run, block: FUNCTIONS[run._choice(block, "function")](
        number(run.slot(block, "number"))
    ),
    "math.round": _round,
    "math.constrain": _constrain,
    "math.of_list": lambda run, block: OF_LIST[run._choice(block, "function")](
        numbers_of(run.slot(block, "list"))
    ),
    "math.random_integer": _random,
    "math.random_item": _random_item,
    "logic.truth": lambda run, block: run._choice(block, "truth") == "true",
    "logic.not": lambda run, block: not is_yes(run.slot(block, "a")),
    "logic.junction": _junction,
    "logic.compare": _compare,
    "logic.choose": lambda run, block: run.slot(
        block, "a" if is_yes(run.slot(block, "condition")) else "b"
    ),
    "logic.number_is": lambda run, block: PROPERTIES[run._choice(block, "property")](
        number(run.slot(block, "number"))
    ),
    "logic.divisible": lambda run, block: (
        number(run.slot(block, "number")) % divisor_of(number(run.slot(block, "divisor"))) == 0
    ),
    "text.text": lambda run, block: run.slot(block, "text"),
    "text.join": _join,
    "text.length": lambda run, block: _length(run.slot(block, "text")),
    "text.is_empty": lambda run, block: _length(run.slot(block, "text")) == 0,
    "text.contains": lambda run, block: (
        str(run.slot(block, "part")) in str(run.slot(block, "text"))
    ),
    "text.find": _find_in_text,
    "text.letter": _letter,
    "text.case": _case,
    "text.replace": _replace,
    "text.number": lambda run, block: number_in(str(run.slot(block, "text"))),
    "list.create": lambda run, block: [
        run.slot(block, f"item.{n}") for n in range(1, block.groups.get("item", 0) + 1)
    ],
    "list.filled": _filled,
    "list.length": lambda run, block: len(items_of(run.slot(block, "list"))),
    "list.is_empty": lambda run, block: not items_of(run.slot(block, "list")),
    "list.contains": _contains,
    "list.find": _find,
    "list.get": _get,
    "list.take": _take,
    "list.part": _part,
    "list.sorted": _sorted,
    "list.reversed": lambda run, block: items_of(run.slot(block, "list"))[::-1],
    "list.copy": lambda run, block: list(items_of(run.slot(block, "list"))),
    "list.split": _split,
    "list.joined": _joined,
    "event.told_value": lambda run, block: run.told_value(),
    "control.went_wrong": lambda run, block: run.wrong[-1] if run.wrong else "",
    "table.create": _table,
    "table.get": _at_key,
    "table.get_or": _at_key_or,
    "table.has": _has_key,
    "table.names": lambda run, block: list(table(run.slot(block, "table")).keys),
    "table.values": lambda run, block: list(table(run.slot(block, "table")).values),
    "table.name_with": _name_with,
    "table.length": lambda run, block: len(table(run.slot(block, "table"))),
    "table.is_empty": lambda run, block: len(table(run.slot(block, "table"))) == 0,
    "table.copy": lambda run, block: table(run.slot(block, "table")).copy(),
}
