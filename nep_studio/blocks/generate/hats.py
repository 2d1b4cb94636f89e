"""The generator functions of hats: what a rule waits for, and what its function is called."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass

from nep_studio.blocks.procedures import parameters, procedure_of
from nep_studio.blocks.program import ALL_ROBOTS, Block
from nep_studio.blocks.slots import constant

from .expressions import Expressions, method_call
from .reporters import field_text


@dataclass(frozen=True, slots=True)
class Hat:
    """The decorator of a rule's function, and a text from which the function gets its name.

    The function of an own block has no decorator, but ``arguments``.
    """

    decorator: ast.expr | None
    name: str
    arguments: tuple[str, ...] = ()


HatGenerator = Callable[[Expressions, Block], Hat]


def _when_started(code: Expressions, block: Block) -> Hat:
    return Hat(ast.Attribute(ast.Name("behavior"), "when_started"), "when_started")


def _when_gesture(code: Expressions, block: Block) -> Hat:
    return _when(code, block, "gesture")


def _when_human_state(code: Expressions, block: Block) -> Hat:
    return _when(code, block, "state")


def _when(code: Expressions, block: Block, key: str) -> Hat:
    state = code.slot(block, key)
    again = code.choice(block, "again")
    keywords: dict[str, ast.expr] = {} if again == "ignore" else {"again": ast.Constant(again)}
    decorator = method_call(ast.Name("behavior"), "when", [state], keywords)
    word = str(code.definition(block).value(block, key))
    return Hat(decorator, f"when_{key}_{word}" if key == "gesture" else f"when_{word}")


def _own_define(code: Expressions, block: Block) -> Hat:
    procedure = code.project.procedures[procedure_of(block.type)]
    given = [f"{procedure.id}.{parameter.id}" for parameter in parameters(procedure)]
    arguments = [code.names.parameters[key] for key in given]
    return Hat(None, code.names.procedures[procedure.id], tuple(arguments))


HATS: dict[str, HatGenerator] = {
    "when_started": _when_started,
    "when_gesture": _when_gesture,
    "when_human_state": _when_human_state,
    "own_define": _own_define,
}


# The generator functions of hats about robots and goals.

_SIDES: dict[str, ast.cmpop] = {"over": ast.Gt(), "under": ast.Lt()}
_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _touched(code: Expressions, block: Block) -> Hat:
    return _goal_when(code, block, f"touched_{code.choice(block, 'part')}")


def _heard(code: Expressions, block: Block) -> Hat:
    word = code.slot(block, "word")
    name = f"when_heard_{field_text(code, block, 'word')}"
    return Hat(_behavior("when_heard", [word], _again(code, block)), name)


def _sees(code: Expressions, block: Block) -> Hat:
    return _noticed(code, block, code.choice(block, "thing"))


def _sees_face_of(code: Expressions, block: Block) -> Hat:
    return _noticed(code, block, "face", "name")


def _sees_mark(code: Expressions, block: Block) -> Hat:
    return _noticed(code, block, "mark", "number")


def _noticed(code: Expressions, block: Block, thing: str, key: str = "") -> Hat:
    """A rule for something that a robot sees or hears, of the name in slot ``key`` if there is."""
    arguments: list[ast.expr] = [ast.Constant(thing)]
    words = ["when", thing]
    if key:
        arguments.append(code.slot(block, key))
        words.append(field_text(code, block, key))
    options = _again(code, block) | _source(code, block)
    return Hat(_behavior("when_noticed", arguments, options), "_".join(words))


def _person(code: Expressions, block: Block) -> Hat:
    return _goal_when(code, block, f"person_{code.choice(block, 'distance')}")


def _emotion(code: Expressions, block: Block) -> Hat:
    return _goal_when(code, block, f"emotion_{code.choice(block, 'emotion')}")


def _sensor(code: Expressions, block: Block) -> Hat:
    name = code.choice(block, "sensor")
    value = method_call(code.slot(block, "robot"), "sensor", [ast.Constant(name)], {})
    side = _SIDES[code.choice(block, "side")]
    test = ast.Lambda(_NO_ARGUMENTS, ast.Compare(value, [side], [code.slot(block, "value")]))
    decorator = _behavior("when_true", [test], _again(code, block))
    return Hat(decorator, f"when_{name}_is_{code.choice(block, 'side')}")


def _idle(code: Expressions, block: Block) -> Hat:
    return Hat(_behavior("when_idle", [code.slot(block, "seconds")], {}), "when_idle")


def _goal(code: Expressions, block: Block) -> Hat:
    options: dict[str, ast.expr] = {"when": code.slot(block, "state")}
    if (priority := code.choice(block, "priority")) != "normal":
        options["priority"] = ast.Constant(priority)
    if block.groups.get("stop"):
        options["stop"] = code.slot(block, "stop_state.1")
    if (interrupted := code.choice(block, "interrupted")) != "again":
        options["interrupted"] = ast.Constant(interrupted)
    decorator = _behavior("goal", [code.slot(block, "name")], options)
    return Hat(decorator, f"goal_{field_text(code, block, 'name')}")


def _when_goal(code: Expressions, block: Block) -> Hat:
    event = code.choice(block, "event")
    decorator = _behavior("when_goal", [code.slot(block, "name"), ast.Constant(event)], {})
    return Hat(decorator, f"when_{field_text(code, block, 'name')}_{event}")


def _goal_when(code: Expressions, block: Block, state: str) -> Hat:
    options = _again(code, block) | _source(code, block)
    return Hat(_behavior("when", [ast.Constant(state)], options), f"when_{state}")


def _source(code: Expressions, block: Block) -> dict[str, ast.expr]:
    """The robot that must tell of a state, where the hat names one."""
    if "robot" not in code.definition(block).slots:
        return {}
    robot = field_text(code, block, "robot")
    return {} if robot == ALL_ROBOTS else {"source": constant(robot)}


def _again(code: Expressions, block: Block) -> dict[str, ast.expr]:
    again = code.choice(block, "again")
    return {} if again == "ignore" else {"again": ast.Constant(again)}


def _behavior(method: str, arguments: list[ast.expr], options: dict[str, ast.expr]) -> ast.expr:
    return method_call(ast.Name("behavior"), method, arguments, options)


GOAL_HATS: dict[str, HatGenerator] = {
    "when_touched": _touched,
    "when_heard": _heard,
    "when_sees": _sees,
    "when_sees_face_of": _sees_face_of,
    "when_sees_mark": _sees_mark,
    "when_person": _person,
    "when_emotion": _emotion,
    "when_sensor": _sensor,
    "when_idle": _idle,
    "goal": _goal,
    "when_goal": _when_goal,
}
