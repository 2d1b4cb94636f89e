"""Read statements as chains of blocks; what has no block becomes a code block."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from ..code_text import CodeTextRefused, read_lines
from ..language import Language
from ..procedures import DEFINE, parameters
from .learning import beginning, learned
from .made import CodeUnread, Made
from .matching import match
from .names import SourceNames
from .source import Source, end_of
from .values import ValueReader


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
        begin, left = after, [node for node in nodes if not isinstance(node, ast.Global)]
        while left:
            found = self._statement(left, begin)
            is_end = found is None or len(left) == found[1]
            if found is None or (self._is_last(found[0]) and not is_end):
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
            made.append(Made(note, {"text": "\n".join(said)}, text=_commented(said)))
        return made

    def rule(self, node: ast.FunctionDef, after: int, *, as_code: bool = False) -> list[Made]:
        """The blocks of a function: the hat first."""
        hat = self._hat(node)
        hat.comment = self._source.comment_of(node, after)
        first = self._source.first_line(node, after)
        hat.text = self._source.text(first, node.lineno)
        if as_code:
            return [hat, self.code(_without_global(node.body), node.lineno)]
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
                str(refused), first + refused.line - 1, checklist=("Correct this line.",)
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
            f"No “when” block stands for “@{ast.unparse(node.decorator_list[0])}”.",
            node.decorator_list[0].lineno,
            checklist=("Write the line above the function as a “when” block does.",),
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

    def _is_last(self, made: Made) -> bool:
        return self._language.definitions[made.type].is_last


def _without_pass(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    kept = _without_global(body)
    return [] if len(kept) == 1 and isinstance(kept[0], ast.Pass) else kept


def _without_global(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    return [node for node in body if not isinstance(node, ast.Global)]


def _commented(said: Sequence[str]) -> str:
    return "\n".join(f"# {line}" for line in said)
