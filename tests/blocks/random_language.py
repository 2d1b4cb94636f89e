"""Random programs of docs/language.md: mostly sensible, now and then with a value of another kind.

What waits, asks or is chance is left out: nobody could judge it. Variables have names that pupils
give, also such as Python or the generated program use themselves.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field

from block_building import B, add, build

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetExtra, SetFlag
from nep_studio.blocks.edits.project import SetScope
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import LANGUAGE, LANGUAGES, Parameter, Project

NAMES = ["count", "number", "list", "item", "total", "score", "i", "name", "größe", "text", "max"]
KINDS = ["number", "number", "number", "text", "text", "list", "list", "boolean", "any", "table"]
KEYS = ["Anna", "Ben", "a", 1, 2, "12"]
TEXTS = [
    "",
    "a",
    "don't stop",
    "abc",
    "12",
    " 7 ",
    "3,5",
    "1.50",
    "Anna",
    "two words",
    "x,y,z",
    "é",
]
NUMBERS = [0, 1, 2, 3, 5, 10, -1, -2, 0.5, 2.5, -2.5, 1.5, 0.1, 0.2, 1e-7, 123456789.25]
DEEPEST = 3
EACH_ROBOT, ROBOT = "control.each_robot", "robots.robot"


@dataclass
class Procedure:
    """An own block of a random program."""

    id: str
    parameters: list[Parameter]
    gives_value: bool


@dataclass
class Inside:
    """Where a block is being made: what may stand there."""

    loops: int = 0
    procedure: Procedure | None = None
    depth: int = 0
    variables: list[str] = field(default_factory=list)


class Maker:
    """Makes one program from a seed."""

    def __init__(self, seed: int, language: Language) -> None:
        self.dice = random.Random(seed)
        self.editor = Editor(Project(f"Program {seed}"), language)
        names = self.dice.sample(NAMES, self.dice.randint(4, 6))
        kinds = ["number", "text", "list", "any", *self.dice.choices(KINDS, k=2)]
        kinds[4] = "table" if self._chance(0.4) else kinds[4]
        self.kinds = {
            self.editor.add_variable(name): kind for name, kind in zip(names, kinds, strict=False)
        }
        self.messages = ["go", "come on"][: self.dice.choice([0, 0, 1, 2])]
        self.procedures = [self._procedure(n) for n in range(self.dice.choice([0, 0, 1, 2]))]
        self.where = Inside(variables=list(self.kinds))

    def project(self) -> Project:
        """The program."""
        for procedure in self.procedures:
            self._define(procedure)
        self.where = Inside(variables=list(self.kinds))
        if self._chance(0.2):
            self.editor.apply(SetExtra(LANGUAGE, self.dice.choice(LANGUAGES[1:])))
        for variable in self.kinds:
            if self._chance(0.2):
                self.editor.apply(SetScope(variable, self.dice.choice(["program", "kept", "new"])))
        begin = [self._begin(v) for v in self.kinds if self._chance(0.85)]
        told = [v for v in self.kinds if self._chance(0.8)]
        end = [self._say(B("variable.get", {"variable": v})) for v in told]
        rule = [B("event.started"), *begin, *self._chain(self.dice.randint(2, 6)), *end]
        build(self.editor.language, rule, editor=self.editor)
        for message in self.messages:
            self._rule_for(message)
        build(self.editor.language, [B(ROBOT)], page="robots", editor=self.editor)
        if self._chance(0.2):
            self._disable()
        return self.editor.project

    def _disable(self) -> None:
        """Some blocks are switched off, but no header and no robot, which no Python would tell."""
        blocks, definitions = self.editor.project.blocks, self.editor.language.definitions
        shapes = {k: definitions[b.type].shape for k, b in blocks.items() if b.type != ROBOT}
        usual = sorted(key for key, shape in shapes.items() if shape != "hat")
        for block in self.dice.sample(usual, min(3, len(usual))):
            self.editor.apply(SetFlag(block, "disabled", True))

    def _rule_for(self, message: str) -> None:
        again = self.dice.choice(["", "ignore", "queue"])
        groups = {"repeated": 1} if again else {}
        fields = {"message": message, **({"again.1": again} if again else {})}
        said = self._say(B("event.told_value"))
        chain = self._perhaps_by_itself(self._chain(2))
        rule = [B("event.told", fields, groups=groups), said, *chain]
        build(self.editor.language, rule, editor=self.editor)

    def _chance(self, part: float) -> bool:
        return self.dice.random() < part

    # Own blocks

    def _procedure(self, number: int) -> Procedure:
        kinds = self.dice.choices(["number", "text", "any", "list", "boolean", "table"], k=2)
        given = [
            self.editor.new_parameter(name, kind)
            for name, kind in zip(self.dice.sample(["n", "who", "count"], 2), kinds, strict=True)
        ][: self.dice.randint(0, 2)]
        gives_value = self._chance(0.6)
        name = self.editor.add_procedure([f"own {number}", *given], gives_value=gives_value)
        return Procedure(name, given, gives_value)

    def _define(self, procedure: Procedure) -> None:
        self.where = Inside(procedure=procedure, variables=list(self.kinds))
        chain = self._perhaps_by_itself(self._chain(self.dice.randint(1, 3)))
        if self._chance(0.3) and procedure.gives_value:
            chain.insert(0, self._recursion(procedure))
        if procedure.gives_value and self._chance(0.9):
            chain.append(self._end(B("my.return", inputs={"value": self._any()})))
        place = self.editor.new_stack("behaviour", 400, 40)
        for index, block in enumerate([B(f"my.define.{procedure.id}"), *chain]):
            add(self.editor, block, place if index == 0 else InStack(place.stack, index))

    def _perhaps_by_itself(self, chain: list[B]) -> list[B]:
        """The chain, behind what sets variables so that it may have all of them for itself."""
        if not self._chance(0.3):
            return chain
        begun = [v for v in self.kinds if self._chance(0.9)]
        told = [self._say(B("variable.get", {"variable": v})) for v in begun[:2]]
        return [*map(self._begin, begun), *told, *chain]

    def _end(self, back: B) -> B:
        """The end of an own block that gives a value: mostly that alone."""
        leave = B("control.leave_loop")
        endings = [
            B("control.forever", bodies={"do": [back]}),
            B("control.forever", bodies={"do": [leave]}),
            B("control.stop_rule"),
            B("control.if", inputs={"condition": self._boolean()}, bodies={"do": [back]}),
        ]
        return self.dice.choice(endings) if self._chance(0.12) else back

    def _recursion(self, procedure: Procedure) -> B:
        """An own block that uses itself with a smaller number, and ends at 0."""
        numbers = [p for p in procedure.parameters if p.kind == "number"]
        if not numbers:
            return B("control.note", {"text": "no number"})
        given = B(f"my.parameter.{procedure.id}.{numbers[0].id}")
        test = B("logic.compare", {"comparison": "less_or_equal", "b": 0}, {"a": given})
        back = B("my.return", {"value": 1})
        less = B("math.arithmetic", {"operation": "subtract", "b": 1}, {"a": given})
        own = self.editor.project.new_id("v")
        inputs = {p.id: self._of(p.kind) for p in procedure.parameters}
        call = B(f"my.call.{procedure.id}", inputs={**inputs, numbers[0].id: less})
        own = self.editor.add_variable(f"inner{own}")
        use = B("variable.get", {"variable": own})
        total = B("math.arithmetic", {"operation": "add"}, {"a": use, "b": call})
        return (
            B(
                "control.if",
                inputs={"condition": test},
                bodies={"do": [back]},
            )
            if self._chance(0.3)
            else B(
                "control.if",
                inputs={"condition": test},
                bodies={
                    "do": [back],
                    "otherwise_do.1": [
                        B("variable.set", {"variable": own}, {"value": given}),
                        B("my.return", inputs={"value": total}),
                    ],
                },
                groups={"otherwise": 1},
            )
        )

    def _known(self) -> list[Procedure]:
        """The own blocks that may be used here: none uses itself, or those below it."""
        inside = self.where.procedure
        above = self.procedures.index(inside) if inside is not None else len(self.procedures)
        return self.procedures[:above]

    def _call(self, procedure: Procedure) -> B:
        inputs = {p.id: self._of(p.kind) for p in procedure.parameters}
        return B(f"my.call.{procedure.id}", inputs=inputs)

    # Statements

    def _chain(self, length: int) -> list[B]:
        chain: list[B] = []
        for _ in range(length):
            if self._chance(0.3):
                chain.append(self._say(B("variable.get", {"variable": self._variable()})))
            chain.append(self._statement())
            if chain[-1].type in _LAST:
                break
        return chain

    def _body(self, *, loop: bool = False, apart: bool = False) -> list[B]:
        before = self.where
        loops = 0 if apart else before.loops + loop
        self.where = Inside(loops, before.procedure, before.depth + 1, before.variables)
        chain = self._chain(self.dice.randint(1, 3))
        self.where = before
        return chain

    def _statement(self) -> B:
        choices = [self._say, self._say, self._set, self._set, self._change, self._append]
        choices += [self._list_statement, self._list_statement]
        if "table" in self.kinds.values():
            choices += [self._table_statement, self._table_statement]
        choices.append(self._fact_statement)
        if self.where.depth < DEEPEST:
            choices += [self._if, self._repeat, self._count, self._for_each, self._parts]
            choices += [self._while, self._two_names, self._try]
        if self.messages:
            choices.append(self._tell)
        if self.where.loops and self._chance(0.3):
            return B(self.dice.choice(["control.leave_loop", "control.next_round"]))
        if self.where.depth and self._chance(0.03):
            return B("control.stop_rule")
        doing = [p for p in self._known() if not p.gives_value]
        if doing and self._chance(0.25):
            return self._call(self.dice.choice(doing))
        return self.dice.choice(choices)()

    def _say(self, value: B | None = None) -> B:
        return B("robot.say", inputs={"text": value or self._any()})

    def _variable(self, kind: str = "") -> str:
        fitting = [v for v, its in self.kinds.items() if kind in ("", its)]
        return self.dice.choice(fitting or list(self.kinds))

    def _begin(self, variable: str) -> B:
        """A variable gets what it mostly holds, and nothing that could fail."""
        makers = {"number": self._typed_number, "text": self._typed_text, "list": self._typed_list}
        makers["table"] = self._typed_table
        value = makers.get(self.kinds[variable], self._typed)()
        return B("variable.set", {"variable": variable}, {"value": value})

    def _set(self) -> B:
        variable = self._variable()
        kind = self.kinds[variable] if self._chance(0.96) else "any"
        return B("variable.set", {"variable": variable}, {"value": self._of(kind)})

    def _change(self) -> B:
        variable = self._variable("number" if self._chance(0.98) else "")
        return B("variable.change", {"variable": variable}, {"amount": self._number()})

    def _append(self) -> B:
        variable = self._variable("text" if self._chance(0.9) else "")
        return B("text.append", {"variable": variable}, {"text": self._any()})

    def _list_statement(self) -> B:
        end, place = self.dice.choice(["start", "end"]), self._place()
        match self.dice.randint(0, 3):
            case 0:
                inputs = {"list": self._list_variable(), "value": self._any()}
                return B("list.add", inputs=inputs)
            case 1:
                inputs = {"list": self._list_variable(), "value": self._any(), "number": place}
                return B("list.set", {"end": end}, inputs)
            case 2:
                inputs = {"list": self._list_variable(), "value": self._any(), "number": place}
                return B("list.insert", {"end": end}, inputs)
        return B("list.remove", {"end": end}, {"list": self._list_variable(), "number": place})

    def _table_statement(self) -> B:
        inputs = {"table": self._table_variable(), "key": self._key()}
        match self.dice.randint(0, 20):
            case 0:
                return B("table.take", inputs=inputs)
            case number if number % 2:
                value = self._number() if self._chance(0.7) else self._any()
                return B("table.set", inputs={**inputs, "value": value})
        return B("table.change", inputs={**inputs, "amount": self._number()})

    def _fact_statement(self) -> B:
        making, inside = ["now_true", "no_longer_true"], self.where.procedure
        if inside is None or not any(p.kind == "list" for p in inside.parameters):
            making += ["now_true", "makes_true", "makes_untrue"]  # no fact has a list for a task
        kind = "needs" if self._chance(0.05) else self.dice.choice(making)
        return self._fact(f"plan.{kind}")

    def _fact(self, kind: str) -> B:
        """A fact of few, so that one is often the same as another."""
        count = self.dice.choice([0, 1, 1, 2])
        value = self._any if self._chance(0.1) else self._leaf
        inputs = {f"value.{n}": value() for n in range(1, count + 1)}
        fields = {"fact": self.dice.choice(["a", "b", " a "])}
        return B(kind, fields, inputs, groups={"of": count})

    def _if(self) -> B:
        groups = {"also": self.dice.randint(0, 1), "otherwise": self.dice.randint(0, 1)}
        bodies, inputs = {"do": self._body()}, {"condition": self._boolean()}
        if groups["also"]:
            bodies["also_do.1"], inputs["also_condition.1"] = self._body(), self._boolean()
        if groups["otherwise"]:
            bodies["otherwise_do.1"] = self._body()
        return B("control.if", inputs=inputs, bodies=bodies, groups=groups)

    def _repeat(self) -> B:
        times = self._number() if self._chance(0.4) else self._small()
        return B("control.repeat", inputs={"times": times}, bodies={"do": self._body(loop=True)})

    def _while(self) -> B:
        """A loop that a counter ends."""
        variable = self._variable("number")
        test = B(
            "logic.compare",
            {"comparison": "less", "b": self.dice.randint(0, 4)},
            {"a": B("variable.get", {"variable": variable})},
        )
        change = B("variable.change", {"variable": variable, "amount": 1})
        kind = self.dice.choice(["control.while", "control.repeat_until"])
        condition = test if kind == "control.while" else B("logic.not", inputs={"a": test})
        body = [change, *self._body(loop=True)]
        return B(kind, inputs={"condition": condition}, bodies={"do": body})

    def _count(self) -> B:
        inputs = {
            key: self._number() if self._chance(0.3) else self._small()
            for key in ("first", "last", "step")
            if self._chance(0.5)
        }
        fields = {"variable": self._variable("number"), "first": 1, "last": 3, "step": 1}
        fields["step"] = self.dice.choice([1, 1, 2, -1, 0.5, 0.1, -0.3])
        fields["first"] = self.dice.randint(-1, 4)
        fields["way"] = ("either", "up", "down")[fields["first"] % 3]
        return B("control.count", fields, inputs, {"do": self._body(loop=True)})

    def _for_each(self) -> B:
        body = self._body(loop=True)
        fields = {"variable": self._variable("any" if self._chance(0.9) else "")}
        return B("control.for_each", fields, {"list": self._list()}, {"do": body})

    def _two_names(self) -> B:
        """A list that has two names is changed by one while it is gone through by the other."""
        first, second = self._variable("list"), self._variable("any")
        names = [B("variable.get", {"variable": one}) for one in (first, second, first, second)]
        self.dice.shuffle(names)
        change = {"list": names[0], "value": self._leaf()}
        body = [B("list.add", inputs=change), self._say(names[1])]
        loop = B(
            "control.for_each", {"variable": self._variable()}, {"list": names[2]}, {"do": body}
        )
        same = B("variable.set", {"variable": second}, {"value": names[3]})
        return B("control.repeat", {"times": 1}, bodies={"do": [same, loop]})

    def _try(self) -> B:
        """Something that mostly fails, and what is done then."""
        bodies = {"do": self._body(), "otherwise": self._body()}
        if self._chance(0.7):
            place = B("math.number", {"number": self.dice.choice([1, 9])})
            item = B("list.get", inputs={"number": place, "list": self._list()})
            bodies["do"].insert(0, self._say(item))
        if self._chance(0.5):
            bodies["otherwise"].insert(0, self._say(self._no_reason()))
        return B("control.try", bodies=bodies)

    def _for_the_robot(self) -> list[B]:
        if self.where.procedure is not None:
            return [self._say()]
        said = B("robot.say", inputs={"robot": B("control.this_robot"), "text": self._any()})
        return [said, *self._body(apart=True)]

    def _no_reason(self) -> B:
        """Whether nothing went wrong: the words of what did are nobody's to judge."""
        return B("text.is_empty", inputs={"text": B("control.went_wrong")})

    def _tell(self) -> B:
        """A message whose rule is waited for: of two that run at once nobody knows the order."""
        fields = {"message": self.dice.choice(self.messages)}
        given = {"value.1": self._any()} if self._chance(0.7) else {}
        return B("event.tell", fields, given, groups={"value": len(given), "wait": 1})

    def _parts(self) -> B:
        kind = self.dice.choice(["control.together", "goal.one_of", "goal.in_turn", EACH_ROBOT])
        if kind == EACH_ROBOT:  # of several nobody knows who is first
            return B(kind, bodies={"do": self._for_the_robot()})
        count = self.dice.randint(1, 3) if kind == "goal.in_turn" else 1
        bodies = {f"do.{n}": self._body(apart=True) for n in range(1, count + 1)}
        if self.where.procedure is not None:  # a part gives nothing back for its own block
            bodies = {slot: [self._say()] for slot in bodies}
        return B(kind, bodies=bodies, groups={"part": count})

    # Values

    def _of(self, kind: str) -> B:
        makers = {"number": self._number, "text": self._text, "list": self._list}
        makers["table"] = self._table
        return {**makers, "boolean": self._boolean}.get(kind, self._any)()

    def _get(self, kind: str) -> B:
        """A variable that mostly holds that, or a value that an own block gets."""
        procedure = self.where.procedure
        if procedure is not None and procedure.parameters and self._chance(0.5):
            fitting = [p for p in procedure.parameters if p.kind in (kind, "any")]
            if fitting:
                return B(f"my.parameter.{procedure.id}.{self.dice.choice(fitting).id}")
        variable = self._variable(kind if self._chance(0.98) else "")
        return B("variable.get", {"variable": variable})

    def _deeper(self) -> bool:
        """Whether a value may have values in it; else it is one that is typed or a variable."""
        return self.where.depth < DEEPEST and self._chance(0.65)

    def _any(self) -> B:
        return self.dice.choice(
            [self._number, self._text, self._text, self._list, self._boolean, self._any_block]
        )()

    def _any_block(self) -> B:
        giving = [p for p in self._known() if p.gives_value]
        if giving and self._chance(0.5):
            return self._call(self.dice.choice(giving))
        if "table" in self.kinds.values() and self._chance(0.4):
            return self._at() if self._chance(0.7) else self._name_with()
        if self._chance(0.5):
            return self._item()
        inputs = {"a": self._leaf(), "b": self._leaf(), "condition": self._boolean()}
        return B("logic.choose", inputs=inputs)

    def _leaf(self) -> B:
        leaves = [self._typed_number, self._typed_text]
        return self.dice.choice([*leaves, lambda: self._get("any")])()

    def _item(self) -> B:
        kind = "list.get" if self._chance(0.8) else "list.take"
        inputs = {"number": self._place(), "list": self._list_variable()}
        return B(kind, {"end": self.dice.choice(["start", "end"])}, inputs)

    def _table_variable(self) -> B:
        return self._get("table") if self._chance(0.98) else self._get("any")

    def _table(self) -> B:
        if self._chance(0.6):
            return self._table_variable()
        if self._chance(0.3):
            return B("table.copy", inputs={"table": self._table_variable()})
        return self._typed_table()

    def _typed_table(self) -> B:
        """A table of up to three keys, mostly texts, with values that are mostly typed."""
        count = self.dice.randint(0, 3)
        makers = [
            self._typed_number,
            self._typed_number,
            self._typed_number,
            self._typed,
            self._leaf,
        ]
        make = self.dice.choice(makers)
        entries = [(self._typed_key(), make()) for _ in range(count)]
        inputs = {f"key.{n}": key for n, (key, _) in enumerate(entries, 1)}
        inputs |= {f"value.{n}": value for n, (_, value) in enumerate(entries, 1)}
        return B("table.create", inputs=inputs, groups={"entry": count})

    def _typed_key(self) -> B:
        if self._chance(0.05):
            return B("logic.truth", {"truth": self.dice.choice(["true", "false"])})
        key = self.dice.choice(KEYS)
        kind = "text" if isinstance(key, str) else "number"
        return B("text.text", {kind: key}) if kind == "text" else B("math.number", {kind: key})

    def _key(self) -> B:
        if self._chance(0.01):
            return self._any()
        return (
            self._get(self.dice.choice(["text", "any"])) if self._chance(0.2) else self._typed_key()
        )

    def _at(self) -> B:
        """What a table has at a key, mostly so that it need not be there."""
        inputs = {"table": self._table_variable(), "key": self._key()}
        if self._chance(0.15):
            return B("table.get", inputs=inputs)
        return B("table.get_or", inputs={**inputs, "otherwise": self._leaf()})

    def _name_with(self) -> B:
        """The name of the largest or smallest value, mostly in a table that can say so."""
        fields = {"extreme": self.dice.choice(["max", "min"])}
        if self._chance(0.4):
            return B("table.name_with", fields, {"table": self._table()})
        value = self.dice.choice([self._typed_number, self._typed_text])
        count = self.dice.randint(0, 3)
        inputs = {f"value.{number}": value() for number in range(1, count + 1)}
        inputs |= {f"key.{number}": self._typed_key() for number in range(1, count + 1)}
        table = B("table.create", inputs=inputs, groups={"entry": count})
        return B("table.name_with", fields, {"table": table})

    def _typed_number(self) -> B:
        return B("math.number", {"number": self.dice.choice(NUMBERS)})

    def _typed_text(self) -> B:
        return B("text.text", {"text": self.dice.choice(TEXTS)})

    def _typed(self) -> B:
        if self._chance(0.3):
            return B("logic.truth", {"truth": self.dice.choice(["true", "false"])})
        return self.dice.choice([self._typed_number, self._typed_text, self._typed_list])()

    def _typed_list(self) -> B:
        """A list of two to four items, mostly of one kind."""
        makers = [self._typed_number, self._typed_number, self._typed_text, self._typed]
        make, count = self.dice.choice(makers), self.dice.randint(2, 4)
        inputs = {f"item.{n}": make() for n in range(1, count + 1)}
        return B("list.create", inputs=inputs, groups={"item": count})

    def _numbers(self) -> B:
        """A list that mostly holds numbers."""
        if self._chance(0.15):
            return self._list()
        count = self.dice.randint(2, 4)
        inputs = {f"item.{n}": self._number() for n in range(1, count + 1)}
        return B("list.create", inputs=inputs, groups={"item": count})

    def _positive(self) -> B:
        """A number that is mostly larger than 0."""
        if self._chance(0.1):
            return self._number()
        return B("math.number", {"number": self.dice.choice([1, 2, 3, 0.5, 10, 2.5])})

    def _small(self) -> B:
        return B("math.number", {"number": self.dice.choice([0, 1, 2, 2, 3, 2.5, 0.5, -1, 4])})

    def _place(self) -> B:
        """The place of an item or letter: mostly one that is there."""
        if self._chance(0.1):
            return self._worked_out_place()
        odd = [3, 0, -1, 1.5] if self._chance(0.1) else [1, 1, 2]
        return B("math.number", {"number": self.dice.choice(odd)})

    def _worked_out_place(self) -> B:
        """A place that is a variable, a length, or near one of them."""
        length = B("list.length", inputs={"list": self._list_variable()})
        number = self._get("number") if self._chance(0.4) else length
        if self._chance(0.4):
            return number
        operation = self.dice.choice(["add", "subtract", "subtract", "multiply", "remainder"])
        inputs = [number, self._small() if self._chance(0.7) else self._get("number")]
        self.dice.shuffle(inputs)
        return B("math.arithmetic", {"operation": operation}, dict(zip("ab", inputs, strict=True)))

    def _number(self) -> B:
        if not self._deeper():
            return self._get("number") if self._chance(0.5) else self._typed_number()
        self.where.depth += 1
        made = self._number_block(self.dice.randint(0, 11))
        self.where.depth -= 1
        return made

    def _number_block(self, which: int) -> B:
        match which:
            case 0 | 1 | 2 | 3:
                operations = ["add", "add", "subtract", "multiply", "divide", "power", "remainder"]
                operation = self.dice.choice([*operations, "floor_divide"])
                inputs = {"a": self._number(), "b": self._number()}
                if operation in ("power", "divide", "remainder", "floor_divide"):
                    inputs["b"] = self._positive()
                return B("math.arithmetic", {"operation": operation}, inputs)
            case 4:
                functions = ["absolute", "root", "minus", "ln", "log10", "exp", "pow10"]
                fields = {"function": self.dice.choice(functions)}
                if fields["function"] == "minus":
                    return B("math.function", fields, {"number": self._small()})
                return B("math.function", fields, {"number": self._positive()})
            case 5:
                way = self.dice.choice(["nearest", "nearest", "up", "down"])
                return B("math.round", {"way": way}, {"number": self._number()})
            case 6:
                inputs = {key: self._number() for key in ("number", "low", "high")}
                return B("math.constrain", inputs=inputs)
            case 7:
                functions = ["sum", "min", "max", "mean", "median", "stdev"]
                fields = {"function": self.dice.choice(functions)}
                return B("math.of_list", fields, {"list": self._numbers()})
            case 8:
                kind = self.dice.choice(["text.length", "list.length", "table.length"])
                key = kind.partition(".")[0]
                return B(kind, inputs={key: self._of(key)})
            case 9:
                return B("list.find", inputs={"item": self._any(), "list": self._list()})
            case 10:
                if self._chance(0.1):
                    return B("text.number", inputs={"text": self._text()})
                written = self.dice.choice(["12", " 7 ", "3,5", "1.50", "-4", "1e3", "+2", ".5"])
                return B("text.number", {"text": written})
        return B("text.find", inputs={"part": self._leaf(), "text": self._text()})

    def _text(self) -> B:
        if self._chance(0.04):
            return self._any()
        if not self._deeper():
            return self._get("text") if self._chance(0.5) else self._typed_text()
        self.where.depth += 1
        made = self._text_block(self.dice.randint(0, 6))
        self.where.depth -= 1
        return made

    def _text_block(self, which: int) -> B:
        match which:
            case 0 | 1:
                count = self.dice.randint(2, 3)
                inputs = {f"item.{n}": self._any() for n in range(1, count + 1)}
                return B("text.join", inputs=inputs, groups={"item": count})
            case 2:
                inputs = {"number": self._place(), "text": self._text()}
                return B("text.letter", inputs=inputs)
            case 3:
                case = self.dice.choice(["upper", "lower", "title", "title"])
                return B("text.case", {"case": case}, {"text": self._text()})
            case 4:
                inputs = {key: self._text() for key in ("text", "new", "part")}
                return B("text.replace", inputs=inputs)
            case 5:
                inputs = {"list": self._list(), "mark": self._leaf()}
                return B("list.joined", inputs=inputs)
        return self._typed_text()

    def _list_variable(self) -> B:
        return self._get("list") if self._chance(0.98) else self._get("any")

    def _list(self) -> B:
        if not self._deeper():
            return self._list_variable()
        self.where.depth += 1
        made = self._list_block(self.dice.randint(0, 9))
        self.where.depth -= 1
        return made

    def _list_block(self, which: int) -> B:
        match which:
            case 0 | 1 | 2:
                count = self.dice.randint(1, 4)
                make = self.dice.choice([self._any, self._typed_number, self._typed_text])
                inputs = {f"item.{n}": make() for n in range(1, count + 1)}
                return B("list.create", inputs=inputs, groups={"item": count})
            case 3:
                return B("list.filled", inputs={"item": self._any(), "times": self._small()})
            case 4:
                inputs = {"first": self._place(), "last": self._place(), "list": self._list()}
                return B("list.part", inputs=inputs)
            case 5:
                order = self.dice.choice(["up", "down"])
                return B("list.sorted", {"order": order}, {"list": self._numbers()})
            case 6:
                return B("list.split", inputs={"text": self._text(), "mark": self._leaf()})
            case 7:
                return B("list.copy", inputs={"list": self._list()})
            case 8 if "table" in self.kinds.values():
                kind = self.dice.choice(["table.names", "table.values"])
                return B(kind, inputs={"table": self._table()})
        return B("list.reversed", inputs={"list": self._list()})

    def _boolean(self) -> B:
        if not self._deeper():
            if self._chance(0.5):
                if self._chance(0.05):
                    return self._no_reason()
                return B("logic.truth", {"truth": self.dice.choice(["true", "false"])})
            return self._get("boolean" if self._chance(0.8) else "any")
        self.where.depth += 1
        made = self._boolean_block(self.dice.randint(0, 13))
        self.where.depth -= 1
        return made

    def _boolean_block(self, which: int) -> B:
        match which:
            case 0 | 1:
                comparison = self.dice.choice(["equal", "not_equal"])
                inputs = {"a": self._any(), "b": self._any()}
                return B("logic.compare", {"comparison": comparison}, inputs)
            case 2 | 3:
                comparisons = ["less", "less_or_equal", "greater", "greater_or_equal"]
                make = self.dice.choice([self._number, self._number, self._text])
                fields = {"comparison": self.dice.choice(comparisons)}
                return B("logic.compare", fields, {"a": make(), "b": make()})
            case 4:
                inputs = {"a": self._boolean(), "b": self._boolean()}
                groups = {"more": self.dice.choice([0, 0, 0, 1])}
                if groups["more"]:
                    inputs["c.1"] = self._boolean()
                fields = {"junction": self.dice.choice(["and", "or"])}
                return B("logic.junction", fields, inputs, groups=groups)
            case 5:
                return B("logic.not", inputs={"a": self._boolean()})
            case 6:
                properties = ["even", "odd", "whole", "positive", "negative"]
                fields = {"property": self.dice.choice(properties)}
                return B("logic.number_is", fields, {"number": self._number()})
            case 7:
                return B("text.contains", inputs={"text": self._text(), "part": self._leaf()})
            case 8:
                return B("list.contains", inputs={"list": self._list(), "item": self._any()})
            case 9:
                return B("text.is_empty", inputs={"text": self._text()})
            case 10:
                return B("list.is_empty", inputs={"list": self._list()})
            case 11 if "table" in self.kinds.values():
                if self._chance(0.3):
                    return B("table.is_empty", inputs={"table": self._table()})
                return B("table.has", inputs={"table": self._table(), "key": self._key()})
            case 12:
                return self._fact("plan.is_true")
        inputs = {"number": self._number(), "divisor": self._positive()}
        return B("logic.divisible", inputs=inputs)


_LAST = ("control.leave_loop", "control.next_round", "control.stop_rule", "my.return")
