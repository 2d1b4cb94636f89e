"""Where each variable of a program is known, and what its Python calls it therefore."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Set
from dataclasses import replace

from nep_studio.blocks.deployment import chains
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import DEFINE, parameters, procedure_of
from nep_studio.blocks.program import SCOPE_KEPT, SCOPE_PROGRAM, Project

from .facts import FactReader, Facts
from .names import NameTable, ProgramNames


def local_variables(facts: Mapping[str, Facts]) -> set[str]:
    """The variables that no two stacks share, by what these do with them.

    Each stack always sets them before it reads them, in no part that runs beside others. Where
    several stacks use one, each of them reads it too, and in no loop that began after it was set:
    else a stack may be meant to see what another one sets.
    """
    users: dict[str, list[Facts]] = {}
    for one in facts.values():
        for variable in one.used:
            users.setdefault(variable, []).append(one)
    return {
        variable
        for variable, every in users.items()
        if not any(variable in one.early or variable in one.apart for one in every)
        and (len(every) == 1 or not any(variable in one.watched for one in every))
    }


def as_shared(name: str, local: Collection[str]) -> str:
    """How a tree of a text calls a variable, whether Python says “global” or not."""
    return name if "." in name or name in local else f"{SCOPE_PROGRAM}.{name}"


def scoped(
    names: ProgramNames, facts: Mapping[str, Facts], project: Project, plain: Collection[str] = ()
) -> ProgramNames:
    """The same names, but those of variables of the whole program: ``program.score``.

    One that Python of a person names stays as it is, and so do those of ids in ``plain``.
    """
    written = frozenset[str]().union(*(one.written for one in facts.values()))
    written |= {name for one in facts.values() for name, _, _ in one.begun}
    local = local_variables(facts)
    variables, by_themselves = dict[str, str](), set[str]()
    for variable in project.variables:
        name, scope = names.variables[variable.id], variable.scope
        if scope == SCOPE_KEPT:
            variables[variable.id] = f"{SCOPE_KEPT}.{name}"
        elif name in written or variable.id in plain:
            variables[variable.id] = name
        elif (
            scope == SCOPE_PROGRAM
            or variable.id not in local
            or f"{SCOPE_PROGRAM}.{name}" in written
        ):
            variables[variable.id] = f"{SCOPE_PROGRAM}.{name}"
        else:
            variables[variable.id] = name
            by_themselves.add(name)
    found = replace(names, variables=variables, locals=frozenset(by_themselves))
    return replace(found, parameters=dict(_parameters(found, facts, project, written | set(plain))))


def _parameters(
    names: ProgramNames, facts: Mapping[str, Facts], project: Project, written: Set[str]
) -> Iterator[tuple[str, str]]:
    """What the values of own blocks are called: a variable of another rule may be called so, too.

    ``written`` are the names that Python of a person has, and the ids of variables in it.
    """
    others = {*names.robots.values(), *names.procedures.values(), *names.outside}
    variables = names.variables.items()
    is_plain = {v: name in names.locals and not {v, name} & written for v, name in variables}
    others |= {name.rpartition(".")[2] for v, name in variables if not is_plain[v]}
    for key, one in facts.items():
        header = project.blocks[project.stacks[key].body[0] if key in project.stacks else key]
        procedure = procedure_of(header.type)
        if not header.type.startswith(DEFINE) or procedure not in names.procedures:
            continue
        used = {names.variables[v] for v in one.used if v in names.variables}
        table = NameTable(others | {name for name in used if name in names.locals})
        for parameter in parameters(project.procedures[procedure]):
            yield f"{procedure}.{parameter.id}", table.give(parameter.name, "value")


def share_as_before(project: Project, language: Language) -> None:
    """Let variables that several stacks use belong to the whole program, as they once did."""
    stacks = chains(project, language)
    facts = {chain[0]: FactReader(project, language).read(chain) for chain in stacks}
    users = Counter(variable for one in facts.values() for variable in one.used)
    local = local_variables(facts)
    for variable in project.variables:
        if users[variable.id] > 1 and variable.id in local and not variable.scope:
            variable.scope = SCOPE_PROGRAM
