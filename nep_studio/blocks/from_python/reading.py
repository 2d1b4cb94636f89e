"""Read the Python of a whole program, or of a few lines, into blocks."""

from __future__ import annotations

import ast
import io
import tokenize
import warnings
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from nep_studio.blocks.code_text import CodeTextRefused, lines_inside_texts, read_lines
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.names import MODULES
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, copy
from nep_studio.blocks.procedures import DEFINE, parameters
from nep_studio.blocks.program import Project

from .learning import CodeUnread, Made, beginning, blocks_of, learned
from .values import HEADERS, SourceNames, ValueReader, match, names_in

# The text of a Python file by lines, with its comments, and the tree of it.

LONGEST_PROGRAM = 2_000_000

CHECKLIST = (
    "Look at this line, and at the one above: is a bracket, a quote or a colon missing?",
    "Are the lines inside a block moved in by the same number of spaces?",
    "Undo the last change of the code.",
)


@dataclass(frozen=True, slots=True)
class Source:
    """A Python text; ``comments`` are the comments by line, ``alone`` the lines of only one.

    ``inside_texts`` are the lines that begin inside a text of several lines.
    """

    lines: tuple[str, ...]
    tree: ast.Module
    comments: dict[int, str]
    alone: frozenset[int]
    inside_texts: frozenset[int]

    def first_line(self, node: ast.stmt, after: int) -> int:
        """Where a statement begins with its decorators and the comments above it."""
        first = line = _begin(node)
        while line - 1 > after and (self._is_empty(line - 1) or self._is_above(line - 1, node)):
            line -= 1
            first = line if line in self.alone else first
        return first

    def line_before(self, body: Sequence[ast.stmt]) -> int:
        """The line after which comments belong to statements that are moved in."""
        line, margin = _begin(body[0]) - 1, body[0].col_offset
        while line and (self._is_empty(line) or self._is_alone(line, margin)):
            line -= 1
        return line

    def last_line(self, body: Sequence[ast.stmt]) -> int:
        """The last line of comments that stand below statements as far in as those do."""
        last = line = end_of(body)
        margin = body[0].col_offset
        while line < len(self.lines) and (
            self._is_empty(line + 1) or self._is_alone(line + 1, margin)
        ):
            line += 1
            last = line if line in self.alone else last
        return last

    def margin(self, line: int) -> int:
        """How far in a line begins."""
        text = self.lines[line - 1]
        return len(text) - len(text.lstrip())

    def comment_of(self, node: ast.stmt, after: int) -> str:
        """The comments above a statement and behind its first line."""
        first, begin = self.first_line(node, after), _begin(node)
        said = [self.comments[line] for line in range(first, begin) if line in self.comments]
        if node.lineno in self.comments and node.lineno not in self.alone:
            said.append(self.comments[node.lineno])
        return "\n".join(said)

    def comments_between(self, first: int, last: int, margin: int) -> list[str]:
        """The comments on lines of their own from one line to another, so far in."""
        lines = [line for line in range(first, last + 1) if line in self.alone]
        return [self.comments[line] for line in lines if self.margin(line) == margin]

    def text(self, first: int, last: int) -> str:
        """Lines of the text, without their common margin; texts of several lines keep theirs."""
        numbers = range(first, last + 1)
        code = [n for n in numbers if n not in self.inside_texts and not self._is_empty(n)]
        margin = min(map(self.margin, code), default=0)
        lines = [self.lines[n - 1][margin if n in code else 0 :] for n in numbers]
        return "\n".join(lines).rstrip()

    def _is_above(self, line: int, node: ast.stmt) -> bool:
        return line in self.alone and self.margin(line) <= node.col_offset

    def _is_alone(self, line: int, margin: int) -> bool:
        return line in self.alone and self.margin(line) >= margin

    def _is_empty(self, line: int) -> bool:
        return not self.lines[line - 1].strip()


def read_source(text: str) -> Source:
    """Parse a text; raises CodeUnread with the line."""
    if len(text) > LONGEST_PROGRAM:
        raise CodeUnread(
            "This is too long to become blocks.", 1, checklist=("Take a part of it at a time.",)
        )
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    try:
        with warnings.catch_warnings(action="ignore"):
            tree = ast.parse(text)
        comments, alone = _comments(text)
    except SyntaxError as error:
        raise CodeUnread(
            "Python does not understand this: {msg}.",
            error.lineno or 1,
            checklist=CHECKLIST,
            msg=error.msg,
        ) from error
    except (ValueError, RecursionError, MemoryError, tokenize.TokenError) as error:
        raise CodeUnread("Python cannot read this.", 1, checklist=CHECKLIST) from error
    inside = frozenset(lines_inside_texts(tree))
    return Source(tuple(text.split("\n")), tree, comments, frozenset(alone), inside)


def end_of(nodes: Sequence[ast.stmt]) -> int:
    """The last line of statements."""
    return nodes[-1].end_lineno or nodes[-1].lineno


def _begin(node: ast.stmt) -> int:
    decorators: list[ast.expr] = getattr(node, "decorator_list", [])
    lines = [decorator.lineno for decorator in decorators]
    return min(lines, default=node.lineno)


def _comments(text: str) -> tuple[dict[int, str], set[int]]:
    comments: dict[int, str] = {}
    alone: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            comments[token.start[0]] = token.string.lstrip("#").strip()
            if not token.line[: token.start[1]].strip():
                alone.add(token.start[0])
    return comments, alone


# Read statements as chains of blocks; what has no block becomes a code block.


class StatementReader:
    """Reads the statements of one text."""

    def __init__(self, language: Language, names: SourceNames, source: Source) -> None:
        self.values = ValueReader(language, names)
        self._language = language
        self._source = source
        self._learned = learned(language)

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
            found = self._statement(left, begin)
            is_end = found is None or len(left) == found[1]
            if found is None or (self._language.definitions[found[0].type].is_last and not is_end):
                code.append(left.pop(0))
                continue
            begin = self._keep_code(made, code, begin)
            used = left[: found[1]]
            del left[: found[1]]
            self._describe(found[0], used, begin)
            made.append(found[0])
            begin = end_of(used)
        begin = self._keep_code(made, code, begin)
        said = self._source.comments_between(begin + 1, until, margin)
        note = self.values.type_of("note")
        if said and note:
            text = "\n".join(f"# {line}" for line in said)
            made.append(Made(note, {"text": "\n".join(said)}, text=text))
        return made

    def rule(self, node: ast.FunctionDef, after: int, *, as_code: bool = False) -> list[Made]:
        """The blocks of a function: the hat first."""
        hat = self._hat(node)
        hat.comment = self._source.comment_of(node, after)
        first = self._source.first_line(node, after)
        hat.text = self._source.text(first, node.lineno)
        nodes = _without_global(node.body)
        if as_code and nodes:
            return [hat, self.code(nodes, node.lineno)]
        return [hat, *self.body(node.body)]

    def code(self, nodes: Sequence[ast.stmt], after: int) -> Made:
        """A code block that keeps the text of statements."""
        block_type = self.values.type_of("code_lines")
        first = self._source.first_line(nodes[0], after)
        text = self._source.text(first, end_of(nodes))
        try:
            read_lines(text)
        except CodeTextRefused as refused:
            raise CodeUnread(
                refused.sentence, first + refused.line - 1, checklist=("Correct this line.",)
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
        if len(node.decorator_list) == 1 and not node.args.args:
            for pattern in self._learned.hats:
                found = match(pattern, node.decorator_list)
                made = self.values.made_from(pattern, found) if found is not None else None
                if made is not None:
                    return made
        raise CodeUnread(
            "No “when” block stands for “@{code}”.",
            node.decorator_list[0].lineno,
            checklist=("Write the line above the function as a “when” block does.",),
            code=ast.unparse(node.decorator_list[0]),
        )

    def _statement(self, nodes: Sequence[ast.stmt], begin: int) -> tuple[Made, int] | None:
        """The block that the first of these statements, or several, are; and how many."""
        first = nodes[0]
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Call):
            for made in self.values.called(first.value):
                if not self._language.definitions[made.type].is_value:
                    return made, 1
        for pattern in self._learned.statements.get(beginning(first), ()):
            count = len(pattern.nodes)
            found = match(pattern, nodes[:count]) if count <= len(nodes) else None
            made_from = self.values.made_from(pattern, found) if found is not None else None
            if made_from is not None and found is not None:
                for key, body in found.bodies.items():
                    made_from.bodies[key] = self.body(body)
                return made_from, count
        return None

    def _keep_code(self, made: list[Made], code: list[ast.stmt], begin: int) -> int:
        """Put statements that are no blocks into one code block; gives the line after which."""
        if not code:
            return begin
        made.append(self.code(code, begin))
        end = end_of(code)
        code.clear()
        return end

    def _describe(self, made: Made, nodes: Sequence[ast.stmt], begin: int) -> None:
        made.comment = self._source.comment_of(nodes[0], begin)
        first = self._source.first_line(nodes[0], begin)
        made.text = self._source.text(first, end_of(nodes))


def _without_pass(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    kept = _without_global(body)
    return [] if len(kept) == 1 and isinstance(kept[0], ast.Pass) else kept


def _without_global(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    return [node for node in body if not isinstance(node, ast.Global)]


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
            return made in HEADERS
        case ast.Assign(targets=[ast.Name()], value=ast.Constant() | ast.List(elts=[])):
            return True
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="behavior"), attr=name))):
            return name == "run"
    return False
