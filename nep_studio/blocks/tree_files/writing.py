"""Behaviour trees made of blocks as a file of BehaviorTree.CPP, version 4.

What the file cannot hold is told: what steps of ordinary blocks do, and conditions that are no
own block. They stand there as actions and conditions with the words of the blocks.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

from faults import Text, text_of

from ..arithmetic import number_text
from ..language import Language
from ..procedures import CALL, RETURN, header_of, parameters, procedure_of, words
from ..program import Block, Project
from ..text import sentence
from .elements import Element, TreeFileError
from .reading import Model
from .scripts import Writer, plain

_ORDERS = {
    ("tree.sequence", "memory"): "Sequence",
    ("tree.sequence", "reactive"): "ReactiveSequence",
    ("tree.sequence", "keeps"): "SequenceWithMemory",
    ("tree.fallback", "memory"): "Fallback",
    ("tree.fallback", "reactive"): "ReactiveFallback",
}
_OUTCOMES = {"invert": "Inverter", "success": "ForceSuccess", "failure": "ForceFailure"}
_LIMITED = {
    "tree.parallel": ("Parallel", "enough", "success_count"),
    "tree.retry": ("RetryUntilSuccessful", "times", "num_attempts"),
    "tree.repeat": ("Repeat", "times", "num_cycles"),
}
_TIMED = {
    "tree.time_limit": ("Timeout", "msec", 1000),
    "tree.delay": ("Delay", "delay_msec", 1000),
    "tree.cool_down": ("CoolDown", "seconds", 1),
}


@dataclass(frozen=True, slots=True)
class Exported:
    """The text of a file, and what of the blocks is not in it."""

    text: str
    told: tuple[Text, ...]


def export_trees(project: Project, language: Language) -> Exported:
    """The file of all trees of a project; raises TreeFileError when there is none."""
    hats = [
        project.blocks[stack.body[0]]
        for stacks in project.pages.values()
        for stack in stacks
        if project.blocks[stack.body[0]].type == "tree.tree"
    ]
    if not any(not hat.disabled for hat in hats):
        raise TreeFileError(
            "There is no behaviour tree in this project.",
            checklist=("Drag a “behaviour tree” block onto a page first.",),
        )
    return _Writer(project, language).write([hat for hat in hats if not hat.disabled])


class _Writer:
    """Writes one file."""

    def __init__(self, project: Project, language: Language) -> None:
        self._project = project
        self._language = language
        self._models: dict[str, Model] = {}
        self._told: dict[str, Text] = {}
        self._scripts = Writer(self._value, self._plugged)

    def write(self, hats: Sequence[Block]) -> Exported:
        root = Element("root", {"BTCPP_format": "4"})
        for hat in hats:
            name = str(self._value(hat, "name"))
            if self._value(hat, "runs") != "when_asked":
                root.attributes.setdefault("main_tree_to_execute", name)
            chain = self._project.stack_of(hat.id).body[1:]
            parts = self._all(chain) or [Element("AlwaysSuccess", {})]
            tree = Element("BehaviorTree", {"ID": name}, children=_as_one(parts))
            if hat.comment:
                tree.attributes["_description"] = " ".join(hat.comment.split())
            root.children.append(tree)
        root.children.append(self._described())
        lines = ['<?xml version="1.0" encoding="UTF-8"?>', *_lines(root, 0)]
        return Exported("\n".join(lines) + "\n", tuple(self._told.values()))

    def _described(self) -> Element:
        """What Groot is told of the parts that only this project has."""
        described = Element("TreeNodesModel", {})
        for name, model in self._models.items():
            element = Element(model.kind, {"ID": name})
            for tag, ports in (("input_port", model.inputs), ("output_port", model.outputs)):
                element.children += [Element(tag, {"name": port}) for port in ports]
            described.children.append(element)
        return described

    def _value(self, block: Block, key: str) -> object:
        return self._language.definitions[block.type].value(block, key)

    def _tell(self, text: str, block: Block) -> None:
        said = sentence(self._project, self._language, block.id)
        self._told.setdefault(block.id, text_of(text, block=said))

    def _all(self, chain: Sequence[str]) -> list[Element]:
        blocks = [self._project.blocks[block_id] for block_id in chain]
        return [
            self._one(block)
            for block in blocks
            if not block.disabled and block.type.startswith("tree.")
        ]

    def _one(self, block: Block) -> Element:
        element = self._part(block)
        if block.comment and "name" not in element.attributes:
            named = {"name": " ".join(block.comment.split())}
            at = {"ID": element.attributes.pop("ID")} if "ID" in element.attributes else {}
            element.attributes = {**at, **named, **element.attributes}
        return element

    def _part(self, block: Block) -> Element:
        inside = self._all(block.bodies.get("do", [])) if block.type != "tree.step" else []
        if block.type in ("tree.sequence", "tree.fallback"):
            order = str(self._value(block, "order"))
            return Element(_ORDERS[block.type, order], {}, children=inside)
        if block.type in _LIMITED:
            return self._limited(block, inside)
        if block.type in _TIMED:
            tag, attribute, per_second = _TIMED[block.type]
            if tag == "CoolDown":
                self._models.setdefault(tag, Model("Decorator", {attribute: None}))
            number = self._number(block, "seconds", per_second)
            return Element(tag, {attribute: number}, children=_as_one(inside))
        if block.type == "tree.instead":
            tag = _OUTCOMES[str(self._value(block, "outcome"))]
            return Element(tag, {}, children=_as_one(inside))
        if block.type == "tree.while":
            guard = self._condition(block)
            return Element("ReactiveSequence", {}, children=[guard, *_as_one(inside)])
        if block.type == "tree.check":
            return self._condition(block)
        return self._sub_tree(block) if block.type == "tree.sub_tree" else self._step(block)

    def _limited(self, block: Block, inside: list[Element]) -> Element:
        tag, slot, attribute = _LIMITED[block.type]
        children = inside if tag == "Parallel" else _as_one(inside)
        if block.groups.get("limit"):
            number = self._number(block, f"{slot}.1", 1)
            return Element(tag, {attribute: number}, children=children)
        if tag == "Repeat":
            return Element("KeepRunningUntilFailure", {}, children=children)
        return Element(tag, {attribute: "-1"}, children=children)

    def _number(self, block: Block, key: str, per_one: int) -> str:
        """A number as it stands in the file, or the name of a value of the tree."""
        plugged = self._plugged(block, key)
        if plugged is not None and plugged.type == "math.arithmetic" and per_one != 1:
            plugged = self._plugged(plugged, "a") or plugged
        if plugged is not None:
            return self._of(plugged)
        value = self._value(block, key)
        if isinstance(value, int | float):
            value = number_text(round(value * per_one, 6))
        return str(value)

    def _plugged(self, block: Block, key: str) -> Block | None:
        found = self._project.blocks.get(block.inputs.get(key, ""))
        return None if found is None or found.disabled else found

    def _of(self, plugged: Block) -> str:
        """What is plugged in as an attribute: a value of the tree, or the words of the block."""
        if plugged.type == "tree.value":
            return f"{{{self._value(plugged, 'key')}}}"
        if plugged.type == "logic.truth":
            return str(self._value(plugged, "truth"))
        self._tell("“{block}” is written in words: no file of trees can hold it.", plugged)
        return sentence(self._project, self._language, plugged.id)

    def _text(self, block: Block, key: str) -> str:
        plugged = self._plugged(block, key)
        return self._of(plugged) if plugged is not None else str(self._value(block, key))

    def _condition(self, block: Block) -> Element:
        plugged = self._plugged(block, "condition")
        if plugged is not None and plugged.type == "logic.truth":
            is_true = self._value(plugged, "truth") == "true"
            return Element("AlwaysSuccess" if is_true else "AlwaysFailure", {})
        if plugged is not None and plugged.type.startswith(CALL):
            code = self._at_once(plugged)
            return self._call("Condition", plugged, "") if code is None else _script(code)
        code = None if plugged is None else self._scripts.written(plugged)
        if code is not None:
            return Element("ScriptCondition", {"code": plain(code)})
        self._tell("What “{block}” asks is not in the file: write it there in C++.", block)
        words_of_it = sentence(self._project, self._language, (plugged or block).id)
        self._models.setdefault(words_of_it, Model("Condition"))
        return Element("Condition", {"ID": words_of_it})

    def _at_once(self, block: Block) -> str | None:
        """The script of an own block that only sets values and says yes, or None."""
        header = header_of(self._project, procedure_of(block.type))
        if not header:
            return None
        chain = [self._project.blocks[one] for one in self._project.stack_of(header).body[1:]]
        *body, end = [one for one in chain if not one.disabled] or [block]
        said = self._plugged(end, "value") if end.type == RETURN else None
        is_yes = said is not None and said.type == "logic.truth"
        if not body or not is_yes or said is None or self._value(said, "truth") != "true":
            return None
        return self._code(body)

    def _code(self, body: Sequence[Block]) -> str | None:
        """The script of blocks that set values, or None."""
        script = [self._assigned(block) for block in body]
        return "; ".join(filter(None, script)) if body and None not in script else None

    def _call(self, kind: str, block: Block, name: str) -> Element:
        """A part that is an own block: its values are ports."""
        procedure = self._project.procedures[procedure_of(block.type)]
        own = words(procedure)
        element = Element(kind, {"ID": own})
        if name not in ("", own):
            element.attributes["name"] = name
        model = self._models.setdefault(own, Model(kind))
        for parameter in parameters(procedure):
            model.inputs[_port(parameter.name)] = None
            if text := self._text(block, parameter.id):
                element.attributes[_port(parameter.name)] = text
        if kind == "Condition":
            for key in self._set_inside(procedure.id):
                model.outputs[_port(key)] = None
                element.attributes[_port(key)] = f"{{{key}}}"
        return element

    def _set_inside(self, procedure_id: str) -> list[str]:
        """The values of the tree that an own block sets."""
        header = header_of(self._project, procedure_id)
        chain = self._project.stack_of(header).body[1:] if header else ()
        blocks = [self._project.blocks[one] for one in chain]
        keys = [self._scripts.key(one) for one in blocks if one.type == "tree.set"]
        return list(filter(None, keys))

    def _step(self, block: Block) -> Element:
        name = str(self._value(block, "name"))
        body = [self._project.blocks[one] for one in block.bodies.get("do", [])]
        body = [one for one in body if not one.disabled and one.type != "control.note"]
        results = [self._result(one) for one in body[1:]]
        if body and body[0].type.startswith(CALL) and None not in results:
            element = self._call("Action", body[0], name)
            for port, ours in filter(None, results):
                self._models[element.attributes["ID"]].outputs[_port(port)] = None
                element.attributes[_port(port)] = f"{{{ours}}}"
            return element
        if (code := self._code(body)) is not None:
            named = {} if name in ("", code) else {"name": name}
            return Element("Script", {**named, "code": code})
        self._tell("What “{block}” does is not in the file: write it there in C++.", block)
        self._models.setdefault(name, Model())
        return Element("Action", {"ID": name})

    def _result(self, block: Block) -> tuple[str, str] | None:
        """The port and our name of what comes out of an own block, if a block takes just that."""
        value = self._plugged(block, "value") if block.type == "tree.set" else None
        if value is None or value.type != "tree.value":
            return None
        return str(self._value(value, "key")), str(self._value(block, "key"))

    def _assigned(self, block: Block) -> str | None:
        """The script of a block that sets a value, or None."""
        if block.type != "tree.set":
            return None
        key, value = self._scripts.key(block), self._scripts.slot(block, "value")
        return None if key is None or value is None else f"{key} := {plain(value)}"

    def _sub_tree(self, block: Block) -> Element:
        element = Element("SubTree", {"ID": str(self._value(block, "name"))})
        for one in (self._project.blocks[b] for b in block.bodies.get("ports.1", [])):
            key = str(self._value(one, "key")) if not one.disabled else ""
            if key.startswith("@"):  # BehaviorTree.CPP shares it with all trees
                continue
            key = _port(key)
            if key and one.type == "tree.input":
                element.attributes[key] = self._text(one, "value")
            elif key and one.type == "tree.output":
                element.attributes[key] = f"{{{self._value(one, 'ours')}}}"
        return element


def _port(name: str) -> str:
    """A name as an attribute may have it."""
    port = re.sub(r"[^\w.-]", "_", name)
    return f"_{port}" if port and not (port[0].isalpha() or port[0] == "_") else port


def _script(code: str) -> Element:
    return Element("Script", {"code": code})


def _as_one(parts: list[Element]) -> list[Element]:
    """Parts where only one can be: several are done in order."""
    return parts if len(parts) < 2 else [Element("Sequence", {}, children=parts)]


def _lines(element: Element, depth: int) -> Iterator[str]:
    margin = "  " * depth
    attributes = "".join(f" {key}={quoteattr(text)}" for key, text in element.attributes.items())
    if not element.children:
        yield f"{margin}<{element.tag}{attributes}/>"
        return
    yield f"{margin}<{element.tag}{attributes}>"
    for child in element.children:
        yield from _lines(child, depth + 1)
    yield f"{margin}</{element.tag}>"
