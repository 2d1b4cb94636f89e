"""Behaviour trees of a file of BehaviorTree.CPP as blocks.

What the file only names becomes an own block of that name, which a person fills: an action in a
step, a condition in a check. A value such as ``{goal}`` is a value of the tree.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from faults import Text, text_of

from ..arithmetic import is_number_text, number_of, typed_number
from ..editor import Editor
from ..from_python.learning import Made
from ..from_python.reading import create_chain
from ..procedures import CALL, DEFINE, RETURN, header_of, parameters, title
from ..program import Procedure
from ..slots import LONGEST_NAME, FieldValue, why_not_name
from .elements import Element, TreeFileError
from .plain import KNOWN, Plain, asks, marked
from .scripts import Reader, Value, fill, numbered, set_value, turned
from .values import given_to, key_of, names_in, output_name, ports_of, values_of

MAIN_TREE = "MainTree"
_CUSTOM = ("Action", "Condition", "Control", "Decorator", "SubTree")

# The parts that blocks have: the block with its fields, by the tag.

_ROWS: dict[str, tuple[str, dict[str, FieldValue]]] = {
    "Sequence": ("tree.sequence", {"order": "memory"}),
    "AsyncSequence": ("tree.sequence", {"order": "memory"}),
    "ReactiveSequence": ("tree.sequence", {"order": "reactive"}),
    "SequenceWithMemory": ("tree.sequence", {"order": "keeps"}),
    "Fallback": ("tree.fallback", {"order": "memory"}),
    "AsyncFallback": ("tree.fallback", {"order": "memory"}),
    "ReactiveFallback": ("tree.fallback", {"order": "reactive"}),
    "Inverter": ("tree.instead", {"outcome": "invert"}),
    "ForceSuccess": ("tree.instead", {"outcome": "success"}),
    "ForceFailure": ("tree.instead", {"outcome": "failure"}),
    "KeepRunningUntilFailure": ("tree.repeat", {}),
}
_LIMITED = {
    "Parallel": ("tree.parallel", "enough", ("success_count", "success_threshold")),
    "RetryUntilSuccessful": ("tree.retry", "times", ("num_attempts",)),
    "Repeat": ("tree.repeat", "times", ("num_cycles",)),
}
"""Parts with a number, which is -1 when there is no limit: its slot, its attributes."""
_TIMED = {
    "Timeout": ("tree.time_limit", "msec", 1000),
    "Delay": ("tree.delay", "delay_msec", 1000),
    "CoolDown": ("tree.cool_down", "seconds", 1),
}
_TRUTHS = {"AlwaysSuccess": "true", "AlwaysFailure": "false"}
_REACTIVE = ("ReactiveSequence", "ReactiveFallback")
_AT_ONCE = ("AlwaysSuccess", "AlwaysFailure", "Script", "SetBlackboard")
_ROOM = 90
"""So many letters of a script are the name of an own block."""

# How often a part is asked for what it does: while it stands before others that are asked from the
# first again, what it does must be done within one look, else the later ones would never end.

_ONCE, _INSIDE, _AGAIN = 0, 1, 2
"""As a step does it; its scripts within one look; what it does itself, too."""


@dataclass(slots=True)
class Model:
    """What a file tells of a part of its own: what it is, and what goes in and out by name."""

    kind: str = "Action"
    inputs: dict[str, str | None] = field(default_factory=dict)
    outputs: dict[str, str | None] = field(default_factory=dict)
    """By name; with what goes in where a tree does not say it."""

    def results(self) -> list[str]:
        """What only comes out."""
        return [port for port in self.outputs if port and port not in self.inputs]


@dataclass(frozen=True, slots=True)
class Imported:
    """The first blocks of the trees that were made, and what of the file is not in them."""

    trees: tuple[str, ...]
    told: tuple[Text, ...]


def import_trees(editor: Editor, root: Element, page: str = "behaviour") -> Imported:
    """Make the trees of a file, and the own blocks that they need, on a page, in one step.

    Raises TreeFileError or EditRefused; the project is unchanged then.
    """
    trees = list(root.named("BehaviorTree"))
    if root.tag != "root" or not trees:
        raise TreeFileError(
            "There is no behaviour tree in this file.",
            checklist=(
                "Its outermost element is “root”, and “BehaviorTree” stands in that.",
                "Is it a file that Groot or BehaviorTree.CPP wrote?",
            ),
        )
    with editor.history.transaction("Import behaviour trees"):
        return _Reader(editor, root, trees, page).read()


class _Reader:
    """Reads one file."""

    def __init__(self, editor: Editor, root: Element, trees: list[Element], page: str) -> None:
        self._editor = editor
        self._root = root
        self._trees = trees
        self._page = page
        self._told: dict[str, Text] = {}
        self._there = _tree_names(editor)
        self._names = dict(_new_names(self._there, trees))
        for include in root.named("include"):
            self._tell(
                "The file names another one, “{path}”: import that too.",
                path=include.attributes.get("path", ""),
            )
        told_models = _told_models(root)
        entries = names_in(root)
        is_3 = root.attributes.get("BTCPP_format", "").strip() != "4"
        plain = Plain(told_models.__contains__, self._tell, set(entries), is_3)
        self._parts = [plain.tree(_top(tree)) for tree in trees]
        self._entries = entries | plain.taken
        for part in itertools.chain.from_iterable(self._parts):
            self._entries |= names_in(part)
        self._models = _models(told_models, self._parts)
        self._add_defaults()
        named = dict(zip(map(_id, trees), self._parts, strict=True))
        self._values = values_of(named, self._is_output, self._is_entry)
        self._made = plain.taken - entries
        numbers = _numbers(itertools.chain.from_iterable(self._parts))
        self._scripts = Reader(self._is_entry, numbers.__contains__, self._tell_word)
        self._own: dict[tuple[str, bool], Procedure] = {}
        self._free_y = _below(editor, page)

    def read(self) -> Imported:
        main = self._main()
        made = []
        for tree, parts in zip(self._trees, self._parts, strict=True):
            name = _id(tree)
            runs = "at_start" if name == main else "when_asked"
            hat = Made("tree.tree", {"name": self._names[name], "runs": runs})
            hat.comment = _line(tree.attributes.get("_description", ""))
            chain = self._with_first(self._from_outside(name), self._all(parts))
            made.append(self._put([hat, *chain]))
        return Imported(tuple(made), tuple(self._told.values()))

    def _main(self) -> str:
        """The name of the tree that begins: the file says it, or no other tree names it."""
        said = self._root.attributes.get("main_tree_to_execute")
        if said is not None:
            return said
        named = {
            element.attributes.get("ID", element.tag)
            for part in itertools.chain.from_iterable(self._parts)
            for element in part.inner()
        }
        free = [name for tree in self._trees if (name := _id(tree)) not in named]
        if len(free) > 1 and MAIN_TREE in free:
            return MAIN_TREE
        return free[0] if len(free) == 1 else ""

    def _tell(self, sentence: str, **values: object) -> None:
        said = text_of(sentence, **values)
        self._told.setdefault(str(said), said)

    def _tell_word(self, word: str) -> None:
        self._tell("“{word}” is a name of C++: here it is a text.", word=word)

    def _is_entry(self, name: str) -> bool:
        return name in self._entries or not name.isupper()

    def _is_output(self, element: Element, port: str) -> bool:
        model = self._models.get(_model_key(element))
        return model is not None and port in model.outputs and port not in model.inputs

    def _add_defaults(self) -> None:
        """Give the trees inside others what their models say that they get."""
        for part in itertools.chain.from_iterable(self._parts):
            for element in part.inner():
                model = self._models.get(element.attributes.get("ID", ""))
                if element.tag == "SubTree" and model is not None and model.kind == "SubTree":
                    known = dict(given_to(element))
                    for port, text in (model.inputs | model.outputs).items():
                        if text is not None and port not in known:
                            element.attributes[port] = text

    def _from_outside(self, name: str) -> list[Made]:
        """A step that sets the values that only a program in C++ would have set before."""
        missing = self._values[name].missing()
        if not missing:
            return []
        if told := [key for key in missing if key not in self._made]:
            self._tell(
                "Nothing in the file sets “{values}”: the first step of “{tree}” does it.",
                values=", ".join(told),
                tree=self._names[name],
            )
        first = self._editor.language.word("set what comes from outside")
        return [_step(first, [set_value(key, (0, None)) for key in missing])]

    def _with_first(self, first: list[Made], chain: list[Made]) -> list[Made]:
        """A chain with something done before it."""
        if not first:
            return chain
        top = chain[0] if len(chain) == 1 else None
        if top is not None and top.type == "tree.sequence" and top.fields["order"] == "memory":
            top.bodies["do"][:0] = first
            return chain
        return [Made("tree.sequence", {"order": "memory"}, bodies={"do": [*first, *chain]})]

    def _all(self, elements: Iterable[Element], again: int = _ONCE) -> list[Made]:
        return [self._one(element, again) for element in elements]

    def _one(self, element: Element, again: int = _ONCE) -> Made:
        """The block of an element, with those inside it."""
        made = self._part(element, again)
        if made.type != "tree.step" and not made.comment:
            made.comment = _line(element.attributes.get("name", ""))
        if "_onHalted" in element.attributes:
            self._tell_left(element, "_onHalted")
        return made

    def _part(self, element: Element, again: int) -> Made:
        tag = element.tag
        if tag == "Inverter" and (asked := self._inverted(element)) is not None:
            return asked
        if tag in _ROWS:
            kind, fields = _ROWS[tag]
            return Made(kind, dict(fields), bodies={"do": self._inside(element, again)})
        if tag in _LIMITED:
            return self._limited(element, again)
        if tag in _TIMED:
            return self._timed(element, again)
        if tag in _TRUTHS:
            return _check(Made("logic.truth", {"truth": _TRUTHS[tag]}))
        if tag == "ScriptCondition":
            return self._script_condition(element)
        if tag == "SubTree" or (tag in self._names and not element.children):
            return self._sub_tree(element)
        if tag in ("Script", "SetBlackboard"):
            return self._script(element, again)
        if element.children or tag in ("Control", "Decorator"):
            return self._unknown(element, again)
        return self._custom(element, again)

    def _unknown(self, element: Element, again: int) -> Made:
        """A part around others that only C++ knows."""
        name = element.attributes.get("ID", element.tag)
        self._tell("“{name}” is not known: what is in it is done in order.", name=name)
        inside = self._inside(element, again)
        if len(inside) == 1:
            return inside[0]
        return Made("tree.sequence", {"order": "memory"}, bodies={"do": inside})

    def _inside(self, element: Element, again: int) -> list[Made]:
        """What is in a part, with how often it is asked."""
        children, made = element.children, []
        is_guarded = False
        for at, child in enumerate(children):
            asked = min(again, _INSIDE) if is_guarded else again
            if element.tag in _REACTIVE and any(map(self._may_run, children[at + 1 :])):
                asked = _AGAIN
            elif element.tag in _REACTIVE and child.tag in ("Script", "SetBlackboard"):
                asked = max(asked, _INSIDE)  # what stands before it is not asked again meanwhile
            made.append(self._one(child, asked))
            is_guarded |= element.tag.endswith("Fallback") or any(map(self._asks, child.inner()))
        return made

    def _asks(self, part: Element) -> bool:
        """Whether a part is a condition."""
        if part.tag == "ScriptCondition":
            return True
        model = self._models.get(_model_key(part))
        return not part.children and model is not None and model.kind == "Condition"

    def _may_run(self, part: Element) -> bool:
        """Whether a part may take longer than one look."""
        return any(
            not one.children and one.tag not in _AT_ONCE and not self._asks(one)
            for one in part.inner()
        )

    def _inverted(self, element: Element) -> Made | None:
        """A condition that is turned around is one condition."""
        inside = element.children[0] if len(element.children) == 1 else None
        if inside is None or inside.tag != "ScriptCondition":
            return None
        condition = self._scripts.condition(inside.attributes.get("code", ""))
        return None if condition is None else _check(turned(condition))

    def _script_condition(self, element: Element) -> Made:
        code = _line(element.attributes.get("code", ""))
        condition = self._scripts.condition(code)
        if condition is not None:
            return _check(condition)
        self._tell("The script “{code}” is more than blocks can read.", code=code)
        return self._custom(Element("Condition", {"ID": code or "ScriptCondition"}), _ONCE)

    def _limited(self, element: Element, again: int) -> Made:
        kind, slot, attributes = _LIMITED[element.tag]
        attribute = next((a for a in attributes if a in element.attributes), "")
        made = Made(kind, bodies={"do": self._inside(element, again)})
        if element.attributes.get(attribute, "-1").strip() != "-1":
            made.groups["limit"] = 1
            self._fill_number(made, f"{slot}.1", element, attribute, 1)
        for failures in ("failure_count", "failure_threshold"):
            if element.attributes.get(failures, "1").strip() != "1":
                self._tell_left(element, failures)
        return made

    def _tell_left(self, element: Element, attribute: str) -> None:
        self._tell(
            "“{attribute}” of “{tag}” is not taken over.", attribute=attribute, tag=element.tag
        )

    def _timed(self, element: Element, again: int) -> Made:
        kind, attribute, per_second = _TIMED[element.tag]
        made = Made(kind, bodies={"do": self._inside(element, again)})
        self._fill_number(made, "seconds", element, attribute, per_second)
        return made

    def _fill_number(
        self, made: Made, key: str, element: Element, attribute: str, per_one: int
    ) -> None:
        """Put a number, or a value of the tree, into a slot; the slot keeps its own otherwise."""
        text = element.attributes.get(attribute, "")
        if name := marked(text):
            value = _value_of(name)
            if per_one != 1:
                divided: dict[str, FieldValue] = {"operation": "divide", "b": per_one}
                value = Made("math.arithmetic", divided, {"a": value})
            made.inputs[key] = value
        elif is_number_text(text.strip()) and not (key == "seconds" and "-" in text):
            number = number_of(typed_number(text.strip()))
            made.fields[key] = int(number // per_one) if number % per_one == 0 else number / per_one
        else:
            self._tell_left(element, attribute)

    def _sub_tree(self, element: Element) -> Made:
        name = element.attributes.get("ID", element.tag)
        if name not in self._names and name not in self._there:
            self._tell(
                "The tree “{name}” is not in the file: import it too, or make it.", name=name
            )
        made = Made("tree.sub_tree", {"name": self._names.get(name, _line(name))})
        if chain := [one for key, text in given_to(element) for one in _port(key, text)]:
            made.groups["ports"], made.bodies["ports.1"] = 1, chain
        return made

    def _script(self, element: Element, again: int) -> Made:
        """A step that sets values of the tree, or, where it does more, an own block."""
        code = _line(element.attributes.get("code", ""))
        if element.tag == "SetBlackboard":
            text = element.attributes.get("value", "")
            value = _literal(text)
            shown = f"'{text}'" if isinstance(value[0], str) else marked(text) or text
            code = f"{key_of(element)} := {shown}"
            sets: list[Made] | None = [set_value(key_of(element), value)]
        else:
            sets = self._scripts.statements(code)
        if sets is None:
            self._tell("The script “{code}” is more than blocks can read.", code=code)
            return self._custom(Element("Action", {"ID": code or "Script"}, element.line), again)
        name = _line(element.attributes.get("name", "")) or code
        if not again:
            return _step(name, sets)
        return _check(Made(CALL + self._at_once(name, sets).id))

    def _at_once(self, name: str, body: list[Made]) -> Procedure:
        """An own block that does something within one look, and says yes."""
        made = self._editor.add_procedure([_short(name)], gives_value=True)
        procedure = self._editor.project.procedures[made]
        truth = Made("logic.truth", {"truth": "true"})
        self._put([Made(DEFINE + made), *body, Made(RETURN, inputs={"value": truth})])
        return procedure

    def _custom(self, element: Element, again: int) -> Made:
        """A part that only the file knows: an own block of its name."""
        name = _model_key(element)
        kind = element.tag if element.tag == "Condition" else "Action"
        model = self._models.setdefault(name, Model(kind))
        is_asked = model.kind == "Condition" or again == _AGAIN
        if is_asked and model.kind != "Condition":
            self._tell(
                "“{name}” is asked at each look before others go on: here it is a condition.",
                name=name,
            )
        procedure = self._own_block(name, model, is_asked)
        call = Made(CALL + procedure.id)
        inputs = [port for port in model.inputs if _is_port_name(port)]
        for port, parameter in zip(inputs, parameters(procedure), strict=True):
            text = element.attributes.get(port, model.inputs[port])
            fill(call, parameter.id, *_literal(text or ""))
        if is_asked:
            return _check(call)
        body = [
            set_value(ours, (None, _value_of(port)))
            for port in model.results()
            if (ours := output_name(element.attributes.get(port, "")))
        ]
        return _step(_line(element.attributes.get("name", "")) or name, [call, *body])

    def _own_block(self, name: str, model: Model, is_asked: bool) -> Procedure:
        """The own block of a name, which is made when there is none with such values."""
        if (name, is_asked) not in self._own:
            title_of_it = _short(name)
            if (reason := why_not_name(title_of_it)) is not None:
                raise TreeFileError(
                    "An action or condition cannot be called “{name}”: {reason}",
                    checklist=("Give it a shorter name of one line in the file.",),
                    name=title_of_it,
                    reason=reason,
                )
            known = self._known(title_of_it, model, is_asked)
            made = known or self._new_block(name, model, is_asked)
            self._own[name, is_asked] = made
        return self._own[name, is_asked]

    def _known(self, name: str, model: Model, is_asked: bool) -> Procedure | None:
        project = self._editor.project
        inputs = [_line(port) for port in model.inputs if _is_port_name(port)]
        wanted = " ".join([name, *(f"({port})" for port in inputs)])
        for procedure in project.procedures.values():
            if title(procedure) == wanted and procedure.gives_value == is_asked:
                return procedure if header_of(project, procedure.id) else None
        return None

    def _new_block(self, key: str, model: Model, is_asked: bool) -> Procedure:
        inputs = [_line(port) for port in model.inputs if _is_port_name(port)]
        given = [self._editor.new_parameter(port, "any") for port in inputs]
        made = self._editor.add_procedure([_short(key), *given], gives_value=is_asked)
        procedure = self._editor.project.procedures[made]
        chain = [Made(DEFINE + procedure.id)]
        word = self._editor.language.word
        note = word("fill in here what this does")
        if is_asked:
            note = word("find out here whether this is so")
        chain.append(Made("control.note", {"text": note}))
        chain += [set_value(one, (0, None)) for one in self._results(key, model, is_asked)]
        if is_asked:
            truth = Made("logic.truth", {"truth": "true"})
            chain.append(Made(RETURN, inputs={"value": truth}))
        self._put(chain)
        return procedure

    def _results(self, key: str, model: Model, is_asked: bool) -> list[str]:
        """The values that an own block sets: a condition those outside, by their names there."""
        if not is_asked:
            return model.results()
        texts = (
            one.attributes.get(port, "")
            for port in model.results()
            for part in itertools.chain.from_iterable(self._parts)
            for one in part.inner()
            if _model_key(one) == key
        )
        return list(dict.fromkeys(filter(None, map(output_name, texts))))

    def _put(self, chain: list[Made]) -> str:
        """Make a stack below all that are on the page; gives its first block."""
        first = create_chain(self._editor, chain, (_MARGIN, self._free_y), self._page)
        self._free_y += _height_of(chain)
        return first


# What a file says before its trees are read.


def _tree_names(editor: Editor) -> set[str]:
    """The names of the trees of the project."""
    project = editor.project
    return {
        str(editor.language.definitions[block.type].value(block, "name"))
        for block in project.blocks.values()
        if block.type == "tree.tree"
    }


def _new_names(there: set[str], trees: list[Element]) -> Iterator[tuple[str, str]]:
    """The names of the trees of a file, each with one that no tree of the project has."""
    taken = set(there)
    for tree in trees:
        name = _id(tree)
        numbered = (f"{name} {number}" for number in itertools.count(2))
        free = next(one for one in itertools.chain([name], numbered) if one not in taken)
        taken.add(free)
        yield name, free


def _model_key(element: Element) -> str:
    return element.attributes.get("ID") or element.tag


def _id(tree: Element) -> str:
    return tree.attributes.get("ID", MAIN_TREE)


def _numbers(parts: Iterable[Element]) -> set[str]:
    """The names of values that are numbers, as far as a file tells."""
    found: set[str] = set()
    for element in (one for part in parts for one in part.inner()):
        found.update(numbered(element.attributes.get("code", "")))
        if element.tag == "SetBlackboard" and is_number_text(element.attributes.get("value", "")):
            found.add(key_of(element))
    return found


def _top(tree: Element) -> list[Element]:
    """What stands in a tree; Groot once put it into a “Root”."""
    roots = list(tree.named("Root"))
    return roots[0].children if len(roots) == len(tree.children) == 1 else tree.children


def _told_models(root: Element) -> dict[str, Model]:
    """What a file says of its own parts, and which it writes as what they are."""
    models: dict[str, Model] = {}
    for described in root.named("TreeNodesModel"):
        for element in described.named(*_CUSTOM):
            model = models.setdefault(element.attributes.get("ID", ""), Model(element.tag))
            for port in element.named("input_port", "inout_port"):
                model.inputs[port.attributes.get("name", "")] = port.attributes.get("default")
            for port in element.named("output_port"):
                model.outputs[port.attributes.get("name", "")] = port.attributes.get("default")
    for element in root.inner():
        if element.tag in ("Action", "Condition") and "ID" in element.attributes:
            models.setdefault(element.attributes["ID"], Model(element.tag))
    return models


def _models(told: dict[str, Model], parts: list[list[Element]]) -> dict[str, Model]:
    """What a file says of its own parts, and how its trees use them."""
    models = dict(told)
    inner = (one for row in parts for part in row for one in part.inner())
    for element in inner:
        key = _model_key(element)
        if element.tag in KNOWN:
            continue
        model = models.setdefault(key, Model("Condition" if asks(key) else "Action"))
        if element.tag in ("Action", "Condition"):
            model.kind = element.tag
        for attribute in ports_of(element):
            if attribute not in model.outputs:
                model.inputs.setdefault(attribute)
    return models


# Where stacks are put: how high they are drawn is not known yet, so that it is reckoned roughly.

_MARGIN, _ROW, _GAP = 40.0, 44.0, 80.0


def _below(editor: Editor, page: str) -> float:
    """A height on a page below all of its stacks."""
    project = editor.project
    ends = [
        stack.y + _GAP + _ROW * sum(1 + len(b.bodies) for b in project.within(stack.body))
        for stack in project.pages[page]
    ]
    return max(ends, default=_MARGIN)


def _height_of(chain: Iterable[Made]) -> float:
    waiting, rows = list(chain), 0
    while waiting:
        made = waiting.pop()
        rows += 1 + len(made.bodies)
        waiting += [one for inside in made.bodies.values() for one in inside]
    return _GAP + _ROW * rows


# Small pieces of blocks.


def _check(condition: Made) -> Made:
    return Made("tree.check", inputs={"condition": condition})


def _step(name: str, body: list[Made]) -> Made:
    return Made("tree.step", {"name": " ".join(name.split())}, bodies={"do": body})


def _value_of(key: str) -> Made:
    return Made("tree.value", {"key": key})


def _line(text: str) -> str:
    """A text as one line."""
    return " ".join(text.split())


def _short(name: str) -> str:
    """A name that is not too long for a block."""
    name = _line(name)
    return name if len(name) <= LONGEST_NAME else f"{name[:_ROOM]} …"


def _is_port_name(port: str) -> bool:
    return bool(port.strip()) and why_not_name(_line(port)) is None


def _port(key: str, text: str) -> Iterator[Made]:
    """What goes into a tree under a name, and comes out again where it has one outside."""
    made = Made("tree.input", {"key": key})
    fill(made, "value", *_literal(text))
    yield made
    if ours := marked(text):
        yield Made("tree.output", {"key": key, "ours": ours})


def _literal(text: str) -> Value:
    """What an attribute holds: a value as it is typed, or a value of the tree."""
    if name := marked(text):
        return None, _value_of(name)
    if text in ("true", "false"):
        return None, Made("logic.truth", {"truth": text})
    if is_number_text(text) and str(number := typed_number(text)) == text:
        return number, None
    return text, None
