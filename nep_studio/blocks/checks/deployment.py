"""Checks of the Robots and Nodes pages against the rules: who is missing, who is there twice."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from faults import Text, text_of
from nep_studio.blocks.definitions import Definition, Slot
from nep_studio.blocks.deployment import (
    NodeEntry,
    is_recognised,
    robot_entries,
)
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_gestures import own_gestures, trained_gestures
from nep_studio.blocks.procedures import DEFINE
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.slots import GESTURE_STATE, why_not_name
from nep_studio.blocks.text import sentence

from .diagnostic import Diagnostic, Fix, Found

Uses = Mapping[tuple[str, str], tuple[str, str]]
"""The first block that names a robot or a gesture, and its page, by kind and name."""


def check_deployment(
    project: Project, language: Language, nodes: tuple[NodeEntry, ...], uses: Uses
) -> Iterator[Diagnostic]:
    """Problems of which robots and nodes there are; ``uses`` are those that rules name."""
    robots = robot_entries(project, language)
    yield from _missing_robots(language, {entry.name for entry in robots}, uses)
    yield from _unrecognised_gestures(project, language, nodes, uses)
    # robots are nodes too, so that all their names must differ
    yield from _wrong_names(
        [
            *(("robots", entry.name, entry.block_id) for entry in robots),
            *(("nodes", entry.name, entry.block_id) for entry in nodes),
        ]
    )


def _missing_robots(language: Language, listed: set[str], uses: Uses) -> Iterator[Diagnostic]:
    for (kind, name), (block, page) in uses.items():
        if kind != "robot":
            continue
        if name == ALL_ROBOTS and not listed:
            sentence = Text("There is no robot on the Robots page.")
        elif name == ALL_ROBOTS or name in listed or not name.strip():
            continue
        else:
            sentence = text_of("{name} is not on the Robots page.", name=name)
        robot = language.profile.title if name == ALL_ROBOTS else name
        yield Diagnostic(
            "error",
            "robot_missing",
            page,
            block,
            sentence,
            ("Add the robot to the Robots page.", "Or choose another robot in this block."),
            Fix("add_robot", text_of("Add {robot}", robot=robot), {"name": robot}),
        )


def _unrecognised_gestures(
    project: Project, language: Language, nodes: tuple[NodeEntry, ...], uses: Uses
) -> Iterator[Diagnostic]:
    shipped = language.choices.get("gestures", {})
    own, trained = own_gestures(project), trained_gestures(project)
    for (kind, gesture), (block, page) in uses.items():
        if kind != "gesture":
            continue
        if gesture in own and gesture not in trained:
            yield _untrained(own[gesture].title, page, block)
        elif gesture in trained or not gesture.strip():
            continue  # the project's own recogniser is started with the program
        elif not is_recognised(gesture, nodes, shipped, trained):
            yield Diagnostic(
                "warning",
                "gesture_unrecognised",
                page,
                block,
                text_of(
                    "No node of the Nodes page recognises the gesture “{gesture}”.", gesture=gesture
                ),
                ("Launch a gesture node for it on the Nodes page.",),
                Fix(
                    "add_gesture_node",
                    text_of("Recognise “{gesture}”", gesture=gesture),
                    {"gesture": gesture},
                ),
            )


def _untrained(title: str, page: str, block: str) -> Diagnostic:
    return Diagnostic(
        "warning",
        "gesture_untrained",
        page,
        block,
        text_of("The gesture “{title}” is not learned yet.", title=title),
        ("Record it five times in the panel Gestures.", "Press Train there."),
    )


def _wrong_names(named: Iterable[tuple[str, str, str]]) -> Iterator[Diagnostic]:
    """The pages, names and blocks of robots and nodes whose names are no good."""
    seen: set[str] = set()
    for page, name, block in named:
        reason = why_not_name(name)
        if name == ALL_ROBOTS:
            reason = text_of(
                "“{all_robots}” stands for all robots, and cannot be the name of one.",
                all_robots=ALL_ROBOTS,
            )
        if reason is not None:
            yield Diagnostic("error", "bad_name", page, block, reason, ("Give it another name.",))
        elif name in seen:
            yield Diagnostic(
                "error",
                "same_name",
                page,
                block,
                text_of("Two robots or nodes are called “{name}”.", name=name),
                ("Give each a name of its own.",),
            )
        seen.add(name)


# Checks of what a block asks of its robot: each kind of robot has its own postures and animations.


def check_abilities(project: Project, language: Language, chain: list[str]) -> Found:
    """Choices that the robot of a block, or one of all robots, does not have."""
    for block in project.within(chain, enabled=True):
        yield None
        robot = language.robot_of(block)
        asked = list(language.robots) if robot == ALL_ROBOTS else [robot]
        robots = [name for name in asked if name in language.robots]
        if not robots:
            continue
        definition = language.definitions[block.type]
        for key, slot in definition.keys(block.groups):
            value = definition.value(block, key)
            if slot.kind.name != "choice" or language.why_not_choice(slot, value, block, key):
                continue  # what no robot has is told of by check_blocks
            table = language.table_of(slot, block, key)
            lacking = [name for name in robots if not _has(language, name, table, value)]
            if lacking:
                yield _lacks(project, language, block, (key, slot), lacking)


def _lacks(
    project: Project,
    language: Language,
    block: Block,
    place: tuple[str, Slot],
    lacking: list[str],
) -> Diagnostic:
    key, slot = place
    value = language.definitions[block.type].value(block, key)
    return Diagnostic(
        "error",
        "robot_lacks",
        project.page_of(block.id),
        block.id,
        text_of(
            "“{block}”: “{choice}” is not there for {robots}.",
            block=sentence(project, language, block.id),
            choice=language.label_of(slot, value, block, key),
            robots=[f"{name} ({language.robots[name].title})" for name in lacking],
        ),
        ("Choose another one.", "Or choose another robot in this block."),
        _instead(language, block, key, language.table_of(slot, block, key), lacking),
    )


def _has(language: Language, robot: str, table: str, value: object) -> bool:
    offered = language.robots[robot].tables.get(table)
    return not offered or value in offered


def _instead(
    language: Language, block: Block, key: str, table: str, lacking: list[str]
) -> Fix | None:
    """Let a robot do it that can; where there is none, choose what all of these can."""
    definition = language.definitions[block.type]
    value = definition.value(block, key)
    able = [name for name in language.robots if _has(language, name, table, value)]
    if able and len(lacking) == 1:
        label = text_of("Let {robot} do it", robot=able[0])
        return Fix("let_robot", label, {"block": block.id, "robot": able[0]})
    shared = [
        choice
        for choice in language.choices.get(table, ())
        if all(_has(language, name, table, choice) for name in lacking)
    ]
    if not shared:
        return None
    usual = definition.defaults.get(key.partition(".")[0])
    choice = str(usual) if usual in shared else shared[0]
    label = text_of("Choose “{choice}”", choice=language.choices[table][choice])
    return Fix("choose", label, {"block": block.id, "slot": key, "value": choice})


# Checks of what the robot on the screen cannot do: it has no camera and no files.


def check_real_robots(project: Project, language: Language, chain: list[str]) -> Found:
    """Blocks that need a real robot, and name a virtual one."""
    if project.blocks[chain[0]].type.startswith(DEFINE):
        return  # an own block: the rule that calls it says what it is for
    virtual = {e.name for e in robot_entries(project, language) if e.driver == "virtual"}
    for block in project.within(chain, enabled=True):
        yield None
        definition = language.definitions.get(block.type)
        if definition is None or "needs_real_robot" not in definition.flags:
            continue
        robot = str(definition.value(block, "robot"))
        if robot not in virtual and not (robot == ALL_ROBOTS and virtual):
            continue
        yield Diagnostic(
            "warning",
            "needs_real_robot",
            "behaviour",
            block.id,
            text_of(
                "“{block}” needs a real robot: the program would stop here with the robot on "
                "this screen.",
                block=sentence(project, language, block.id),
            ),
            (
                "Give the robot the address of a real one, on the page Robots.",
                "Or switch this block off for now.",
            ),
        )


# Checks of rules: nothing starts, two rules for the same thing, blocks under no rule.


def check_rules(
    project: Project, language: Language, running: Iterable[list[str]]
) -> Iterator[Diagnostic]:
    """Problems of the beginnings of the chains that become code."""
    hats = [project.blocks[chain[0]] for chain in running]
    hats = [hat for hat in hats if not hat.type.startswith(DEFINE)]
    if not hats:
        yield Diagnostic(
            "error",
            "no_rule",
            "behaviour",
            "",
            "Nothing starts this program: it has no “when” block.",
            ("Drag a “when” block from the palette onto the page Behaviour.",),
        )
    first: dict[str, str] = {}
    for hat in hats:
        if first.setdefault(_trigger(language, hat), hat.id) != hat.id:
            yield Diagnostic(
                "warning",
                "same_trigger",
                project.page_of(hat.id),
                hat.id,
                text_of(
                    "Two rules begin with “{block}”. Both will run.",
                    block=sentence(project, language, hat.id),
                ),
                ("Put the blocks of both rules under one.", "Or let one wait for something else."),
            )


def _trigger(language: Language, hat: Block) -> str:
    """What a rule waits for; a gesture is the human state that its node tells."""
    definition = language.definitions[hat.type]
    for slot in definition.slots.values():
        if slot.kind.name == "gesture":
            return f"{GESTURE_STATE}{definition.value(hat, slot.name)}"
        if slot.kind.name == "state":
            return f"{definition.value(hat, slot.name)}{_goal_name(definition, hat)}"
    values = [str(definition.value(hat, key)) for key, _ in definition.keys(hat.groups)]
    return f"block {hat.type} {values}"


def _goal_name(definition: Definition, hat: Block) -> str:
    """What tells goals that begin alike from each other, and from rules: their name."""
    return f" goal {definition.value(hat, 'name')}" if "name" in definition.slots else ""
