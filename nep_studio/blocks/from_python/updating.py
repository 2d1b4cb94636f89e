"""Change a program to what its edited Python says, and nothing that the edit did not touch."""

from __future__ import annotations

import ast
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import partial
from itertools import pairwise

from faults import Words
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetComment, SetField
from nep_studio.blocks.edits.placing import CreateBlocks, DeleteBlocks, MoveBlocks
from nep_studio.blocks.errors import CodeRefused, EditRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.operations.selection import chain_around
from nep_studio.blocks.places import InBody, InInput, InStack, NewStack, Place
from nep_studio.blocks.procedures import procedure_of
from nep_studio.blocks.program import Block, Project

from .learning import CodeUnread, Made, blocks_of
from .reading import CHECKLIST, ReadRule, Source, create_chain, read_rules, read_source

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
        matcher = SequenceMatcher(None, before, [made.text for made in wanted], autojunk=False)
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
        groups = {name: count for name, count in block.groups.items() if count}
        wanted = {name: count for name, count in made.groups.items() if count}
        if block.type == made.type and groups == wanted:
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
        if block.comment != made.comment:
            editor.apply(SetComment(block.id, made.comment))
        for key, slot in list(definition.keys(block.groups)):
            if slot.kind.name == "body":
                body = list(block.bodies.get(key, []))
                self._update(body, made.bodies.get(key, []), partial(InBody, block.id, key))
                continue
            if key in block.inputs:
                editor.apply(DeleteBlocks(block.inputs[key], 1))
            wanted = made.fields.get(key)
            if wanted is not None and definition.value(block, key) != wanted:
                editor.apply(SetField(block.id, key, wanted))
            if key in made.inputs:
                self._create([made.inputs[key]], InInput(block.id, key))

    def _create(self, chain: Sequence[Made], place: Place) -> None:
        roots, blocks = blocks_of(self._editor.project, self._editor.language, chain)
        self._editor.apply(CreateBlocks(roots, blocks, place))

    def _text(self, block: str) -> str:
        """The lines that a block makes with all inside it, without their margin."""
        if block not in self._numbers:
            return ""
        first, last = self._numbers[block]
        return textwrap.dedent("\n".join(self._lines[first - 1 : last])).rstrip()


@dataclass(frozen=True, slots=True)
class _Written:
    """A stack that makes a function now: its chain and its lines."""

    stack: str
    function: str
    text: str


def update_from_python(editor: Editor, text: str) -> None:
    """Make the program what a text says, as one step; raises CodeUnread, and changes nothing.

    Stacks whose lines are the same stay as they are, with their ids, places, comments and disabled
    blocks; in the others, blocks whose lines are the same do. Disabled rules and loose stacks stay.
    """
    source = read_source(text)
    as_code: set[str] = set()
    anew = False
    while True:
        try:
            with editor.transaction("change the code"):
                functions = _update(editor, source, as_code, anew)
                wrong = _functions_that_differ(editor, source, functions)
                if wrong:
                    raise _Differs(wrong)
        except _Differs as differs:
            if differs.functions <= as_code:
                raise CodeUnread(
                    differs.sentence,
                    _line_of(source, min(differs.functions)),
                    checklist=("Write it in another way.", "Or undo the last change."),
                ) from differs
            as_code |= differs.functions
        except EditRefused as refused:
            if anew:
                raise CodeUnread(refused.sentence, 1, checklist=refused.checklist) from refused
            anew = True
        except RecursionError as error:  # of a tree that Python could still read
            raise CodeUnread("Python cannot read this.", 1, checklist=CHECKLIST) from error
        else:
            return


class _Differs(Exception):
    """Functions that would not be made again from the blocks as they are in the text."""

    def __init__(self, functions: set[str], sentence: Words = "") -> None:
        super().__init__()
        self.functions = functions
        self.sentence = sentence or "This function cannot become blocks that say the same."


def _update(editor: Editor, source: Source, as_code: set[str], anew: bool) -> dict[str, str]:
    """Change the stacks whose lines have changed; ``anew``, make those anew.

    Gives the name of the function that each stack is to make.
    """
    code = _code(editor)
    written = _written(editor.project, code)
    rules = read_rules(editor, source, as_code, [] if anew else [w.text for w in written])
    left = {stack.stack: stack for stack in written}
    same = [_take(left, (w for w in left.values() if w.text == rule.text)) for rule in rules]
    firsts = []
    for number, (rule, known) in enumerate(zip(rules, same, strict=True)):
        if known is not None:
            firsts.append(editor.project.stacks[known.stack].body[0])
            continue
        name = rule.function.name
        known = _take(left, (w for w in left.values() if w.function == name))
        if known is None and len(rules) == len(written):  # it has got another name
            known = left.pop(written[number].stack, None)
        firsts.append(_change(editor, code, rule, known, anew))
    for gone in left.values():
        stack = editor.project.stacks[gone.stack]
        editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    _put_in_order(editor, firsts)
    names = [rule.function.name for rule in rules]
    stacks = [editor.project.stack_of(first).id for first in firsts]
    return dict(zip(stacks, names, strict=True))


def _change(editor: Editor, code: Code, rule: ReadRule, known: _Written | None, anew: bool) -> str:
    """Make a stack what a rule says, or a new one; gives its first block."""
    if known is None:
        return create_chain(editor, rule.chain)
    stack = editor.project.stacks[known.stack]
    if not anew:
        return ChainUpdater(editor, code).update_stack(stack.body[0], rule.chain)
    editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    return create_chain(editor, rule.chain, (stack.x, stack.y))


def _put_in_order(editor: Editor, firsts: Sequence[str]) -> None:
    """Let stacks come on their page in the order of the text; they stay where they lie."""
    project = editor.project
    for above, first in pairwise(firsts):
        upper, stack = project.stack_of(above), project.stack_of(first)
        page = project.page_of(stack.id)
        if page != project.page_of(upper.id) or procedure_of(project.blocks[first].type):
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
            spans[stack] = (spans.get(stack, (number, 0))[0], number)
    found, every = [], code.text.splitlines()
    for stack, (first, last) in spans.items():
        lines = every[first - 1 : last]
        headers = (line[4:].partition("(")[0] for line in lines if line.startswith("def "))
        text = textwrap.dedent("\n".join(lines)).rstrip()
        found.append(_Written(stack, next(headers, ""), text))
    return found


def _functions_that_differ(
    editor: Editor, source: Source, functions: Mapping[str, str]
) -> set[str]:
    """The functions that the blocks would make in another way than the text has them."""
    try:
        made = ast.parse(generate_program(editor.project, editor.language).text)
    except CodeRefused as refused:
        if refused.block in editor.project.blocks:
            stack = editor.project.stack_of(refused.block).id
            if stack in functions:
                raise _Differs({functions[stack]}, refused.sentence) from refused
        raise CodeUnread(refused.sentence, 1, checklist=refused.checklist) from refused
    again = [_plain(node) for node in made.body if isinstance(node, ast.FunctionDef)]
    return {
        node.name
        for node in source.tree.body
        if isinstance(node, ast.FunctionDef) and _plain(node) not in again
    }


def _plain(function: ast.FunctionDef) -> tuple[object, ...]:
    """A function without what the generator writes by itself: the name of a rule, global lines."""
    name = "" if function.decorator_list else function.name
    return name, _comparable(function.decorator_list), _comparable(function.body)


def _comparable(node: object) -> object:
    """A tree as something to compare."""
    if isinstance(node, list):
        return [_comparable(one) for one in node if not isinstance(one, ast.Global)]
    if isinstance(node, ast.AST):
        return (type(node), *[_comparable(getattr(node, name, None)) for name in node._fields])
    return type(node), node


def _line_of(source: Source, name: str) -> int:
    functions = (n for n in source.tree.body if isinstance(n, ast.FunctionDef) and n.name == name)
    return next((node.lineno for node in functions), 1)
