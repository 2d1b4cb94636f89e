"""What of a text the blocks would not say again: compared with the Python that they make."""

from __future__ import annotations

import ast
import symtable
import warnings
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field

from nep_studio.blocks.code_text import CodeTextRefused, compile_quietly
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.names import API
from nep_studio.blocks.generate.program import ProgramGenerator, generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.shared_objects import SHARED_OBJECTS

from ..program import SCOPE_PROGRAM
from .equal_forms import as_power, as_said, by_value, is_gone_through, told_by_robot
from .joined import as_joined, told_in_braces
from .learning import CodeUnread
from .naming import functions_of, locals_of, names_made, note_anew, stopped_in
from .outside import HEADERS, Part, is_frame
from .reading import as_block
from .scoping import is_beginning, with_shared_names
from .source import Source, begin_of, end_of, read_source
from .told_names import is_taken_over


@dataclass(frozen=True, slots=True)
class Lost:
    """What would be lost or changed: the lines of what is then kept as Python instead.

    ``kinds`` are those of the values of the program, by name; ``places`` the lines of the innermost
    statements that other blocks might say as they are; ``around`` those that are in no function,
    which may depend on what is in these. ``apart`` are names that functions have for themselves,
    and that would be the whole program's, ``begun`` variables of it that begin otherwise.
    """

    lines: set[int]
    kinds: dict[str, int]
    places: set[int] = field(default_factory=set)
    around: set[int] = field(default_factory=set)
    apart: set[str] = field(default_factory=set)
    begun: set[str] = field(default_factory=set)


def lost_lines(
    editor: Editor,
    source: Source,
    parts: Sequence[Part],
    functions: Mapping[str, ast.FunctionDef],
    apart: Set[str] = frozenset(),
) -> Lost:
    """What of a text would be lost or changed.

    ``functions`` are those of the text by the stacks that are to make them; the names ``apart`` are
    known to be no variables. Raises CodeUnread for
    what cannot be kept as Python either.
    """
    generator = ProgramGenerator(editor.project, editor.language)
    try:
        code = generator.generate()
        compile_quietly(code.text)
    except CodeRefused as refused:
        if refused.block in editor.project.blocks:
            stack = editor.project.stack_of(refused.block).id
            if stack in functions:
                return Lost({functions[stack].lineno}, generator.kinds())
        raise CodeUnread(refused.sentence, 1, checklist=refused.checklist) from refused
    except CodeTextRefused as refused:
        checklist = ("Undo the last change of the code.",)
        raise CodeUnread(refused.sentence, 1, checklist=checklist) from refused
    made = _made_source(code)
    _require_own_names(source, parts)
    if lines := _imports_needed(source, made):
        return Lost(lines, generator.kinds())
    if names := _names_shared(editor, code, made, functions) - apart:
        return Lost(set(), generator.kinds(), apart=names)
    again = _functions_made(editor, code, made)
    both = [(there, again[stack]) for stack, there in functions.items() if stack in again]
    if lines := {there.lineno for there, other in both if not _require_same_scope(there, other)}:
        return Lost(lines, generator.kinds())
    note_anew(source.tree, generator.kinds())
    lost, places = _lost_functions(editor, source, code, made, functions)
    around = _lost_around(source, made)
    places = places or _setting(source, around)
    lines = lost | around or _lost_comments(source, made, functions)
    given = [node for node in source.tree.body if is_beginning(node)]
    as_made = [node for node in made.tree.body if is_beginning(node)]
    begun = {
        _target(node)
        for node in given  # all that one line makes have its number
        if node.lineno in around and _may_begin(node) and not any(_same(node, m) for m in as_made)
    }
    return Lost(lines, generator.kinds(), places, around, begun=begun)


def _imports_needed(source: Source, made: Source) -> set[int]:
    """The lines that import what the program would, did Python in it not name it otherwise."""
    named = {node.id for node in ast.walk(made.tree) if isinstance(node, ast.Name)}
    named -= {name for node in made.tree.body for name in _imported(node)}
    return {
        begin_of(node)
        for node in source.tree.body
        if is_taken_over(node) and not named.isdisjoint(_imported(node))
    }


def _imported(node: ast.stmt) -> Iterator[str]:
    if isinstance(node, ast.Import | ast.ImportFrom):
        yield from (alias.asname or alias.name for alias in node.names)


def _made_source(code: Code) -> Source:
    made = read_source(code.text)
    with_shared_names(made.tree, {})
    return made


def _names_shared(
    editor: Editor, code: Code, made: Source, functions: Mapping[str, ast.FunctionDef]
) -> set[str]:
    """The names that functions have for themselves, and that would be the whole program's."""
    by_stack = _functions_made(editor, code, made)
    return {
        name
        for stack, there in functions.items()
        if stack in by_stack
        for name in locals_of(there)
        if _is_shared(by_stack[stack], name)
    }


def lost_of_functions(editor: Editor, functions: Mapping[str, ast.FunctionDef]) -> set[int]:
    """The lines of those functions, by their stacks, that the blocks would make in another way."""
    if not functions:
        return set()
    try:
        code = generate_program(editor.project, editor.language)
        again = _functions_made(editor, code, _made_source(code))
    except CodeRefused as refused:
        is_known = refused.block in editor.project.blocks
        stack = editor.project.stack_of(refused.block).id if is_known else ""
        return {one.lineno for of, one in functions.items() if stack in (of, "")}
    return {
        one.lineno
        for stack, one in functions.items()
        if stack not in again or _differing(one, again[stack])
    }


def _require_own_names(source: Source, parts: Sequence[Part]) -> None:
    """Own Python cannot give another meaning to what the program itself calls so."""
    taken = {"behavior", *API} | {
        target.id
        for node in source.tree.body
        if isinstance(node, ast.Assign) and _is_header(node)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for part in parts:
        for node in ast.parse(part.text).body if part.function is None else ():
            for name in sorted(taken.intersection(_bound(node))):
                raise _taken(name, node, part.line + node.lineno - 1)


def _taken(name: str, node: ast.stmt, line: int) -> CodeUnread:
    """That a statement gives another meaning to what the program calls so, in words that fit."""
    sentence, step = "“{name}” has a meaning in the program already.", "Give it another name."
    match node:
        case ast.Assign(value=ast.Call()) if name not in API:
            step = 'Write it as the program does: nao = Robot("NAO"), behavior = Behavior("Test").'
        case ast.Assign() | ast.AnnAssign() | ast.AugAssign() | ast.For():
            sentence = "“{name}” has a meaning in the program already, and cannot be a variable."
            step = "Give the variable another name."
    return CodeUnread(sentence, line, checklist=(step,), name=name)


def _bound(node: ast.stmt) -> set[str]:
    """The names to which a statement outside of functions gives a meaning."""
    is_import = isinstance(node, ast.ImportFrom) and node.module == "nep_core"
    return set() if is_import else set(names_made([node]))


def _lost_functions(
    editor: Editor,
    source: Source,
    code: Code,
    made: Source,
    functions: Mapping[str, ast.FunctionDef],
) -> tuple[set[int], set[int]]:
    """The statements, or functions, that the blocks would make in another way; the innermost."""
    by_stack = _functions_made(editor, code, made)
    _call_as_there(made, {by_stack[s].name: functions[s].name for s in by_stack if s in functions})
    lost: set[int] = set()
    places: set[int] = set()
    renamed: dict[str, int] = {}
    for stack, there in functions.items():
        again = by_stack.get(stack)
        if again is None:
            lost.add(there.lineno)
            continue
        lost |= _differing(there, again)
        inner = set(_innermost(there.body, again.body, there.lineno))
        places |= inner
        if inner and not there.decorator_list:
            places.add(there.lineno)  # its values may be of other kinds
        if again.name != there.name:
            renamed[there.name] = there.lineno
    if not lost:
        _require_no_use(source, renamed)
    return lost, places


def _call_as_there(made: Source, names: Mapping[str, str]) -> None:
    """Let the blocks stop rules by the names that the functions of these have in the text."""
    for stopped in stopped_in(made.tree):
        stopped.id = names.get(stopped.id, stopped.id)


def _functions_made(editor: Editor, code: Code, made: Source) -> dict[str, ast.FunctionDef]:
    """The functions that the blocks make, by their stacks."""
    found: dict[str, ast.FunctionDef] = {}
    for node in made.tree.body:
        block = code.block_at(node.lineno)
        if isinstance(node, ast.FunctionDef) and block in editor.project.blocks:
            found[editor.project.stack_of(str(block)).id] = node
    return found


def _innermost(there: Sequence[ast.stmt], again: Sequence[ast.stmt], around: int) -> Iterator[int]:
    """The lines of the innermost statements that differ; of the one around them by their number."""
    ours, theirs = _without_global(there), _without_global(again)
    if len(ours) != len(theirs):
        yield around
        return
    for one, other in zip(ours, theirs, strict=True):
        if _same(one, other):
            continue
        inner, bodies = _inside(one), _inside(other)
        if inner.keys() != bodies.keys() or not _is_so_begun(one, other):
            yield one.lineno
            continue
        is_elif = bool(_else_ifs(one))
        for name, body in inner.items():
            found = set(_innermost(body, bodies[name], one.lineno))
            is_part = is_elif and name == "orelse"
            yield from {one.lineno if is_part and n == body[0].lineno else n for n in found}


def _inside(node: ast.stmt) -> dict[str, list[ast.stmt]]:
    """The statements in another one, by where they are."""
    bodies = {name: getattr(node, name, []) for name in ("body", "orelse")}
    match node:
        case ast.Try(handlers=[ast.ExceptHandler(body=body)], finalbody=[]):
            bodies["handlers"] = body
    return {name: body for name, body in bodies.items() if body}


def _is_so_begun(one: ast.stmt, other: ast.stmt) -> bool:
    """Whether two statements are the same but for what is in their bodies."""
    plain = [as_block(one), as_block(other)]
    inside = ("body", "orelse", *(["handlers"] if "handlers" in _inside(one) else []))
    parts = [[getattr(n, f, None) for f in n._fields if f not in inside] for n in plain]
    parts[0] += _caught(one)
    parts[1] += _caught(other)
    return bool(_inside(one)) and type(plain[0]) is type(plain[1]) and _same(*parts)


def _caught(node: ast.stmt) -> list[object]:
    """What the parts of a “try” catch, and by which names."""
    handlers = node.handlers if isinstance(node, ast.Try) else []
    return [part for handler in handlers for part in (handler.type, handler.name)]


def _setting(source: Source, lines: set[int]) -> set[int]:
    """The statements that put something into the variables that begin in these lines.

    By the blocks that they are a variable begins with 0, with a text or with a list.
    """
    names = set[str]()
    for node in source.tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)]) if node.lineno in lines:
                names.add(name)
    found = set[int]()
    for function in functions_of(source.tree):
        for inner in ast.walk(function):
            match inner:
                case (
                    ast.Assign(targets=[ast.Name(id=name)])
                    | ast.AugAssign(target=ast.Name(id=name))
                ) if name in names:
                    found.add(inner.lineno)
    return found


def _differing(there: ast.FunctionDef, again: ast.FunctionDef) -> set[int]:
    """The lines of what differs between a function and the one that blocks make."""
    is_so_called = there.name == again.name and _same(there.args, again.args)
    if not _require_same_scope(there, again):
        return {there.lineno}
    if not there.decorator_list and not is_so_called:
        return {there.lineno}
    if not _same(there.decorator_list, again.decorator_list):
        return {there.lineno}
    ours, theirs = _without_global(there.body), _without_global(again.body)
    if len(ours) != len(theirs):
        return {there.lineno}
    lost = {a.lineno for a, b in zip(ours, theirs, strict=True) if not _same(a, b)}
    return lost


def _require_same_scope(there: ast.FunctionDef, again: ast.FunctionDef) -> bool:
    """Whether what a function has for itself in the text stays its own among the blocks.

    Raises CodeUnread for a rule that has it: nothing else than blocks can be made of its function.
    """
    both = list(functions_of(there)), list(functions_of(again))
    inner = len(both[0]) if len(both[0]) == len(both[1]) else 1  # else lines differ anyway
    for ours, theirs in zip(both[0][:inner], both[1][:inner], strict=True):
        for name, line in locals_of(ours).items():
            if not _is_shared(theirs, name):
                continue
            if not there.decorator_list:
                return False
            raise CodeUnread(
                "“{name}” is a variable of the whole program, and this rule has one of its own.",
                line,
                checklist=(
                    "Write a “global” line with this name first in the function, to mean that one.",
                    "Give the variable another name.",
                ),
                name=name,
            )
    return True


def _is_shared(function: ast.FunctionDef | ast.AsyncFunctionDef, name: str) -> bool:
    names = {f"{owner}.{name}" for owner in SHARED_OBJECTS}
    return any(
        (isinstance(node, ast.Name) and node.id in names)
        or (isinstance(node, ast.Global) and name in node.names)
        for node in ast.walk(function)
    )


def _require_no_use(source: Source, renamed: Mapping[str, int]) -> None:
    """The program names the functions of rules by itself: nothing may call them, only stop them."""
    stopped = set(map(id, stopped_in(source.tree)))
    for node in ast.walk(source.tree):
        if id(node) in stopped:
            continue
        if isinstance(node, ast.Name) and node.id in renamed and isinstance(node.ctx, ast.Load):
            raise CodeUnread(
                "“{name}” is the function of a rule: the program gives it a name by itself.",
                node.lineno,
                checklist=("Put what it does into a function of its own, and call that one.",),
                name=node.id,
            )


def _lost_around(source: Source, made: Source) -> set[int]:
    """The statements around the functions that the program would not write so by itself."""
    again = [_plain(node) for node in made.tree.body]
    said = {n.id for n in ast.walk(made.tree) if isinstance(n, ast.Name)}
    used = set(_read_of_program(source))
    lost = set()
    for node in source.tree.body:
        is_said = is_frame(node) or is_beginning(node)
        if not is_said or isinstance(node, ast.ImportFrom) or _plain(node) in again:
            continue
        if isinstance(node, ast.Assign) and _is_header(node):
            _require_unused(node, used)
        elif not (is_beginning(node) and _target(node) not in said):
            lost.add(begin_of(node))
    return lost


def _target(node: ast.stmt) -> str:
    match node:
        case ast.Assign(targets=[ast.Name(id=name)]):
            return name
    return ""


def _may_begin(node: ast.stmt) -> bool:
    """Whether own Python may begin a variable: what is kept begins as it was kept."""
    return _target(node).startswith(f"{SCOPE_PROGRAM}.")


def _require_unused(node: ast.Assign, used: set[str]) -> None:
    """What the program calls otherwise cannot be used by this name."""
    (target,) = node.targets
    if isinstance(target, ast.Name) and target.id in used:
        step = "Call a robot as on the page Robots, in small letters."
        match node.value:
            case ast.Call(func=ast.Name(id="Behavior")):
                step = "Call it “behavior”, wherever it stands."
            case ast.Call(args=[ast.List()]) if target.id == "all_robots":
                step = "Put the names of all robots into this list, as on the page Robots."
            case ast.Call(args=[ast.List()]):
                step = "Call it “all_robots”, wherever it stands."
        raise CodeUnread(
            "The program does not say this by the name “{name}”.",
            node.lineno,
            checklist=(step,),
            name=target.id,
        )


def _read_of_program(source: Source) -> Iterator[str]:
    """The names of what is outside of all functions that are read, wherever they are."""
    with warnings.catch_warnings(action="ignore"):
        left = [symtable.symtable("\n".join(source.lines), "program.py", "exec")]
    while left:
        table = left.pop()
        is_outside = table.get_type() == "module"
        for symbol in table.get_symbols():
            if symbol.is_referenced() and (is_outside or symbol.is_global()):
                yield symbol.get_name()
        left += table.get_children()


def _is_header(node: ast.Assign) -> bool:
    return isinstance(node.value, ast.Call) and getattr(node.value.func, "id", "") in HEADERS


def _lost_comments(
    source: Source, made: Source, functions: Mapping[str, ast.FunctionDef]
) -> set[int]:
    """The innermost statements around comments that would be gone."""
    missing = Counter(source.comments.values()) - Counter(made.comments.values())
    lost = set()
    for line, said in source.comments.items():
        if not missing[said] or not said:
            continue
        around = [f for f in functions.values() if _holds(source, f, line)]
        if not around:
            raise CodeUnread(
                "This comment has no place among the blocks.",
                line,
                checklist=("Write it on a line of its own, above what it is about.",),
            )
        inner: ast.stmt = around[0]
        parts = set[int]()
        for node in ast.walk(around[0]):
            parts |= {id(one) for one in _else_ifs(node)}
            if not isinstance(node, ast.stmt) or id(node) in parts:
                continue
            if _holds(source, node, line) and node.lineno >= inner.lineno:
                inner = node
        lost.add(inner.lineno)
        lost.add(around[0].lineno) if inner.lineno == line else None
    return lost


def _else_ifs(node: ast.AST) -> list[ast.stmt]:
    """The “elif” of an “if”, which is a part of it and no statement of its own."""
    is_one = isinstance(node, ast.If) and len(node.orelse) == 1
    inner = node.orelse[0] if isinstance(node, ast.If) and is_one else None
    is_part = isinstance(inner, ast.If) and inner.col_offset == getattr(node, "col_offset", -1)
    return [inner] if inner is not None and is_part else []


def _holds(source: Source, node: ast.stmt, line: int) -> bool:
    """Whether a line is one of a statement, or a comment at its end that is as far in."""
    if begin_of(node) <= line <= end_of([node]):
        return True
    is_inside = begin_of(node) < line and source.margin(line) > node.col_offset
    return is_inside and line <= source.end_inside(node)


def _without_global(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    """Statements without the “global” lines, which do nothing."""
    kept = [node for node in body if not isinstance(node, ast.Global)]
    return kept if kept or not body else [ast.Pass()]


def _same(one: object, other: object) -> bool:
    """Whether two trees are the same without their “global” lines; ends at the first difference."""
    left = [(one, other)]
    while left:
        ours, theirs = map(_as_compared, left.pop())
        if isinstance(ours, ast.BinOp) and isinstance(theirs, ast.JoinedStr):
            ours = as_joined(ours, knows_texts=True)
        if isinstance(ours, ast.BinOp) and isinstance(theirs, ast.Call):
            ours = as_power(ours)
        if type(ours) is not type(theirs):
            return False
        if isinstance(ours, ast.FormattedValue) and isinstance(theirs, ast.FormattedValue):
            left += told_in_braces(ours, theirs)
        elif isinstance(ours, ast.Call) and (told := told_by_robot(ours, theirs)):
            left += told
        elif isinstance(ours, ast.For) and is_gone_through(ours, theirs):
            left += [(getattr(ours, n), getattr(theirs, n)) for n in ("target", "body", "orelse")]
        elif isinstance(ours, ast.AST):
            left += [(getattr(ours, n, None), getattr(theirs, n, None)) for n in ours._fields]
        elif isinstance(ours, list) and isinstance(theirs, list):
            lines = _without_global(ours), _without_global(theirs)
            if len(lines[0]) != len(lines[1]):
                return False
            left += zip(*lines, strict=True)
        elif ours != theirs:
            return False
    return True


def _plain(node: object) -> object:
    """A tree as something to look for among others, without “global” lines."""
    if isinstance(node, list):
        return [_plain(one) for one in _without_global(node)]
    node = _as_compared(node)
    if not isinstance(node, ast.AST):
        return type(node), node
    return (type(node), *[_plain(getattr(node, name, None)) for name in node._fields])


def _as_compared(node: object) -> object:
    """Other ways to write a block count as the block."""
    if isinstance(node, ast.With) or (isinstance(node, ast.For) and not _names_its_list(node)):
        return as_block(node)
    return by_value(as_said(node)) if isinstance(node, ast.Call) else as_joined(node)


def _names_its_list(loop: ast.For) -> bool:
    """Whether the list that a loop goes through is named inside it: it might change there."""
    items = loop.iter.value if isinstance(loop.iter, ast.Subscript) else loop.iter
    inside = {one.id for line in loop.body for one in ast.walk(line) if isinstance(one, ast.Name)}
    return not isinstance(items, ast.Name) or items.id in inside
