"""Python that people wrote into blocks follows when what it names is called otherwise."""

from __future__ import annotations

import ast
import copy
import re
import unicodedata
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

from faults import Words
from nep_studio.blocks.code_text import (
    CodeTextRefused,
    made_by,
    parse_lines,
    python_slots,
    read_outside,
)
from nep_studio.blocks.deployment import OUTSIDE_BLOCK, chains, robot_entries
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import DEFINE, parameters, procedure_of
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.shared_objects import SHARED_OBJECTS

from .facts import FactReader, Facts
from .names import ProgramNames
from .program import give_names
from .scopes import scoped

NO_ROBOTS: Mapping[str, str] = {}

# Where the names in a piece of Python are, as Python itself understands them.

_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
_COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
_WORD = re.compile(rf"(?:(?:{'|'.join(SHARED_OBJECTS)})\.)?\w+")


class CannotRename(Exception):
    """A name that cannot be followed: it is made in another way than by a value."""


class NameInUse(Exception):
    """The new name, which means something else where the old one stands."""


def renamed(
    text: str,
    names: Mapping[str, str],
    *,
    apart: frozenset[str] = frozenset(),
    new: frozenset[str] = frozenset(),
    called: Mapping[str, Mapping[str, str]] | None = None,
) -> str:
    """The text with other ``names`` for what is outside of it; texts and comments stay.

    A name that a function in the text has for itself stays, and so do those ``apart``. The text
    itself may not give a meaning to those that are ``new``. ``called`` are the other names of what
    functions are given, by the names of these. Raises CannotRename, NameInUse, CodeTextRefused.
    """
    tree = parse_lines(text)
    walker = _Walker(names, apart, called or {})
    made = _made(tree.body)
    shared = {n for one in ast.walk(tree) if isinstance(one, ast.Global) for n in one.names}
    for name in sorted(new & (made | shared)):
        raise NameInUse(name)
    walker.visit(tree)
    if not walker.found:
        return text
    return _with_names(text, tree, walker.found)


class _Walker(ast.NodeVisitor):
    """Finds the nodes in which names stand that are to be others, each with the new name."""

    def __init__(
        self,
        names: Mapping[str, str],
        hidden: frozenset[str],
        called: Mapping[str, Mapping[str, str]],
    ) -> None:
        self.found: list[tuple[ast.AST, str, str]] = []
        self._names = names
        self._called = called
        self._hidden = hidden
        self._of_class = frozenset[str]()

    def visit_Name(self, node: ast.Name) -> None:
        self._find(node, node.id)

    def visit_Global(self, node: ast.Global) -> None:
        for name in node.names:
            if name in self._names:
                self.found.append((node, name, self._names[name]))

    def visit_Call(self, node: ast.Call) -> None:
        if isinstance(node.func, ast.Name) and node.func.id not in self._hidden:
            given = self._called.get(node.func.id, {})
            for word in node.keywords:
                if word.arg in given:
                    self.found.append((word, str(word.arg), given[str(word.arg)]))
        self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._function(node)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        self._function(node)

    def visit_Lambda(self, node: ast.Lambda) -> None:
        self._function(node)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._require_free(node)
        for one in (*node.decorator_list, *node.bases, *node.keywords):
            self.visit(one)
        before, self._of_class = self._of_class, frozenset(_made(node.body))
        for line in node.body:
            self.visit(line)
        self._of_class = before

    def visit_ListComp(self, node: ast.ListComp) -> None:
        self._comprehension(node)

    def visit_SetComp(self, node: ast.SetComp) -> None:
        self._comprehension(node)

    def visit_DictComp(self, node: ast.DictComp) -> None:
        self._comprehension(node)

    def visit_GeneratorExp(self, node: ast.GeneratorExp) -> None:
        self._comprehension(node)

    def generic_visit(self, node: ast.AST) -> None:
        if not isinstance(node, ast.Name):
            self._require_free(node)
        super().generic_visit(node)

    def _find(self, node: ast.AST, name: str) -> None:
        if name not in self._names or name in self._hidden:
            return
        if name in self._of_class:
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
                raise CannotRename(name)
            return
        if self._names[name] in self._hidden | self._of_class:
            raise NameInUse(self._names[name])
        self.found.append((node, name, self._names[name]))

    def _require_free(self, node: ast.AST) -> None:
        """What is defined or imported by a name cannot get another one."""
        for name in made_by(node):
            if name in self._names and name not in self._hidden | self._of_class:
                raise CannotRename(name)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> None:
        self._require_free(node)
        given = node.args
        plain = [*given.posonlyargs, *given.args, *given.kwonlyargs]
        every = [*plain, *filter(None, (given.vararg, given.kwarg))]
        outside: list[ast.expr | None] = [*given.defaults, *given.kw_defaults]
        outside += [one.annotation for one in every]
        body: Sequence[ast.AST] = [node.body] if isinstance(node, ast.Lambda) else node.body
        if not isinstance(node, ast.Lambda):
            outside += [*node.decorator_list, node.returns]
        for one in filter(None, outside):
            self.visit(one)
        made = _made(body) | {one.arg for one in every}
        before = self._hidden, self._of_class
        self._hidden, self._of_class = (self._hidden | made) - _shared(body), frozenset()
        for part in body:
            self.visit(part)
        self._hidden, self._of_class = before

    def _comprehension(
        self, node: ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp
    ) -> None:
        self.visit(node.generators[0].iter)
        made = {n for g in node.generators for one in ast.walk(g.target) for n in made_by(one)}
        before = self._hidden, self._of_class
        self._hidden, self._of_class = self._hidden | made, frozenset()
        for number, part in enumerate(node.generators):
            for one in (part.target, *([part.iter] if number else []), *part.ifs):
                self.visit(one)
        inner = [node.key, node.value] if isinstance(node, ast.DictComp) else [node.elt]
        for one in inner:
            self.visit(one)
        self._hidden, self._of_class = before


def _made(body: Sequence[ast.AST]) -> set[str]:
    """The names that lines give a meaning to where they are, and not in a function inside."""
    made, waiting = set[str](), list(body)
    while waiting:
        node = waiting.pop()
        made.update(made_by(node))
        if isinstance(node, _COMPREHENSIONS):
            made |= {
                one.target.id
                for one in ast.walk(node)
                if isinstance(one, ast.NamedExpr) and isinstance(one.target, ast.Name)
            }
        elif not isinstance(node, (*_FUNCTIONS, ast.ClassDef)):
            waiting += ast.iter_child_nodes(node)
    return made - _shared(body)


def _shared(body: Sequence[ast.AST]) -> set[str]:
    """The names that lines say are global, and not in a function inside."""
    found, waiting = set[str](), list(body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Global):
            found |= set(node.names)
        if not isinstance(node, (*_FUNCTIONS, ast.ClassDef)):
            waiting += ast.iter_child_nodes(node)
    return found


# Write the new names where the old ones stand, and see that nothing else has changed.


@dataclass(frozen=True, slots=True)
class _Word:
    """A word of a text: where it begins in its line, in letters."""

    line: int
    begin: int
    text: str

    def is_called(self, name: str) -> bool:
        """Whether Python reads it as this name."""
        return unicodedata.normalize("NFKC", self.text) == name


def _with_names(text: str, tree: ast.Module, found: Sequence[tuple[ast.AST, str, str]]) -> str:
    """The text with new names in the nodes that were found; raises CannotRename."""
    lines = text.split("\n")
    texts = [one for one in ast.walk(tree) if isinstance(one, ast.JoinedStr)]
    in_texts = {id(name) for one in texts for name in _names_in_order(one)}
    inside = {id(n): number for number, n in enumerate(_names_in_order(tree)) if id(n) in in_texts}
    written = _words_of_texts(lines, tree, {old for _, old, _ in found}) if inside else {}
    changes: list[tuple[_Word, str]] = []
    for node, old, new in found:
        places = (
            [written.get(inside[id(node)])] if id(node) in inside else _places(lines, node, old)
        )
        if not places or not all(place is not None and place.is_called(old) for place in places):
            raise CannotRename(old)
        changes += [(place, new) for place in places if place is not None]
    for word, new in sorted(changes, key=lambda c: (c[0].line, c[0].begin), reverse=True):
        line = lines[word.line - 1]
        lines[word.line - 1] = line[: word.begin] + new + line[word.begin + len(word.text) :]
    after = "\n".join(lines)
    for node, old, new in found:
        _rename_node(node, old, new)
    if ast.dump(parse_lines(after)) != ast.dump(tree):
        raise CannotRename(found[0][1])
    return after


def _rename_node(node: ast.AST, old: str, new: str) -> None:
    match node:
        case ast.Name():
            node.id = new
        case ast.keyword():
            node.arg = new
        case ast.Global():
            node.names = [new if name == old else name for name in node.names]


def _places(lines: Sequence[str], node: ast.AST, name: str) -> list[_Word | None]:
    """The word of a node, or those of it that are this name."""
    first, last = getattr(node, "lineno", 1), getattr(node, "end_lineno", 1)
    begin = len(lines[first - 1].encode()[: getattr(node, "col_offset", 0)].decode())
    if not isinstance(node, ast.Global):
        word = _WORD.match(lines[first - 1], begin)
        return [_Word(first, begin, word[0]) if word else None]
    words = [
        _Word(number, word.start(), word[0])
        for number in range(first, last + 1)
        for word in _WORD.finditer(lines[number - 1], begin if number == first else 0)
    ]
    return next(([word] for word in words if word.is_called(name)), [])


def _names_in_order(tree: ast.AST) -> list[ast.Name]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.Name)]


def _words_of_texts(lines: list[str], tree: ast.Module, names: set[str]) -> dict[int, _Word]:
    """The words in texts with braces that are names, by the numbers of these in the tree.

    Python of before 3.12 does not say where those stand: each word is tried by itself.
    """
    texts = [node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr)]
    rows = {n for node in texts for n in range(node.lineno, (node.end_lineno or node.lineno) + 1)}
    plain, before = _without_names(tree), [name.id for name in _names_in_order(tree)]
    found: dict[int, _Word] = {}
    for row in sorted(rows):
        for match in _WORD.finditer(lines[row - 1]):
            word = _Word(row, match.start(), match[0])
            if not any(word.is_called(name) for name in names):
                continue
            line = lines[row - 1]
            changed = f"{line[: word.begin]}{_OTHER}{line[match.end() :]}"
            try:
                tried = parse_lines("\n".join([*lines[: row - 1], changed, *lines[row:]]))
            except CodeTextRefused:
                continue
            if _without_names(tried) == plain:
                after = [name.id for name in _names_in_order(tried)]
                pairs = enumerate(zip(before, after, strict=True))
                found.update((n, word) for n, (one, other) in pairs if one != other)
    return found


_OTHER = "another_name_that_nobody_has"


def _without_names(tree: ast.Module) -> str:
    tree = copy.deepcopy(tree)
    for name in _names_in_order(tree):
        name.id = "_"
    return ast.dump(tree)


# The names of a program, and the blocks in which people wrote Python.


def names_of(project: Project, language: Language, plain: Collection[str] = ()) -> ProgramNames:
    """What everything in a project is called in its Python, as far as that can be read.

    The variables of the ids in ``plain`` are called as where Python of a person names them.
    """
    used, facts = set[str](), dict[str, Facts]()
    headers: dict[str, None] = {}
    made, defined = frozenset[str](), frozenset[str]()
    for chain in chains(project, language):
        first = project.blocks[chain[0]]
        facts[first.id] = FactReader(project, language).read(chain)
        if first.type.startswith(DEFINE):
            headers[procedure_of(first.type)] = None
        if first.type == OUTSIDE_BLOCK:
            try:
                read = read_outside(str(language.definitions[first.type].value(first, "code")))
            except CodeTextRefused:
                continue
            made, defined = made | read.set_here, defined | read.defined
        for block in project.within(chain):
            definition = language.definitions.get(block.type)
            used.update(definition.robots_in(block) if definition is not None else ())
    listed = [entry.name for entry in robot_entries(project, language)]
    ordered = [p for p in project.procedures if p in headers]
    names = give_names(project, listed, used, ordered, made, defined)
    return scoped(names, facts, project, plain)


@contextmanager
def names_followed(
    project: Project,
    language: Language,
    apply: Callable[[SetField], None],
    robots: Mapping[str, str] = NO_ROBOTS,
) -> Iterator[None]:
    """What is called otherwise after the body is so in the Python that people wrote, too.

    ``robots`` are the new names of robots by the old ones. Raises EditRefused when a name cannot
    be followed: what was done is then to be taken back.
    """
    pieces = list(_pieces(project, language))
    if not pieces:
        yield
        return
    plain = _named_plainly(project, language, pieces)
    before = names_of(project, language, plain)
    yield
    language = language.of(project)
    after = names_of(project, language, plain)
    change = _Change(project, before, after, robots, pieces)
    for piece in pieces:
        text = change.of(piece)
        if text != piece.text:
            apply(SetField(piece.block.id, piece.key, text))
    if _plain(names_of(project, language, plain)) != _plain(after):
        shown = next(iter(change.new), "")
        raise EditRefused(_TAKEN, checklist=(_OTHER_NAME,), line=pieces[0].line, new=shown)


def _words(text: str) -> set[str]:
    return {unicodedata.normalize("NFKC", word) for word in _WORD.findall(text)}


def _named_plainly(project: Project, language: Language, pieces: Sequence[_Piece]) -> set[str]:
    """The variables that Python of a person names, also where it does nothing."""
    words = {word for piece in pieces for word in _words(piece.text)}
    names = names_of(project, language, [variable.id for variable in project.variables])
    return {variable for variable, name in names.variables.items() if name in words}


def _plain(names: ProgramNames) -> ProgramNames:
    """The names without those that own Python makes."""
    return replace(names, outside=frozenset(), locals=frozenset())


_TAKEN = "In the Python “{line}”, “{new}” means something else already."
_OTHER_NAME = "Choose another name."


@dataclass(frozen=True, slots=True)
class _Piece:
    """Python in a field of a block."""

    block: Block
    key: str
    text: str
    stack: str
    defines: str
    """The own block whose definition it is in, or an empty text."""

    @property
    def line(self) -> str:
        """The first line, by which a person finds it."""
        return next((line.strip() for line in self.text.split("\n") if line.strip()), "")


def _pieces(project: Project, language: Language) -> Iterator[_Piece]:
    for block in project.blocks.values():
        definition = language.definitions.get(block.type)
        for key in python_slots(definition, block.groups) if definition is not None else ():
            stack = project.stack_of(block.id)
            header = project.blocks[stack.body[0]].type
            defines = procedure_of(header) if header.startswith(DEFINE) else ""
            text = str(definition.value(block, key)) if definition is not None else ""
            yield _Piece(block, key, text, stack.id, defines)


@dataclass(slots=True)
class _Change:
    """How the names of a program have changed, for its pieces of Python."""

    project: Project
    before: ProgramNames
    after: ProgramNames
    robots: Mapping[str, str]
    pieces: Sequence[_Piece]
    names: dict[str, str] = field(init=False)
    called: dict[str, dict[str, str]] = field(init=False)
    new: frozenset[str] = field(init=False)

    def __post_init__(self) -> None:
        old, now = self.before, self.after
        pairs = [(name, now.variables.get(key)) for key, name in old.variables.items()]
        pairs += [(name, now.procedures.get(key)) for key, name in old.procedures.items()]
        robots = {robot: self.robots.get(robot, robot) for robot in old.robots}
        pairs += [(old.robots[one], now.robots.get(other)) for one, other in robots.items()]
        self.names = {one: other for one, other in pairs if other is not None and one != other}
        self.called = {
            name: given
            for procedure, name in old.procedures.items()
            if (given := self._given(procedure))
        }
        self.new = frozenset(self.names.values()) - _plain(old).taken()

    def of(self, piece: _Piece) -> str:
        """The text of a piece with the new names; raises EditRefused."""
        names = {**self.names, **self._given(piece.defines)}
        new = self.new | (
            frozenset(self._given(piece.defines).values()) - _plain(self.before).taken()
        )
        if not names and not self.called:
            return piece.text
        margin = "" if "\n" in piece.text else piece.text[: -len(piece.text.lstrip()) or None]
        plain = piece.text.removeprefix(margin)
        try:
            return margin + renamed(
                plain, names, apart=self._apart(piece), new=new, called=self.called
            )
        except CodeTextRefused as refused:
            if not _words(piece.text) & (names.keys() | new):
                return piece.text
            raise self._refused(
                "The Python “{line}” cannot be read: the new name cannot be written there.",
                ("Correct this Python first.",),
                piece,
            ) from refused
        except NameInUse as taken:
            raise self._refused(_TAKEN, (_OTHER_NAME,), piece, new=taken.args[0]) from taken
        except CannotRename as cannot:
            raise self._refused(
                "The Python “{line}” makes “{name}” in a way in which it cannot be renamed.",
                ("Give it another name in this Python first.",),
                piece,
                name=cannot.args[0],
            ) from cannot

    def _refused(
        self, sentence: Words, checklist: tuple[Words, ...], piece: _Piece, **values: str
    ) -> EditRefused:
        return EditRefused(sentence, checklist=checklist, line=piece.line, **values)

    def _given(self, procedure: str) -> dict[str, str]:
        """The new names of the values that an own block is given, by the old ones."""
        old, now = self.before.parameters, self.after.parameters
        known = self.project.procedures.get(procedure)
        keys = [f"{procedure}.{p.id}" for p in parameters(known)] if known is not None else []
        both = [(old[key], now[key]) for key in keys if key in old and key in now]
        return {one: other for one, other in both if one != other}

    def _apart(self, piece: _Piece) -> frozenset[str]:
        """The names of robots and own blocks that mean something else in this function."""
        if piece.block.type == OUTSIDE_BLOCK:
            return frozenset()
        own = {*self.before.robots.values(), *self.before.procedures.values()}
        made = set[str]()
        for other in self.pieces:
            if other.stack == piece.stack and other.key and own:
                try:
                    made |= _made(parse_lines(other.text).body)
                except CodeTextRefused:
                    continue
        return frozenset(own & made)
