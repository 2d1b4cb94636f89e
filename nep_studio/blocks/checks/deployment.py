"""Checks of the Robots and Nodes pages against the rules: who is missing, who is there twice."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from itertools import count

from faults import Text, text_of
from nep_studio.blocks.deployment import (
    OUTSIDE_BLOCK,
    NodeEntry,
    RobotEntry,
    can_be_stopped,
    is_recognised,
    robot_entries,
)
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_gestures import own_gestures, trained_gestures
from nep_studio.blocks.procedures import DEFINE
from nep_studio.blocks.program import ALL_ROBOTS, Block, Project
from nep_studio.blocks.slots import GESTURE_STATE, why_not_name

from .diagnostic import Diagnostic, Fix, Found, found

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
    seen: set[str] = set()
    entries: list[RobotEntry | NodeEntry] = [*robots, *nodes]
    for entry in entries:
        name, block = entry.name, entry.block_id
        reason = why_not_name(name)
        if name == ALL_ROBOTS:
            reason = text_of(
                "“{all_robots}” stands for all robots, and cannot be the name of one.",
                all_robots=ALL_ROBOTS,
            )
        if reason is not None:
            page, remedy = project.page_of(block), "Give it another name."
            yield Diagnostic("error", "bad_name", page, block, reason, (remedy,))
        elif name in seen:
            yield found("same_name", project, language, block, name=name)
        seen.add(name)


def _missing_robots(language: Language, listed: set[str], uses: Uses) -> Iterator[Diagnostic]:
    for (kind, name), (block, page) in uses.items():
        if kind != "robot" or name in listed or not name.strip():
            continue
        words, robot = text_of("{name} is not on the Robots page.", name=name), name
        if name == ALL_ROBOTS:
            if listed:
                continue
            words, robot = Text("There is no robot on the Robots page."), language.profile.title
        yield Diagnostic(
            "error",
            "robot_missing",
            page,
            block,
            words,
            ("Add the robot to the Robots page.", "Or choose another robot in this block."),
            Fix("add_robot", text_of("Add {robot}", robot=robot), {"name": robot}),
        )


def _unrecognised_gestures(
    project: Project, language: Language, nodes: tuple[NodeEntry, ...], uses: Uses
) -> Iterator[Diagnostic]:
    """Gestures that nothing knows yet: for those that are known, Run adds what recognises them."""
    shipped = language.choices.get("gestures", {})
    own, trained = own_gestures(project), trained_gestures(project)
    for (kind, gesture), (block, _) in uses.items():
        if kind != "gesture" or gesture in trained or not gesture.strip():
            continue
        if gesture in own:
            title = own[gesture].title
            yield found("gesture_untrained", project, language, block, title=title)
        elif gesture not in shipped and not is_recognised(gesture, nodes, shipped, trained):
            yield found("gesture_unrecognised", project, language, block, gesture=gesture)


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
            if slot.kind.name != "choice" or project.plugged(block, key) is not None:
                continue  # what is plugged in is known, and refused, while it runs
            if language.why_not_choice(slot, value, block, key):
                continue  # what no robot has is told of by check_blocks
            table = language.table_of(slot, block, key)
            lacking = [name for name in robots if not _has(language, name, table, value)]
            if lacking:
                yield found(
                    "robot_lacks",
                    project,
                    language,
                    block.id,
                    _instead(language, block, key, table, lacking),
                    choice=language.label_of(slot, value, block, key),
                    robots=[f"{name} ({language.robots[name].title})" for name in lacking],
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
        if project.plugged(block, "robot") is not None:
            continue
        robot = str(definition.value(block, "robot"))
        if robot in virtual or (robot == ALL_ROBOTS and virtual):
            yield found("needs_real_robot", project, language, block.id)


# Checks of rules: nothing starts, two rules for the same thing, blocks under no rule.

_HEARS_BLOCK = "event.told"


def check_rules(
    project: Project, language: Language, running: Iterable[list[str]]
) -> Iterator[Diagnostic]:
    """Problems of the beginnings of the chains that become code."""
    hats = [project.blocks[chain[0]] for chain in running]
    hats = [hat for hat in hats if not hat.type.startswith(DEFINE) and hat.type != OUTSIDE_BLOCK]
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
        if hat.type == _HEARS_BLOCK:  # that several hear a message is what messages are for
            continue
        if first.setdefault(_trigger(language, hat), hat.id) != hat.id:
            yield found("same_trigger", project, language, hat.id)


# Checks of what rules say to each other: messages without a rule, rules that are not there.

_TELLS, _HEARS = re.compile(r"\btell\("), re.compile(r"\bwhen_told\(")


def check_talk(
    project: Project, language: Language, running: Iterable[list[str]], uses: Uses
) -> Iterator[Diagnostic]:
    """Messages that nobody hears or tells, and stopped rules that are not there.

    What own Python tells and hears is not known.
    """
    named = {kind: {n: use for (k, n), use in uses.items() if k == kind} for kind in _TALK}
    if not any(named.values()):
        return
    blocks = [block for chain in running for block in project.within(chain, enabled=True)]
    code = "\n".join(str(b.fields["code"]) for b in blocks if "code" in b.fields)
    for message, (block, _) in named["message"].items():
        if message not in named["heard"] and message.strip() and not _HEARS.search(code):
            yield found("unheard_message", project, language, block, message=message)
    for message, (block, _) in named["heard"].items():
        if message not in named["message"] and message.strip() and not _TELLS.search(code):
            yield found("untold_message", project, language, block, message=message)
    for hat, (block, _) in named["rule"].items():
        if hat and not can_be_stopped(project, language, hat):
            yield found("unknown_rule", project, language, block)


_TALK = ("message", "heard", "rule")

GOALS = frozenset({"goal.goal", "goal.goal_when", "goal.goal_asked"})
OF_GOAL = "goal.when_goal"
NAMING = frozenset({OF_GOAL, "goal.pursue", "goal.is_pursued", "goal.give_up"})
"""The blocks that name a goal."""
INSIDE = frozenset({"goal.value", "goal.fail"})
"""The blocks that speak of the goal that is pursued."""


def check_goals(
    project: Project, language: Language, running: Sequence[list[str]]
) -> Iterator[Diagnostic]:
    """Goals of one name, blocks that name one that is not there, and what is in no goal."""
    names: dict[str, str] = {}
    hats = [hat for chain in running if (hat := project.blocks[chain[0]]).type in GOALS]
    taken = {_goal_name(language, hat) for hat in hats}
    for hat in hats:
        name = _goal_name(language, hat)
        if names.setdefault(name, hat.id) != hat.id:
            free = next(n for number in count(2) if (n := f"{name} {number}") not in taken)
            fix = _name_it(hat, free)
            yield found("same_goal", project, language, hat.id, fix, name=name)
    if not any(block.type in NAMING | INSIDE for block in project.blocks.values()):
        return
    for chain in running:
        hat_type = project.blocks[chain[0]].type
        is_goal = hat_type in GOALS or hat_type == OF_GOAL or hat_type.startswith(DEFINE)
        for block in project.within(chain, enabled=True):
            if block.type in NAMING and "name" not in block.inputs:
                yield from _unknown_goal(project, language, block, names)
            elif block.type in INSIDE and not is_goal:
                yield found("outside_goal", project, language, block.id)


def goal_names(project: Project, language: Language) -> list[str]:
    """What the goals of a project are called, each once."""
    goals = (block for block in project.blocks.values() if block.type in GOALS)
    return sorted({name for goal in goals if (name := _goal_name(language, goal))})


def _goal_name(language: Language, block: Block) -> str:
    return str(language.definitions[block.type].value(block, "name"))


def _unknown_goal(
    project: Project, language: Language, block: Block, goals: Mapping[str, str]
) -> Iterator[Diagnostic]:
    name = _goal_name(language, block)
    if name in goals:
        return
    folded = {goal.casefold().strip(): goal for goal in goals}
    near = get_close_matches(name.casefold().strip(), folded, 1)
    chosen = folded[near[0]] if near else next(iter(goals)) if len(goals) == 1 else ""
    offered = _name_it(block, chosen) if chosen else None
    yield found("unknown_goal", project, language, block.id, offered, name=name)


def _name_it(block: Block, name: str) -> Fix:
    label = text_of("Choose “{choice}”", choice=name)
    return Fix("choose", label, {"block": block.id, "slot": "name", "value": name})


# Checks of behaviour trees: two of one name, and names of trees that are not there.

TREE = "tree.tree"
OF_TREE = frozenset({"tree.sub_tree", "tree.do", "tree.succeeds"})


def check_trees(project: Project, language: Language, running: Iterable[list[str]]) -> Found:
    """Problems of the names of trees; ``running`` are the chains that become code."""
    trees, named = dict[str, str](), list[Block]()
    for chain in running:
        hat = project.blocks[chain[0]]
        if hat.type == TREE:
            name = _name(language, hat)
            if trees.setdefault(name, hat.id) != hat.id:
                named.append(hat)
        for block in project.within(chain, enabled=True):
            yield None
            if block.type in OF_TREE:
                named.append(block)
    for block in named:
        yield from _wrong_name(project, language, block, trees)


def _wrong_name(
    project: Project, language: Language, block: Block, trees: dict[str, str]
) -> Iterator[Diagnostic]:
    name = _name(language, block)
    if block.type == TREE:
        free = next(n for number in count(2) if (n := f"{name} {number}") not in trees)
        yield found("same_tree", project, language, block.id, _name_it(block, free), name=name)
    elif name not in trees:
        folded = {tree.casefold().strip(): tree for tree in trees}
        near = get_close_matches(name.casefold().strip(), folded, 1)
        chosen = folded[near[0]] if near else next(iter(trees)) if len(trees) == 1 else ""
        fix = _name_it(block, chosen) if chosen else None
        yield found("unknown_tree", project, language, block.id, fix, name=name)


def _name(language: Language, block: Block) -> str:
    return str(language.definitions[block.type].value(block, "name"))


def _trigger(language: Language, hat: Block) -> str:
    """What a rule waits for; a gesture is the human state that its node tells.

    What a state of the program waits for is that of this state alone.
    """
    definition = language.definitions[hat.type]
    is_of_state = any(slot.kind.name == "mode" for slot in definition.slots.values())
    for slot in () if is_of_state else definition.slots.values():
        if slot.kind.name == "gesture":
            return f"{GESTURE_STATE}{definition.value(hat, slot.name)}"
        if slot.kind.name == "state":
            # goals that begin alike are told from each other, and from rules, by their name
            goal = f" goal {definition.value(hat, 'name')}" if "name" in definition.slots else ""
            return f"{definition.value(hat, slot.name)}{goal}"
    values = [
        f"block {hat.inputs[key]}" if key in hat.inputs else str(definition.value(hat, key))
        for key, _ in definition.keys(hat.groups)
    ]
    return f"block {hat.type} {values}"
