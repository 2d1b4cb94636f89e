"""The language of docs/language.md, run block by block: a judge of the Python that blocks make.

Written from that page alone, and to be kept so: it shares no code with the generator, nor with what
generated Python calls. It is slow and plain. What it cannot judge in finite time it gives up.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from reference_values import (
    ARITHMETIC,
    CLOSE,
    COMPARISONS,
    FUNCTIONS,
    LARGEST,
    MOST_CALLS,
    MOST_STEPS,
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
    number,
    number_in,
    numbers_of,
    place,
    rounded,
    spoken,
    table,
    told,
    whole,
)

from nep_studio.blocks.arithmetic import number_of
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import header_of, parameter_of, parameters, procedure_of
from nep_studio.blocks.program import Block, Project


class RuleEnded(Exception):
    """Stop this rule."""


class LoopLeft(Exception):
    """Leave the loop."""


class RoundLeft(Exception):
    """Go on with the next round."""


class GivenBack(Exception):
    """An own block gives a value back."""

    def __init__(self, value: Value) -> None:
        super().__init__()
        self.value = value


UNSET, BEFORE, HERE, NOWHERE = range(4)
"""A variable at a place: perhaps not set, set before this round of a loop, in it; no such place."""


class Interpreter:
    """Runs the rule that begins at the start, and keeps what robots say."""

    def __init__(self, project: Project, language: Language) -> None:
        self.project = project
        self.language = language.of(project)
        self.said: list[str] = []
        self._steps = self._calls = 0
        self._turns: dict[str, int] = {}
        self.facts: list[Value] = []
        self._parameters: list[dict[str, Value]] = []
        self._told: list[tuple[str, Value]] = []
        """The rules that run because of a message, each with what came with it."""
        self.wrong: list[str] = []
        """What went wrong, where something else is done instead."""
        self._own: list[dict[str, Value]] = []
        """The variables of the run of this rule, and of the calls that it is in."""
        self._locals = self._variables_of_stacks()
        self.variables: dict[str, Value] = {v.id: self._first(v.id) for v in project.variables}

    def run(self) -> list[str]:
        """What is said; ends with “error” where the rule ends by one."""
        spoken[0] = self.project.spoken_language
        start = next(
            stack
            for stack in self.project.pages["behaviour"]
            if self.project.blocks[stack.body[0]].type == "event.started"
        )
        self._own = [self._begun(start.body[0])]
        try:
            self._chain(start.body[1:])
        except Wrong:
            self.said.append("error")
        except RuleEnded:
            pass
        except RecursionError:
            raise GivenUp from None
        return self.said

    # Variables

    def _blocks(self) -> list[Block]:
        stacks = self.project.pages["behaviour"]
        return [b for s in stacks for b in self.project.within(s.body, enabled=True)]

    def _first(self, variable: str) -> Value:
        """What a variable holds before it is set."""
        blocks = self._blocks()
        for kind_of_place, empty in (("list", list), ("table", Table)):
            if any(variable in self._taken_for(kind_of_place, block) for block in blocks):
                return empty()
        appended = [b.fields.get("variable") for b in blocks if b.type == "text.append"]
        if variable in appended:
            return ""
        users = [b for b in blocks if _is_set_by(b, variable)]
        looks = {self._looks(b) if b.type == "variable.set" else "number" for b in users}
        return "" if looks == {"text"} else False if looks == {"truth"} else 0

    def _looks(self, block: Block) -> str:
        """The kind of what a *set* block holds, as a person sees it."""
        plugged = self._plugged(block, "value")
        if plugged is None:
            return kind(self.slot(block, "value"))
        result = self.language.definitions[plugged.type].result
        return {"text": "text", "colour": "text", "boolean": "truth"}.get(result, "number")

    def _taken_for(self, kind_of_place: str, block: Block) -> set[str]:
        """The variables that stand in the places for lists, or for tables, of a block."""
        keys = self.language.definitions[block.type].keys(block.groups)
        plugged = [
            self._plugged(block, key) for key, slot in keys if slot.kind.name == kind_of_place
        ]
        return {str(b.fields.get("variable")) for b in plugged if b and b.type == "variable.get"}

    def _variables_of_stacks(self) -> dict[str, set[str]]:
        """The variables that belong to the runs and calls of each stack, by its first block."""
        users: dict[str, list[list[str]]] = {}
        for stack in self.project.pages["behaviour"]:
            blocks = self.project.within(stack.body, enabled=True)
            for variable in {str(b.fields["variable"]) for b in blocks if "variable" in b.fields}:
                users.setdefault(variable, []).append(stack.body)
        found: dict[str, set[str]] = {
            stack.body[0]: set() for stack in self.project.stacks.values()
        }
        for variable in self.project.variables:
            stacks = users.get(variable.id, [])
            if variable.scope in ("program", "kept"):
                continue
            try:
                uses = [self._use(variable.id, stack) for stack in stacks]
            except Wrong:  # read before it is set, or used in parts
                continue
            if len(stacks) == 1 or uses == [{HERE}] * len(stacks):
                for stack in stacks:
                    found[stack[0]].add(variable.id)
        return found

    def _begun(self, first_block: str) -> dict[str, Value]:
        """The variables of one run or call of a stack, before anything is set."""
        return {variable: self._first(variable) for variable in self._locals[first_block]}

    def _use(self, variable: str, stack: list[str]) -> set[int]:
        """How far away from where it is set a stack reads a variable: in which states."""
        self._reads: set[int] = set()
        self._look(self.project.blocks[stack[0]], variable, UNSET)
        self._sets(stack[1:], variable, UNSET)
        return self._reads

    def _sets(self, chain: list[str], variable: str, state: int) -> int:
        """What is known of a variable after a chain; raises Wrong where it is read unset."""
        reached = True
        for block_id in chain:
            block = self.project.blocks[block_id]
            if not block.disabled:
                after = self._sets_it(block, variable, state)
                reached = reached and after != NOWHERE
                state = state if after == NOWHERE else after
        return state if reached else NOWHERE

    def _look(self, block: Block, variable: str, state: int) -> None:
        """Note how a block itself reads a variable."""
        plugged = [self.project.blocks[b] for b in block.inputs.values()]
        reads = any(
            b.fields.get("variable") == variable
            for value in plugged
            for b in self.project.within([value.id], enabled=True)
        )
        is_it = block.fields.get("variable") == variable
        if reads or (is_it and block.type in ("variable.change", "text.append")):
            if state == UNSET:
                raise Wrong("read before it is set")
            is_again = block.type in ("control.while", "control.repeat_until", "control.wait_until")
            self._reads.add(min(state, BEFORE) if is_again and reads else state)

    def _sets_it(self, block: Block, variable: str, state: int) -> int:
        self._look(block, variable, state)
        is_it = block.fields.get("variable") == variable
        if block.type == "variable.set" and is_it:
            return HERE
        inside = [b for chain in block.bodies.values() for b in chain]
        within = list(self.project.within(inside, enabled=True))
        is_inside = any(b.fields.get("variable") == variable for b in within)
        if is_inside and block.type in _SIDE_BY_SIDE_OR_BY_TURNS:
            raise Wrong("used in parts")
        is_once = block.type in ("control.if", "control.try", "robot_speech.ask")
        inner = state if is_once else min(state, BEFORE)
        if is_it and block.type in ("control.count", "control.for_each"):
            inner = HERE
        ends = [self._sets(c, variable, inner) for c in block.bodies.values()]
        if block.type == "control.if":
            slots = 1 + block.groups.get("also", 0) + block.groups.get("otherwise", 0)
            whole = block.groups.get("otherwise") and len(ends) == slots
            return min(ends if whole else [*ends, state])
        if self.language.definitions[block.type].shape == "cap" and not block.bodies:
            return NOWHERE
        is_left = any(b.type == "control.leave_loop" for b in within)
        return NOWHERE if block.type == "control.forever" and not is_left else state

    def _place_of_variable(self, variable: str) -> dict[str, Value]:
        if variable in self._own[-1]:
            return self._own[-1]
        return self.variables

    def get(self, variable: str) -> Value:
        return self._place_of_variable(variable)[variable]

    def set(self, variable: str, value: Value) -> None:
        if isinstance(value, int) and abs(value) > 10**300:
            raise GivenUp
        if isinstance(value, str | list | Table) and len(value) > 2_000:
            raise GivenUp
        self._place_of_variable(variable)[variable] = value

    # Slots

    def _plugged(self, block: Block, key: str) -> Block | None:
        block_id = block.inputs.get(key)
        plugged = self.project.blocks[block_id] if block_id else None
        return None if plugged is None or plugged.disabled else plugged

    def slot(self, block: Block, key: str) -> Value:
        """What is in a slot."""
        plugged = self._plugged(block, key)
        definition = self.language.definitions[block.type]
        slot = definition.slots[key.partition(".")[0]]
        if plugged is not None:
            value = self.value(plugged)
            if slot.kind.becomes_text:
                return value if block.type in _AS_IT_IS else told(value)
            if slot.kind.name == "list":
                return items_of(value)
            if slot.kind.name == "table":
                return table(value)
            return number(value) if slot.kind.is_number else value
        if slot.kind.name == "boolean":
            return False
        if slot.kind.name in ("list", "table"):
            return [] if slot.kind.name == "list" else Table()
        field = definition.value(block, key)
        if slot.kind.is_number:
            return number_of(field)  # type: ignore[arg-type]
        return "" if field is None else field  # type: ignore[return-value]

    def _choice(self, block: Block, key: str) -> str:
        return str(self.language.definitions[block.type].value(block, key))

    def _step(self) -> None:
        self._steps += 1
        if self._steps > MOST_STEPS:
            raise GivenUp

    # Reporters

    def value(self, block: Block) -> Value:
        """What a reporter gives."""
        self._step()
        if block.type.startswith("my.parameter."):
            return self._parameters[-1][parameter_of(block.type)]
        if block.type.startswith("my.call."):
            return self._call(block)
        value = REPORTERS[block.type](self, block)
        if isinstance(value, str | list | Table) and len(value) > MOST_STEPS:
            raise GivenUp
        if isinstance(value, float) and not (math.isfinite(value) and abs(value) < LARGEST):
            raise GivenUp
        if isinstance(value, int) and abs(value) > 10**300:
            raise GivenUp
        return value

    def _call(self, block: Block) -> Value:
        procedure = self.project.procedures[procedure_of(block.type)]
        values = {p.id: self.slot(block, p.id) for p in parameters(procedure)}
        for parameter in parameters(procedure):
            values[parameter.id] = _AS_KIND[parameter.kind](values[parameter.id])
        self._calls += 1
        if self._calls > MOST_CALLS:
            raise GivenUp
        header = header_of(self.project, procedure.id)
        self._parameters.append(values)
        self._own.append(self._begun(header))
        try:
            self._chain(self.project.stack_of(header).body[1:])
        except GivenBack as given:
            return given.value
        finally:
            self._parameters.pop()
            self._own.pop()
            self._calls -= 1
        return 0

    # Messages

    def told_value(self) -> Value:
        """What came with the message of this rule."""
        return self._told[-1][1] if self._told else ""

    def tell(self, message: str, value: Value) -> None:
        """Let the rule for a message do what it does, and wait for it."""
        for stack in self.project.pages["behaviour"]:
            hat = self.project.blocks[stack.body[0]]
            if hat.type != "event.told" or self._choice(hat, "message") != message:
                continue
            running = [rule for rule, _ in self._told]
            again = self._choice(hat, "again.1") if hat.groups.get("repeated") else "ignore"
            if hat.id in running and again == "restart":
                raise GivenUp
            if running[-1:] == [hat.id] or (hat.id in running and again == "queue"):
                raise Wrong("it would wait for itself")
            if hat.id not in running:
                self._do_rule(hat.id, stack.body[1:], value)

    def _do_rule(self, hat: str, body: list[str], value: Value) -> None:
        self._told.append((hat, value))
        around = self._own, self._parameters, self.wrong
        self._own, self._parameters, self.wrong = [self._begun(hat)], [], []
        try:
            self._chain(body)
        except (Wrong, RuleEnded):
            pass  # it ends this rule only
        finally:
            self._own, self._parameters, self.wrong = around
            self._told.pop()

    # Statements

    def _chain(self, chain: list[str]) -> None:
        for block_id in chain:
            block = self.project.blocks[block_id]
            if block.disabled:
                continue
            self._step()
            if block.type.startswith("my.call."):
                self._call(block)
            else:
                STATEMENTS[block.type](self, block)

    def body(self, block: Block, slot: str) -> None:
        self._chain(block.bodies.get(slot, []))

    def round(self, block: Block) -> bool:
        """Do a round of a loop; whether the loop goes on."""
        self._step()
        try:
            self.body(block, "do")
        except LoopLeft:
            return False
        except RoundLeft:
            pass
        return True

    def turn(self, block: Block) -> int:
        turn = self._turns.get(block.id, 0)
        self._turns[block.id] = turn + 1
        return turn


def _is_set_by(block: Block, variable: str) -> bool:
    """Whether a block sets, changes, counts with or goes through a list with a variable."""
    return block.fields.get("variable") == variable and block.type != "variable.get"


def _text(value: Value) -> Value:
    return told(value)


_AS_KIND: dict[str, Callable[[Value], Value]] = {
    "number": number,
    "text": _text,
    "boolean": is_yes,
    "list": items_of,
    "table": table,
    "any": lambda value: value,
}
_SIDE_BY_SIDE_OR_BY_TURNS = ("control.together", "goal.one_of", "goal.in_turn", "tree.step")
_AS_IT_IS = ("text.length", "text.is_empty")
"""Blocks that take any value for what it is, in a place for a text."""


# What each block means


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


def _at(run: Interpreter, block: Block) -> tuple[list, int]:
    wanted, items = run.slot(block, "number"), items_of(run.slot(block, "list"))
    return items, place(wanted, run._choice(block, "end"), len(items))


def _get(run: Interpreter, block: Block) -> Value:
    items, index = _at(run, block)
    return items[index]


def _take(run: Interpreter, block: Block) -> Value:
    items, index = _at(run, block)
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


def _set_key(run: Interpreter, block: Block) -> None:
    held, key = table(run.slot(block, "table")), run.slot(block, "key")
    held.put(key, run.slot(block, "value"))


def _take_key(run: Interpreter, block: Block) -> None:
    key = run.slot(block, "key")
    table(run.slot(block, "table")).remove(key)


def _change_key(run: Interpreter, block: Block) -> None:
    held, key = table(run.slot(block, "table")), run.slot(block, "key")
    amount = number(run.slot(block, "amount"))
    before = 0 if held.place(key) is None else number(held.at(key))
    if abs(before) > LARGEST:
        raise GivenUp
    held.put(key, before + amount)


# Facts


def _fact(run: Interpreter, block: Block) -> list[Value]:
    values = [run.slot(block, f"value.{n}") for n in range(1, block.groups.get("of", 0) + 1)]
    return [run.slot(block, "fact"), *values]


def _asked_fact(run: Interpreter, block: Block) -> list[Value]:
    name, *values = _fact(run, block)
    if not str(name).strip() or any(kind(value) == "list" for value in values):
        raise Wrong("no fact")
    return [str(name).strip(), *values]


def _is_true(run: Interpreter, block: Block) -> bool:
    fact = _asked_fact(run, block)
    return any(equal(fact, other) for other in run.facts)


def _makes_true(run: Interpreter, block: Block) -> None:
    run.facts.append(_asked_fact(run, block))


def _makes_untrue(run: Interpreter, block: Block) -> None:
    fact = _asked_fact(run, block)
    run.facts = [other for other in run.facts if not equal(fact, other)]


def _needs(run: Interpreter, block: Block) -> None:
    if not _is_true(run, block):
        raise Wrong("not true")


REPORTERS: dict[str, Callable[[Interpreter, Block], Value]] = {
    "plan.fact": _fact,
    "plan.is_true": _is_true,
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
    "table.length": lambda run, block: len(table(run.slot(block, "table"))),
    "table.is_empty": lambda run, block: len(table(run.slot(block, "table"))) == 0,
    "table.copy": lambda run, block: table(run.slot(block, "table")).copy(),
}


def _say(run: Interpreter, block: Block) -> None:
    run.said.append(told(run.slot(block, "text")))


def _set(run: Interpreter, block: Block) -> None:
    run.set(str(block.fields["variable"]), run.slot(block, "value"))


def _change(run: Interpreter, block: Block) -> None:
    variable = str(block.fields["variable"])
    amount = number(run.slot(block, "amount"))
    run.set(variable, number(run.get(variable)) + amount)


def _append(run: Interpreter, block: Block) -> None:
    variable = str(block.fields["variable"])
    text = told(run.slot(block, "text"))
    run.set(variable, told(run.get(variable)) + text)


def _if(run: Interpreter, block: Block) -> None:
    if is_yes(run.slot(block, "condition")):
        return run.body(block, "do")
    for n in range(1, block.groups.get("also", 0) + 1):
        if is_yes(run.slot(block, f"also_condition.{n}")):
            return run.body(block, f"also_do.{n}")
    if block.groups.get("otherwise"):
        run.body(block, "otherwise_do.1")
    return None


def _repeat(run: Interpreter, block: Block) -> None:
    for _ in range(rounded(run.slot(block, "times"))):
        if not run.round(block):
            return


def _while(run: Interpreter, block: Block) -> None:
    while is_yes(run.slot(block, "condition")) and run.round(block):
        pass


def _repeat_until(run: Interpreter, block: Block) -> None:
    while not is_yes(run.slot(block, "condition")) and run.round(block):
        pass


def _forever(run: Interpreter, block: Block) -> None:
    while run.round(block):
        pass


def _count(run: Interpreter, block: Block) -> None:
    first, last, step = (number(run.slot(block, key)) for key in ("first", "last", "step"))
    if step == 0:
        raise Wrong("a step of 0")
    step = abs(step) if first <= last else -abs(step)
    rounds = (last - first) / step
    for n in range(math.floor(rounds + CLOSE) + 1):
        run.set(str(block.fields["variable"]), first + n * step)
        if not run.round(block):
            return


def _for_each(run: Interpreter, block: Block) -> None:
    for item in list(items_of(run.slot(block, "list"))):
        run.set(str(block.fields["variable"]), item)
        if not run.round(block):
            return


def _add(run: Interpreter, block: Block) -> None:
    value, items = run.slot(block, "value"), items_of(run.slot(block, "list"))
    items.append(value)


def _set_item(run: Interpreter, block: Block) -> None:
    wanted, items = run.slot(block, "number"), items_of(run.slot(block, "list"))
    value = run.slot(block, "value")
    items[place(wanted, run._choice(block, "end"), len(items))] = value


def _insert(run: Interpreter, block: Block) -> None:
    value, wanted = run.slot(block, "value"), run.slot(block, "number")
    items = items_of(run.slot(block, "list"))
    items.insert(place(wanted, run._choice(block, "end"), len(items) + 1), value)


def _remove(run: Interpreter, block: Block) -> None:
    items, index = _at(run, block)
    del items[index]


def _together(run: Interpreter, block: Block) -> None:
    for n in range(1, block.groups.get("part", 0) + 1):
        run.body(block, f"do.{n}")


def _one_of(run: Interpreter, block: Block) -> None:
    if block.groups.get("part", 0) > 1:
        raise GivenUp
    run.body(block, "do.1")


def _in_turn(run: Interpreter, block: Block) -> None:
    count = block.groups.get("part", 0)
    run.body(block, f"do.{run.turn(block) % count + 1}")


def _tell(run: Interpreter, block: Block) -> None:
    if not block.groups.get("wait"):
        raise GivenUp  # nobody can judge who is faster
    value = run.slot(block, "value.1") if block.groups.get("value") else ""
    run.tell(run._choice(block, "message"), value)


def _try(run: Interpreter, block: Block) -> None:
    try:
        run.body(block, "do")
    except Wrong as wrong:
        run.wrong.append(f"{wrong}")
        try:
            run.body(block, "otherwise")
        finally:
            run.wrong.pop()


def _raise(error: type[Exception]) -> Callable[[Interpreter, Block], None]:
    def statement(run: Interpreter, block: Block) -> None:
        raise error

    return statement


def _give_back(run: Interpreter, block: Block) -> None:
    raise GivenBack(run.slot(block, "value"))


STATEMENTS: dict[str, Callable[[Interpreter, Block], None]] = {
    "robot.say": _say,
    "variable.set": _set,
    "variable.change": _change,
    "text.append": _append,
    "control.if": _if,
    "control.repeat": _repeat,
    "control.while": _while,
    "control.repeat_until": _repeat_until,
    "control.forever": _forever,
    "control.count": _count,
    "control.for_each": _for_each,
    "control.leave_loop": _raise(LoopLeft),
    "control.next_round": _raise(RoundLeft),
    "control.stop_rule": _raise(RuleEnded),
    "control.try": _try,
    "event.tell": _tell,
    "control.note": lambda run, block: None,
    "control.together": _together,
    "goal.one_of": _one_of,
    "goal.in_turn": _in_turn,
    "list.add": _add,
    "list.set": _set_item,
    "list.insert": _insert,
    "list.remove": _remove,
    "table.set": _set_key,
    "table.change": _change_key,
    "table.take": _take_key,
    "my.return": _give_back,
    "plan.now_true": _makes_true,
    "plan.makes_true": _makes_true,
    "plan.no_longer_true": _makes_untrue,
    "plan.makes_untrue": _makes_untrue,
    "plan.needs": _needs,
}
