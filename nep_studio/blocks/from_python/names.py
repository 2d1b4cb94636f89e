"""What the names in a Python text stand for: robots, variables, own blocks, their values."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field

from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.edits.project import RenameProject

from ..deployment import robot_entries, robots_used
from ..editor import Editor
from ..generate.names import RESERVED, python_name
from ..places import InStack
from nep_studio.blocks.procedures import parameters, words
from ..program import ALL_ROBOTS, ROBOT_BLOCK, Parameter, Procedure, Project
from .learning import CodeUnread

_HEADERS = ("Robot", "Behavior")


@dataclass(slots=True)
class SourceNames:
    """What identifiers stand for: names of robots, ids of variables, own blocks.

    ``parameters`` are the values of the own block that is being read, by identifier.
    """

    robots: dict[str, str] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)
    procedures: dict[str, Procedure] = field(default_factory=dict)
    parameters: dict[str, str] = field(default_factory=dict)


def names_in(editor: Editor, tree: ast.Module) -> SourceNames:
    """Find what the names of a text stand for in a project, and make there what lacks."""
    names = _known(editor)
    assigned: list[str] = []
    for node in tree.body:
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id=made))
            ) if made in _HEADERS:
                _note(editor, names, name, made, node)
            case ast.FunctionDef(decorator_list=[]):
                _note_procedure(editor, names, node)
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant() | ast.List()):
                assigned.append(name)
    for name in [*assigned, *_shared(tree)]:
        if name not in names.robots and name not in names.variables and name not in RESERVED:
            names.variables[name] = editor.add_variable(_free(editor.project, name))
    _require_variables(names, tree)
    return names


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


def _known(editor: Editor) -> SourceNames:
    names = SourceNames()
    for entry in robot_entries(editor.project, editor.language):
        names.robots.setdefault(_safe(entry.name.lower(), "robot"), entry.name)
    for robot in robots_used(editor.project, editor.language):
        names.robots.setdefault(_safe(robot.lower(), "robot"), robot)
    names.robots.setdefault("all_robots", ALL_ROBOTS)
    for variable in editor.project.variables:
        names.variables.setdefault(_safe(variable.name, "variable"), variable.id)
    for procedure in editor.project.procedures.values():
        names.procedures.setdefault(_safe(words(procedure), "block"), procedure)
    return names


def _safe(text: str, fallback: str) -> str:
    name = python_name(text, fallback)
    return f"{name}_" if name in RESERVED else name


def _note(editor: Editor, names: SourceNames, name: str, made: str, node: ast.Assign) -> None:
    call = node.value
    assert isinstance(call, ast.Call)
    match call.args:
        case [ast.Constant(value=str(text))] if made == "Behavior":
            if text != editor.project.name:
                editor.apply(RenameProject(text))
        case [ast.Constant(value=str(text))]:
            if text not in names.robots.values():
                _add_robot(editor, text)
            names.robots[name] = text
        case [ast.List(elts=listed)] if made == "Robot":
            names.robots[name] = ALL_ROBOTS
            for robot in listed:
                if isinstance(robot, ast.Constant) and isinstance(robot.value, str):
                    _add_robot(editor, robot.value)
        case _:
            raise CodeUnread(
                "{made} needs a name in quotes here.",
                node.lineno,
                checklist=('Write the name in quotes, such as "NAO".',),
                made=made,
            )


def _add_robot(editor: Editor, name: str) -> None:
    if any(e.name == name for e in robot_entries(editor.project, editor.language)):
        return
    block = editor.language.definitions[ROBOT_BLOCK].new_block(editor.project.new_id("b"))
    block.fields["name"] = name
    stacks = editor.project.pages["robots"]
    place = (
        InStack(stacks[-1].id, len(stacks[-1].body))
        if stacks
        else editor.new_stack("robots", 40, 40)
    )
    editor.apply(CreateBlocks((block.id,), (block,), place))


def _note_procedure(editor: Editor, names: SourceNames, node: ast.FunctionDef) -> None:
    given = node.args
    if given.vararg or given.kwarg or given.kwonlyargs or given.posonlyargs or given.defaults:
        raise CodeUnread(
            "An own block takes plain values only.",
            node.lineno,
            checklist=("Write its parameters as plain names, with commas between them.",),
        )
    wanted, gives_value = [argument.arg for argument in given.args], _gives_value(node)
    known = names.procedures.get(node.name)
    if known is not None and len(parameters(known)) == len(wanted):
        return
    own = [Parameter(editor.project.new_id("a"), name.replace("_", " ")) for name in wanted]
    procedure = Procedure(
        editor.project.new_id("p"), (node.name.replace("_", " ").strip(), *own), gives_value
    )
    editor.apply(AddProcedure(procedure, len(editor.project.procedures)))
    names.procedures[node.name] = procedure


def _gives_value(function: ast.FunctionDef) -> bool:
    return any(isinstance(n, ast.Return) and n.value is not None for n in ast.walk(function))


def _shared(tree: ast.Module) -> Iterator[str]:
    """The names that the whole program shares: those that functions say are global.

    Lines that are in no function are a program's own too.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.Global):
            yield from node.names
    for line in tree.body:
        match line:
            case ast.AugAssign(target=ast.Name(id=name)):
                yield name
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if not (
                isinstance(value, ast.Call) and getattr(value.func, "id", "") in _HEADERS
            ):
                yield name
            case ast.For(target=ast.Name(id=name)) if name != "_":
                yield name


def _free(project: Project, name: str) -> str:
    """A name for a new variable that no other has; its Python name is the same."""
    taken = {variable.name for variable in project.variables}
    return name if name not in taken else f"{name}_"
