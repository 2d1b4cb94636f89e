"""What every node needs to talk: publish and subscribe, the master, the launcher, robots, rules.

Enters what is true for a node of any robot, with no screen: ``wire`` (messages and frames),
``networks`` (who finds whom), ``processes`` (a node and its life), ``program`` (what decides),
``recordings`` and the command line ``cli``. No Qt, no numpy, and nothing of the studio, which is
one client among others. Other libraries than those of the wire are imported inside functions.

The public names are loaded when they are first used, so that a small node starts fast.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from nep_core.errors import NepError

    from .networks.master import Master
    from .networks.zmq_networks import Broker, BrokerNetwork, DirectNetwork, PeerNetwork
    from .processes.launcher import Launcher
    from .processes.node import Node
    from .program.behavior import Behavior, in_turn, one_of, what_went_wrong
    from .program.choices import emotion_state
    from .program.facts import (
        fact,
        is_true,
        makes_true,
        makes_untrue,
        needs,
        no_longer_true,
        now_true,
        true_while,
    )
    from .program.goals import fail_goal, goal_value
    from .program.human import (
        heard_answer,
        heard_word,
        human_state,
        is_remembered,
        remember,
        times_seen,
        until_state,
        was_seen,
    )
    from .program.kept import Kept
    from .program.messages import tell, told_value
    from .program.plans import reach, the_plan
    from .program.robot import (
        Robot,
        as_robot,
        colour_from,
        for_each_robot,
        mix_colours,
        this_robot,
    )
    from .program.tables import (
        as_table,
        change_at,
        has_key,
        name_with_largest,
        name_with_smallest,
        names_in,
        remove_key,
        set_at,
        table_of,
        value_at,
    )
    from .program.tasks import (
        at_once,
        end_actions,
        set_priority,
        stop_program,
        stop_rule,
        together,
        wait,
        wait_until,
    )
    from .program.timing import (
        date_today,
        start_timer,
        time_now,
        time_part,
        timer_seconds,
        weekday_today,
    )
    from .program.tree import (
        Check,
        CoolDown,
        Delay,
        Fallback,
        ForceFailure,
        ForceSuccess,
        Input,
        Invert,
        Output,
        Parallel,
        Repeat,
        Retry,
        Sequence,
        Step,
        SubTree,
        TimeLimit,
        WhileTrue,
        do_tree,
        fail_step,
        set_tree_value,
        tree_value,
    )
    from .program.values import (
        add_item,
        append_text,
        as_list,
        as_number,
        as_text,
        count_down,
        count_from,
        count_up,
        deviation_of,
        has_item,
        has_part,
        insert_item,
        is_at_least,
        is_at_most,
        is_less,
        is_more,
        is_same,
        item_of,
        items_between,
        join_items,
        largest_of,
        length_of,
        letter_of,
        list_with,
        mean_of,
        median_of,
        number_in,
        parts_of,
        place_in_text,
        place_of,
        random_whole,
        remove_item,
        replace_part,
        set_item,
        smallest_of,
        sorted_items,
        sum_of,
        take_item,
        title_case,
        to_nearest,
        to_power,
    )
    from .program.variables import Variables
    from .wire.pubsub import Publisher, Subscriber

_HOMES = {
    name: module
    for module, names in {
        "errors": "NepError",
        "networks.master": "Master",
        "networks.zmq_networks": "Broker BrokerNetwork DirectNetwork PeerNetwork",
        "processes.launcher": "Launcher",
        "processes.node": "Node",
        "program.behavior": "Behavior in_turn one_of what_went_wrong",
        "program.choices": "emotion_state",
        "program.facts": "fact is_true makes_true makes_untrue needs no_longer_true now_true "
        "true_while",
        "program.goals": "fail_goal goal_value",
        "program.human": "heard_answer heard_word human_state is_remembered remember times_seen "
        "until_state was_seen",
        "program.kept": "Kept",
        "program.messages": "tell told_value",
        "program.plans": "reach the_plan",
        "program.robot": "Robot as_robot colour_from for_each_robot mix_colours this_robot",
        "program.tables": "as_table change_at has_key name_with_largest "
        "name_with_smallest names_in remove_key set_at table_of value_at",
        "program.tasks": "at_once end_actions set_priority stop_program stop_rule together wait "
        "wait_until",
        "program.timing": "date_today start_timer time_now time_part timer_seconds weekday_today",
        "program.tree": "Check CoolDown Delay Fallback ForceFailure ForceSuccess Input Invert "
        "Output Parallel Repeat Retry Sequence Step SubTree TimeLimit WhileTrue "
        "do_tree fail_step set_tree_value tree_value",
        "program.values": "add_item append_text as_list as_number as_text count_down count_from "
        "count_up deviation_of "
        "has_item has_part insert_item is_at_least is_at_most is_less is_more "
        "is_same item_of items_between join_items largest_of length_of letter_of "
        "list_with mean_of median_of number_in parts_of place_in_text place_of "
        "random_whole remove_item replace_part set_item smallest_of sorted_items "
        "sum_of take_item title_case to_nearest to_power",
        "program.variables": "Variables",
        "wire.pubsub": "Publisher Subscriber",
    }.items()
    for name in names.split()
}

__all__ = ["Behavior", "Broker", "BrokerNetwork", "Check", "CoolDown", "Delay", "DirectNetwork"]
__all__ += ["Fallback", "ForceFailure", "ForceSuccess", "Input", "Invert", "Kept", "Launcher"]
__all__ += ["Master", "NepError", "Node", "Output", "Parallel", "PeerNetwork", "Publisher"]
__all__ += ["Repeat", "Retry", "Robot", "Sequence", "Step", "SubTree", "Subscriber", "TimeLimit"]
__all__ += ["Variables", "WhileTrue", "add_item", "append_text", "as_list", "as_number", "as_robot"]
__all__ += ["as_table", "as_text", "at_once", "change_at", "colour_from", "count_down"]
__all__ += ["count_from", "count_up", "date_today", "deviation_of", "do_tree", "emotion_state"]
__all__ += ["end_actions", "fact", "fail_goal", "fail_step", "for_each_robot", "goal_value"]
__all__ += ["has_item", "has_key", "has_part", "heard_answer", "heard_word", "human_state"]
__all__ += ["in_turn", "insert_item", "is_at_least", "is_at_most", "is_less", "is_more"]
__all__ += ["is_remembered", "is_same", "is_true", "item_of", "items_between", "join_items"]
__all__ += ["largest_of", "length_of", "letter_of", "list_with", "makes_true", "makes_untrue"]
__all__ += ["mean_of", "median_of", "mix_colours", "name_with_largest", "name_with_smallest"]
__all__ += ["names_in", "needs", "no_longer_true", "now_true", "number_in", "one_of", "parts_of"]
__all__ += ["place_in_text", "place_of", "random_whole", "reach", "remember", "remove_item"]
__all__ += ["remove_key", "replace_part", "set_at", "set_item", "set_priority", "set_tree_value"]
__all__ += ["smallest_of", "sorted_items", "start_timer", "stop_program", "stop_rule", "sum_of"]
__all__ += ["table_of", "take_item", "tell", "the_plan", "this_robot", "time_now", "time_part"]
__all__ += ["timer_seconds", "times_seen", "title_case", "to_nearest", "to_power", "together"]
__all__ += ["told_value", "tree_value", "true_while", "until_state", "value_at", "wait"]
__all__ += ["wait_until", "was_seen", "weekday_today", "what_went_wrong"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"nep_core has no {name}")
    return getattr(import_module(f"nep_core.{_HOMES[name]}"), name)
