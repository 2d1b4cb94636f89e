"""Read the Python of a whole program, or of a few lines, into blocks."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

from ..editor import Editor
from ..edits import CreateBlocks
from ..generate.names import MODULES
from ..language import Language
from ..operations.copying import Clip, copy
from ..program import Project
from ..reading import from_bytes
from ..writing import to_bytes
from .made import CodeUnread, Made, blocks_of
from .names import names_in
from .source import Source, read_source
from .statements import StatementReader

_HEADERS = ("Robot", "Behavior")
_BETWEEN = 120.0


@dataclass(frozen=True, slots=True)
class ReadRule:
    """A function of the text as blocks; ``text`` are its lines, with the comments above it."""

    function: ast.FunctionDef
    chain: list[Made]
    text: str


def read_rules(
    editor: Editor, source: Source, as_code: Collection[str] = (), known: Collection[str] = ()
) -> list[ReadRule]:
    """The functions of a program; robots, variables and own blocks that lack are made.

    ``as_code`` names the functions whose statements become one code block. A function whose text
    is ``known`` is not read: its chain is empty. It may hold what blocks say but nobody can read.
    """
    left = Counter(known)
    names = names_in(editor, source.tree)
    reader = StatementReader(editor.language, names, source)
    rules, after = [], 0
    for node in source.tree.body:
        if isinstance(node, ast.FunctionDef):
            first = source.first_line(node, after)
            text = source.text(first, source.last_line(node.body))
            left.subtract([text])
            is_known = left[text] >= 0
            chain = [] if is_known else reader.rule(node, after, as_code=node.name in as_code)
            rules.append(ReadRule(node, chain, text))
        elif not _is_frame(node):
            raise CodeUnread(
                "This is outside of the functions, where blocks have no place for it.",
                node.lineno,
                checklist=("Put it into a function below a “when” line.",),
            )
        after = node.end_lineno or node.lineno
    return rules


def read_snippet(text: str, language: Language, base: Project) -> Clip:
    """Blocks of a few lines of Python, to be pasted into ``base``; raises CodeUnread.

    Functions are rules or own blocks, other lines one stack, an expression alone a value.
    """
    source = read_source(text)
    scratch = scratch_of(base, language)
    names = names_in(scratch, source.tree)
    reader = StatementReader(scratch.language, names, source)
    made, loose = [], []
    for node in source.tree.body:
        if isinstance(node, ast.FunctionDef):
            made.append(create_chain(scratch, reader.rule(node, 0)))
        elif not _is_frame(node) or len(source.tree.body) == 1:
            loose.append(node)
    if loose:
        made.append(create_chain(scratch, _loose(reader, loose)))
    if not made:
        raise CodeUnread(
            "There is nothing here that blocks could be made of.",
            1,
            checklist=("Choose lines that do something: comments alone become no blocks.",),
        )
    ids = [block for first in made for block in scratch.project.stack_of(first).body]
    return copy(scratch.project, scratch.language, ids)


def scratch_of(base: Project, language: Language) -> Editor:
    """An editor of a copy of a project."""
    return Editor(from_bytes(to_bytes(base), "project", language), language)


def create_chain(editor: Editor, chain: list[Made], at: tuple[float, float] | None = None) -> str:
    """Make a stack of a chain on the first page, at a place or below all; gives its first block."""
    lowest = max((s.y for s in editor.project.pages["behaviour"]), default=40 - 2 * _BETWEEN)
    roots, blocks = blocks_of(editor.project, editor.language, chain)
    place = editor.new_stack("behaviour", *(at or (40, lowest + 2 * _BETWEEN)))
    editor.apply(CreateBlocks(roots, blocks, place))
    return roots[0]


def _loose(reader: StatementReader, nodes: list[ast.stmt]) -> list[Made]:
    if len(nodes) == 1 and isinstance(nodes[0], ast.Expr):
        value = nodes[0].value
        found = reader.values.blocks(value)
        code = reader.values.type_of("code_value")
        is_call = isinstance(value, ast.Call) and (not found or found[0][0].type == code)
        if found and not is_call:
            return [found[0][0]]
        if isinstance(value, ast.Constant) and (made := _constant(reader, value)):
            return [made]
    return reader.chain(nodes, 0, 0)


def _constant(reader: StatementReader, node: ast.Constant) -> Made | None:
    """The block of a number or a text that stands alone."""
    is_text = isinstance(node.value, str)
    block_type = reader.values.type_of("text" if is_text else "number")
    made = Made(block_type)
    is_filled = bool(block_type) and reader.values.fill(made, "text" if is_text else "number", node)
    return made if is_filled else None


def _is_frame(node: ast.stmt) -> bool:
    """Whether a statement is written by the program itself, around the rules."""
    match node:
        case ast.Expr(value=ast.Constant(value=str())):
            return True
        case ast.ImportFrom(module="nep_core"):
            return True
        case ast.Import(names=names):
            return all(name.name in MODULES and not name.asname for name in names)
        case ast.Assign(targets=[ast.Name()], value=ast.Call(func=ast.Name(id=made))):
            return made in _HEADERS
        case ast.Assign(targets=[ast.Name()], value=ast.Constant() | ast.List(elts=[])):
            return True
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="behavior"), attr=name))):
            return name == "run"
    return False
