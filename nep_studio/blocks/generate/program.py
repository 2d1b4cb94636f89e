"""The whole generated file: what is imported, the robots, the variables, the rules."""

from __future__ import annotations

import ast
import itertools
import re
import textwrap
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from nep_studio.blocks.code_text import CodeText, read_outside
from nep_studio.blocks.deployment import (
    OUTSIDE_BLOCK,
    RobotEntry,
    can_be_stopped,
    chains,
    node_entries,
    robot_entries,
)
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import DEFINE, parameters, procedure_of, words
from nep_studio.blocks.program import ALL_ROBOTS, LANGUAGES, Block, Project
from nep_studio.blocks.shared_objects import SHARED_OBJECTS
from nep_studio.blocks.sharing import Chain, Sharing, look_at, sharing_of
from nep_studio.blocks.slices import Steps, at_once
from nep_studio.blocks.slots import Setting, constant

from .expressions import Expressions, call, literal, method_call, refusing, show
from .facts import FactReader, Facts, together
from .generators import REPORTERS
from .kinds import Kinds, parameter_key, result_key, variable_key
from .names import CLASSES, MODULES, NameTable, ProgramNames
from .rules import HATS, Hat, Line, RuleWriter
from .scopes import as_shared, scoped
from .source_map import Code


@dataclass(frozen=True, slots=True)
class _Rule:
    """A written rule, what it was written for, and what it needs to be there."""

    made_for: tuple[object, ...]
    code: Code
    api: frozenset[str]
    modules: frozenset[str]
    robots: frozenset[str]
    variables: frozenset[str]
    kinds: dict[str, int]
    """The kinds that it was written for."""
    rules: dict[str, str]
    """The names of the functions of other rules that it was written with."""


PLACES = ("top", "here", "end")
"""Where own Python stands: above what is imported, among the rules, below all."""

_FUTURE = re.compile(r"from\s+__future__\s")


@lru_cache(maxsize=256)
def runs(lines: tuple[str, ...]) -> bool:
    """Whether own Python lets the behaviour run itself."""
    return any(
        isinstance(node, ast.Attribute)
        and node.attr == "run"
        and isinstance(node.value, ast.Name)
        and node.value.id == "behavior"
        for node in ast.walk(ast.parse("\n".join(lines)))
    )


@dataclass(frozen=True, slots=True)
class Outside:
    """Own Python that stands outside of all functions."""

    block: Block
    place: str
    read: CodeText

    def begins(self) -> frozenset[str]:
        """The variables that it begins itself."""
        return self.read.set_here

    def imports(self) -> frozenset[str]:
        """The modules that it imports itself."""
        return self.read.defined & MODULES


class ProgramGenerator:
    """Makes the Python of a project, and again after an edit for the stacks that have changed."""

    def __init__(self, project: Project, language: Language) -> None:
        self._project = project
        self._language = language.of(project)
        self._rules: dict[str, _Rule] = {}
        self._facts: dict[str, tuple[object, Facts]] = {}
        self._kinds = Kinds()
        self._kinds_for: object = None
        self._written_with = ProgramNames({}, {})
        self._robots: dict[str, tuple[tuple[int, int], frozenset[str]]] = {}
        self._chains: dict[str, tuple[object, Chain]] = {}

    def kinds(self) -> dict[str, int]:
        """The kinds of what the program keeps, as it was written last, by the names in Python.

        What an own block gives back is called ``name()``, what it is given ``name(value)``.
        """
        names, kinds = self._written_with, self._kinds
        own = [(p, self._project.procedures[p], name) for p, name in names.procedures.items()]
        return {
            **{
                as_shared(name, names.locals): kinds.of(variable_key(v))
                for v, name in names.variables.items()
            },
            **{f"{name}()": kinds.of(result_key(p)) for p, _, name in own},
            **{
                f"{name}({names.parameters[f'{p}.{one.id}']})": kinds.of(parameter_key(p, one.id))
                for p, procedure, name in own
                for one in parameters(procedure)
            },
        }

    def generate(self) -> Code:
        """The program as it is now; raises CodeRefused, which names the block."""
        return at_once(self.steps())

    def steps(self) -> Steps[Code]:
        """The same in steps; when they are given up, the rules that are written stay written."""
        self._language = self._language.of(self._project)
        written = {
            self._project.parents[chain[0]].owner: chain
            for chain in chains(self._project, self._language)
        }
        self._robots = {s: known for s, known in self._robots.items() if s in written}
        headers = self._headers(written)
        outside = self._outside(written)
        plain = yield from self._names(written, headers, outside)
        has_changed = yield from self._read_facts(written)
        names = scoped(plain, self._facts_of(), self._project)
        self._written_with = names
        sharing = yield from self._sharing(written, names)
        self._kinds = self._kinds_in(names, is_changed=has_changed)
        functions = NameTable(names.taken())
        ordered = self._in_order(written, names, headers, outside)
        begun = [self._begin(written[stack], names, functions, sharing) for stack in ordered]
        rules = {
            written[stack][0]: function
            for stack, (_, _, function) in zip(ordered, begun, strict=True)
            if can_be_stopped(self._project, self._language, written[stack][0])
        }
        for stack, (code, hat, function) in zip(ordered, begun, strict=True):
            code.rules = rules
            self._rules[stack] = yield from self._rule(stack, written[stack], code, hat, function)
        self._rules = {stack: self._rules[stack] for stack in ordered}
        return self._assemble(names, outside)

    def _headers(self, written: dict[str, list[str]]) -> dict[str, str]:
        """The stacks that define own blocks, by the ids of those, in the order of the list."""
        found: dict[str, str] = {}
        for stack, chain in written.items():
            header = self._project.blocks[chain[0]]
            if not header.type.startswith(DEFINE):
                continue
            procedure = procedure_of(header.type)
            if procedure in found:
                raise CodeRefused(
                    "This own block is defined twice.",
                    block=header.id,
                    checklist=("Take one of the two definitions out.",),
                )
            found[procedure] = stack
        return {p: found[p] for p in self._project.procedures if p in found}

    def _outside(self, written: dict[str, list[str]]) -> dict[str, Outside]:
        """The stacks of own Python that stands outside of all functions."""
        found: dict[str, Outside] = {}
        for stack, chain in written.items():
            block = self._project.blocks[chain[0]]
            if block.type == OUTSIDE_BLOCK:
                definition = self._language.definitions[block.type]
                with refusing(block):
                    read = read_outside(str(definition.value(block, "code")))
                own = Outside(block, str(definition.value(block, "place")), read)
                if own.place != "top" and any(_FUTURE.match(line) for line in read.lines):
                    raise CodeRefused(
                        "“from __future__” stands at the very top of a program.",
                        block=block.id,
                        checklist=("Choose “at the very top” in this block.",),
                    )
                found[stack] = own
        return found

    def _in_order(
        self,
        written: dict[str, list[str]],
        names: ProgramNames,
        headers: dict[str, str],
        outside: dict[str, Outside],
    ) -> list[str]:
        """The stacks as they stand in the text: own blocks are defined before the rules.

        Own Python stands where it is on its page, above all of them when nothing is above it, but
        below the own blocks that it names.
        """
        of_place = {place: [s for s in outside if outside[s].place == place] for place in PLACES}
        others = [s for s in written if s not in of_place["top"] and s not in of_place["end"]]
        first = list(itertools.takewhile(lambda s: s in outside, others))
        rest = others[len(first) :]
        defining = list(headers.values())
        if not any(s in outside for s in rest):
            rest = [*defining, *rest]
        own, between = frozenset(names.procedures.values()), list[str]()
        for stack in rest:
            is_free = stack in outside and not own & outside[stack].read.read
            between += [] if is_free or stack in defining else defining
            between.append(stack)
        return [*of_place["top"], *dict.fromkeys([*first, *between]), *of_place["end"]]

    def _sharing(self, written: dict[str, list[str]], names: ProgramNames) -> Steps[Sharing]:
        """What parts that run at once change, from all chains; those that are known stay so."""
        self._chains = {stack: known for stack, known in self._chains.items() if stack in written}
        for stack, chain in written.items():
            state = self._project.revisions.get(stack, 0), self._project.procedure_revision
            if stack not in self._chains or self._chains[stack][0] != state:
                for found in look_at(self._project, self._language, chain):
                    if found is None:
                        yield
                    else:
                        self._chains[stack] = state, found
        return sharing_of((chain for _, chain in self._chains.values()), names.variables)

    def _read_facts(self, written: dict[str, list[str]]) -> Steps[bool]:
        """What the stacks do; says whether one of them does other things than before."""
        known, changed = self._facts, self._facts.keys() != written.keys()
        self._facts = {}
        for stack, chain in written.items():
            revision = (self._project.revisions.get(stack), self._project.procedure_revision)
            before = known.get(stack)
            if before is None or before[0] != revision:
                yield
                facts = FactReader(self._project, self._language).read(chain)
                changed |= before is None or before[1] != facts
                before = revision, facts
            self._facts[stack] = before
        return changed

    def _facts_of(self) -> dict[str, Facts]:
        return {stack: facts for stack, (_, facts) in self._facts.items()}

    def _kinds_in(self, names: ProgramNames, *, is_changed: bool) -> Kinds:
        """The kinds of what the program keeps, as they were unless a stack does other things."""
        if not is_changed and self._kinds_for == names:
            return self._kinds
        self._kinds_for = names
        return together(self._facts_of(), self._project, names)

    def _begin(
        self, chain: list[str], names: ProgramNames, functions: NameTable, sharing: Sharing
    ) -> tuple[Expressions, Hat, str]:
        """What a rule is written with, how it begins, and the name of its function."""
        code = Expressions(self._project, self._language, names, REPORTERS, self._kinds)
        code.sharing = sharing
        hat_block = self._project.blocks[chain[0]]
        hat = HATS[code.definition(hat_block).generator](code, hat_block)
        if hat_block.type.startswith(DEFINE):
            code.procedure, function = procedure_of(hat_block.type), hat.name
        elif hat.outside is not None:
            function = ""
        else:
            function = functions.give(hat.name, "when")
        return code, hat, function

    def _rule(
        self, stack: str, chain: list[str], code: Expressions, hat: Hat, function: str
    ) -> Steps[_Rule]:
        """Write the rule of a stack, unless it is written already."""
        names = code.names
        if code.procedure:
            gives_value = self._project.procedures[code.procedure].gives_value
            code.gives_nothing = gives_value and self._facts[stack][1].is_open
        revision = self._project.revisions.get(stack)
        made_for = (
            *(revision, function, names, self._project.procedure_revision),
            *(code.sharing, self._kinds.has_lists_twice),
        )
        known = self._rules.get(stack)
        if known is not None and known.made_for == made_for and self._fits(known, code.rules):
            return known
        writer = RuleWriter(code)
        yield from writer.write(function, hat, chain)
        return _Rule(
            made_for,
            _code(writer.lines),
            frozenset(code.api),
            frozenset(code.modules),
            frozenset(code.robots),
            frozenset(code.variables),
            code.written_for,
            code.rules_named,
        )

    def _fits(self, known: _Rule, rules: Mapping[str, str]) -> bool:
        """Whether the kinds of what is kept, and the names of other rules, are as they were."""
        is_same = all(rules.get(hat) == name for hat, name in known.rules.items())
        return is_same and all(self._kinds.of(key) == kind for key, kind in known.kinds.items())

    def _names(
        self, written: dict[str, list[str]], headers: dict[str, str], outside: dict[str, Outside]
    ) -> Steps[ProgramNames]:
        """Names for the robots of the Robots page, others that rules use, variables, own blocks.

        Own Python may put values into variables, but nothing else has a name that it makes.
        """
        made = frozenset(name for own in outside.values() for name in own.read.set_here)
        defined = frozenset(name for own in outside.values() for name in own.read.defined)
        listed = [entry.name for entry in robot_entries(self._project, self._language)]
        used = set[str]()
        for stack, chain in written.items():
            yield
            used |= self._robots_in(stack, chain)
        return give_names(self._project, listed, used, list(headers), made, defined)

    def _robots_in(self, stack: str, chain: list[str]) -> frozenset[str]:
        revision = self._project.revisions.get(stack, 0), self._project.procedure_revision
        known = self._robots.get(stack)
        if known is None or known[0] != revision:
            robots = frozenset(
                name
                for block in self._project.within(chain)
                if (definition := self._language.definitions.get(block.type)) is not None
                for name in definition.robots_in(block)
            )
            known = self._robots[stack] = (revision, robots)
        return known[1]

    def _assemble(self, names: ProgramNames, outside: dict[str, Outside]) -> Code:
        rules = self._rules
        top = [stack for stack, own in outside.items() if own.place == "top"]
        end = [stack for stack, own in outside.items() if own.place == "end"]
        between = [stack for stack in rules if stack not in top and stack not in end]
        first = list(itertools.takewhile(lambda stack: stack in outside, between))
        parts = [self._head(names, outside, top, first)]
        for stack in between[len(first) :]:
            parts += [_GAP, rules[stack].code]
        if not any(runs(own.read.lines) for own in outside.values()):
            is_apart = any(stack not in outside for stack in between)
            parts.append(_code(_unmade([*(["", ""] if is_apart else [""]), "behavior.run()"])))
        for stack in end:
            parts += [_GAP, rules[stack].code]
        blocks = tuple(itertools.chain.from_iterable(part.blocks for part in parts))
        return Code("".join(part.text for part in parts), blocks, dict(names.variables))

    def _head(
        self, names: ProgramNames, outside: dict[str, Outside], top: list[str], first: list[str]
    ) -> Code:
        """All above the functions: what is imported, the robots, the variables, own Python."""
        rules = self._rules.values()
        begun = {name for own in outside.values() if own.place != "end" for name in own.begins()}
        api = {"Behavior"}.union(*(rule.api for rule in rules))
        modules = set[str]().union(*(rule.modules for rule in rules))
        modules -= {name for stack in top for name in outside[stack].imports()}
        used = set[str]().union(*(rule.robots for rule in rules))
        if "as_robot" in api:  # a text may be the name of any of them
            used |= {entry.name for entry in robot_entries(self._project, self._language)}
        robots = self._robot_lines(names, used)
        if robots:
            api.add("Robot")
        held = dict(self._variables(names))
        objects = [one for one in SHARED_OBJECTS if any(n.startswith(f"{one}.") for n in held)]
        held = {name: first for name, first in held.items() if name not in begun}
        api.update(CLASSES[one] for one in objects)
        head = [*(f"import {name}" for name in sorted(modules))]
        head += [*_import_lines(sorted(api)), ""]
        options: dict[str, ast.expr] = {}
        if self._project.ends_on_error:
            options["on_error"] = ast.Constant("end")
        if self._project.spoken_language != LANGUAGES[0]:
            options["language"] = ast.Constant(self._project.spoken_language)
        behavior = show(call("Behavior", ast.Constant(self._project.name), **options))
        page = [*_with_docstring(self._project.name, [self._rules[s].code for s in top])]
        page += [*_unmade(head), *robots, *_unmade([f"behavior = {behavior}"])]
        for one in objects:
            page += _unmade(_shared_object(one, held))
        page += _unmade([f"{name} = {held[name]}" for name in held if "." not in name])
        for stack in first:
            own = self._rules[stack].code
            page += [("", ""), *zip(own.text.splitlines(), own.blocks, strict=True)]
        return _code(page)

    def _variables(self, names: ProgramNames) -> Iterator[tuple[str, str]]:
        """The names of variables that are not by themselves, with what they hold first."""
        used = frozenset[str]().union(*(rule.variables for rule in self._rules.values()))
        for variable, name in names.variables.items():
            if variable in used and name not in names.locals:
                yield name, self._kinds.first[variable]

    def _robot_lines(self, names: ProgramNames, used: set[str]) -> list[tuple[str, str]]:
        """A line for each robot that the rules use, with its block on the Robots page."""
        entries = {e.name: e.block_id for e in robot_entries(self._project, self._language)}
        lines = []
        for name, identifier in names.robots.items():
            if name not in used:
                continue
            which: ast.expr = ast.Constant(name)
            if name == ALL_ROBOTS:
                which = ast.List([ast.Constant(robot) for robot in entries])
            line = f"{identifier} = {show(call('Robot', which))}"
            lines.append((line, entries.get(name, "")))
        return lines


def give_names(
    project: Project,
    listed: Sequence[str],
    used: Collection[str],
    own_blocks: Sequence[str],
    made: frozenset[str],
    defined: frozenset[str],
) -> ProgramNames:
    """The Python names of a project's robots, variables and own blocks, each its own.

    ``listed`` are the robots of the Robots page, ``used`` those that blocks name, ``own_blocks``
    the ids of those that are defined; ``made`` are the names to which own Python outside of all
    functions gives a meaning, ``defined`` those of them that are no plain values.
    """
    table = NameTable(made)
    robots: dict[str, str] = {}
    for name in [*listed, *sorted(set(used) - {ALL_ROBOTS}), ALL_ROBOTS]:
        if name not in robots:
            text = "all_robots" if name == ALL_ROBOTS else name.lower()
            robots[name] = table.give(text, "robot")
    table = NameTable({*robots.values(), *defined})
    variables = {v.id: table.give(v.name, "variable") for v in project.variables}
    table = NameTable({*robots.values(), *variables.values(), *made})
    procedures = {p: table.give(words(project.procedures[p]), "block") for p in own_blocks}
    names = ProgramNames(robots, variables, procedures, outside=made)
    taken = names.taken()
    for p in own_blocks:
        local = NameTable(taken)
        for parameter in parameters(project.procedures[p]):
            names.parameters[f"{p}.{parameter.id}"] = local.give(parameter.name, "value")
    return names


def generate_program(project: Project, language: Language) -> Code:
    """The Python of a project; raises CodeRefused, which names the block."""
    return ProgramGenerator(project, language).generate()


def _import_lines(names: Sequence[str]) -> list[str]:
    """What is imported of nep_core, in as many lines as it needs to be read."""
    line = f"from nep_core import {', '.join(names)}"
    if len(line) <= LONGEST_LINE:
        return [line]
    margin = "    "
    width = LONGEST_LINE - len(margin) - 1
    wrapped = textwrap.wrap(", ".join(names), width, break_on_hyphens=False)
    return [
        "from nep_core import (",
        *(f"{margin}{part}" for part in wrapped[:-1]),
        f"{margin}{wrapped[-1]},",
        ")",
    ]


LONGEST_LINE = 88


def _shared_object(name: str, held: Mapping[str, str]) -> list[str]:
    """The lines that make what variables are attributes of."""
    parts = [(*key.partition("."), first) for key, first in held.items()]
    given = [f"{attribute}={first}" for owner, _, attribute, first in parts if owner == name]
    line = f"{name} = {CLASSES[name]}({', '.join(given)})"
    if len(line) <= LONGEST_LINE:
        return [line]
    return [f"{name} = {CLASSES[name]}(", *(f"    {one}," for one in given), ")"]


def _unmade(lines: Sequence[str]) -> list[Line]:
    """Lines that no block made."""
    return [(line, "") for line in lines]


def _code(page: Sequence[Line]) -> Code:
    lines, blocks = zip(*page, strict=True)
    return Code("\n".join(lines) + "\n", blocks)


_GAP = _code(_unmade(["", ""]))


def _with_docstring(name: str, own: Sequence[Code]) -> list[Line]:
    """The first lines: own Python, with a text of what the file is unless it has one itself."""
    lines = [line for code in own for line in zip(code.text.splitlines(), code.blocks, strict=True)]
    if lines and ast.get_docstring(ast.parse("\n".join(text for text, _ in lines))) is not None:
        return lines
    is_comment = [not text or text.startswith("#") for text, _ in lines]
    above = next((n for n, one in enumerate(is_comment) if not one), len(lines))
    return [*lines[:above], (_docstring(name), ""), *lines[above:]]


def _docstring(name: str) -> str:
    sentence = f"{name.rstrip('.')}. Made with NEP Studio."
    if '"' in sentence or "\\" in sentence or not sentence.isprintable():
        return literal(sentence)
    return f'"""{sentence}"""'


# The Robots and Nodes pages as Python: the launcher starts each of them.


def generate_launch(project: Project, language: Language) -> Code:
    """The Python that starts the robots and the nodes of a project."""
    page = _unmade(["from nep_core import Launcher", "", "launcher = Launcher()"])
    for robot in robot_entries(project, language):
        start = _start(language.profile.node, robot.name, _robot_settings(robot))
        page.append((start, robot.block_id))
    for node in node_entries(project, language):
        page.append((_start(node.node, node.name, dict(node.parameters)), node.block_id))
    return _code(page)


def _robot_settings(robot: RobotEntry) -> dict[str, Setting]:
    settings = {"robot": robot.name, "driver": robot.driver, "address": robot.address}
    return {**settings, "model": robot.model} if robot.model else {**settings}


def _start(node: str, name: str, settings: dict[str, Setting]) -> str:
    keywords = {key: constant(value) for key, value in {"name": name, **settings}.items()}
    start = method_call(ast.Name("launcher"), "start", [ast.Constant(node)], keywords)
    return show(start)
