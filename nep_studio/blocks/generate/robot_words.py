"""The generator functions of robot blocks that are more than one call."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from ..program import Block
from .expressions import Expressions, ValueGenerator
from .nodes import constant, method_call
from .printing import show
from .statements import Body, Function, Gap, Piece, StatementGenerator

ANSWER = "answer"
"""The name of what a robot was answered, in the function that asks."""


def field_text(code: Expressions, block: Block, key: str) -> str:
    """What the field of a slot holds, as a text."""
    return str(code.definition(block).value(block, key))


def _numbers(block: Block, group: str) -> Iterator[int]:
    yield from range(1, block.groups.get(group, 0) + 1)


def _ask(code: Expressions, block: Block) -> list[Piece]:
    words = code.slots(block, "word", "answer")
    arguments = [code.slot(block, "question"), ast.List(words)]
    seconds = {"seconds": code.slot(block, "seconds")}
    asked = show(method_call(code.slot(block, "robot"), "ask", arguments, seconds))
    pieces: list[Piece] = [f"{ANSWER} = {asked}"]
    for number, word in enumerate(words, start=1):
        test = show(ast.Compare(ast.Name(ANSWER), [ast.Eq()], [word]))
        pieces += [f"{'if' if number == 1 else 'elif'} {test}:", Body(f"do.{number}")]
    if block.groups.get("otherwise"):
        pieces += ["else:" if words else f"if not {ANSWER}:", Body("otherwise_do.1")]
    return pieces


def _wait_for_word(code: Expressions, block: Block) -> list[Piece]:
    others = code.slots(block, "other", "more")
    seconds = {"seconds": code.slot(block, "seconds")}
    arguments = [code.slot(block, "word"), *others]
    return [show(method_call(code.slot(block, "robot"), "wait_for_word", arguments, seconds))]


def _one_of(code: Expressions, block: Block) -> list[Piece]:
    return _parts(code, block, "one_of")


def _in_turn(code: Expressions, block: Block) -> list[Piece]:
    return _parts(code, block, "in_turn")


def _parts(code: Expressions, block: Block, name: str) -> list[Piece]:
    functions = [Function(code.part_name(), f"do.{number}") for number in _numbers(block, "part")]
    chosen = code.api_call(name, *(ast.Name(function.name) for function in functions))
    return [*functions, Gap(), show(chosen)]


def _until_state(code: Expressions, block: Block) -> list[Piece]:
    turns = code.api_call("until_state", code.slot(block, "state"))
    return [f"for _ in {show(turns)}:", Body("do", loop=True)]


def _until_state_at_most(code: Expressions, block: Block) -> list[Piece]:
    turns = code.api_call("until_state", code.slot(block, "state"), code.slot(block, "times"))
    return [f"for _ in {show(turns)}:", Body("do", loop=True)]


def _on_robot(method: str, *arguments: str) -> ValueGenerator:
    """The generator of a question to a robot: constants, and "{slot}" for what is in a slot."""

    def generate(code: Expressions, block: Block) -> ast.expr:
        given = [
            code.slot(block, argument[1:-1]) if argument.startswith("{") else constant(argument)
            for argument in arguments
        ]
        return method_call(code.slot(block, "robot"), method, given, {})

    return generate


def _emotion(code: Expressions, block: Block) -> ast.expr:
    state = ast.Constant(f"emotion_{code.choice(block, 'emotion')}")
    return code.api_call("was_seen", state, ast.Constant(EMOTION_S))


EMOTION_S = 3
"""How long a person looks so after a node has told it."""

ROBOT_STATEMENTS: dict[str, StatementGenerator] = {
    "ask": _ask,
    "wait_for_word": _wait_for_word,
    "one_of": _one_of,
    "in_turn": _in_turn,
    "until_state": _until_state,
    "until_state_at_most": _until_state_at_most,
}

ROBOT_REPORTERS: dict[str, ValueGenerator] = {
    "sees_face_of": _on_robot("sees", "face", "{name}"),
    "sees_mark": _on_robot("sees", "mark", "{number}"),
    "seen_face": _on_robot("seen_name", "face"),
    "seen_mark": _on_robot("seen_name", "mark"),
    "emotion": _emotion,
}
