"""The Python of blocks that speak of the behaviour: messages, other rules, goals, states, waits."""

from __future__ import annotations

import ast
from functools import partial

from nep_studio.blocks.program import Block

from .expressions import (
    Expressions,
    Piece,
    StatementGenerator,
    ValueGenerator,
    method_call,
    show,
)

_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _within(code: Expressions, block: Block) -> ast.expr:
    condition = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    return code.api_call("wait_until", condition, code.slot(block, "seconds"))


def _of_machine(method: str, code: Expressions, block: Block) -> ast.expr:
    """What is asked of the behaviour about its states, or of one state machine of several."""
    state = [code.slot(block, "state")] if "state" in code.definition(block).slots else []
    named = block.groups.get("machine")
    options = {"machine": code.slot(block, "machine.1")} if named else {}
    return method_call(ast.Name("behavior"), method, state, options)


def _of_behavior(code: Expressions, block: Block, method: str, *more: ast.expr) -> ast.expr:
    """What the behaviour is asked of a goal by its name."""
    return method_call(ast.Name("behavior"), method, [code.slot(block, "name"), *more])


def _tell(code: Expressions, block: Block) -> list[Piece]:
    given = [code.slot(block, "message")]
    if block.groups.get("value"):
        given.append(code.slot(block, "value.1"))
    options = {"wait": ast.Constant(True)} if block.groups.get("wait") else {}
    return [show(code.api_call("tell", *given, **options))]


def _stop_other_rule(code: Expressions, block: Block) -> list[Piece]:
    return [show(method_call(ast.Name("behavior"), "stop", [code.slot(block, "rule")]))]


def _go_to_state(code: Expressions, block: Block) -> list[Piece]:
    return [show(_of_machine("go_to", code, block))]


def _pursue(code: Expressions, block: Block) -> list[Piece]:
    given = [code.value_in(block, "value.1")] if block.groups.get("value") else []
    return [show(_of_behavior(code, block, "pursue", *given))]


def _set_priority(code: Expressions, block: Block) -> list[Piece]:
    priority = ast.Constant(code.choice(block, "priority"))
    displaced = code.choice(block, "displaced")
    options = {} if displaced == "resume" else {"displaced": ast.Constant(displaced)}
    return [show(code.api_call("set_priority", priority, **options))]


BEHAVIOUR_VALUES: dict[str, ValueGenerator] = {
    "within": _within,
    "goal_is_pursued": lambda code, block: _of_behavior(code, block, "pursues"),
    "is_in_state": partial(_of_machine, "is_in"),
    "state_now": partial(_of_machine, "state_now"),
}

BEHAVIOUR_STATEMENTS: dict[str, StatementGenerator] = {
    "tell": _tell,
    "stop_other_rule": _stop_other_rule,
    "go_to_state": _go_to_state,
    "pursue": _pursue,
    "give_up_goal": lambda code, block: [show(_of_behavior(code, block, "give_up"))],
    "set_priority": _set_priority,
}
