"""Rules in Python: what a hat waits for, and the function of a stack with each line's block."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain as chain_of

from faults import Text
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.procedures import parameters, procedure_of
from nep_studio.blocks.program import ALL_ROBOTS, Block
from nep_studio.blocks.sharing import is_slow, variables_set
from nep_studio.blocks.slots import constant

from ..code_text import CodeText, CodeTextRefused, as_names, compile_quietly, read_outside
from ..errors import CodeRefused
from .expressions import (
    Assignment,
    Body,
    EndRule,
    Expressions,
    Function,
    Gap,
    GiveBack,
    Leave,
    Piece,
    Written,
    comment_lines,
    compare,
    method_call,
    refusing,
    show,
)
from .generators import REPORTERS, STATEMENTS, note_names
from .names import AT_ONCE, FUNCTIONS


@dataclass(frozen=True, slots=True)
class Hat:
    """The decorator of a rule's function, and a text from which the function gets its name.

    The function of an own block has no decorator, but ``arguments``; own Python outside of all
    functions has ``outside`` instead.
    """

    decorator: ast.expr | None
    name: str
    arguments: tuple[str, ...] = ()
    outside: CodeText | None = None


HatGenerator = Callable[[Expressions, Block], Hat]


def _own_define(code: Expressions, block: Block) -> Hat:
    procedure = code.project.procedures[procedure_of(block.type)]
    given = [f"{procedure.id}.{parameter.id}" for parameter in parameters(procedure)]
    arguments = [code.names.parameters[key] for key in given]
    return Hat(None, code.names.procedures[procedure.id], tuple(arguments))


def _program_lines(code: Expressions, block: Block) -> Hat:
    with refusing(block):
        read = read_outside(code.text(block, "code"))
    note_names(code, read)
    return Hat(None, "", outside=read)


# The generator functions of hats.

_SIDES: dict[str, ast.cmpop] = {"over": ast.Gt(), "under": ast.Lt()}
_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def _hat(name: str, method: str, *arguments: ast.expr, **options: ast.expr) -> Hat:
    """A rule that begins with a method of the behaviour."""
    return Hat(method_call(ast.Name("behavior"), method, list(arguments), options), name)


def _again(code: Expressions, block: Block) -> dict[str, ast.expr]:
    """What to do when it comes again: said where the hat says it, also when that is the usual."""
    if not block.groups.get("repeated"):
        return {}
    return {"again": ast.Constant(code.choice(block, "again.1"))}


def _with_source(code: Expressions, block: Block) -> dict[str, ast.expr]:
    """What to do again, and the robot that must tell of a state, where the hat names one."""
    options = _again(code, block)
    if "robot" in code.definition(block).slots:
        robot = code.text(block, "robot")
        return options if robot == ALL_ROBOTS else {**options, "source": constant(robot)}
    return options


def _when(code: Expressions, block: Block, key: str, name: str = "when") -> Hat:
    state = code.slot(block, key)
    return _hat(f"{name}_{code.text(block, key)}", "when", state, **_again(code, block))


def _when_state(code: Expressions, block: Block, sort: str, key: str) -> Hat:
    """A rule for a state of a sort, such as “touched”, that is told by the choice in a slot."""
    state = f"{sort}_{code.choice(block, key)}"
    return _hat(f"when_{state}", "when", ast.Constant(state), **_with_source(code, block))


def _heard(code: Expressions, block: Block) -> Hat:
    name = f"when_heard_{code.text(block, 'word')}"
    return _hat(name, "when_heard", code.slot(block, "word"), **_again(code, block))


def _noticed(code: Expressions, block: Block, thing: str, key: str = "") -> Hat:
    """A rule for something that a robot sees or hears, of the name in slot ``key`` if there is."""
    arguments: list[ast.expr] = [ast.Constant(thing)]
    words = ["when", thing]
    if key:
        arguments.append(code.slot(block, key))
        words.append(code.text(block, key))
    return _hat("_".join(words), "when_noticed", *arguments, **_with_source(code, block))


def _sensor(code: Expressions, block: Block) -> Hat:
    chosen = code.chosen(block, "sensor")
    sensor = code.slot(block, "sensor") if chosen is None else ast.Constant(chosen)
    value = method_call(code.slot(block, "robot"), "sensor", [sensor])
    side = code.choice(block, "side")
    test = ast.Lambda(_NO_ARGUMENTS, compare(value, _SIDES[side], code.slot(block, "value")))
    return _hat(f"when_{chosen or 'sensor'}_is_{side}", "when_true", test, **_again(code, block))


def _when_true(code: Expressions, block: Block) -> Hat:
    test = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    return _hat("when_true", "when_true", test, **_again(code, block))


def _when_told(code: Expressions, block: Block) -> Hat:
    name = f"when_told_{code.text(block, 'message')}"
    return _hat(name, "when_told", code.slot(block, "message"), **_again(code, block))


def _machine(code: Expressions, block: Block) -> dict[str, ast.expr]:
    """Which state machine is meant, where a block names one."""
    return {"machine": code.slot(block, "machine.1")} if block.groups.get("machine") else {}


def _state(code: Expressions, block: Block) -> Hat:
    options = _machine(code, block)
    if block.groups.get("first"):
        options = {"first": ast.Constant(True), **options}
    name = f"state_{code.text(block, 'state')}"
    return _hat(name, "state", code.slot(block, "state"), **options)


def _transition(code: Expressions, block: Block, option: str, value: ast.expr) -> Hat:
    ends = code.text(block, "state"), code.text(block, "target")
    states = code.slot(block, "state"), code.slot(block, "target")
    options = {option: value, **_machine(code, block)}
    return _hat("from_{}_to_{}".format(*ends), "transition", *states, **options)


def _transition_when(code: Expressions, block: Block) -> Hat:
    test = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    return _transition(code, block, "when", test)


def _transition_by(option: str, key: str) -> HatGenerator:
    """The generator of a transition that what is in a slot sets off."""
    return lambda code, block: _transition(code, block, option, code.slot(block, key))


def _at(code: Expressions, block: Block) -> Hat:
    name = f"at_{code.text(block, 'time')}"
    days = code.choice(block, "days")
    options: dict[str, ast.expr] = {} if days == "every_day" else {"days": ast.Constant(days)}
    return _hat(name, "at", code.slot(block, "time"), **options)


def _goal(code: Expressions, block: Block, **when: ast.expr) -> Hat:
    options = when
    if (priority := code.choice(block, "priority")) != "normal":
        options["priority"] = ast.Constant(priority)
    if block.groups.get("stop"):
        options["stop"] = code.slot(block, "stop_state.1")
    if (interrupted := code.choice(block, "interrupted")) != "again":
        options["interrupted"] = ast.Constant(interrupted)
    if block.groups.get("robot"):
        options["robot"] = code.slot(block, "robot.1")
    if block.groups.get("limit"):
        options["at_most_s"] = code.slot(block, "seconds.1")
    return _hat(f"goal_{code.text(block, 'name')}", "goal", code.slot(block, "name"), **options)


def _goal_when(code: Expressions, block: Block) -> Hat:
    condition = ast.Lambda(_NO_ARGUMENTS, code.slot(block, "condition"))
    return _goal(code, block, when=condition)


def _when_goal(code: Expressions, block: Block) -> Hat:
    event = code.choice(block, "event")
    name = f"when_{code.text(block, 'name')}_{event}"
    return _hat(name, "when_goal", code.slot(block, "name"), ast.Constant(event))


def _tree(code: Expressions, block: Block) -> Hat:
    runs = code.choice(block, "runs")
    options = {} if runs == "when_asked" else {"runs": ast.Constant(runs)}
    return _hat(code.text(block, "name"), "tree", code.slot(block, "name"), **options)


HATS: dict[str, HatGenerator] = {
    "when_started": lambda code, block: Hat(
        ast.Attribute(ast.Name("behavior"), "when_started"), "when_started"
    ),
    "when_gesture": lambda code, block: _when(code, block, "gesture", "when_gesture"),
    "when_human_state": lambda code, block: _when(code, block, "state"),
    "when_touched": lambda code, block: _when_state(code, block, "touched", "part"),
    "when_heard": _heard,
    "when_sees": lambda code, block: _noticed(code, block, code.choice(block, "thing")),
    "when_sees_face_of": lambda code, block: _noticed(code, block, "face", "name"),
    "when_sees_mark": lambda code, block: _noticed(code, block, "mark", "number"),
    "when_person": lambda code, block: _when_state(code, block, "person", "distance"),
    "when_emotion": lambda code, block: _when_state(code, block, "emotion", "emotion"),
    "when_sensor": _sensor,
    "when_idle": lambda code, block: _hat("when_idle", "when_idle", code.slot(block, "seconds")),
    "when_true": _when_true,
    "when_told": _when_told,
    "every": lambda code, block: _hat("every", "every", code.slot(block, "seconds")),
    "at": _at,
    "goal": lambda code, block: _goal(code, block, when=code.slot(block, "state")),
    "goal_when": _goal_when,
    "goal_asked": _goal,
    "state": _state,
    "transition_when": _transition_when,
    "transition_state": _transition_by("when", "trigger"),
    "transition_told": _transition_by("told", "message"),
    "transition_after": _transition_by("after", "seconds"),
    "transition_done": lambda code, block: _transition(code, block, "done", ast.Constant(True)),
    "when_goal": _when_goal,
    "tree": _tree,
    "own_define": _own_define,
    "program_lines": _program_lines,
}


def generator_names() -> dict[str, frozenset[str]]:
    """The names of the generator functions by the kind of block, and of callable functions."""
    return {
        "hat": frozenset(HATS),
        "statement": frozenset(STATEMENTS),
        "value": frozenset(REPORTERS),
        "function": FUNCTIONS,
    }


# Write one stack as the function of a rule, without recursion, with the block of each line.

DEEPEST_LOOP = 20
"""CPython refuses more: "too many statically nested blocks"."""

DEEPEST_INDENT = 90
"""CPython stops at 100 indents."""

LOOPS_OF_GUARD = 2
"""A “try” counts so much among loops: the part that is tried, and the part that is done then."""

_MARGINS = tuple("    " * indent for indent in range(DEEPEST_INDENT + 2))


@dataclass(slots=True)
class _Scope:
    """A function being written: where its ``global`` line goes, and for which variables."""

    line: int
    indent: int
    block: str
    gives_back: bool
    assigned: set[str] = field(default_factory=set)


@dataclass(slots=True)
class _Above:
    """Where the outermost loop of a function begins: what is called in it is made above it."""

    line: int
    indent: int
    has_functions: bool = False


@dataclass(slots=True)
class _Frame:
    """What is left to write of a chain (blocks) or of a block (pieces), and how deep it is.

    ``opens`` marks the chain that is the whole body of a function.
    """

    left: Iterator[Block | Piece]
    block: str
    indent: int
    loops: int
    scope: _Scope
    opens: bool = False
    guards: int = 0
    """How many blocks that try something are around it in its function."""
    begins: int = 0
    """The first line of a block, with its comment."""
    above: _Above | None = None
    """Of what is in a loop."""
    moves: tuple[int, _Above] | None = None
    """The first line of a function that is written in a loop, and where it is moved then."""


Line = tuple[str, str]
"""A line of Python with the block that made it, or an empty text."""


class RuleWriter:
    """Writes one rule: its lines, each with the block that made it."""

    def __init__(self, code: Expressions) -> None:
        self.lines: list[Line] = []
        self._code = code
        self._has_code_blocks = False
        self._is_after_function = False

    def write(self, function_name: str, hat: Hat, stack: Sequence[str]) -> Iterator[None]:
        """Write decorator, header and body; ``stack[0]`` is the block of the hat.

        It rests before each block.
        """
        hat_block = self._code.project.blocks[stack[0]]
        self._comment(hat_block, "")
        if hat.outside is not None:
            self._outside(hat.outside, stack)
            return
        if hat.decorator is not None:
            self._line(f"@{show(hat.decorator)}", hat_block.id)
        self._line(f"def {function_name}({', '.join(hat.arguments)}):", hat_block.id)
        frames = [self._function(stack[1:], hat_block.id, 1)]
        while frames:
            frame = frames[-1]
            item = next(frame.left, None)
            if item is None:
                scope = frames.pop().scope
                self._is_after_function |= frame.opens
                own = self._code.names.locals
                shared = {name for name in scope.assigned - own if "." not in name}
                if frame.opens and shared:  # at the end of a function
                    line = f"{_MARGINS[scope.indent]}global {', '.join(sorted(shared))}"
                    self.lines.insert(scope.line, (line, scope.block))
                if frame.moves is not None:
                    self._move_above(*frame.moves)
                if not frames and self._code.gives_nothing:
                    if self.lines[-1][0] == f"{_MARGINS[1]}pass":
                        self.lines.pop()
                    self._line(f"{_MARGINS[1]}return 0", hat_block.id)
            elif isinstance(item, Block):
                yield
                frames.append(self._block(frame, item))
            elif (inner := self._piece(frame, item)) is not None:
                frames.append(inner)
        if self._has_code_blocks:
            # Code that a person wrote is right by itself, but perhaps not where it is
            try:
                compile_quietly("\n".join(line for line, _ in self.lines))
            except CodeTextRefused as refused:
                _, block = self.lines[min(max(refused.line, 1), len(self.lines)) - 1]
                raise CodeRefused(
                    refused.sentence, block=block, checklist=("Change the code.",)
                ) from refused

    def _outside(self, read: CodeText, stack: Sequence[str]) -> None:
        """Write own Python that stands outside of all functions."""
        for block in (self._code.project.blocks[below] for below in stack[1:]):
            if not block.disabled:
                raise CodeRefused(
                    "Nothing goes below this block: it would never be reached.",
                    block=block.id,
                    checklist=("Move the blocks below it to another place.",),
                )
        for line in read.lines:
            self._line(line, stack[0])

    def _block(self, chain: _Frame, block: Block) -> _Frame:
        definition = self._code.definition(block)
        self._keep_apart(definition)
        begins = len(self.lines)
        self._comment(block, _MARGINS[chain.indent])
        if definition.page != "behaviour":
            raise CodeRefused(
                "This block belongs on the page {page}, not under a rule.",
                block=block.id,
                checklist=("Move it to the page {page}.",),
                page=Text(definition.page.title()),
            )
        if definition.call is not None:
            pieces: Sequence[Piece] = (show(self._code.call(block, definition.call)),)
        else:
            pieces = STATEMENTS[definition.generator](self._code, block)
        pieces = self._whole(block, pieces)
        return _Frame(
            iter(pieces),
            block.id,
            chain.indent,
            chain.loops,
            chain.scope,
            guards=chain.guards,
            begins=begins,
            above=chain.above,
        )

    def _whole(self, block: Block, pieces: Sequence[Piece]) -> Sequence[Piece]:
        """The same, so that no other rule sets a variable between its being read and set here."""
        code = self._code
        shared = code.sharing.shared
        if not shared or len(pieces) != 1 or not isinstance(pieces[0], str | Assignment):
            return pieces
        piece = pieces[0]
        line = piece if isinstance(piece, str) else piece.line
        variables = shared.intersection(variables_set(code.project, code.language, block))
        names = {code.names.variables[one] for one in variables if one in code.names.variables}
        names -= code.names.locals  # nobody else sets those
        if not any(_can_be_torn(line, name) for name in names) or self._takes_time(block):
            return pieces
        code.api.add(AT_ONCE)
        whole = f"with {AT_ONCE}: {line}"
        return [Assignment(piece.variable, whole) if isinstance(piece, Assignment) else whole]

    def _takes_time(self, block: Block) -> bool:
        """Whether what is plugged into a block waits: nobody else is to wait for that."""
        inside = self._code.project.within(list(block.inputs.values()), enabled=True)
        return any(is_slow(self._code.language, self._code.sharing, one) for one in inside)

    def _piece(self, frame: _Frame, piece: Piece) -> _Frame | None:
        """Write one piece of a block; give the chain inside it, if it has one."""
        margin = _MARGINS[frame.indent]
        if isinstance(piece, str):
            self._line(margin + piece, frame.block)
            return None
        if not isinstance(piece, Body | Function):
            self._simple(frame, piece, margin)
            return None
        chain = self._code.project.blocks[frame.block].bodies.get(piece.slot, [])
        if isinstance(piece, Function):
            return self._inner_function(frame, piece, chain)
        indent, loops = frame.indent + 1, frame.loops + (piece.loop or piece.is_with)
        guards = frame.guards + piece.guard
        nested = loops + LOOPS_OF_GUARD * guards
        blocks = self._enabled(chain, frame.block, indent, nested, piece.first)
        above = frame.above
        if piece.loop and above is None:
            above = _Above(frame.begins, frame.indent)
        return _Frame(blocks, frame.block, indent, loops, frame.scope, guards=guards, above=above)

    def _inner_function(self, frame: _Frame, piece: Function, chain: Sequence[str]) -> _Frame:
        """Begin a function inside another one: it is made where it is used, but in no loop."""
        indent, moves = frame.indent, None
        if piece.decorator:
            self._line(_MARGINS[indent] + piece.decorator, frame.block)
        elif frame.above is not None:
            indent, moves = frame.above.indent, (len(self.lines), frame.above)
        elif not self.lines[-1][0].endswith(":"):
            self._line("", "")
        self._line(f"{_MARGINS[indent]}def {piece.name}():", frame.block)
        function = self._function(chain, frame.block, indent + 1)
        function.moves = moves
        return function

    def _move_above(self, begin: int, loop: _Above) -> None:
        """Let a function that is called in a loop be made once, above the loop."""
        moved = self.lines[begin:]
        del self.lines[begin:]
        is_first = self.lines[loop.line - 1][0].endswith(":")
        if loop.has_functions or not is_first:
            moved.insert(0, ("", ""))
        after = [] if loop.has_functions else [("", "")]
        self.lines[loop.line : loop.line] = moved + after
        loop.line += len(moved)
        loop.has_functions = True
        self._is_after_function = False

    def _simple(
        self,
        frame: _Frame,
        piece: Gap | Assignment | Leave | EndRule | GiveBack | Written,
        margin: str,
    ) -> None:
        """Write a piece that has no blocks in it."""
        if isinstance(piece, Gap):
            if frame.above is None:  # else the functions are not here
                self._line("", "")
            return
        if isinstance(piece, Written):
            self._has_code_blocks = True
            frame.scope.assigned.update(piece.assigned)
            for number, line in enumerate(piece.lines, start=1):
                text = line if number in piece.inside_texts else margin + line
                is_within = number + 1 in piece.inside_texts
                self._line(text if is_within else text.rstrip(), frame.block)
            return
        if isinstance(piece, EndRule) and (self._code.procedure or frame.scope.indent > 1):
            self._line(margin + show(self._code.api_call("stop_rule")), frame.block)
            return
        if isinstance(piece, Assignment):
            frame.scope.assigned.add(piece.variable)
        elif isinstance(piece, Leave) and not frame.loops and frame.scope.indent > 1:
            raise CodeRefused(
                "A part of a block that has several cannot leave the loop around them.",
                block=frame.block,
                checklist=("Put it below that block, into an “if”.",),
            )
        elif isinstance(piece, Leave) and not frame.loops:
            raise CodeRefused(
                "This block leaves a loop, but it is in none.",
                block=frame.block,
                checklist=("Put it into a “repeat”, “while” or “for each” block.",),
            )
        elif isinstance(piece, GiveBack) and not frame.scope.gives_back:
            raise CodeRefused(
                "Only the definition of an own block gives a value back.",
                block=frame.block,
                checklist=("Put it under the header of an own block.",),
            )
        self._line(margin + piece.line, frame.block)

    def _function(self, chain: Sequence[str], owner: str, indent: int) -> _Frame:
        gives_back = bool(self._code.procedure) and indent == 1
        scope = _Scope(len(self.lines), indent, owner, gives_back)
        blocks = self._enabled(chain, owner, indent, 0)
        return _Frame(blocks, owner, indent, 0, scope, opens=True)

    def _keep_apart(self, definition: Definition) -> None:
        """Leave a line free around a function that stands for a block, but where a mouth opens."""
        is_function = {"of_tree", "apart"} <= definition.flags
        if (is_function or self._is_after_function) and not self.lines[-1][0].endswith(":"):
            self._line("", "")

    def _enabled(
        self, chain: Sequence[str], owner: str, indent: int, loops: int, first: str = ""
    ) -> Iterator[Block | Piece]:
        """The blocks of a chain that are not disabled; where there are none, write ``pass``.

        Not where a ``first`` line stands above them.
        """
        if loops > DEEPEST_LOOP or indent > DEEPEST_INDENT:
            raise CodeRefused(
                "Blocks are nested too deep: {deepest_loop} loops or {deepest_indent} blocks "
                "inside each other at most.",
                block=owner,
                checklist=("Take the inner blocks out into a rule of their own.",),
                deepest_loop=DEEPEST_LOOP,
                deepest_indent=DEEPEST_INDENT,
            )
        project_blocks = self._code.project.blocks
        blocks = [project_blocks[i] for i in chain if not project_blocks[i].disabled]
        definitions = [self._code.language.definitions.get(block.type) for block in blocks]
        is_silent = all(one is not None and "silent" in one.flags for one in definitions)
        above = [first] if first else []
        return chain_of(above, blocks, ["pass"] if is_silent and (blocks or not first) else [])

    def _line(self, line: str, block: str) -> None:
        self._is_after_function = False
        self.lines.append((line, block))

    def _comment(self, block: Block, margin: str) -> None:
        """What a person wrote at a block; control characters could end the comment."""
        if block.comment:
            for line in comment_lines(block.comment):
                self._line(margin + line, block.id)


def _can_be_torn(line: str, variable: str) -> bool:
    """Whether a statement reads and changes a variable, with a call in between.

    Threads take turns at calls and at the ends of loops only: ``n += 1`` is whole by itself.
    """
    if "(" not in line or (line.count(variable) < 2 and "+=" not in line):
        return False  # without going through it: most lines
    statement = as_names(ast.parse(line)).body[0]
    own_call = statement.value if isinstance(statement, ast.Expr) else None
    nodes = list(ast.walk(statement))
    named = sum(isinstance(node, ast.Name) and node.id == variable for node in nodes)
    is_read = named > 1 or (named and isinstance(statement, ast.AugAssign))
    return bool(is_read) and any(isinstance(n, ast.Call) and n is not own_call for n in nodes)
