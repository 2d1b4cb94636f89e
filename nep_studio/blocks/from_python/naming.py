"""What the names of a Python text stand for: robots, variables, own blocks, and their kinds."""

from __future__ import annotations

import ast
import functools
import itertools
import operator
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from nep_studio.blocks.code_text import bodies_of, made_by, outside_functions
from nep_studio.blocks.edits.content import AddProcedure, SetExtra, SetField
from nep_studio.blocks.edits.project import RenameProject, SetScope
from nep_studio.blocks.procedures import DEFINE, parameters, words
from nep_studio.blocks.shared_objects import SHARED_OBJECTS

from ..deployment import can_be_stopped, names_used, robot_entries
from ..editor import Editor
from ..errors import CodeRefused
from ..generate.expressions import ANSWER, WORDS, compare
from ..generate.kinds import ANY, LIST, RESULT_KINDS, TABLE, TEXT, TRUTH, Seen, kinds_of, note
from ..generate.names import RESERVED, python_name
from ..generate.program import generate_program
from ..generate.renaming import names_of
from ..generate.scopes import as_shared
from ..operations.fixes import append_entry
from ..program import (
    ALL_ROBOTS,
    LANGUAGE,
    LANGUAGES,
    ON_ERROR,
    ROBOT_BLOCK,
    SCOPE_KEPT,
    SCOPE_PROGRAM,
    Parameter,
    Procedure,
)
from .learning import CodeUnread, at_line
from .outside import HEADERS
from .scoping import is_shared


@dataclass(slots=True)
class SourceNames:
    """What identifiers stand for: names of robots, ids of variables, own blocks, rules.

    ``parameters`` are the values of the own block that is being read, by identifier; ``rules``
    are as ``settle_rules`` takes them.
    """

    robots: dict[str, str] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)
    procedures: dict[str, Procedure] = field(default_factory=dict)
    parameters: dict[str, str] = field(default_factory=dict)
    rules: dict[str, str] = field(default_factory=dict)


MOST_TURNS, TURNS_OF_KINDS = 6, 3
"""How often statements are read in another of their ways; when own blocks then take any value."""


@dataclass(slots=True)
class Turns:
    """Which of the ways to read it each statement gets its turn, by its line: the best at first.

    ``ways`` is how many a statement has, as far as this is known: as many as it was read in since
    another one was wanted.
    """

    taken: dict[int, int] = field(default_factory=dict)
    ways: dict[int, int] = field(default_factory=dict)
    left: int = MOST_TURNS

    def go_on(self, lines: Collection[int]) -> bool:
        """Take the next way of the statements in these lines; False when none has another."""
        # One that was to be read in another way, and was in none, is no statement with ways
        others = [one for one in lines if self.ways.get(one, 1 if one in self.taken else 2) > 1]
        for line in others if self.left else ():
            self.taken[line] = self.taken.get(line, 0) + 1
        self.left -= 1
        return bool(others) and self.left >= 0

    def kinds_at(self, line: int, kinds: Sequence[str]) -> Sequence[str]:
        """The kinds of the values of an own block in this line, when those are a guess."""
        self.ways[line] = 1 if set(kinds) <= {"any"} else 2
        return ["any"] * len(kinds) if self.taken.get(line, 0) >= TURNS_OF_KINDS else kinds


@dataclass(frozen=True, slots=True)
class Hints:
    """What is known of a text that was read before.

    The kinds of its values by name, and the lines that its blocks would say in another way.
    """

    kinds: Mapping[str, int]
    differed: Collection[int]
    turns: Turns = field(default_factory=Turns, compare=False)


def names_in(
    editor: Editor,
    tree: ast.Module,
    functions: Sequence[ast.FunctionDef],
    as_code: Collection[str] = (),
    *,
    loose: bool = False,
    hints: Hints | None = None,
    apart: Collection[str] = (),
) -> SourceNames:
    """Find what the names of a text stand for in a project, and make there what lacks.

    ``functions`` are those that become blocks. What a function keeps to itself is a variable too,
    but for the names ``apart``, and those of a function that is named in ``as_code``: its lines
    stay Python. Lines that are in no function are a program's own when they are ``loose``: what
    they put values into becomes variables too.
    """
    names = _known(editor, loose=loose)
    for name in apart:
        if not is_shared(name):
            names.variables.pop(name, None)
    begun = _begun_otherwise(tree, hints)
    known = _kinds_given(tree, names) if hints is None else hints.kinds
    _note_kinds(tree, {name: ANY if name in begun else kinds for name, kinds in known.items()})
    for node in tree.body:
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id=made))
            ) if made in HEADERS:
                with at_line(node.lineno):
                    _note(editor, names, name, made, node)
    if loose and any(stopped_in(tree)):
        names.rules |= _rules_there(editor)
    names.rules |= rules_in(functions)
    of_functions = {node.name: node for node in functions if not node.decorator_list}
    assigned: list[str] = []
    others = {n.name for n in tree.body if isinstance(n, ast.FunctionDef | ast.ClassDef)}
    for name in others - of_functions.keys():
        names.procedures.pop(name, None)
    position = 0
    for node in of_functions.values():
        with at_line(node.lineno):
            _note_procedure(editor, names, node, tree, begun, hints, position)
        position = list(editor.project.procedures).index(names.procedures[node.name].id) + 1
    shared = {name.rpartition(".")[2] for name in _shared(tree, loose=False)}
    kept = [name for node in functions if node.name not in as_code for name in _kept(node)]
    taken = {*names.procedures, *others, *shared, *_only_asked(tree)}
    assigned += [name for name in kept if name not in taken]
    found = dict.fromkeys([*assigned, *_begun(tree), *_shared(tree, loose=loose)])
    _add_variables(
        editor, names, [name for name in found if is_shared(name) or name not in apart], tree
    )
    _require_variables(names, tree)
    return names


def _only_asked(tree: ast.Module) -> set[str]:
    """The names that only the block has that asks a robot something: they are no variables."""
    used = Counter(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
    asked: Counter[str] = Counter()
    for node in ast.walk(tree):
        for lines in bodies_of(node):
            for first, second in itertools.pairwise(lines):
                asked.update(_of_question(first, second))
    return {name for name, times in asked.items() if used[name] == times}


def _of_question(first: ast.stmt, second: ast.stmt) -> Iterator[str]:
    """The names of a question and what is done after each answer, as often as they are there.

    Of what may be answered, too, where that is worked out in the line before.
    """
    match first, second:
        case ast.Assign([ast.Name(listed)], ast.List()), _ if _root(listed) == WORDS:
            yield listed
            return
        case ast.Assign([ast.Name(answer)], ast.Call(ast.Attribute(attr="ask"), given)), ast.If():
            pass
        case _:
            return
    tests = list(_tests(second))
    match given:
        case [_, ast.List(words)]:
            listed = ""
        case [_, ast.Name(listed)] if _root(listed) == WORDS:
            made = range(len(tests))
            words = [ast.Subscript(ast.Name(listed), ast.Constant(number)) for number in made]
        case _:
            return
    wanted = [ast.unparse(compare(ast.Name(answer), ast.Eq(), word)) for word in words]
    told = [ast.unparse(test) for test in tests]
    if _root(answer) == ANSWER and told == (wanted or [f"not {answer}"]):
        yield from [name for name in (answer, listed) if name for _ in (first, *told)]


def _tests(node: ast.If) -> Iterator[ast.expr]:
    """What an “if” and each “elif” of it ask."""
    yield node.test
    match node.orelse:
        case [ast.If(test=ast.Compare(ops=[ast.Eq()])) as inner]:
            yield from _tests(inner)


def _root(name: str) -> str:
    """A name without the number that makes it differ from another one."""
    return name.rstrip("0123456789").removesuffix("_")


# Rules are named by their functions; the block with which one begins is made after it is read.


def stopped_in(tree: ast.AST) -> Iterator[ast.Name]:
    """Where Python names a rule to be stopped."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(
                func=ast.Attribute(value=ast.Name(id="behavior"), attr="stop"),
                args=[ast.Name() as named],
            ):
                yield named


def _rules_there(editor: Editor) -> dict[str, str]:
    """The blocks with which the rules of a project begin, by the names of their functions."""
    try:
        code = generate_program(editor.project, editor.language)
    except CodeRefused:
        return {}
    found: dict[str, str] = {}
    for number, line in enumerate(code.text.splitlines(), start=1):
        hat = code.block_at(number) or ""
        if line.startswith("def ") and can_be_stopped(editor.project, editor.language, hat):
            found[line.removeprefix("def ").partition("(")[0]] = hat
    return found


_TO_COME = "def "
"""What stands before the name of a function in place of the block that is not there yet."""


def rules_in(functions: Sequence[ast.FunctionDef]) -> dict[str, str]:
    """What stands for the rules of functions, by name, until their blocks are there."""
    found: dict[str, str] = {}
    for node in functions:
        match node.decorator_list:
            case [ast.Call(func=ast.Attribute(attr=made)) | ast.Attribute(attr=made)]:
                if made not in ("goal", "when_goal"):
                    found[node.name] = _TO_COME + node.name
    return found


def settle_rules(
    editor: Editor, hats: Mapping[str, str], before: Mapping[str, str] | None = None
) -> None:
    """Let blocks that name a rule name its first block; ``hats`` are these by their functions.

    ``before`` are the functions of blocks that were there: where one is gone, its function's is
    meant.
    """
    project, definitions = editor.project, editor.language.definitions
    for block in list(project.blocks.values()):
        definition = definitions.get(block.type)
        if definition is None or "rule" not in definition.kinds:
            continue
        for key, slot in definition.keys(block.groups):
            named = str(block.fields.get(key, ""))
            if slot.kind.name != "rule" or named in project.blocks:
                continue
            function = named.removeprefix(_TO_COME)
            function = (before or {}).get(named, "") if function == named else function
            if function in hats:
                editor.apply(SetField(block.id, key, hats[function]))


def _add_variables(
    editor: Editor, names: SourceNames, wanted: Sequence[str], tree: ast.Module
) -> None:
    """Make the variables that lack, and let all of them be known where the text says so."""
    said = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    called = {variable: name for name, variable in names.variables.items() if name in said}
    for name in wanted:
        owner, _, plain = name.rpartition(".")
        is_known = name in names.robots or plain in RESERVED or python_name(plain, "") != plain
        if is_known:
            continue
        if name not in names.variables:
            names.variables[name] = _variable_called(editor, plain, called.keys())
        variable = editor.project.variable(names.variables[name])
        assert variable is not None
        called[variable.id] = name
        is_other = SCOPE_KEPT in (owner, variable.scope) and owner != variable.scope
        if is_other or (variable.scope == SCOPE_PROGRAM and not owner):
            editor.apply(SetScope(variable.id, owner))


def _variable_called(editor: Editor, name: str, taken: Collection[str]) -> str:
    """The variable of a name in Python that has none of those ``taken``, or a new one."""
    project = editor.project
    for variable in project.variables:
        if variable_name(variable.name) == name and variable.id not in taken:
            return variable.id
    others = {variable.name for variable in project.variables}
    # A name for a new variable that no other has; its Python name is the same
    return editor.add_variable(name if name not in others else f"{name}_")


def _begun(tree: ast.Module) -> Iterator[str]:
    """The names of plain values that no function has for itself too."""
    own = {name for function in functions_of(tree) for name in locals_of(function)}
    for node in tree.body:
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Constant() | ast.List() | ast.Dict()
            ) if name not in own:
                yield name


def functions_of(tree: ast.AST) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    """All functions, also those in others."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node


def locals_of(function: ast.FunctionDef | ast.AsyncFunctionDef) -> dict[str, int]:
    """The names that a function has for itself, each with the first line that puts a value there.

    What it is given is not one of them.
    """
    return names_made(function.body)


def names_made(body: Sequence[ast.stmt]) -> dict[str, int]:
    """The names to which statements give a meaning where they are, each with the first line."""
    nodes = [node for part in body for node in outside_functions(part)]
    shared = {
        n for node in nodes if isinstance(node, ast.Global | ast.Nonlocal) for n in node.names
    }
    made: dict[str, int] = {}
    for node in sorted(nodes, key=lambda n: getattr(n, "lineno", 0)):
        for name in made_by(node):
            if name not in shared and not is_shared(name):
                made.setdefault(name, getattr(node, "lineno", body[0].lineno))
    return made


def _kept(function: ast.FunctionDef) -> list[str]:
    """The names that a function, or what it does for each robot, gives values to for itself."""
    return list(dict.fromkeys(name for one in _own_parts(function) for name in _kept_in(one)))


def _own_parts(function: ast.FunctionDef) -> Iterator[ast.FunctionDef]:
    """A function, and those in it that are done for each robot: these have variables, too."""
    yield function
    done = {
        node.args[1].id
        for node in ast.walk(function)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "for_each_robot"
        if len(node.args) > 1 and isinstance(node.args[1], ast.Name)
    }
    for node in ast.walk(function) if done else ():
        if isinstance(node, ast.FunctionDef) and node is not function and node.name in done:
            yield node


def _kept_in(function: ast.FunctionDef) -> list[str]:
    """The names that a function gives values to, and has for itself."""
    others = {argument.arg for argument in function.args.args} | {"_"}
    others.update(
        n for one in ast.walk(function) if isinstance(one, ast.Nonlocal) for n in one.names
    )
    others.update(one.name for one in ast.walk(function) if isinstance(one, ast.FunctionDef))
    nodes = [node for part in function.body for node in outside_functions(part)]
    plain = [target.id for node in nodes if (target := _plain_target(node)) is not None]
    made = Counter(name for node in nodes for name in made_by(node))
    own = locals_of(function)
    return [
        name
        for name, times in Counter(plain).items()
        if name in own and name not in others and made[name] == times
    ]


def names_made_otherwise(tree: ast.Module) -> set[str]:
    """The names that rules have for themselves, and that they make in a way that no block does."""
    rules = [n for n in tree.body if isinstance(n, ast.FunctionDef) and n.decorator_list]
    every = [one for rule in rules for one in _own_parts(rule)]
    return {name for one in every for name in locals_of(one).keys() - set(_kept_in(one))}


def _plain_target(node: ast.AST) -> ast.Name | None:
    """The name to which a statement gives a value as blocks do."""
    match node:
        case (
            ast.Assign(targets=[ast.Name() as target])
            | ast.AugAssign(target=ast.Name() as target)
            | ast.For(target=ast.Name() as target)
        ):
            return target
    return None


def _kinds_given(tree: ast.Module, names: SourceNames) -> dict[str, int]:
    """The kinds of what a text puts into the variables that it makes itself."""
    found: dict[str, int] = {}
    same: dict[str, set[str]] = {}
    for node in ast.walk(tree):
        match node:
            case (
                ast.Assign(targets=[ast.Name(id=name)], value=ast.Name(id=other))
                | ast.AugAssign(target=ast.Name(id=name), value=ast.Name(id=other))
            ):
                same.setdefault(name, set()).add(other)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                found[name] = found.get(name, 0) | kinds_of(value)
            case ast.Name(id=name, ctx=ast.Store()):
                found.setdefault(name, 0)
            case ast.AugAssign(target=ast.Name(id=name), value=value):
                found[name] = found.get(name, 0) | kinds_of(value)
            case ast.For(target=ast.Name(id=name)):
                found[name] = ANY
    for _ in range(MOST_NAMES_OF_ONE):
        for name, others in same.items():
            found[name] = found.get(name, 0) | _all_kinds(found.get(one, 0) for one in others)
    of_variables = {name: kinds for name, kinds in found.items() if kinds}
    never = dict.fromkeys(_never_given(tree), 0)
    return {n: kinds for n, kinds in (of_variables | never).items() if n not in names.variables}


def _never_given(tree: ast.Module) -> Iterator[str]:
    """The values of own blocks that nothing calls, which may be anything; as kinds name them."""
    named = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.decorator_list and node.name not in named:
            yield from (f"{node.name}({one.arg})" for one in node.args.args)


MOST_NAMES_OF_ONE = 4
"""So often what is known of one name is said of another that is set to it."""


def _all_kinds(kinds: Iterator[int]) -> int:
    return functools.reduce(operator.or_, kinds, 0)


def note_anew(tree: ast.Module, kinds: Mapping[str, int]) -> None:
    """Note the kinds that are known by now, and no others."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name | ast.Call) and hasattr(node, "kinds"):
            del node.kinds
    _note_kinds(tree, kinds)


def _note_kinds(tree: ast.Module, kinds: Mapping[str, int]) -> None:
    """Note the kinds of variables, and of values of own blocks, wherever they stand in a text."""
    for top in tree.body:
        known = kinds
        if isinstance(top, ast.FunctionDef):
            names = {one.arg: f"{top.name}({one.arg})" for one in top.args.args}
            given = {arg: kinds[name] for arg, name in names.items() if name in kinds}
            others = {name: kind for name, kind in kinds.items() if name not in names}
            known = {**others, **given}
        for node in ast.walk(top):
            name = getattr(node, "id", "")
            if isinstance(node, ast.Call):
                name = f"{getattr(node.func, 'id', '')}()"
            found = known.get(name)
            if isinstance(node, ast.Name | ast.Call) and found is not None:
                note(node, found)


def _require_variables(names: SourceNames, tree: ast.Module) -> None:
    """What is global must be a variable: a robot, a function and “wait” cannot become one."""
    lines = {
        name: node.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.Global)
        for name in node.names
    }
    for name, line in lines.items():
        if name not in names.variables:
            raise CodeUnread(
                "“{name}” has a meaning in the program already, and cannot be a variable.",
                line,
                checklist=("Give the variable another name.",),
                name=name,
            )


def _known(editor: Editor, *, loose: bool = False) -> SourceNames:
    """The names of a project; variables are known by all of theirs where lines are ``loose``."""
    names = SourceNames()
    for entry in robot_entries(editor.project, editor.language):
        names.robots.setdefault(_safe(entry.name.lower(), "robot"), entry.name)
    for robot in names_used(editor.project, editor.language, "robot"):
        names.robots.setdefault(_safe(robot.lower(), "robot"), robot)
    names.robots.setdefault("all_robots", ALL_ROBOTS)
    names.variables = keys_of(editor)
    for variable in editor.project.variables if loose else ():
        plain = variable_name(variable.name)
        for name in (plain, *(f"{owner}.{plain}" for owner in SHARED_OBJECTS)):
            names.variables.setdefault(name, variable.id)
    defined = {editor.project.blocks[s.body[0]].type for s in editor.project.stacks.values()}
    procedures = editor.project.procedures.values()
    for procedure in sorted(procedures, key=lambda one: DEFINE + one.id not in defined):
        names.procedures.setdefault(_safe(words(procedure), "block"), procedure)
    return names


def keys_of(editor: Editor) -> dict[str, str]:
    """The variables of a project by how its Python calls them, as a tree of a text does."""
    names = names_of(editor.project, editor.language)
    return {as_shared(name, names.locals): one for one, name in names.variables.items()}


def names_taken(editor: Editor) -> set[str]:
    """The names that robots and variables of a project have in Python."""
    names = _known(editor, loose=True)
    return names.robots.keys() | names.variables.keys()


def variable_name(text: str) -> str:
    """What a variable is called in Python, if nothing else there is."""
    return _safe(text, "variable")


def _safe(text: str, fallback: str) -> str:
    name = python_name(text, fallback)
    return f"{name}_" if name in RESERVED else name


def _note(editor: Editor, names: SourceNames, name: str, made: str, node: ast.Assign) -> None:
    call = node.value
    assert isinstance(call, ast.Call)
    match call.args:
        case _ if call.keywords and not _is_known(call, made):
            pass
        case [ast.Constant(value=str(text))] if made == "Behavior":
            if text != editor.project.name:
                editor.apply(RenameProject(text))
            _note_on_error(editor, call)
            _note_language(editor, call)
            return
        case [ast.Constant(value=str(text))]:
            if text not in names.robots.values():
                _add_robot(editor, text)
            names.robots[name] = text
            return
        case [ast.List(elts=listed)] if made == "Robot" and all(map(_text_of, listed)):
            names.robots[name] = ALL_ROBOTS
            for robot in listed:
                _add_robot(editor, _text_of(robot))
            return
    raise _header_unread(call, made, node.lineno)


def _header_unread(call: ast.Call, made: str, line: int) -> CodeUnread:
    """That a robot or the behaviour is not made as the program makes it, with what to do."""
    sentence = "{made} needs a name in quotes here."
    step = 'Write it as the program does: nao = Robot("NAO"), behavior = Behavior("Test").'
    if made == "Robot":
        step = 'Write the name in quotes, such as "NAO".'
    if call.args and _text_of(call.args[0]):
        sentence = "{made} is given a name here, and nothing else."
        if made == "Robot":
            step = "Give the robot the address of a real one, on the page Robots."
    return CodeUnread(sentence, line, checklist=(step,), made=made)


def _is_known(call: ast.Call, made: str) -> bool:
    """Whether the program can keep all that a call names."""
    return made == "Behavior" and {word.arg for word in call.keywords} <= {ON_ERROR, LANGUAGE}


def _text_of(node: ast.expr) -> str:
    is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    return str(node.value) if is_text else ""  # type: ignore[attr-defined]


def _note_on_error(editor: Editor, call: ast.Call) -> None:
    """Keep whether an error of one rule ends the program."""
    said = {word.arg: word.value for word in call.keywords}.get(ON_ERROR)
    is_end = isinstance(said, ast.Constant) and said.value == "end"
    if is_end != editor.project.ends_on_error:
        editor.apply(SetExtra(ON_ERROR, "end" if is_end else None))


def _note_language(editor: Editor, call: ast.Call) -> None:
    """The language in which the program tells values; one that is not known stays as it was."""
    given = {keyword.arg: getattr(keyword.value, "value", "") for keyword in call.keywords}
    code = given.get(LANGUAGE, LANGUAGES[0])
    if code in LANGUAGES and code != editor.project.spoken_language:
        editor.apply(SetExtra(LANGUAGE, None if code == LANGUAGES[0] else code))


def _add_robot(editor: Editor, name: str) -> None:
    if all(e.name != name for e in robot_entries(editor.project, editor.language)):
        append_entry(editor, "robots", ROBOT_BLOCK, {"name": name})


def _note_procedure(
    editor: Editor,
    names: SourceNames,
    node: ast.FunctionDef,
    tree: ast.Module,
    begun: Mapping[str, str],
    hints: Hints | None,
    position: int,
) -> None:
    """Find the own block that a function makes, or make it at a position of the list of them."""
    wanted = [argument.arg for argument in node.args.args]
    gives_value = any(isinstance(n, ast.Return) and n.value is not None for n in ast.walk(node))
    gives_value = gives_value or (_never_ends(node.body) and _is_value(node.name, tree))
    known = names.procedures.get(node.name)
    if known is not None and len(parameters(known)) == len(wanted):
        return
    kinds: Sequence[str] = list(_kinds_of_parameters(node, tree, begun))
    if hints is not None:
        kinds = hints.turns.kinds_at(node.lineno, kinds)
    own = [
        Parameter(editor.project.new_id("a"), words_of(name), kind)
        for name, kind in zip(wanted, kinds, strict=True)
    ]
    procedure = Procedure(editor.project.new_id("p"), (words_of(node.name), *own), gives_value)
    editor.apply(AddProcedure(procedure, position))
    names.procedures[node.name] = procedure


def words_of(name: str) -> str:
    """What an own block, or a value of it, is called by its name in Python."""
    return name.replace("_", " ").strip() or name


def _never_ends(body: Sequence[ast.stmt]) -> bool:
    """Whether a function stops its rule, or goes on forever, wherever it comes to."""
    match body[-1]:
        case ast.Expr(value=ast.Call(func=ast.Name(id="stop_rule"))):
            return True
        case ast.While(test=ast.Constant(value=True)):
            return True
        case ast.If(body=inner, orelse=[_, *_] as others):
            return _never_ends(inner) and _never_ends(others)
    return False


def _is_value(name: str, tree: ast.Module) -> bool:
    """Whether a function is called somewhere for what it gives."""
    called = [n for n in ast.walk(tree) if isinstance(n, ast.Call)]
    alone = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr)}
    return any(getattr(n.func, "id", "") == name and id(n) not in alone for n in called)


_MAKES = {
    **{"as_list": "list", "as_number": "number", "as_table": "table", "bool": "boolean"},
    **{"as_robot": "robot", "as_text": "text", "str": "text"},
}


def _kinds_of_parameters(
    function: ast.FunctionDef, tree: ast.Module, begun: Mapping[str, str]
) -> Iterator[str]:
    """The kinds of the values of an own block, as its calls and its definition show them.

    ``begun`` are the kinds of variables that would begin otherwise if no block took them for that.
    """
    calls = [
        node.args
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == function.name
    ]
    for place, argument in enumerate(function.args.args):
        given = [arguments[place] for arguments in calls if place < len(arguments)]
        shown = itertools.chain(
            map(_kind_made, given), _kinds_begun(function, argument.arg, given, begun)
        )
        made_there = {_kind_made(node) for node in _given_to_calls(function, argument.arg)}
        fitting = (kind for kind in shown if kind not in made_there and _may_all_be(given, kind))
        yield next(fitting, "any")


def _given_to_calls(function: ast.FunctionDef, parameter: str) -> Iterator[ast.expr]:
    """The calls that are given a value of an own block, and nothing else.

    What makes it a text there is written only where it may be something else.
    """
    for node in ast.walk(function):
        match node:
            case ast.Call(args=[ast.Name(id=name)], keywords=[]) if name == parameter:
                yield node


def _kind_made(node: ast.expr) -> str:
    """The kind that a call makes of a value for an own block, or an empty text."""
    is_made = isinstance(node, ast.Call) and not is_junction(node)
    return _MAKES.get(getattr(node.func, "id", ""), "") if is_made else ""  # type: ignore[attr-defined]


def _kinds_begun(
    function: ast.FunctionDef, parameter: str, given: Sequence[ast.expr], begun: Mapping[str, str]
) -> Iterator[str]:
    """The kinds that variables have by being given to an own block, or by being set in it."""
    for kind in ("list", "table"):
        if any(isinstance(node, ast.Name) and begun.get(node.id) == kind for node in given):
            yield kind
    for node in ast.walk(function):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Name(id=value)):
                if value == parameter:
                    yield begun.get(name, "")


def _may_all_be(given: Sequence[ast.expr], kind: str) -> bool:
    return bool(kind) and all(may_be(node, RESULT_KINDS[kind]) for node in given)


def _begun_otherwise(tree: ast.Module, hints: Hints | None) -> dict[str, str]:
    """The kinds with which variables begin, but would not when the text was read before."""
    found: dict[str, str] = {}
    for node in tree.body if hints is not None else ():
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                if hints is not None and node.lineno in hints.differed:
                    kinds = {LIST: "list", TABLE: "table", TEXT: "text", TRUTH: "boolean"}
                    found[name] = kinds.get(kinds_of(value), "")
    return found


def _shared(tree: ast.Module, *, loose: bool) -> Iterator[str]:
    """The names that the whole program shares: those that functions say are global.

    Lines that are in no function are a program's own too when they are ``loose``.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.Global):
            yield from node.names
        elif isinstance(node, ast.Name) and is_shared(node.id):
            yield node.id
    for line in tree.body if loose else ():
        match line:
            case ast.AugAssign(target=ast.Name(id=name)):
                yield name
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if not (
                isinstance(value, ast.Call) and getattr(value.func, "id", "") in HEADERS
            ):
                yield name
            case ast.For(target=ast.Name(id=name)) if name != "_":
                yield name


# Of which form an expression is.


def within(node: ast.expr, names: Collection[str]) -> ast.expr:
    """What is in a call of a function of one of these names; else the node itself."""
    match node:
        case ast.Call(func=ast.Name(id=name), args=[inner], keywords=[]) if name in names:
            return inner
    return node


def is_junction(node: ast.expr) -> bool:
    """Whether it is a truth made of “and” or “or”: their blocks give one by themselves."""
    return isinstance(within(node, ("bool",)), ast.BoolOp)


def may_be(node: ast.expr, kinds: int, seen: Seen | None = None) -> bool:
    """Whether a value can be of these kinds, as far as the text tells; any if it never is any."""
    found = kinds_of(node, seen)
    return not found or bool(found & kinds)
