"""Python that a person writes into a block: whether it can be there, and what it names."""

from __future__ import annotations

import ast
import re
import symtable
import unicodedata
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import CodeType
from typing import TypeVar

from faults import Text, Words, text_of
from nep_studio.blocks.shared_objects import SHARED_OBJECTS

from .definitions import PYTHON_KINDS, Definition
from .errors import BlocksError
from .program import Block, Project
from .slots import JOINERS

_GENERATOR_FLAGS = 0x20 | 0x80 | 0x200
"""Of a code object: it is a generator, a coroutine, or both."""


class CodeTextRefused(BlocksError):
    """Python that cannot be where it is; ``line`` is the one that is wrong, from 1.

    ``reason`` is the sentence without the line.
    """

    def __init__(self, reason: Words, line: int = 1, *, checklist: Sequence[Words] = ()) -> None:
        super().__init__(_in_line(reason, line), checklist=checklist)
        self.reason = reason
        self.line = line


@dataclass(frozen=True, slots=True)
class CodeText:
    """Python that can be in a block: its lines, and which names it reads and makes.

    ``inside_texts`` are the lines that begin inside a text of several lines; ``set_here`` are
    the names that it makes itself, and not a function inside it. Outside of all functions these
    are the ones that it makes in any case, ``defined`` those of them that are no plain values.
    """

    lines: tuple[str, ...]
    inside_texts: frozenset[int]
    read: frozenset[str]
    made: frozenset[str]
    set_here: frozenset[str] = frozenset()
    defined: frozenset[str] = frozenset()
    is_empty: bool = False
    is_closed: bool = False


@lru_cache(maxsize=1024)
def read_lines(text: str, *, in_loop: bool = True) -> CodeText:
    """Check statements that stand in a function, or raise CodeTextRefused."""
    lines = _visible_lines(text)
    tree = _parse("\n".join(lines), "exec")
    inside = frozenset(lines_inside_texts(tree))
    opening = ["def _():", " while 1:"] if in_loop else ["def _():", " if 1:"]
    shifted = [
        line if n in inside or not line.strip() else f"  {line}" for n, line in enumerate(lines, 1)
    ]
    try:
        code = compile_quietly("\n".join([*opening, *shifted, "  pass"]))
    except CodeTextRefused as refused:
        line = min(max(refused.line - 2, 1), len(lines))
        raise CodeTextRefused(refused.reason, line) from refused
    if any(getattr(c, "co_flags", 0) & _GENERATOR_FLAGS for c in code.co_consts):
        waiting = (n for n in outside_functions(tree) if isinstance(n, ast.Yield | ast.YieldFrom))
        line = min((node.lineno for node in waiting), default=1)
        raise CodeTextRefused("“yield” and “await” cannot be in a block of a program.", line)
    for node in outside_functions(tree):
        if isinstance(node, ast.Global | ast.Nonlocal):
            raise CodeTextRefused(
                "The program writes “global” by itself.",
                node.lineno,
                checklist=("Write the “global” line first in the function.",),
            )
    read, made = _names(tree)
    here = frozenset(name for node in outside_functions(tree) for name in made_by(node))
    return CodeText(tuple(lines), inside, read, made, here, is_empty=not tree.body)


@lru_cache(maxsize=256)
def read_outside(text: str) -> CodeText:
    """Check lines that stand outside of all functions, or raise CodeTextRefused."""
    lines = _visible_lines(text)
    tree = _parse("\n".join(lines), "exec")
    compile_quietly("\n".join(lines))
    of_program = frozenset(_of_program(symtable.symtable("\n".join(lines), "program.py", "exec")))
    read, made = (names & of_program for names in _names(tree))
    body = tree.body if isinstance(tree, ast.Module) else []
    defined = frozenset(name for node in body for name in made_by(node))
    targets = [target for node in body for target in _targets(node)]
    values = frozenset(t.id for t in targets if isinstance(t, ast.Name))
    inside = frozenset(lines_inside_texts(tree))
    return CodeText(tuple(lines), inside, read, made, values | defined, defined, not body)


def _of_program(table: symtable.SymbolTable) -> Iterator[str]:
    """The names that stand for what is outside of all functions, wherever they are."""
    is_outside = table.get_type() == "module"
    yield from (s.get_name() for s in table.get_symbols() if is_outside or s.is_global())
    for inner in table.get_children():
        yield from _of_program(inner)


def _targets(node: ast.stmt) -> list[ast.expr]:
    """What a plain statement puts values into."""
    match node:
        case ast.Assign(targets=targets):
            parts = [t.elts if isinstance(t, ast.Tuple | ast.List) else [t] for t in targets]
            return [target for part in parts for target in part]
        case ast.AnnAssign(target=target, value=ast.expr()):
            return [target]
    return []


@lru_cache(maxsize=1024)
def read_value(text: str) -> CodeText:
    """Check an expression, or raise CodeTextRefused."""
    lines = _visible_lines(text)
    if len(lines) != 1:
        raise CodeTextRefused("A value is written on one line.")
    plain = lines[0].strip()
    tree = _parse(plain, "eval")
    if ast.dump(_parse(f"({plain})", "eval")) != ast.dump(tree):
        raise CodeTextRefused("This is not one value.")
    refused = (ast.NamedExpr, ast.Await, ast.Yield, ast.YieldFrom)
    if any(isinstance(node, refused) for node in ast.walk(tree)):
        raise CodeTextRefused("“:=”, “yield” and “await” cannot be in a value.")
    compile_quietly(f"lambda: ({plain})")
    read, made = _names(tree)
    value = tree.body
    if isinstance(value, ast.Tuple):
        plain = f"({plain})"
    whole = ast.Name | ast.Attribute | ast.Call | ast.Subscript | ast.List | ast.Tuple
    closed = isinstance(value, whole | ast.JoinedStr)
    return CodeText((plain,), frozenset(), read, made, is_closed=closed)


def compile_quietly(text: str) -> CodeType:
    """Compile without running anything and without warnings, or raise CodeTextRefused."""
    try:
        with warnings.catch_warnings(action="ignore"):
            code: CodeType = compile(text, "program.py", "exec", dont_inherit=True)
            return code
    except SyntaxError as error:
        raise CodeTextRefused(_syntax_sentence(error), error.lineno or 1) from error
    except (ValueError, RecursionError, MemoryError, OverflowError) as error:
        raise CodeTextRefused("Python cannot read this.") from error


def parse_lines(text: str) -> ast.Module:
    """The tree of Python in a block, statements or a value, or raise CodeTextRefused."""
    tree = _parse(text, "exec")
    assert isinstance(tree, ast.Module)
    return tree


def _parse(text: str, mode: str) -> ast.Module | ast.Expression:
    try:
        with warnings.catch_warnings(action="ignore"):
            tree: ast.Module | ast.Expression = ast.parse(text, mode=mode)  # type: ignore[assignment]
            return as_names(tree)
    except SyntaxError as error:
        line = error.lineno or 1
        raise CodeTextRefused(_syntax_sentence(error), line) from error
    except (ValueError, RecursionError, MemoryError, OverflowError) as error:
        raise CodeTextRefused("Python cannot read this.") from error


_Tree = TypeVar("_Tree", bound=ast.AST)


def as_names(tree: _Tree) -> _Tree:
    """The same tree, in which a variable of the whole program is a name: ``program.score``."""
    for node in ast.walk(tree):
        for key, value in ast.iter_fields(node):
            if isinstance(value, ast.Attribute):
                setattr(node, key, _as_name(value))
            elif isinstance(value, list) and any(isinstance(v, ast.Attribute) for v in value):
                made = [_as_name(v) if isinstance(v, ast.Attribute) else v for v in value]
                setattr(node, key, made)
    return tree


def _as_name(node: ast.Attribute) -> ast.expr:
    match node.value:
        case ast.Name(id=owner) if owner in SHARED_OBJECTS:
            return ast.copy_location(ast.Name(f"{owner}.{node.attr}", node.ctx), node)
    return node


def _visible_lines(text: str) -> list[str]:
    """The lines of a text; what Python would take for something else is refused."""
    lines = text.rstrip().split("\n")
    for number, line in enumerate(lines, start=1):
        if not line.translate(_SEEN_AS_GAPS).isprintable() or _FILLERS.search(line):
            raise CodeTextRefused("There is a character here that cannot be seen.", number)
    return lines


def lines_inside_texts(tree: ast.AST) -> Iterator[int]:
    """The lines that begin inside a text of several lines."""
    for node in ast.walk(tree):
        is_text = isinstance(node, ast.JoinedStr) or (
            isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
        )
        if is_text and isinstance(node, ast.expr):
            yield from range(node.lineno + 1, (node.end_lineno or node.lineno) + 1)


def _names(tree: ast.AST) -> tuple[frozenset[str], frozenset[str]]:
    """The names that Python reads, and those that it makes."""
    nodes = list(ast.walk(tree))
    changed = [node.target for node in nodes if isinstance(node, ast.AugAssign)]
    names = [node for node in nodes if isinstance(node, ast.Name)]
    read = [name.id for name in names if isinstance(name.ctx, ast.Load) or name in changed]
    return frozenset(read), frozenset(name for node in nodes for name in made_by(node))


def outside_functions(tree: ast.AST) -> Iterator[ast.AST]:
    """The parts of Python that are in no function or class of its own."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda):
            waiting += ast.iter_child_nodes(node)


def bodies_of(node: ast.AST) -> Iterator[list[ast.stmt]]:
    """The lists of statements that stand directly in a part of Python."""
    for name in ("body", "orelse", "finalbody"):
        if isinstance(body := getattr(node, name, None), list):
            yield body


def made_by(node: ast.AST) -> Iterator[str]:
    """The names that a part of Python makes itself."""
    match node:
        case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
            yield name
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            yield from ((alias.asname or alias.name).partition(".")[0] for alias in names)
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case (
            ast.ExceptHandler(name=str(name))
            | ast.MatchAs(name=str(name))
            | ast.MatchStar(name=str(name))
            | ast.MatchMapping(rest=str(name))
        ):
            yield name


def _syntax_sentence(error: SyntaxError) -> Text:
    return text_of("Python does not understand this: {msg}.", msg=error.msg)


def _in_line(sentence: Words, line: int) -> Words:
    if line == 1:
        return sentence
    return text_of("Line {line}: {sentence}", line=line, sentence=sentence)


# Where Python stands in blocks.


def python_slots(definition: Definition, groups: Mapping[str, int]) -> Iterator[str]:
    """The keys of the fields of a block whose text is run as Python; none of most blocks."""
    if definition.holds_python:
        for key, slot in definition.keys(groups):
            if slot.kind.name in PYTHON_KINDS:
                yield key


def hides_python(project: Project, definitions: Mapping[str, Definition], block: Block) -> bool:
    """Whether there is Python in the blocks inside a folded one, or in itself."""
    found = (definitions.get(one.type) for one in project.within([block.id]))
    return any(definition is not None and definition.holds_python for definition in found)


def trim_python(block: Block, definition: Definition) -> None:
    """Take away what is around the Python in a block that was read from a file: it does nothing."""
    for key in python_slots(definition, block.groups):
        if isinstance(text := block.fields.get(key), str):
            block.fields[key] = _BLANK_LINES.sub("", text.rstrip())
            if "\n" not in text.strip():
                block.fields[key] = text.strip()


_BLANK_LINES = re.compile(r"\A(?:[ \t]*\n)+")


# Code as a person can trust their eyes with it.

LONG_RUN = 12
"""More spaces than these behind a word hide what comes after them."""
_SPACES = r" \t\u00a0\u1680\u2000-\u200a\u202f\u205f\u2800\u3000"
_RUN = re.compile(rf"(?<=\S)(?:[{_SPACES}]{{{LONG_RUN},}}|\t{{4,}})")
_DEEP = re.compile(rf"(?m)^(?:[{_SPACES}]{{80,}}|\t{{{LONG_RUN},}})")
_EMPTY_LINES = re.compile(rf"\n(?:[ \t]*\n){{{LONG_RUN},}}")
_FILLERS = re.compile("[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u3164\uffa0]")
"""Letters without a look, which names of Python may have: ``ㅤ = 1`` is a line of it."""
_SEEN_AS_GAPS = str.maketrans(dict.fromkeys(f"\t{JOINERS}", " "))
_CHOOSERS = "\ufe00-\ufe0f\U000e0100-\U000e01ef"
_CARRIED = re.compile(
    rf"(?<=[{_CHOOSERS}])[{_CHOOSERS}]|(?<=[^\W0-9])(?<=[\x00-\x7f])[{_CHOOSERS}]"
    "|(?<=[\u0300-\u036f]{4})[\u0300-\u036f]"
)
"""What chooses the look of a letter and carries a hidden text instead; a heap of accents."""
_UNSEEN = frozenset(("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"))
_END = "\n"
_PLAIN = frozenset(f"\n\t{JOINERS}")


def plainly(text: str) -> str:
    """The text with signs for what cannot be seen: long gaps, controls, marks of direction."""
    if text.isascii():
        if "   " not in text and text.isprintable():
            return text  # as nearly all are
    else:
        text = _FILLERS.sub(lambda found: _sign(found[0]), text)
        text = _CARRIED.sub(lambda found: _sign(found[0]), text)
    text = _RUN.sub(_gap, text)
    text = _DEEP.sub(_gap, text)
    return "".join(map(_seen, text))


def plainly_in_a_line(text: str) -> str:
    """The same for what is one line, as a name: its ends of lines are signs, and forge none."""
    return plainly(text).replace("\n", _sign("\n")).replace("\t", _sign("\t"))


def plainly_and_short(text: str) -> str:
    """The same, with a sign for empty lines behind which nobody would look for more."""
    return plainly(_EMPTY_LINES.sub(lambda lines: f"\n⟨{lines[0].count(_END) - 1} ↵⟩\n", text))


def _gap(found: re.Match[str]) -> str:
    return f" ⟨{len(found[0])} \N{OPEN BOX}⟩ "


def _seen(letter: str) -> str:
    if letter in _PLAIN or unicodedata.category(letter) not in _UNSEEN:
        return letter
    return _sign(letter)


def _sign(letter: str) -> str:
    return f"⟨U+{ord(letter):04X}⟩"
