"""Python names for what people name: robots, variables, rules; always legal, never taken."""

from __future__ import annotations

import builtins
import keyword
import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache

from nep_studio.blocks.shared_objects import SHARED_OBJECTS

VALUES = frozenset(
    {
        *(
            "add_item",
            "append_text",
            "as_list",
            "as_number",
            "as_table",
            "as_robot",
            "as_text",
            "change_at",
            "count_down",
            "count_from",
            "count_up",
            "deviation_of",
        ),
        *("has_item", "has_key", "has_part", "insert_item", "is_at_least", "is_at_most", "is_less"),
        *("is_more", "is_same", "item_of", "items_between", "join_items", "largest_of"),
        *("length_of", "letter_of", "list_with", "mean_of", "median_of", "number_in"),
        *("name_with_largest", "name_with_smallest", "names_in"),
        *("parts_of", "place_in_text", "place_of", "random_whole", "remove_item", "remove_key"),
        *("replace_part", "set_at", "set_item", "smallest_of", "sorted_items", "sum_of"),
        *("table_of", "take_item", "title_case", "to_nearest", "to_power", "value_at"),
    }
)
"""What nep_core does with values where plain Python does something else."""

TREE = frozenset(
    {
        *("Check", "CoolDown", "Delay", "Fallback", "ForceFailure", "ForceSuccess", "Input"),
        *("Invert", "Output", "Parallel", "Repeat", "Retry", "Sequence", "Step", "SubTree"),
        *("TimeLimit", "WhileTrue"),
    }
)
"""The parts of behaviour trees."""

API = VALUES | frozenset(
    {
        *TREE,
        "Behavior",
        "Kept",
        "Launcher",
        "Robot",
        "Variables",
        "at_once",
        "colour_from",
        "date_today",
        "end_actions",
        "fail_goal",
        "for_each_robot",
        "goal_value",
        "fact",
        "do_tree",
        "fail_step",
        "emotion_state",
        "heard_answer",
        "heard_word",
        "human_state",
        "in_turn",
        "is_remembered",
        "is_true",
        "makes_true",
        "makes_untrue",
        "mix_colours",
        "needs",
        "no_longer_true",
        "now_true",
        "one_of",
        "reach",
        "remember",
        "start_timer",
        "set_priority",
        "set_tree_value",
        "stop_program",
        "stop_rule",
        "tell",
        "time_now",
        "time_part",
        "timer_seconds",
        "times_seen",
        "together",
        "told_value",
        "the_plan",
        "this_robot",
        "true_while",
        "tree_value",
        "until_state",
        "wait",
        "wait_until",
        "was_seen",
        "weekday_today",
        "what_went_wrong",
    }
)
"""What a generated program may import from nep_core under its own name."""

CLASSES = {"program": "Variables", "kept": "Kept"}
"""Of which class of nep_core the objects are that variables are attributes of."""

AT_ONCE = "at_once"
"""What a line is done ``with`` that reads and sets what others set at the same time."""

FUNCTIONS = frozenset(name for name in API if name[0].islower() and name != AT_ONCE)
"""The functions of nep_core that a block may call."""

MODULES = frozenset({"math", "random", "statistics"})
"""The modules of the standard library that a program may import."""

RESERVED = frozenset(
    {
        *keyword.kwlist,
        *keyword.softkwlist,
        *(name for name in dir(builtins) if not name.startswith("_")),
        *("exit", "quit", "copyright", "credits", "license", "help"),
        *API,
        *("behavior", "launcher", "answer", "expected_words"),
        *SHARED_OBJECTS,
        *MODULES,
    }
)
"""Names that keep their meaning in a generated program."""

_LONGEST = 40


@lru_cache(maxsize=4096)  # asked for each rule at every edit
def python_name(text: str, fallback: str) -> str:
    """Turn any text into an identifier, as near to it as can be: “größe (cm)” to größe_cm.

    Python reads identifiers in NFKC form, so that the result is in that form. ``fallback`` is
    used where nothing is left, and stands before what cannot begin a name. What is a name already
    stays it, so that Python of a person keeps the names in it; but for those such as __name__.
    """
    normal = unicodedata.normalize("NFKC", text)
    is_special = normal.startswith("__") and normal.endswith("__")
    is_same = unicodedata.normalize("NFKC", normal) == normal
    if normal.isidentifier() and normal.strip("_") and is_same and not is_special:
        return normal
    kept = "".join(c if f"a{c}".isidentifier() else "_" for c in normal)
    name = re.sub("_+", "_", kept)[:_LONGEST].strip("_")
    if name and not name.isidentifier():
        name = f"{fallback}_{name}"
    is_safe = name.isidentifier() and unicodedata.normalize("NFKC", name) == name
    return name if is_safe else fallback


class NameTable:
    """Names given so far in one generated file."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = set(taken)
        self._next_numbers: dict[str, int] = {}

    def give(self, text: str, fallback: str) -> str:
        """A name for ``text`` that nothing else in the file has."""
        name = python_name(text, fallback)
        if name in RESERVED:
            name += "_"
        unique, number = name, self._next_numbers.get(name, 2)
        while unique in self._taken or unique in RESERVED:
            unique, number = f"{name.rstrip('_')}_{number}", number + 1
        self._next_numbers[name] = number  # a thousand rules for one gesture stay fast
        self._taken.add(unique)
        return unique


@dataclass(frozen=True, slots=True)
class ProgramNames:
    """The Python names in a program, by the names of robots and the ids of all else.

    A variable of the whole program is called as ``program.score``. ``outside`` are the names that
    own Python outside of all functions makes, ``locals`` those of variables by themselves.
    """

    robots: dict[str, str]
    variables: dict[str, str]
    procedures: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, str] = field(default_factory=dict)
    outside: frozenset[str] = frozenset()
    locals: frozenset[str] = frozenset()

    def taken(self) -> set[str]:
        """All these names."""
        named = (self.robots, self.variables, self.procedures, self.parameters)
        every = {name for names in named for name in names.values()}
        return {name.rpartition(".")[2] for name in every} | self.outside
