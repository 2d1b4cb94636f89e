"""Checks of each block by itself: unknown types, empty slots, choices that are not offered."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from faults import Text, text_of
from nep_studio.blocks.arithmetic import number_of
from nep_studio.blocks.code_text import CodeTextRefused, read_lines, read_outside, read_value
from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.deployment import OUTSIDE_BLOCK
from nep_studio.blocks.language import Language
from nep_studio.blocks.mouths import Sort, mouth_of, why_not_in
from nep_studio.blocks.procedures import CALL, DEFINE, PARAMETER, RETURN, procedure_of, title
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.sharing import EACH_ROBOT
from nep_studio.blocks.slots import FieldValue
from nep_studio.blocks.text import sentence

from .diagnostic import Diagnostic, Found, Severity, found


def check_blocks(project: Project, language: Language, chain: list[str]) -> Found:
    """Problems of single blocks; disabled blocks have none. And of a chain that nothing starts."""
    page, definitions = project.page_of(chain[0]), language.definitions
    first, kind = definitions.get(project.blocks[chain[0]].type), project.kind_of_page(page)
    if first is not None and first.shape != "hat" and first.page == kind == "behaviour":
        yield found("loose_block", project, language, chain[0])
    for block in project.within(chain, enabled=True):
        yield None
        definition = definitions.get(block.type)
        if definition is None:
            unknown = "unknown_own_block" if procedure_of(block.type) else "unknown_block"
            yield found(unknown, project, language, block.id, type=block.type)
            continue
        if definition.page != kind:
            right = Text(definition.page.title())
            yield found("wrong_page", project, language, block.id, page=right)
        for key, slot in definition.keys(block.groups):
            plugged = project.blocks.get(block.inputs.get(key, ""))
            if slot.kind.name == "body" or (plugged is not None and not plugged.disabled):
                continue
            wrong = _why_not_filled(project, language, block, definition, key, slot)
            if wrong is not None:
                yield _wrong_here(project, language, block, ("error", *wrong))


def _wrong_here(
    project: Project, language: Language, block: Block, wrong: _Misplaced
) -> Diagnostic:
    severity, kind, reason, remedy = wrong
    said = sentence(project, language, block.id)
    words = text_of("“{block}”: {reason}", block=said, reason=reason)
    return Diagnostic(severity, kind, project.page_of(block.id), block.id, words, (remedy,))


_Wrong = tuple[str, Text, str]
"""The kind, the sentence and the remedy of what is wrong with a block."""
_Misplaced = tuple[Severity, str, Text, str]
"""The same, and before it how bad it is."""


def _why_not_filled(
    project: Project, language: Language, block: Block, definition: Definition, key: str, slot: Slot
) -> _Wrong | None:
    """The kind, the sentence and the checklist of what is wrong with a slot, or None."""
    value, kind = definition.value(block, key), slot.kind
    if kind.missing is not None and not (kind.typed and str(value).strip()):
        return ("empty_slot", kind.missing, kind.advice)
    if kind.name == "variable" and project.variable(str(value)) is None:
        remedy = "Choose a variable, or make a new one."
        return ("no_variable", Text("no variable is chosen."), remedy)
    reason = language.why_not_choice(slot, value, block, key)
    if reason is not None:
        return ("unknown_choice", reason, "Choose another one.")
    if kind.name in ("number", "duration"):
        return _why_not_number(definition, slot, value)
    return None


def _why_not_number(definition: Definition, slot: Slot, value: FieldValue | None) -> _Wrong | None:
    """What is wrong with a number as it is typed, for what it is meant."""
    if slot.kind.name == "duration" and number_of(value) < 0:
        reason = Text("a time cannot be less than 0 seconds.")
        return ("negative", reason, "Write a time of 0 or more.")
    if "loop" not in definition.flags or slot.kind.name != "number":
        return None
    number = number_of(value)
    if slot.name == "times" and number < 0:
        return ("negative", Text("this cannot be done less than 0 times."), "Write 0 or more.")
    if slot.name == "step" and int(number) == 0:
        reason = Text("counting in steps of 0 never ends.")
        return ("no_step", reason, "Write a whole number but 0.")
    return None


# Checks of what a block must be inside of: a loop, the definition of an own block, good Python.

CODE_LINES, CODE_VALUE = "code.lines", "code.value"


class _Place(NamedTuple):
    """What a block is inside of: an own block, a loop, a part that runs beside others, a tree.

    ``mouth`` is what may be where it is, ``has_steps`` whether a step may be around it.
    """

    procedure: str
    loop: bool = False
    apart: bool = False
    mouth: Sort = ""
    has_steps: bool = False
    has_robot: bool = False
    """Whether “this robot” may be known."""


def check_inside(project: Project, language: Language, chain: list[str]) -> Found:
    """Blocks that mean nothing where they are."""
    hat = project.blocks[chain[0]]
    own = procedure_of(hat.type) if hat.type.startswith(DEFINE) else ""
    first = language.definitions.get(hat.type)
    mouth: Sort = mouth_of(first) if first is not None else ""
    start = _Place(own, mouth=mouth, has_steps=bool(own or mouth), has_robot=bool(own))
    waiting = [(block_id, start) for block_id in reversed(chain)]
    while waiting:
        yield None
        block_id, place = waiting.pop()
        block = project.blocks[block_id]
        definition = language.definitions.get(block.type)
        if block.disabled or definition is None:
            continue
        if (wrong := _why_not_there(block, definition, place)) is not None:
            yield _wrong_here(project, language, block, wrong)
        if block.inputs or block.bodies:
            inner = _inner(definition, place)
            plugged = inner._replace(has_robot=place.has_robot)  # worked out before, and once
            waiting += [(child, plugged) for child in block.inputs.values()]
            waiting += [(child, inner) for chain in block.bodies.values() for child in chain]


def _inner(definition: Definition, place: _Place) -> _Place:
    place = place._replace(mouth=mouth_of(definition))
    if definition.id == EACH_ROBOT:
        place = place._replace(has_robot=True)
    if "apart" in definition.flags:
        return place._replace(loop=False, apart=True)
    return place._replace(loop=True) if "loop" in definition.flags else place


def _why_not_there(block: Block, definition: Definition, place: _Place) -> _Misplaced | None:
    """How bad it is, the kind, the sentence and the remedy of what is wrong, or None."""
    if misplaced := why_not_in(place.mouth, definition):
        return ("error", "outside_tree", *misplaced)
    if "in_step" in definition.flags and not place.has_steps:
        reason = Text("it is in no step of a behaviour tree.")
        return ("error", "outside_step", reason, "Put it into a “step” block of a tree.")
    if "in_each_robot" in definition.flags and not place.has_robot:
        reason = Text("it is in no “do for each of … at once”.")
        remedy = "Put it into a block “do for each of … at once”."
        return ("error", "outside_each_robot", reason, remedy)
    if "in_loop" in definition.flags and not place.loop:
        return ("error", "outside_loop", Text("it is in no loop."), "Put it into a “repeat” block.")
    if block.type == RETURN and (not place.procedure or place.apart):
        reason = Text("only the definition of an own block gives a value back.")
        remedy = "Put it under a “define” block, and not into “do together”."
        return ("error", "outside_own_block", reason, remedy)
    if block.type.startswith(PARAMETER) and procedure_of(block.type) != place.procedure:
        reason = Text("this value is known only inside the definition of its own block.")
        remedy = "Move it under the “define” block that it comes from."
        return ("error", "parameter_outside", reason, remedy)
    if block.type in (CODE_LINES, CODE_VALUE, OUTSIDE_BLOCK):
        text = str(definition.value(block, "code"))
        try:
            if block.type == CODE_VALUE:
                read_value(text)
            elif block.type == OUTSIDE_BLOCK:
                read_outside(text)
            else:
                read_lines(text, in_loop=place.loop)
        except CodeTextRefused as refused:
            return ("error", "wrong_python", refused.sentence, "Change the code.")
    return None


# Checks of own blocks: called without a definition, defined twice, giving nothing, in circles.


def check_own_blocks(project: Project, language: Language, running: Iterable[list[str]]) -> Found:
    """Problems of own blocks; ``running`` are the chains that become code."""
    headers: dict[str, str] = {}
    calls: dict[str, dict[str, str]] = {}

    def found_here(kind: str, procedure: str, block: str) -> Diagnostic:
        own_block = title(project.procedures[procedure])
        return found(kind, project, language, block, own_block=own_block)

    for chain in running:
        header = project.blocks[chain[0]]
        owner = procedure_of(header.type) if header.type.startswith(DEFINE) else ""
        gives_back, called = False, calls.setdefault(owner, {})
        for block in project.within(chain, enabled=True):
            yield None
            gives_back |= block.type == RETURN
            if block.type.startswith(CALL):
                called.setdefault(procedure_of(block.type), block.id)
        if owner and headers.setdefault(owner, header.id) != header.id:
            yield found_here("defined_twice", owner, header.id)
        if owner and project.procedures[owner].gives_value and not gives_back:
            yield found_here("gives_nothing", owner, header.id)
    missing = {p: block for called in calls.values() for p, block in called.items()}
    for procedure, block_id in missing.items():
        if procedure in project.procedures and procedure not in headers:
            yield found_here("no_definition", procedure, block_id)
    for procedure, header_id in headers.items():
        if _reaches(procedure, calls):
            yield found_here("calls_itself", procedure, header_id)


def _reaches(procedure: str, calls: dict[str, dict[str, str]]) -> bool:
    """Whether an own block is called, however indirectly, by itself."""
    waiting, seen = list(calls.get(procedure, ())), set[str]()
    while waiting:
        called = waiting.pop()
        if called == procedure:
            return True
        if called not in seen:
            seen.add(called)
            waiting += calls.get(called, ())
    return False
