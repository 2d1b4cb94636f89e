"""The language of docs/language.md, run block by block: a judge of the Python that blocks make.

Written from that page alone, and to be kept so: it shares no code with the generator, nor with what
generated Python calls. It is slow and plain. What it cannot judge in finite time it gives up.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from reference_reporters import REPORTERS, asked_fact, is_true, item_at
from reference_values import (
    CLOSE,
    LARGEST,
    MOST_CALLS,
    MOST_STEPS,
    GivenUp,
    Table,
    Value,
    Wrong,
    equal,
    is_yes,
    items_of,
    kind,
    number,
    place,
    rounded,
    spoken,
    table,
    told,
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
            self._mouths: list[set[int]] = []
            try:
                uses = [self._use(variable.id, stack) for stack in stacks] + self._mouths
            except Wrong:  # read before it is set, or used in parts
                continue
            if len(stacks) == 1 or uses == [{HERE}] * len(uses):
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
        mouths = [b for b in within if b.type == EACH_ROBOT]
        apart = {b.id for one in mouths for b in self.project.within(one.bodies.get("do", []))}
        named = {b.id for b in within if b.fields.get("variable") == variable}
        if named - apart and block.type in _SIDE_BY_SIDE_OR_BY_TURNS:
            raise Wrong("used in parts")
        if block.type == EACH_ROBOT:
            return self._sets_for_each(block, variable, UNSET if named else state)
        is_once = block.type in ("control.if", "control.try", "robot_speech.ask")
        inner = state if is_once else min(state, BEFORE)
        if (
            named & apart
        ):  # a robot has its own: what it sets is not known here, nor what is set here
            inner, state = inner if is_once else UNSET, UNSET
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

    def _sets_for_each(self, block: Block, variable: str, after: int) -> int:
        """The blocks that are done for each robot are as a stack by themselves."""
        around, self._reads = self._reads, set()
        self._sets(block.bodies.get("do", []), variable, UNSET)
        if after == UNSET:
            self._mouths.append(self._reads)
        self._reads = self._reads | around
        return after

    def own_of_mouth(self, block: Block) -> dict[str, Value]:
        """The variables that each robot has for itself, before anything is set."""
        blocks = self.project.within(block.bodies.get("do", []), enabled=True)
        used = {str(b.fields.get("variable", "")) for b in blocks}
        return {variable: self._first(variable) for variable in used & self._own[-1].keys()}

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
EACH_ROBOT = "control.each_robot"
_SIDE_BY_SIDE_OR_BY_TURNS = ("control.together", "goal.one_of", "goal.in_turn", "tree.step")
_AS_IT_IS = ("text.length", "text.is_empty")
"""Blocks that take any value for what it is, in a place for a text."""


# What each block means that does something


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


def _makes_true(run: Interpreter, block: Block) -> None:
    run.facts.append(asked_fact(run, block))


def _makes_untrue(run: Interpreter, block: Block) -> None:
    fact = asked_fact(run, block)
    run.facts = [other for other in run.facts if not equal(fact, other)]


def _needs(run: Interpreter, block: Block) -> None:
    if not is_true(run, block):
        raise Wrong("not true")


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
    way = block.fields.get("way", "either")
    if (way == "up" and last < first) or (way == "down" and last > first):
        return
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
    items, index = item_at(run, block)
    del items[index]


def _together(run: Interpreter, block: Block) -> None:
    for n in range(1, block.groups.get("part", 0) + 1):
        run.body(block, f"do.{n}")


def _each_robot(run: Interpreter, block: Block) -> None:
    """With one robot, which is all that can be judged."""
    run._own.append(run.own_of_mouth(block))
    try:
        run.body(block, "do")
    finally:
        run._own.pop()


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
    EACH_ROBOT: _each_robot,
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
