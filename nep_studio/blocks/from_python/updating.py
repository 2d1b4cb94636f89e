"""Change a program to what its edited Python says, and nothing that the edit did not touch."""

from __future__ import annotations

import ast
import itertools
import logging
import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import partial
from itertools import pairwise

from faults import Words
from nep_studio.blocks.code_text import CodeTextRefused, read_outside
from nep_studio.blocks.deployment import OUTSIDE_BLOCK, chains, names_used, robot_entries
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import (
    AddGroup,
    ChangeProcedure,
    RemoveGroup,
    RemoveProcedure,
    SetComment,
    SetField,
)
from nep_studio.blocks.edits.placing import CreateBlocks, DeleteBlocks, MoveBlocks
from nep_studio.blocks.edits.project import RemoveVariable, SetScope
from nep_studio.blocks.errors import BlocksError, CodeRefused, EditRefused
from nep_studio.blocks.generate.expressions import comment_lines
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.operations.finding import why_not_robot_name
from nep_studio.blocks.operations.fixes import rename_robot
from nep_studio.blocks.operations.selection import chain_around
from nep_studio.blocks.places import InBody, InInput, InStack, NewStack, Place, variable_uses
from nep_studio.blocks.procedures import changed, parameters, procedure_of
from nep_studio.blocks.program import SCOPE_PROGRAM, Block, Parameter, Project, split_slot

from .comparing import lost_lines
from .learning import CodeUnread, Made, RefusedAtLine, at_line, blocks_of
from .mistakes import too_deep
from .naming import (
    Hints,
    Turns,
    keys_of,
    names_made_otherwise,
    settle_rules,
    variable_name,
    words_of,
)
from .outside import Part, parts_of
from .reading import ReadRule, create_chain, create_outside, read_rules
from .scoping import is_shared, with_shared_names
from .source import Source, read_source

log = logging.getLogger(__name__)
_WORD = re.compile(r"\w+")

# Change a chain of blocks to another one, keeping the blocks whose Python is the same.


class ChainUpdater:
    """Changes stacks that made ``code`` as they were."""

    def __init__(self, editor: Editor, code: Code) -> None:
        self._editor = editor
        self._code = code
        self._lines = code.text.splitlines()
        self._numbers: dict[str, tuple[int, int]] = {}
        for number, block in enumerate(code.blocks, start=1):
            while block in editor.project.blocks:
                first = self._numbers.get(block, (number, 0))[0]
                self._numbers[block] = (first, number)
                block = editor.project.parents[block].owner

    def update_stack(self, first: str, wanted: Sequence[Made]) -> str:
        """Change the stack that begins with a block; its hat stays when it is of the same type.

        Gives the first block as it is then.
        """
        project = self._editor.project
        stack = project.stack_of(first)
        hat = project.blocks[first]
        # the lines of the hat, to the one that begins the function
        lines = [self._lines[number - 1] for number in self._code.lines_of(first)]
        end = next((n for n, line in enumerate(lines, 1) if line.startswith("def ")), 0)
        if "\n".join(lines[:end]) == wanted[0].text:
            pass
        elif hat.type != wanted[0].type:
            roots, blocks = blocks_of(project, self._editor.language, wanted[:1])
            self._editor.apply(DeleteBlocks(first, 1))
            if stack.id in project.stacks:
                place: Place = InStack(stack.id, 0)
            else:
                place = self._editor.new_stack("behaviour", stack.x, stack.y)
            self._editor.apply(CreateBlocks(roots, blocks, place))
            stack = project.stack_of(roots[0])
        else:
            self._change(hat, wanted[0])
        below = stack.id
        self._update(stack.body[1:], wanted[1:], lambda index: InStack(below, index + 1))
        return stack.body[0]

    def _update(
        self, old: Sequence[str], wanted: Sequence[Made], place: Callable[[int], Place]
    ) -> None:
        """Change the blocks of a chain, from its end on; disabled ones stay where they are."""
        blocks = self._editor.project.blocks
        enabled = [index for index, block in enumerate(old) if not blocks[block].disabled]
        before = [self._text(old[index]) for index in enabled]
        # Python that is kept as it is may read as other blocks do, which would say it otherwise
        code = {t for i, t in zip(enabled, before, strict=True) if self._is_code(old[i])}
        is_new = [self._is_code_type(made.type) and made.text not in code for made in wanted]
        after = [(made.text, new) for made, new in zip(wanted, is_new, strict=True)]
        same = [(text, False) for text in before]
        matcher = SequenceMatcher(None, same, after, autojunk=False)
        for what, i, end, j, until in reversed(matcher.get_opcodes()):
            if what == "equal":
                continue
            pairs = min(end - i, until - j)
            for index in reversed(enabled[i + pairs : end]):
                self._editor.apply(DeleteBlocks(old[index], 1))
            for number in range(pairs):
                self._replace(old[enabled[i + number]], wanted[j + number], place)
            if until - j > pairs:
                begin = enabled[i] if i < len(enabled) else len(old)
                begin = enabled[i + pairs - 1] + 1 if pairs else begin
                self._create(wanted[j + pairs : until], place(begin))

    def _replace(self, block_id: str, made: Made, place: Callable[[int], Place]) -> None:
        """Change a block to another: itself when it is of the same type, else by a new one."""
        block = self._editor.project.blocks[block_id]
        if self._is_such(block, made):
            self._change(block, made)
            return
        chain = chain_around(self._editor.project, block_id)
        first = place(0)
        index = chain.index(block_id) - (first.index if isinstance(first, InStack | InBody) else 0)
        self._editor.apply(DeleteBlocks(block_id, 1))
        self._create([made], place(index))

    def _change(self, block: Block, made: Made) -> None:
        """Give a block other fields, plugged blocks, comment, and what is in its bodies."""
        editor = self._editor
        definition = editor.language.definitions[block.type]
        for name, group in definition.groups.items():
            is_there, slots = bool(block.groups.get(name)), definition.group_slots(name)
            if group.unfolds and is_there != bool(made.groups.get(name)):
                remove = RemoveGroup(block.id, name, 1, slots)
                editor.apply(remove if is_there else AddGroup(block.id, name, 1, slots, {}))
        if block.comment != made.comment and not definition.is_value:  # a value's is in no Python
            editor.apply(SetComment(block.id, made.comment))
        for key, slot in list(definition.keys(block.groups)):
            if slot.kind.name == "body":
                body = list(block.bodies.get(key, []))
                self._update(body, made.bodies.get(key, []), partial(InBody, block.id, key))
                continue
            plugged = editor.project.blocks.get(block.inputs.get(key, ""))
            stays = plugged is not None and self._stays(plugged, made.inputs.get(key))
            if plugged is not None and not stays:
                editor.apply(DeleteBlocks(plugged.id, 1))
            # what the Python does not say is as in a new block
            wanted = made.fields.get(key, definition.defaults.get(split_slot(key)[0]))
            if key not in made.inputs and definition.value(block, key) != wanted:
                editor.apply(SetField(block.id, key, wanted))
            if key in made.inputs and not stays:
                self._create([made.inputs[key]], InInput(block.id, key))

    def _stays(self, plugged: Block, made: Made | None) -> bool:
        """Whether a value block can stay where it is; what is in it becomes what is wanted."""
        if made is None:
            return plugged.disabled
        if plugged.disabled or not self._is_such(plugged, made):
            return False
        self._change(plugged, made)
        return True

    def _is_such(self, block: Block, made: Made) -> bool:
        """Whether a block is of the wanted type and has as many of all its parts.

        Parts that unfold count only where blocks are plugged in.
        """
        if block.type != made.type:
            return False
        definition = self._editor.language.definitions[block.type]
        return all(
            block.groups.get(name, 0) == made.groups.get(name, 0)
            or (
                group.unfolds
                and not any(f"{slot}.1" in block.inputs for slot in definition.group_slots(name))
            )
            for name, group in definition.groups.items()
        )

    def _create(self, chain: Sequence[Made], place: Place) -> None:
        roots, blocks = blocks_of(self._editor.project, self._editor.language, chain)
        self._editor.apply(CreateBlocks(roots, blocks, place))

    def _is_code(self, block: str) -> bool:
        return self._is_code_type(self._editor.project.blocks[block].type)

    def _is_code_type(self, block_type: str) -> bool:
        definition = self._editor.language.definitions.get(block_type)
        return definition is not None and definition.generator == "code_lines"

    def _text(self, block: str) -> str:
        """The lines that a block makes with all inside it, without their margin."""
        if block not in self._numbers:
            return ""
        first, last = self._numbers[block]
        return textwrap.dedent("\n".join(self._lines[first - 1 : last])).rstrip()


@dataclass(frozen=True, slots=True)
class _Written:
    """A stack that makes a function now: its chain and its lines.

    ``procedure`` is the own block that it defines, if any, ``given`` are the values of that one.
    """

    stack: str
    function: str
    text: str
    procedure: str
    given: list[str]


def update_from_python(editor: Editor, text: str) -> None:
    """Make the program what a text says, as one step; raises CodeUnread, and changes nothing.

    Stacks whose lines are the same stay as they are, with their ids, places, comments and disabled
    blocks; in the others, blocks whose lines are the same do. Disabled rules and loose stacks stay.
    What has no block stays Python, in a rule or outside of all functions.
    """
    source = read_source(text, is_program=True)
    with_shared_names(source.tree, _free_names(editor))
    try:
        _update_until_same(editor, source)
    except (BlocksError, EditRefused):
        raise
    except RecursionError as error:
        raise too_deep(source.tree, source.lines) from error
    except Exception as error:
        log.exception("Python could not be read")
        raise CodeUnread(
            "This program could not be read: nothing has changed, and your text is still here.",
            1,
            checklist=("Undo the last change of the code.",),
        ) from error


def _free_names(editor: Editor) -> dict[str, str]:
    """What a name that a text does not explain stands for in a project."""
    keys = {variable: name for name, variable in keys_of(editor).items()}
    return {
        variable_name(one.name): name if is_shared(name) else f"{SCOPE_PROGRAM}.{name}"
        for one in editor.project.variables
        if (name := keys.get(one.id))
    }


MOST_READINGS = 3
"""How often a text is read, each time with more that is known of its values."""


def _update_until_same(editor: Editor, source: Source) -> None:
    """Change the blocks; what would not be said again by them is kept as Python, or refused.

    Where something would not, all is read again first, with what is known then, and after that in
    the other ways in which the statements that differ can be read.
    """
    kept, apart = set[int](), names_made_otherwise(source.tree)
    hints: Hints | None = None
    turns = Turns()
    readings = 1
    anew = False
    while True:
        try:
            with editor.transaction("change the code"):
                parts, functions = _update(editor, source, kept, anew, hints, apart)
                lost = lost_lines(editor, source, parts, functions, apart)
                if lost.lines or lost.apart:
                    raise _Differs(lost.lines)
        except _Differs as differs:
            apart |= lost.apart
            if lost.apart:
                continue
            differed = hints.differed if hints else differs.lines
            known, hints = hints, Hints(lost.kinds, differed, turns)
            if hints != known and readings < MOST_READINGS:
                readings += 1
                continue
            if turns.go_on(lost.places):
                continue
            more = differs.lines - lost.around - kept
            if not more and not lost.begun <= apart:
                apart |= lost.begun
                continue
            more = more or (differs.lines - kept)
            if not more:
                raise CodeUnread(
                    differs.sentence,
                    min(differs.lines),
                    checklist=_OTHERWISE,
                ) from differs
            kept |= more
        except EditRefused as refused:
            if anew:
                line = refused.line if isinstance(refused, RefusedAtLine) else 1
                checklist = refused.checklist or _OTHERWISE
                raise CodeUnread(refused.sentence, line, checklist=checklist) from refused
            anew = True
        else:
            return


_OTHERWISE = ("Write it in another way.", "Or undo the last change.")


class _Differs(Exception):
    """Lines that would not be made again from the blocks as they are in the text."""

    def __init__(self, lines: set[int], sentence: Words = "") -> None:
        super().__init__()
        self.lines = lines
        self.sentence = sentence or "This cannot become blocks that say the same."


def _update(
    editor: Editor,
    source: Source,
    kept: set[int],
    anew: bool,
    hints: Hints | None,
    apart: set[str],
) -> tuple[list[Part], dict[str, ast.FunctionDef]]:
    """Change the stacks whose lines have changed; ``anew``, make those anew.

    ``hints`` are what is known of the text when it was read before.

    Gives the parts of the text, and the function that each stack is to make.
    """
    parts = parts_of(source, kept, apart)
    _rename_robot(editor, source)
    code = _code(editor)
    written = _written(editor.project, code)
    if _rename_own_blocks(editor, source, parts, written):
        code = _code(editor)
        written = _written(editor.project, code)
    named = [w.text for w in written if not apart.isdisjoint(_WORD.findall(w.text))]
    known_texts = [] if anew else [w.text for w in written if w.text not in named]
    rules = read_rules(editor, source, parts, kept, known_texts, hints, apart)
    left = {stack.stack: stack for stack in written}
    before = {editor.project.stacks[one.stack].body[0]: one.function for one in written}
    same = [
        None if rule.chain else _take(left, (w for w in left.values() if w.text == rule.text))
        for rule in rules
    ]
    firsts = []
    page = "behaviour"
    for number, (rule, known) in enumerate(zip(rules, same, strict=True)):
        if known is not None:
            firsts.append(editor.project.stacks[known.stack].body[0])
        else:
            name = rule.function.name
            known = _take(left, (w for w in left.values() if w.function == name))
            if known is None and len(rules) == len(written):  # it has got another name
                known = left.pop(written[number].stack, None)
            with at_line(rule.function.lineno):
                firsts.append(_change(editor, code, rule, known, anew, page))
        page = editor.project.page_of(firsts[-1])
    for gone in left.values():
        stack = editor.project.stacks[gone.stack]
        editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    hats = {rule.function.name: first for rule, first in zip(rules, firsts, strict=True)}
    settle_rules(editor, hats, before)
    _remove_own_blocks(editor, written)
    _remove_variables(editor, apart)
    _set_scopes(editor, source)
    _put_in_order(editor, _update_outside(editor, parts, firsts))
    stacks = [editor.project.stack_of(first).id for first in firsts]
    return parts, dict(zip(stacks, (rule.function for rule in rules), strict=True))


def _rename_robot(editor: Editor, source: Source) -> None:
    """Give a robot the name that it has in the text, where the text has no other for it."""
    said = set[str]()
    for node in source.tree.body:
        match node:
            case ast.Assign(value=ast.Call(func=ast.Name(id="Robot"), args=[given])):
                texts = (one.value for one in ast.walk(given) if isinstance(one, ast.Constant))
                said |= {text for text in texts if isinstance(text, str)}
    project, language = editor.project, editor.language
    listed = {entry.name: entry.block_id for entry in robot_entries(project, language)}
    used = names_used(project, language, "robot")
    gone = [name for name in listed if name in used and name not in said]
    new = [name for name in said if name not in listed]
    if len(gone) == len(new) == 1 and why_not_robot_name(editor, new[0]) is None:
        try:
            rename_robot(editor, listed[gone[0]], new[0])
        except EditRefused:  # Python that is to be read anew names it in another way
            log.debug("a robot keeps its name until the text is read")


def _rename_own_blocks(
    editor: Editor, source: Source, parts: Sequence[Part], written: Sequence[_Written]
) -> bool:
    """Give own blocks, and their values, the names that they have in the text; says if any had not.

    Those that are in it by no name of theirs are the new ones there, in their order. One that
    gives a value now, or none any more, makes way for a new one.
    """
    plain = [p.function for p in parts if p.function and not p.function.decorator_list]
    there = {function.name: function for function in plain}
    before = {one.function: one for one in written if one.procedure}
    new = [name for name in there if name not in before]
    gone = [name for name in before if name not in there]
    names = dict(zip(gone, new, strict=True)) if len(gone) == len(new) else {}
    is_changed = False
    for one in before.values():
        function = there.get(names.get(one.function, one.function))
        given = [argument.arg for argument in function.args.args] if function else []
        if function is None or len(given) != len(one.given):
            continue
        lines = source.lines[function.lineno - 1 : function.end_lineno]
        if _gives_value(lines) != _gives_value(one.text.splitlines()):
            taken = {*there, *before}
            names_left = (f"{one.function}_{number}" for number in itertools.count(2))
            free = next(name for name in names_left if name not in taken)
            is_changed |= _rename_own_block(editor, one, free, one.given)
        elif (function.name, given) != (one.function, one.given):
            is_changed |= _rename_own_block(editor, one, function.name, given)
    return is_changed


def _gives_value(lines: Sequence[str]) -> bool:
    return any(line.lstrip().startswith("return ") for line in lines)


def _rename_own_block(editor: Editor, one: _Written, name: str, given: Sequence[str]) -> bool:
    """Give an own block and its values other names in Python; says whether it could be."""
    procedure = editor.project.procedures[one.procedure]
    values = [
        part if old == new else Parameter(part.id, words_of(new), part.kind)
        for part, old, new in zip(parameters(procedure), one.given, given, strict=True)
    ]
    of_values = iter(values)
    parts = [next(of_values) if isinstance(p, Parameter) else p for p in procedure.parts]
    if name != one.function:
        said = [part for part in parts if isinstance(part, str)]
        first = parts.index(said[0])
        parts = [p for p in parts if isinstance(p, Parameter)]
        parts.insert(first if len(said) == 1 else 0, words_of(name))
    try:
        new = changed(procedure, parts, gives_value=procedure.gives_value)
        editor.apply(ChangeProcedure(new))
    except EditRefused:  # Python that is to be read anew names it in another way
        log.debug("an own block keeps its name until the text is read")
        return False
    return True


def _remove_own_blocks(editor: Editor, written: Sequence[_Written]) -> None:
    """Remove the own blocks that were defined and are not any more, where nothing has them."""
    used = {procedure_of(block.type) for block in editor.project.blocks.values()}
    for one in written:
        if one.procedure and one.procedure not in used:
            editor.apply(RemoveProcedure(one.procedure))


def _set_scopes(editor: Editor, source: Source) -> None:
    """Let variables be the whole program's that the text has so, but would be by themselves."""
    said = {node.id for node in ast.walk(source.tree) if isinstance(node, ast.Name)}
    for name, variable in keys_of(editor).items() if any(map(is_shared, said)) else ():
        if not is_shared(name) and name not in said and f"{SCOPE_PROGRAM}.{name}" in said:
            editor.apply(SetScope(variable, SCOPE_PROGRAM))


def _remove_variables(editor: Editor, own: set[str]) -> None:
    """Remove the variables whose names rules have for themselves now, where no block has them."""
    variables = editor.project.variables if own else ()
    for variable in [one for one in variables if variable_name(one.name) in own]:
        if not variable_uses(editor.project, variable.id):
            editor.apply(RemoveVariable(variable.id))


def _update_outside(editor: Editor, parts: Sequence[Part], firsts: Sequence[str]) -> list[str]:
    """Change the stacks of own Python; gives the first blocks of all stacks as in the text."""
    left = [
        block
        for chain in chains(editor.project, editor.language)
        if (block := editor.project.blocks[chain[0]]).type == OUTSIDE_BLOCK
    ]
    known = {text for block in left if (text := _own_text(block))}
    definition = editor.language.definitions.get(OUTSIDE_BLOCK)
    ordered: list[str] = []
    functions = iter(firsts)
    page = editor.project.page_of(firsts[0]) if firsts else "behaviour"
    for part in parts:
        if part.function is not None:
            ordered.append(next(functions))
            page = editor.project.page_of(ordered[-1])
            continue
        for text in _pieces(part.text, known):
            fitting = [b for b in left if definition and definition.value(b, "place") == part.place]
            same = next((b for b in fitting if _own_text(b) == text), None)
            free = [b for b in fitting if _own_text(b) not in part.text]
            found = same or next(iter(free), None)
            if found is None:
                ordered.append(create_outside(editor, text, part.place, part.line, page))
                continue
            left.remove(found)
            if same is None:
                editor.apply(SetComment(found.id, ""))
                editor.apply(SetField(found.id, "code", text))
            ordered.append(found.id)
    for gone in left:
        editor.apply(DeleteBlocks(gone.id, len(editor.project.stack_of(gone.id).body)))
    return ordered


def _own_text(block: Block) -> str:
    """The lines of a block of own Python, with its comment above them."""
    code = str(block.fields.get("code", "")).rstrip()
    return "\n".join([*comment_lines(block.comment), code])


def _pieces(text: str, known: set[str]) -> list[str]:
    """A text in the pieces that are blocks already, and what is between them."""
    lines, pieces, start, number = text.split("\n"), list[str](), 0, 0
    while number < len(lines):
        rest = "\n".join(lines[number:])
        fitting = [t for t in known if t and (rest == t or rest.startswith(f"{t}\n"))]
        found = max(fitting, key=len, default=None)
        if found is None:
            number += 1
            continue
        pieces += ["\n".join(lines[start:number]), found]
        number += found.count("\n") + 1
        start = number
    pieces.append("\n".join(lines[start:]))
    pieces = [piece.strip("\n") for piece in pieces if piece.strip()]
    try:
        for piece in pieces:
            read_outside(piece)
    except CodeTextRefused:
        return [text]
    return pieces


def _change(
    editor: Editor, code: Code, rule: ReadRule, known: _Written | None, anew: bool, page: str
) -> str:
    """Make a stack what a rule says, or a new one on a page; gives its first block."""
    if known is None:
        return create_chain(editor, rule.chain, page=page)
    stack = editor.project.stacks[known.stack]
    hat = editor.project.blocks[stack.body[0]].type
    if not anew and (hat == rule.chain[0].type or not procedure_of(hat)):
        return ChainUpdater(editor, code).update_stack(stack.body[0], rule.chain)
    page = editor.project.page_of(stack.id)
    editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    return create_chain(editor, rule.chain, (stack.x, stack.y), page)


def _put_in_order(editor: Editor, firsts: Sequence[str]) -> None:
    """Let stacks come on their page in the order of the text; they stay where they lie."""
    project = editor.project
    if any(project.blocks[first].type == OUTSIDE_BLOCK for first in firsts):
        _sort(editor, firsts)
        firsts = _as_written(editor, firsts)
    else:
        firsts = [f for f in firsts if not procedure_of(project.blocks[f].type)]
    _sort(editor, firsts)


def _as_written(editor: Editor, firsts: Sequence[str]) -> list[str]:
    """Stacks in the order in which the program writes them: own blocks above who uses them."""
    lines: dict[str, int] = {}
    for number, block in enumerate(_code(editor).blocks):
        if block in editor.project.blocks:
            first = editor.project.stack_of(block).body[0]
            lines.setdefault(first, number)
    return sorted((first for first in firsts if first in lines), key=lambda first: lines[first])


def _sort(editor: Editor, firsts: Sequence[str]) -> None:
    project = editor.project
    for above, first in pairwise(firsts):
        upper, stack = project.stack_of(above), project.stack_of(first)
        page = project.page_of(stack.id)
        if page != project.page_of(upper.id):
            continue
        position = project.pages[page].index(upper)
        if project.pages[page].index(stack) < position:
            place = NewStack(page, project.new_id("s"), stack.x, stack.y, position)
            editor.apply(MoveBlocks(first, len(stack.body), place))


def _take(left: dict[str, _Written], fitting: Iterator[_Written]) -> _Written | None:
    found = next(fitting, None)
    return left.pop(found.stack) if found is not None else None


def _code(editor: Editor) -> Code:
    """The code as it is; none when the blocks make none."""
    try:
        return generate_program(editor.project, editor.language)
    except CodeRefused:
        return Code("", ())


def _written(project: Project, code: Code) -> list[_Written]:
    """The stacks that make functions now, in the order of the code."""
    spans: dict[str, tuple[int, int]] = {}
    for number, block in enumerate(code.blocks, start=1):
        if block and project.kind_of_page(project.page_of(block)) == "behaviour":
            stack = project.stack_of(block).id
            if project.blocks[project.stacks[stack].body[0]].type == OUTSIDE_BLOCK:
                continue
            spans[stack] = (spans.get(stack, (number, 0))[0], number)
    found, every = [], code.text.splitlines()
    for stack, (first, last) in spans.items():
        hat, numbers = project.stacks[stack].body[0], range(first, last + 1)
        lines = [
            line
            for line, number in zip(every[first - 1 : last], numbers, strict=True)
            # as a text is read: without what the program writes by itself
            if not (line.startswith("    global ") and code.blocks[number - 1] == hat)
        ]
        header = next((line[4:] for line in lines if line.startswith("def ")), "")
        name, _, said = header.removesuffix("):").partition("(")
        given = said.split(", ") if said else []
        text = textwrap.dedent("\n".join(lines)).rstrip()
        procedure = procedure_of(project.blocks[hat].type)
        found.append(_Written(stack, name, text, procedure, given))
    return found
