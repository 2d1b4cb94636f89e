"""Behaviour trees of a file of BehaviorTree.CPP as blocks.

What the file only names becomes an own block of that name, which a person fills: an action in a
step, a condition in a check. A value such as ``{goal}`` is a value of the tree.
"""

from __future__ import annotations

import ast
import itertools
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from faults import Text, text_of

from ..arithmetic import is_number_text, number_of, typed_number
from ..editor import Editor
from ..from_python.learning import Made
from ..from_python.reading import create_chain
from ..procedures import CALL, DEFINE, RETURN, header_of, parameters, title
from ..program import Procedure
from ..slots import FieldValue, why_not_name
from .elements import Element, TreeFileError

MAIN_TREE = "MainTree"
_MARK = re.compile(r"\{\s*=?([^{}]*)\}")
_ASSIGNED = re.compile(r"\s*([A-Za-z_@][\w.@]*)\s*:?=(?!=)\s*(.+?)\s*")
_STATEMENT = re.compile(r"""(?:'[^']*'|"[^"]*"|[^;])+""")
_NAME = re.compile(r"[A-Za-z_@][\w.@]*")
_NOT_PORTS = frozenset({"ID", "name"})
_CUSTOM = ("Action", "Condition", "Control", "Decorator", "SubTree")

# The parts that blocks have: the block with its fields, by the tag.

_ROWS: dict[str, tuple[str, dict[str, FieldValue]]] = {
    "Sequence": ("tree.sequence", {"order": "memory"}),
    "AsyncSequence": ("tree.sequence", {"order": "memory"}),
    "ReactiveSequence": ("tree.sequence", {"order": "reactive"}),
    "SequenceWithMemory": ("tree.sequence", {"order": "keeps"}),
    "SequenceStar": ("tree.sequence", {"order": "keeps"}),
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
    "RetryUntilSuccesful": ("tree.retry", "times", ("num_attempts",)),
    "Repeat": ("tree.repeat", "times", ("num_cycles",)),
}
"""Parts with a number, which is -1 when there is no limit: its slot, its attributes."""
_TIMED = {
    "Timeout": ("tree.time_limit", "msec", 1000),
    "Delay": ("tree.delay", "delay_msec", 1000),
    "CoolDown": ("tree.cool_down", "seconds", 1),
}
_TRUTHS = {"AlwaysSuccess": "true", "AlwaysFailure": "false"}


@dataclass(slots=True)
class Model:
    """What a file tells of a part of its own: what it is, and what goes in and out by name."""

    kind: str = "Action"
    inputs: dict[str, None] = field(default_factory=dict)
    outputs: dict[str, None] = field(default_factory=dict)


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
        self._names = dict(_new_names(editor, trees))
        self._models = _models(root, trees, self._names)
        self._own: dict[str, Procedure] = {}
        self._free_y = _below(editor, page)

    def read(self) -> Imported:
        for include in self._root.named("include"):
            self._tell(
                "The file names another one, “{path}”: import that too.",
                path=include.attributes.get("path", ""),
            )
        main = self._main()
        made = []
        for tree in self._trees:
            name = tree.attributes.get("ID", MAIN_TREE)
            runs = "at_start" if name == main else "when_asked"
            hat = Made("tree.tree", {"name": self._names[name], "runs": runs})
            chain = [hat, *self._all(tree.children)]
            made.append(self._put(chain))
        return Imported(tuple(made), tuple(self._told.values()))

    def _main(self) -> str:
        """The name of the tree that begins: the file says it, or no other tree names it."""
        said = self._root.attributes.get("main_tree_to_execute")
        if said is not None:
            return said
        named = {e.attributes.get("ID") for e in self._root.inner() if e.tag.startswith("SubTree")}
        names = [tree.attributes.get("ID", MAIN_TREE) for tree in self._trees]
        free = [name for name in names if name not in named]
        return free[0] if len(free) == 1 else ""

    def _tell(self, sentence: str, **values: str) -> None:
        said = text_of(sentence, **values)
        self._told.setdefault(str(said), said)

    def _all(self, elements: Iterable[Element]) -> list[Made]:
        return [self._one(element) for element in elements]

    def _one(self, element: Element) -> Made:
        """The block of an element, with those inside it."""
        made = self._part(element)
        if made.type != "tree.step":
            made.comment = element.attributes.get("name", "")
        self._tell_unread(element)
        return made

    def _tell_unread(self, element: Element) -> None:
        for attribute in element.attributes:
            if attribute.startswith("_"):
                self._tell_left(element, attribute)

    def _part(self, element: Element) -> Made:
        tag = element.tag
        if tag in _ROWS:
            kind, fields = _ROWS[tag]
            return Made(kind, dict(fields), bodies={"do": self._all(element.children)})
        if tag in _LIMITED:
            return self._limited(element)
        if tag in _TIMED:
            return self._timed(element)
        if tag in _TRUTHS:
            return _check(Made("logic.truth", {"truth": _TRUTHS[tag]}))
        if tag in ("SubTree", "SubTreePlus") or (tag in self._names and not element.children):
            return self._sub_tree(element)
        if tag in ("Script", "SetBlackboard"):
            return self._script(element)
        if element.children or tag in ("Control", "Decorator"):
            name = element.attributes.get("ID", tag)
            self._tell("“{name}” is not known: what is in it is done in order.", name=name)
            fields = {"order": "memory"}
            return Made("tree.sequence", {**fields}, bodies={"do": self._all(element.children)})
        return self._custom(element)

    def _limited(self, element: Element) -> Made:
        kind, slot, attributes = _LIMITED[element.tag]
        attribute = next((a for a in attributes if a in element.attributes), "")
        made = Made(kind, bodies={"do": self._all(element.children)})
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

    def _timed(self, element: Element) -> Made:
        kind, attribute, per_second = _TIMED[element.tag]
        made = Made(kind, bodies={"do": self._all(element.children)})
        self._fill_number(made, "seconds", element, attribute, per_second)
        return made

    def _fill_number(
        self, made: Made, key: str, element: Element, attribute: str, per_one: int
    ) -> None:
        """Put a number, or a value of the tree, into a slot; the slot keeps its own otherwise."""
        text = element.attributes.get(attribute, "")
        if marked := _marked(text):
            value = _value_of(marked)
            if per_one != 1:
                divided: dict[str, FieldValue] = {"operation": "divide", "b": per_one}
                value = Made("math.arithmetic", divided, {"a": value})
            made.inputs[key] = value
        elif is_number_text(text.strip()):
            number = number_of(typed_number(text.strip()))
            made.fields[key] = int(number // per_one) if number % per_one == 0 else number / per_one
        else:
            self._tell_left(element, attribute)

    def _sub_tree(self, element: Element) -> Made:
        name = element.attributes.get("ID", element.tag)
        made = Made("tree.sub_tree", {"name": self._names.get(name, name)})
        ports = {
            key: value
            for key, value in element.attributes.items()
            if key not in _NOT_PORTS and not key.startswith("_")
        }
        for remap in element.named("remap"):  # as version 3 says it
            inner, outer = (remap.attributes.get(key, "") for key in ("internal", "external"))
            ports[inner] = f"{{{outer}}}"
        if chain := [one for key, text in ports.items() for one in _port(key, text)]:
            made.groups["ports"], made.bodies["ports.1"] = 1, chain
        return made

    def _script(self, element: Element) -> Made:
        """A step that sets values of the tree, or, where it does more, an own block."""
        code = element.attributes.get("code", "").strip()
        if element.tag == "SetBlackboard":
            key = element.attributes.get("output_key", element.attributes.get("key", ""))
            text = element.attributes.get("value", "")
            key = _marked(key) or key
            return _step(f"{key} := {text}", [_set(key, *_literal(text))])
        sets = list(_assignments(code))
        if code and None not in sets:
            return _step(code, [one for one in sets if one is not None])
        own = Element("Action", {"ID": code or "Script"}, element.line)
        self._tell("The script “{code}” is more than blocks can read.", code=code)
        return self._custom(own)

    def _custom(self, element: Element) -> Made:
        """A part that only the file knows: an own block of its name."""
        name = element.attributes.get("ID", element.tag)
        model = self._models.get(_model_key(element), Model())
        procedure = self._own_block(name, model)
        call = Made(CALL + procedure.id)
        for parameter in parameters(procedure):
            text = element.attributes.get(parameter.name)
            if text is not None:
                _fill(call, parameter.id, *_literal(text))
        if model.kind == "Condition":
            return _check(call)
        results = [
            _set(ours, None, _value_of(port))
            for port in model.outputs
            if (ours := _marked(element.attributes.get(port, "")))
        ]
        return _step(element.attributes.get("name", name), [call, *results])

    def _own_block(self, name: str, model: Model) -> Procedure:
        """The own block of a name, which is made when there is none with such values."""
        if name not in self._own:
            if (reason := why_not_name(name)) is not None:
                raise TreeFileError(
                    "An action or condition cannot be called “{name}”: {reason}",
                    checklist=("Give it a shorter name of one line in the file.",),
                    name=name,
                    reason=reason,
                )
            self._own[name] = self._known(name, model) or self._new_block(name, model)
        return self._own[name]

    def _known(self, name: str, model: Model) -> Procedure | None:
        project = self._editor.project
        wanted = " ".join([name, *(f"({port})" for port in model.inputs)])
        for procedure in project.procedures.values():
            is_condition = model.kind == "Condition"
            if title(procedure) == wanted and procedure.gives_value == is_condition:
                return procedure if header_of(project, procedure.id) else None
        return None

    def _new_block(self, name: str, model: Model) -> Procedure:
        is_condition = model.kind == "Condition"
        given = [self._editor.new_parameter(port, "any") for port in model.inputs]
        made = self._editor.add_procedure([name, *given], gives_value=is_condition)
        procedure = self._editor.project.procedures[made]
        chain = [Made(DEFINE + procedure.id)]
        word = self._editor.language.word
        note = word("fill in here what this does")
        if is_condition:
            note = word("find out here whether this is so")
        chain.append(Made("control.note", {"text": note}))
        chain += [_set(port, 0, None) for port in model.outputs]
        if is_condition:
            truth = Made("logic.truth", {"truth": "true"})
            chain.append(Made(RETURN, inputs={"value": truth}))
        self._put(chain)
        return procedure

    def _put(self, chain: list[Made]) -> str:
        """Make a stack below all that are on the page; gives its first block."""
        first = create_chain(self._editor, chain, (_MARGIN, self._free_y), self._page)
        self._free_y += _height_of(chain)
        return first


# What a file says before its trees are read.


def _new_names(editor: Editor, trees: list[Element]) -> Iterator[tuple[str, str]]:
    """The names of the trees of a file, each with one that no tree of the project has."""
    project = editor.project
    taken = {
        str(editor.language.definitions[block.type].value(block, "name"))
        for block in project.blocks.values()
        if block.type == "tree.tree"
    }
    for tree in trees:
        name = tree.attributes.get("ID", MAIN_TREE)
        numbered = (f"{name} {number}" for number in itertools.count(2))
        free = next(one for one in itertools.chain([name], numbered) if one not in taken)
        taken.add(free)
        yield name, free


def _model_key(element: Element) -> str:
    return element.attributes.get("ID", element.tag)


def _models(root: Element, trees: list[Element], names: dict[str, str]) -> dict[str, Model]:
    """What a file says of its own parts, and how its trees use them."""
    models: dict[str, Model] = {}
    for described in root.named("TreeNodesModel"):
        for element in described.named(*_CUSTOM):
            model = models.setdefault(element.attributes.get("ID", ""), Model(element.tag))
            for port in element.named("input_port", "inout_port"):
                model.inputs[port.attributes.get("name", "")] = None
            for port in element.named("output_port"):
                model.outputs[port.attributes.get("name", "")] = None
    for element in (inner for tree in trees for inner in tree.inner()):
        key = _model_key(element)
        model = models.setdefault(key, Model())
        if element.tag in ("Action", "Condition"):
            model.kind = element.tag
        elif element.tag == "ScriptCondition":
            model.kind = "Condition"
        for attribute in element.attributes:
            is_port = attribute not in _NOT_PORTS and not attribute.startswith("_")
            if is_port and attribute not in model.outputs:
                model.inputs[attribute] = None
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


def _set(key: str, value: FieldValue | None, plugged: Made | None) -> Made:
    made = Made("tree.set", {"key": key})
    _fill(made, "value", value, plugged)
    return made


def _fill(made: Made, key: str, value: FieldValue | None, plugged: Made | None) -> None:
    if plugged is not None:
        made.inputs[key] = plugged
    elif value is not None:
        made.fields[key] = value


def _port(key: str, text: str) -> Iterator[Made]:
    """What goes into a tree under a name, and comes out again where it has one outside."""
    made = Made("tree.input", {"key": key})
    _fill(made, "value", *_literal(text))
    yield made
    if ours := _marked(text):
        yield Made("tree.output", {"key": key, "ours": ours})


def _marked(text: str) -> str:
    """The name in ``{name}``, or an empty text; ``{=}`` has none."""
    found = _MARK.fullmatch(text.strip())
    return found[1].strip() if found else ""


def _literal(text: str) -> tuple[FieldValue | None, Made | None]:
    """What an attribute holds: a value as it is typed, or a value of the tree."""
    if marked := _marked(text):
        return None, _value_of(marked)
    if is_number_text(text) and str(number := typed_number(text)) == text:
        return number, None
    return text, None


def _assignments(code: str) -> Iterator[Made | None]:
    """The blocks of a script that only sets values; None for each part that does more."""
    for part in filter(str.strip, _STATEMENT.findall(code)):
        found = _ASSIGNED.fullmatch(part)
        yield _assignment(found[1], found[2]) if found else None


def _assignment(key: str, text: str) -> Made | None:
    if text in ("true", "false"):
        return _set(key, None, Made("logic.truth", {"truth": text}))
    if _NAME.fullmatch(text):
        return _set(key, None, _value_of(text))
    try:
        value = ast.literal_eval(text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return None
    is_plain = type(value) in (int, float, str) and not (isinstance(value, str) and "\\" in text)
    return _set(key, value, None) if is_plain else None
