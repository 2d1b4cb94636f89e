"""Read a few lines of Python, or a whole program, as blocks to be pasted."""

from __future__ import annotations

import ast

from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, copy
from nep_studio.blocks.program import Project

from .learning import CodeUnread, Made
from .naming import names_in
from .outside import HERE, is_frame, is_made_docstring, parts_of
from .reading import StatementReader, create_chain, create_outside, scratch_of
from .source import Source, read_source
from .updating import update_from_python


def read_snippet(text: str, language: Language, base: Project) -> Clip:
    """Blocks of a few lines of Python, to be pasted into ``base``; raises CodeUnread.

    Functions are rules or own blocks, other lines one stack, an expression alone a value. Of a
    text with rules all becomes blocks that a whole program needs.
    """
    source = read_source(text)
    scratch = scratch_of(base, language)
    if _is_program(source):
        for page in scratch.project.pages:
            if scratch.project.kind_of_page(page) == "behaviour":
                for stack in list(scratch.project.pages[page]):
                    scratch.apply(DeleteBlocks(stack.body[0], len(stack.body)))
        update_from_python(scratch, text)
        pages = scratch.project.pages.items()
        stacks = [
            s for p, of in pages if scratch.project.kind_of_page(p) == "behaviour" for s in of
        ]
        ids = [block for stack in stacks for block in stack.body]
        return copy(scratch.project, scratch.language, ids)
    functions = [part.function for part in parts_of(source) if part.function is not None]
    names = names_in(scratch, source.tree, functions, loose=True)
    reader = StatementReader(scratch.language, names, source)
    made, loose = [], []
    for node in source.tree.body:
        if isinstance(node, ast.FunctionDef) and node in functions:
            made.append(create_chain(scratch, reader.rule(node, 0)))
        elif isinstance(node, ast.FunctionDef):
            first = source.first_line(node, 0)
            text = "\n".join(source.lines[first - 1 : source.end_inside(node)])
            made.append(create_outside(scratch, text, HERE, first))
        elif not _is_around(node, source) or len(source.tree.body) == 1:
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


def _is_program(source: Source) -> bool:
    """Whether a text has rules in it."""
    parts = parts_of(source)
    return any(part.function is not None and part.function.decorator_list for part in parts)


def _is_around(node: ast.stmt, source: Source) -> bool:
    """Whether a statement is written by the program itself: no value of a variable is."""
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant | ast.List):
        return False
    return is_frame(node) or (node is source.tree.body[0] and is_made_docstring(node))


def _loose(reader: StatementReader, nodes: list[ast.stmt]) -> list[Made]:
    if len(nodes) == 1 and isinstance(nodes[0], ast.Expr):
        value = nodes[0].value
        found = reader.values.blocks(value)
        code = reader.values.type_of("code_value")
        is_call = isinstance(value, ast.Call) and (not found or found[0][0].type == code)
        if found and not is_call:
            return [found[0][0]]
    return reader.chain(nodes, 0, 0)
