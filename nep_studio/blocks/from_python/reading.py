"""Read the Python of a whole program, or of a few lines, into blocks."""

from __future__ import annotations

import ast
import itertools
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from nep_studio.blocks.code_text import CodeTextRefused, read_lines
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.expressions import comment_line, comment_text
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import height_of
from nep_studio.blocks.procedures import DEFINE, parameters
from nep_studio.blocks.program import FARTHEST, Project

from .equal_forms import other_statements
from .learning import CodeUnread, Made, beginning, blocks_of, learned
from .naming import Hints, SourceNames, Turns, names_in
from .outside import Part
from .simpler import is_made, with_more
from .source import Source, end_of
from .values import ValueReader, match

# Read statements as chains of blocks; what has no block becomes a code block.


_Candidate = tuple[Made, int, Mapping[str, list[ast.stmt]]]


def _written(candidate: _Candidate) -> int:
    return candidate[0].written


class StatementReader:
    """Reads the statements of one text; those in the lines ``kept`` stay Python."""

    def __init__(
        self,
        language: Language,
        names: SourceNames,
        source: Source,
        kept: Collection[int] = (),
        turns: Turns | None = None,
    ) -> None:
        self.values = ValueReader(language, names)
        self._kept = kept
        self._turns = turns or Turns()
        self._language = language
        self._source = source
        self._learned = learned(language)
        self._above: dict[str, tuple[ast.FunctionDef, int]] = {}
        """Functions above a loop that something in it is given, by their names; the lines after
        which comments are theirs."""
        self._reach = 0
        """The first line of such functions that a statement was given; 0 for none."""

    def body(self, nodes: Sequence[ast.stmt]) -> list[Made]:
        """The blocks of statements that are moved in, with the comments above and below them."""
        before, last = self._source.line_before(nodes), self._source.last_line(nodes)
        return self.chain(_without_pass(nodes), before, last, nodes[0].col_offset)

    def chain(
        self, nodes: Sequence[ast.stmt], after: int, until: int = 0, margin: int = 0
    ) -> list[Made]:
        """The blocks of statements; comments from line ``after`` on belong to them.

        ``until`` is the last line where a comment can belong to them, 0 for that of the last one;
        it is so far in as ``margin``.
        """
        made: list[Made] = []
        code: list[ast.stmt] = []
        begin, left = after, _without_global(nodes)
        while left:
            count = with_more(left)
            if not self._are_blocks(left[:count], begin):
                code += left[:count]
                del left[:count]
                continue
            earlier, self._reach = self._reach, 0
            found = self._statement(left, begin)
            reach, self._reach = self._reach, _first(earlier, self._reach)
            is_end = found is None or not _without_end(left[found[1] :])
            if found is None or (self._language.definitions[found[0].type].is_last and not is_end):
                code.append(left.pop(0))
                continue
            begin = self._keep_code(made, code, begin)
            used = left[: found[1]]
            del left[: found[1]]
            if self._language.definitions[found[0].type].is_last:
                left.clear()
            self._describe(found[0], used, begin, reach)
            made += self._notes_above(used, begin)
            made.append(found[0])
            begin = end_of(used)
        begin = self._keep_code(made, code, begin)
        made += self._notes(self._source.comments_between(begin + 1, until, margin))
        return made

    def _are_blocks(self, nodes: Sequence[ast.stmt], begin: int) -> bool:
        """Whether the simpler statements of one line are all blocks: else they stay Python.

        Raises _NotSaid for one that stands on no line of its own, and is none.
        """
        if len(nodes) == 1 and not is_made(nodes[0]):
            return True
        found = [self._statement([node], begin) for node in nodes]
        are_blocks = all(one is not None and not one[0].written for one in found)
        if is_made(nodes[0]) and not are_blocks:
            raise _NotSaid
        return are_blocks

    def rule(self, node: ast.FunctionDef, after: int) -> list[Made]:
        """The blocks of a function: the hat first."""
        hat = self._hat(node)
        hat.comment = self._source.comment_of_function(node, after)
        first = self._source.first_line(node, after)
        hat.text = self._source.text(first, node.lineno)
        nodes = _without_global(node.body)
        if nodes and (node.lineno in self._kept or _is_one_piece(node)):
            last = self._source.last_line(node.body)
            return [hat, self.code(nodes, self._source.line_before(node.body), last)]
        try:
            return [hat, *self.body(node.body)]
        except _NotSaid:
            last = self._source.last_line(node.body)
            return [hat, self.code(nodes, self._source.line_before(node.body), last)]

    def code(self, nodes: Sequence[ast.stmt], after: int, until: int = 0) -> Made:
        """A code block that keeps the text of statements, and of comments below them."""
        block_type = self.values.type_of("code_lines")
        first = self._source.first_line(nodes[0], after)
        text = self._source.text(first, max(until, end_of(nodes)))
        try:
            read_lines(text)
        except CodeTextRefused as refused:
            raise CodeUnread(
                refused.reason,
                self._source.line_at(first, refused.line),
                checklist=refused.checklist or ("Correct this line.",),
            ) from refused
        if not block_type:
            raise CodeUnread("There is no block for this.", first)
        return Made(block_type, {"code": text}, text=text)

    def _hat(self, node: ast.FunctionDef) -> Made:
        if not node.decorator_list:
            procedure = self.values.names.procedures[node.name]
            ids = [f"{procedure.id}.{parameter.id}" for parameter in parameters(procedure)]
            given = [argument.arg for argument in node.args.args]
            self.values.names.parameters = dict(zip(given, ids, strict=True))
            return Made(DEFINE + procedure.id)
        self.values.names.parameters = {}
        if len(node.decorator_list) == 1:
            _require_no_values(node)
            for pattern in self._learned.hats_for(node.decorator_list[0]):
                found = match(pattern, node.decorator_list)
                made = self.values.made_from(pattern, found) if found is not None else None
                if made is not None:
                    return made
        if len(node.decorator_list) > 1:
            raise CodeUnread(
                "The function of a rule has one line with “@” above it.",
                node.decorator_list[1].lineno,
                checklist=("Make a function of its own for each of them.",),
            )
        raise CodeUnread(
            "No “when” block stands for “@{code}”.",
            node.decorator_list[0].lineno,
            checklist=("Write the line above the function as a “when” block does.",),
            code=ast.unparse(node.decorator_list[0]),
        )

    def _statement(self, nodes: Sequence[ast.stmt], begin: int) -> tuple[Made, int] | None:
        """The block that the first of these statements, or several, are; and how many."""
        if (plain := as_block(nodes[0])) is not nodes[0]:
            inner = self._statement([plain], begin)
            if inner is not None:
                return inner
        if above := _functions_above(nodes):
            return self._below_functions(nodes[: above + 1], begin)
        if functions := self._given(nodes[0]):
            return self._with_functions(functions, nodes, begin)
        first = nodes[0]
        if first.lineno in self._kept:
            return None
        turn = self._turns.taken.get(first.lineno, 0)
        if turn:
            every = self._ways(nodes)
            self._turns.ways[first.lineno] = len(every)
            found = every[turn % len(every)] if every else None
        else:
            found = min(self._candidates(nodes), key=_written, default=None)
        if found is None:
            return None
        made, count, bodies = found
        try:
            for key, body in bodies.items():
                made.bodies[key] = self.body(body)
        except _NotSaid:
            return None
        return made, count

    def _below_functions(self, nodes: Sequence[ast.stmt], begin: int) -> tuple[Made, int] | None:
        """The block of a statement that uses all functions above it, and how many these are."""
        *functions, last = nodes
        before = dict(self._above)
        for one in functions:
            is_above = one.lineno < last.lineno
            if isinstance(one, ast.FunctionDef):
                self._above[one.name] = one, self._source.right_above(one) if is_above else 0
        found = self._statement([last], begin)
        if found is None or self._above != before:
            self._above = before
            return None
        return found[0], len(nodes)

    def _given(self, node: ast.stmt) -> list[str]:
        """The functions above a loop that a statement in it gives to a block."""
        match node:
            case ast.Expr(ast.Call(func=ast.Name(id="for_each_robot"), args=[_, *given])):
                pass
            case ast.Expr(ast.Call(args=given)):
                pass
            case _:
                return []
        names = [one.id if isinstance(one, ast.Name) else "" for one in given]
        if names and self._above.keys() >= set(names):
            return names
        return []

    def _with_functions(
        self, names: Sequence[str], nodes: Sequence[ast.stmt], begin: int
    ) -> tuple[Made, int] | None:
        """The block of a statement as if the functions of these names stood directly above it."""
        taken = {name: self._above.pop(name) for name in dict.fromkeys(names)}
        functions = [function for function, _ in taken.values()]
        found = self._statement([*functions, *nodes], begin)
        if found is None or found[1] <= len(names):
            self._above |= taken
            return None
        self._reach = _first(self._reach, *(self._source.first_line(one, 0) for one in functions))
        said = [self._source.comment_of(*one) for one in taken.values()]
        found[0].comment = "\n".join(filter(None, said))
        return found[0], found[1] - len(functions)

    def _notes_above(self, nodes: Sequence[ast.stmt], begin: int) -> list[Made]:
        """The comments that stand alone above the functions that are above a statement."""
        said: list[str] = []
        for one in nodes[: _functions_above(nodes)]:
            if one.lineno < nodes[-1].lineno:
                last = self._source.right_above(one)
                said += self._source.comments_between(begin + 1, last, one.col_offset)
                begin = end_of([one])
        return self._notes(said)

    def _notes(self, said: Sequence[str]) -> list[Made]:
        note = self.values.type_of("note")
        return [
            Made(note, {"text": line}, text=comment_line(line)) for line in said if line and note
        ]

    def _ways(self, nodes: Sequence[ast.stmt]) -> list[_Candidate]:
        """All the different blocks that the first statements are, with no more Python than needed.

        The order is that of ``_candidates``.
        """
        every = list(self._candidates(nodes, is_best_enough=False))
        least = min(map(_written, every), default=0)
        different: list[_Candidate] = []
        for one in every:
            if _written(one) == least and one not in different:
                different.append(one)
        return different

    def _candidates(
        self, nodes: Sequence[ast.stmt], *, is_best_enough: bool = True
    ) -> Iterator[_Candidate]:
        """The blocks that the first statements are, how many these are, and what is in bodies.

        Ends with the first of which no value stays Python, where that ``is_best_enough``.
        """
        first = nodes[0]
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Call):
            for made in self.values.called(first.value):
                if not self._language.definitions[made.type].is_value:
                    yield made, 1, {}
                    if is_best_enough and not made.written:
                        return
        for form in (first, *other_statements(first)):
            for one in self._of_patterns([form, *nodes[1:]], is_other=form is not first):
                yield one
                if is_best_enough and not _written(one):
                    return
        if not is_best_enough:  # their Python will tell whether a value in them is a text
            yield from self._of_patterns(nodes, may_be_unclear=True)

    def _of_patterns(
        self, nodes: Sequence[ast.stmt], *, is_other: bool = False, may_be_unclear: bool = False
    ) -> Iterator[_Candidate]:
        """The blocks that the first statements are by their patterns."""
        patterns = self._learned.statements.get(beginning(nodes[0]), ())
        if may_be_unclear:
            patterns = [replace(one, clear=frozenset()) for one in patterns if one.clear]
        for pattern in patterns:
            count = len(pattern.nodes)
            is_kept = any(node.lineno in self._kept for node in nodes[:count])
            found = match(pattern, nodes[:count]) if count <= len(nodes) and not is_kept else None
            if found is None:
                continue
            made_from = self.values.made_from(pattern, found, is_other=is_other)
            if made_from is not None:
                yield made_from, count, found.bodies

    def _keep_code(self, made: list[Made], code: list[ast.stmt], begin: int) -> int:
        """Put statements that are no blocks into one code block; gives the line after which."""
        if not code:
            return begin
        end = self._source.end_inside(code[-1])
        made.append(self.code(code, begin, end))
        code.clear()
        return end

    def _describe(self, made: Made, nodes: Sequence[ast.stmt], begin: int, reach: int) -> None:
        """Give a block its text and comment; ``reach`` is a line of what it has above a loop."""
        if is_made(nodes[0]):
            return
        first, said = self._source.first_line(nodes[0], begin), nodes[0]
        if _functions_above(nodes):
            said, right_above = nodes[-1], self._source.right_above(nodes[0])
            above = [end_of([one]) for one in nodes[:-1] if one.lineno < said.lineno]
            begin = max(begin, *above, 0)
            first = min(right_above + 1, self._source.first_line(said, begin))
        first = _first(reach, first)
        said_there = self._source.comment_of(said, begin)
        made.comment = "\n".join(filter(None, [made.comment, said_there]))
        made.text = self._source.text(first, self._source.end_inside(nodes[-1]))


class _NotSaid(Exception):
    """A statement that stands on no line of its own is no block."""


def as_block(node: ast.stmt) -> ast.stmt:
    """A statement as a block says it, without what the program writes around it by itself.

    Such as ``with at_once:``, a list that is copied before a loop, the end of a rule in a part.
    """
    match node:
        case ast.With(items=[ast.withitem(ast.Name("at_once"), None)], body=[inner]):
            return inner
        case ast.For(iter=ast.Subscript(items, ast.Slice(None, None, None))):
            plain = ast.For(node.target, items, node.body, node.orelse, node.type_comment)
            return ast.copy_location(plain, node)
        case ast.Expr(value=ast.Call(ast.Name("stop_rule"), [], [])):
            return ast.copy_location(ast.Return(None), node)
    return node


def _functions_above(nodes: Sequence[ast.stmt]) -> int:
    """How many functions stand above a statement in which blocks are given each of them once."""
    functions = [getattr(one, "name", "") for one in itertools.takewhile(_is_part, nodes)]
    below = nodes[len(functions) : len(functions) + 1]
    if not functions or not below or isinstance(below[0], ast.Expr):
        return 0
    given: Counter[str] = Counter()
    for inner in ast.walk(below[0]):
        match inner:
            case ast.Expr(ast.Call(args=names)):
                given.update(one.id for one in names if isinstance(one, ast.Name))
    return len(functions) if all(given[name] == 1 for name in functions) else 0


def _is_part(node: ast.stmt) -> bool:
    return isinstance(node, ast.FunctionDef) and not node.decorator_list


def _first(*lines: int) -> int:
    """The first of those lines that are some."""
    return min(filter(None, lines), default=0)


def _without_pass(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    kept = _without_global(body)
    return [] if len(kept) == 1 and isinstance(kept[0], ast.Pass) else kept


def _without_end(nodes: Sequence[ast.stmt]) -> Sequence[ast.stmt]:
    """Statements below a block, without what an own block gives at its end by itself."""
    match nodes:
        case [ast.Return(value=ast.Constant(value=0))]:
            return []
    return nodes


def _without_global(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    return [node for node in body if not isinstance(node, ast.Global)]


def _is_one_piece(node: ast.FunctionDef) -> bool:
    """Whether functions in a function change what that one has for itself, as no blocks can."""
    return any(isinstance(inner, ast.Nonlocal) for inner in ast.walk(node))


def _require_no_values(node: ast.FunctionDef) -> None:
    """A rule begins by itself: it is given nothing, and gives nothing back."""
    given = node.args
    values = (given.args, given.posonlyargs, given.kwonlyargs, given.vararg, given.kwarg)
    if any(values) or node.returns is not None:
        raise CodeUnread(
            "The function of a rule is given nothing, and gives nothing back.",
            node.lineno,
            checklist=("Write its line with “():” at the end.",),
        )


@dataclass(frozen=True, slots=True)
class ReadRule:
    """A function of the text as blocks; ``text`` are its lines, with the comments above it."""

    function: ast.FunctionDef
    chain: list[Made]
    text: str


def read_rules(
    editor: Editor,
    source: Source,
    parts: Sequence[Part],
    kept: Collection[int] = (),
    known: Collection[str] = (),
    hints: Hints | None = None,
    apart: Collection[str] = (),
) -> list[ReadRule]:
    """The functions of a program; robots, variables and own blocks that lack are made.

    ``hints`` are what is known of it when it was read before; the names ``apart`` are no variables.

    The statements, and the bodies of functions, that begin in lines that are ``kept`` become code
    blocks. A function whose text is ``known`` is not read: its chain is empty. It may hold what
    blocks say but nobody can read.
    """
    left = Counter(known)
    functions = [(p.function, p.line, p.text) for p in parts if p.function is not None]
    as_code = {function.name for function, _, _ in functions if function.lineno in kept}
    own = [function for function, _, _ in functions]
    names = names_in(editor, source.tree, own, as_code, hints=hints, apart=apart)
    turns = hints.turns if hints is not None else None
    reader = StatementReader(editor.language, names, source, kept, turns)
    rules = []
    for node, after, above in functions:
        last = source.last_line(node.body)
        text = source.text(source.first_line(node, after), last)
        text = f"{above}\n{text}" if above else text
        left.subtract([text])
        is_known = left[text] >= 0 and not any(node.lineno <= n <= last for n in kept)
        chain = [] if is_known else reader.rule(node, after)
        if chain and above:
            said = "\n".join(map(comment_text, above.split("\n"))).strip("\n")
            chain[0].comment = "\n".join(filter(None, [said, chain[0].comment]))
            chain[0].text = f"{above}\n{chain[0].text}"
        rules.append(ReadRule(node, chain, text))
    return rules


def scratch_of(base: Project, language: Language) -> Editor:
    """An editor of a copy of a project."""
    return Editor(from_bytes(to_bytes(base), "project", language), language)


_EDGE = 40.0


def create_chain(
    editor: Editor,
    chain: list[Made],
    at: tuple[float, float] | None = None,
    page: str = "behaviour",
) -> str:
    """Make a stack of a chain on a page, at a place or below all; gives its first block."""
    project = editor.project
    last = max(project.pages[page], key=lambda stack: stack.y, default=None)
    below = last.y + height_of(project, last.body) if last is not None else _EDGE
    roots, blocks = blocks_of(project, editor.language, chain)
    place = editor.new_stack(page, *(at or (_EDGE, min(below, FARTHEST / 2))))
    editor.apply(CreateBlocks(roots, blocks, place))
    return roots[0]


def create_outside(
    editor: Editor, text: str, place: str, line: int = 1, page: str = "behaviour"
) -> str:
    """Make a stack of own Python that stands outside of all functions; gives its block."""
    definitions = editor.language.definitions.values()
    found = next((d.id for d in definitions if d.generator == "program_lines"), None)
    if found is None:
        raise CodeUnread(
            "This is outside of the functions, where blocks have no place for it.",
            line,
            checklist=("Put it into a function below a “when” line.",),
        )
    return create_chain(editor, [Made(found, {"code": text, "place": place})], page=page)
