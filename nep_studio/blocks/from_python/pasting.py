"""Read a few lines of Python, or a whole program, as blocks to be pasted."""

from __future__ import annotations

import ast
from bisect import bisect_left
from collections.abc import Mapping

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.generate.expressions import comment_line, comment_lines
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, copy
from nep_studio.blocks.program import Project

from .comparing import lost_of_functions
from .learning import CodeUnread, Made
from .naming import locals_of, names_in, names_made, names_taken, settle_rules
from .outside import HERE, TOP, is_frame, is_made_docstring, parts_of
from .reading import StatementReader, create_chain, create_outside, scratch_of
from .scoping import with_shared_names
from .source import Source, begin_of, end_of, read_source, without_margin
from .updating import update_from_python


def read_snippet(text: str, language: Language, base: Project) -> Clip:
    """Blocks of a few lines of Python, to be pasted into ``base``; raises CodeUnread.

    Functions are rules or own blocks, other lines one stack, an expression alone a value. Of a
    text with rules all becomes blocks that a whole program needs.
    """
    text = without_margin(text)
    source = read_source(text)
    with_shared_names(source.tree, {})
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
    kept = set[int]()
    while True:
        clip, changed = _read_lines(source, scratch_of(base, language), kept)
        if not changed:
            return clip
        kept |= changed


def _read_lines(source: Source, scratch: Editor, kept: set[int]) -> tuple[Clip, set[int]]:
    """The blocks of a text without rules, and the lines of functions that would do other things.

    Those in the lines ``kept`` stay Python.
    """
    functions = [part.function for part in parts_of(source, kept) if part.function is not None]
    taken = names_taken(scratch) | _names_made(source)
    changed = {one.lineno for one in functions if taken & _own_names(one)}
    names = names_in(scratch, source.tree, functions, loose=True)
    reader = StatementReader(scratch.language, names, source, kept)
    made, loose = [], []
    stacks: dict[str, ast.FunctionDef] = {}
    hats: dict[str, str] = {}
    has_functions = any(isinstance(node, ast.FunctionDef) for node in source.tree.body)
    is_alone = len(source.tree.body) == 1
    for node in source.tree.body:
        if isinstance(node, ast.FunctionDef) and node in functions:
            made.append(create_chain(scratch, reader.rule(node, 0)))
            stacks[scratch.project.stack_of(made[-1]).id] = node
            hats[node.name] = made[-1]
        elif isinstance(node, ast.FunctionDef):
            first = source.first_line(node, 0)
            text = source.whole(first, source.end_inside(node))
            made.append(create_outside(scratch, text, HERE, first))
        elif _is_import_outside(node, has_functions):
            text = "\n".join([*comment_lines(source.comment_of(node, 0)), ast.unparse(node)])
            made.append(create_outside(scratch, text, TOP, node.lineno))
        elif not _is_around(node, source) or (is_alone and not _is_all(node)):
            loose.append(node)
    is_loose_last = bool(loose) and loose[-1] is source.tree.body[-1]
    if loose:
        until = len(source.lines) if is_loose_last else 0
        made.append(create_chain(scratch, _loose(reader, source, loose, until)))
    settle_rules(scratch, hats)
    if made and not is_loose_last and (below := _comments_below(source)):
        made.append(create_outside(scratch, below, HERE))
    if not made:
        raise CodeUnread(
            "There is nothing here that blocks could be made of.",
            1,
            checklist=("Choose lines that do something: comments alone become no blocks.",),
        )
    clip = _clip(scratch, made)
    lost = _lost_comments(source, clip)
    around = {one.lineno for one in source.tree.body if _holds(source, one, lost)}
    changed |= around - kept
    if lost and not changed:
        said = "\n".join(comment_line(source.comments[line]) for line in lost)
        made.insert(0, create_outside(scratch, said, HERE))
        clip = _clip(scratch, made)
    return clip, changed | (_changed(scratch, stacks) if stacks else set())


def _clip(scratch: Editor, firsts: list[str]) -> Clip:
    ids = [block for first in firsts for block in scratch.project.stack_of(first).body]
    return copy(scratch.project, scratch.language, ids)


def _lost_comments(source: Source, clip: Clip) -> list[int]:
    """The lines of the comments that no block has."""
    said, code = set[str](), list[str]()
    for block in clip.project.blocks.values():
        said.update(block.comment.split("\n"))
        said.add(str(block.fields.get("text", "")))
        code.append(str(block.fields.get("code", "")))
    whole = "\n".join(code)
    return [n for n, one in source.comments.items() if not (one in said or one in whole)]


def _holds(source: Source, node: ast.stmt, lines: list[int]) -> bool:
    """Whether one of these lines, which are in order, is in a statement."""
    first = bisect_left(lines, begin_of(node))
    return first < len(lines) and lines[first] <= source.end_inside(node)


def _names_made(source: Source) -> set[str]:
    """The names that lines outside of functions give a meaning to."""
    is_function = ast.FunctionDef | ast.AsyncFunctionDef
    loose = [node for node in source.tree.body if not isinstance(node, is_function)]
    return set(names_made(loose)) if loose else set()


def _own_names(function: ast.FunctionDef) -> set[str]:
    """The names that a function has for itself, also those of what it is given."""
    return {argument.arg for argument in function.args.args} | locals_of(function).keys()


def _changed(scratch: Editor, stacks: Mapping[str, ast.FunctionDef]) -> set[int]:
    """The lines of the functions that blocks would make in another way, by their stacks."""
    for page, others in scratch.project.pages.items():
        if scratch.project.kind_of_page(page) == "behaviour":
            for stack in [one for one in others if one.id not in stacks]:
                scratch.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    return lost_of_functions(scratch, stacks)


def _is_program(source: Source) -> bool:
    """Whether a text has rules in it."""
    parts = parts_of(source)
    return any(part.function is not None and part.function.decorator_list for part in parts)


def _is_around(node: ast.stmt, source: Source) -> bool:
    """Whether a statement is written by the program itself: no value of a variable is."""
    if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant | ast.List | ast.Dict):
        return False
    return (
        is_frame(node) or _is_api(node) or (node is source.tree.body[0] and is_made_docstring(node))
    )


def _is_all(node: ast.stmt) -> bool:
    """Whether a statement imports all that there is in a module."""
    return isinstance(node, ast.ImportFrom) and node.names[0].name == "*"


def _is_api(node: ast.stmt) -> bool:
    """Whether a statement imports all that programs have, which they name by themselves."""
    return isinstance(node, ast.ImportFrom) and node.module == "nep_core" and _is_all(node)


def _is_import_outside(node: ast.stmt, has_functions: bool) -> bool:
    """Whether an import stands above the functions, which may use what it names."""
    if not isinstance(node, ast.Import | ast.ImportFrom) or is_frame(node) or _is_api(node):
        return False
    return has_functions or _is_all(node)


def _comments_below(source: Source) -> str:
    """The comments below the last statement of a text, and not in it."""
    last = source.end_inside(source.tree.body[-1]) if source.tree.body else 0
    below = range(last + 1, len(source.lines) + 1)
    return "\n".join(source.lines[n - 1].strip() for n in below if n in source.alone)


def _loose(
    reader: StatementReader, source: Source, nodes: list[ast.stmt], until: int
) -> list[Made]:
    """The blocks of lines that are in no function, with the comments down to a line."""
    if len(nodes) == 1 and isinstance(nodes[0], ast.Expr):
        value = nodes[0].value
        found = reader.values.blocks(value)
        code = reader.values.type_of("code_value")
        is_call = isinstance(value, ast.Call) and (not found or found[0][0].type == code)
        if found and not is_call:
            made = found[0][0]
            lines = range(source.first_line(nodes[0], 0), max(until, end_of(nodes)) + 1)
            made.comment = "\n".join(source.comments[n] for n in lines if n in source.comments)
            return [made]
    return reader.chain(nodes, 0, until)
