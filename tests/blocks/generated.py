"""Questions about generated Python: does it compile, what does it name, which constants has it."""

from __future__ import annotations

import ast
import builtins
import keyword
import unicodedata

from nep_studio.blocks.generate.names import API, MODULES, RESERVED
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project

PARTS_OF_PROGRAMS = {
    *("str", "bool", "range", "from_end", "new", "part", "behavior", "_", "when", "run"),
    *("abs", "float", "len", "list", "map", "max", "min", "reversed", "round", "sorted", "sum"),
    *MODULES,
    *("choice", "randint", "random"),
    *("mean", "median", "stdev"),
    *("pi", "e", "tau", "sqrt", "log", "log10", "exp", "radians", "degrees", "ceil", "floor"),
    *("sin", "cos", "tan", "asin", "acos", "atan"),
    *("append", "index", "insert", "join", "pop", "reverse", "split"),
    *("find", "get", "lower", "replace", "title", "upper", "values"),
}
HATS_AND_ROBOTS = {
    *("at", "days", "every", "when_told", "wait"),
    *(
        "goal",
        "pursue",
        "pursues",
        "give_up",
        "when_goal",
        "when_heard",
        "when_noticed",
        "when_true",
        "when_idle",
        "source",
    ),
    *("tree", "runs", "reactive", "keeps_place"),
    *("state", "first", "machine", "transition", "told", "after", "done", "go_to", "is_in"),
    "state_now",
    *("priority", "stop", "interrupted", "ask", "wait_for_word", "seconds", "sees", "seen_name"),
}
"""What the generator functions of robot blocks, goals and trees name."""


def parse(text: str) -> ast.Module:
    """The tree of a program that compiles and is text of one line per line."""
    text.encode("utf-8")
    compile(text, "program.py", "exec")
    assert not any(c in text for c in "\r\x00\x0b\x0c\x85\u2028\u2029")
    return ast.parse(text)


def names_used(tree: ast.AST) -> set[str]:
    """Everything that a program refers to: names, attributes, keyword arguments, imports."""
    names = set()
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.alias(name=name):
                names.add(name)
            case ast.keyword(arg=name):
                names.add(name or "**")
            case ast.ImportFrom(module=module):
                assert module == "nep_core"
            case ast.Lambda() | ast.arg() | ast.Global():
                pass
    return names


def names_made(tree: ast.AST) -> set[str]:
    """The names that a program gives itself."""
    made = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            made.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            made.add(node.id)
        elif isinstance(node, ast.arg):
            made.add(node.arg)
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("Variables", "Kept"):
            made |= {given.arg for given in node.keywords if given.arg}
    return made


def assert_tame(text: str, language: Language) -> ast.Module:
    """Check that a program names only what programs name, and its own robots and variables."""
    tree = parse(text)
    made = names_made(tree)
    calls = [d.call for d in language.definitions.values() if d.call is not None]
    known = {call.name for call in calls}
    known |= {name for call in calls for name in (*call.keywords, *call.constants)}
    strange = (
        names_used(tree)
        - made
        - known
        - API
        - PARTS_OF_PROGRAMS
        - HATS_AND_ROBOTS
        - {"again", "when_started"}
    )
    assert not strange, strange
    for name in made - {"behavior", "answer", "program", "kept", "_"}:
        assert name not in RESERVED and not hasattr(builtins, name) and not keyword.iskeyword(name)
        assert unicodedata.normalize("NFKC", name) == name
    return tree


def constants(tree: ast.AST) -> list[tuple[type, str]]:
    """The constants of a program with their types; a signed number is one constant."""
    found, signed = [], set()
    for node in ast.walk(tree):
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Sub):  # how much less
            value = getattr(node.value, "value", None)
            if isinstance(value, int | float):
                found.append((type(value), repr(-value)))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            value = getattr(node.operand, "value", None)
            if isinstance(value, int | float):
                signed.add(id(node.operand))
                found.append((type(value), repr(-value)))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and id(node) not in signed:
            found.append((type(node.value), repr(node.value)))
    return found


def constant_of(value: object) -> tuple[type, str]:
    """How ``constants`` tells a value."""
    return type(value), repr(value)


def assert_mapped(code: Code, project: Project, language: Language) -> None:
    """Check that each statement of each rule is mapped to the block that makes such a statement."""
    language = language.of(project)
    for rule in ast.parse(code.text).body:
        if not isinstance(rule, ast.FunctionDef):
            continue
        for node in ast.walk(rule):
            if isinstance(node, ast.stmt):
                block = code.block_at(node.lineno)
                assert block is not None and node.lineno in code.lines_of(block)
                assert made_by(node, rule, language) & {project.blocks[block].type}, code.text


def has_written_code(project: Project) -> bool:
    """Whether a person wrote Python into the program, which may then name anything."""
    return any(block.type.startswith("code.") for block in project.blocks.values())


def made_by(node: ast.stmt, rule: ast.FunctionDef, language: Language) -> set[str]:
    """The types of blocks that make a statement."""
    shapes = {d.id: d.shape for d in language.definitions.values()}
    hats = {block_type for block_type, shape in shapes.items() if shape == "hat"}
    calls_code = {"code.lines", "control.note"}
    own = {block_type for block_type in shapes if block_type.startswith("my.call.")}
    match node:
        case ast.For():
            loops = {d.id for d in language.definitions.values() if "loop" in d.flags}
            return loops - {"control.while", "control.forever", "control.repeat_until"}
        case ast.With(body=[inner]):  # at_once, around what must not be interrupted
            return made_by(inner, rule, language)
        case ast.While():
            return {"control.while", "control.forever", "control.repeat_until"}
        case ast.If():
            return {"control.if", "robot_speech.ask"}
        case ast.Assign():
            sets = {"variable.set", "variable.change", "text.append"}
            return {*sets, "list.set", "robot_speech.ask"}
        case ast.AugAssign():
            return {"variable.change", "text.append"}
        case ast.Delete():
            return {"list.remove"}
        case ast.Break():
            return {"control.leave_loop"}
        case ast.Continue():
            return {"control.next_round"}
        case ast.Return():
            defines = {block_type for block_type in hats if block_type.startswith("my.define.")}
            return {"control.stop_rule", "my.return", *defines}
        case ast.FunctionDef():
            return hats if node is rule else with_functions(language)
        case ast.Global():
            return hats | with_functions(language)
        case ast.Pass():
            bodies = {block_type for block_type, shape in shapes.items() if shape == "c"}
            return {*hats, *bodies, *calls_code}
        case ast.Expr(value=ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name))):
            calls = {d.id for d in language.definitions.values() if d.call and d.call.name == name}
            return calls | own | {d.id for d in language.definitions.values() if d.generator}
    return set()


def with_functions(language: Language) -> set[str]:
    """The types of blocks whose bodies are functions."""
    return {d.id for d in language.definitions.values() if "apart" in d.flags}
