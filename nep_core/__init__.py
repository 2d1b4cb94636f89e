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
    from .program.behavior import Behavior, in_turn, one_of
    from .program.human import (
        heard_word,
        human_state,
        is_remembered,
        remember,
        times_seen,
        until_state,
        was_seen,
    )
    from .program.kept import Kept
    from .program.robot import Robot, colour_from, mix_colours
    from .program.tasks import at_once, stop_program, stop_rule, together, wait, wait_until
    from .program.values import (
        add_item,
        append_text,
        as_list,
        as_number,
        as_text,
        count_from,
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
        "program.behavior": "Behavior in_turn one_of",
        "program.human": "heard_word human_state is_remembered remember times_seen until_state "
        "was_seen",
        "program.kept": "Kept",
        "program.robot": "Robot colour_from mix_colours",
        "program.tasks": "at_once stop_program stop_rule together wait wait_until",
        "program.values": "add_item append_text as_list as_number as_text count_from deviation_of "
        "has_item has_part insert_item is_at_least is_at_most is_less is_more is_same item_of "
        "items_between join_items largest_of length_of letter_of list_with mean_of median_of "
        "number_in parts_of place_in_text place_of random_whole remove_item replace_part set_item "
        "smallest_of sorted_items sum_of take_item title_case to_nearest to_power",
        "program.variables": "Variables",
        "wire.pubsub": "Publisher Subscriber",
    }.items()
    for name in names.split()
}

__all__ = ["Behavior", "Broker", "BrokerNetwork", "DirectNetwork", "Launcher", "Master"]
__all__ += ["NepError", "Node", "PeerNetwork", "Publisher", "Robot", "Subscriber", "at_once"]
__all__ += ["colour_from", "heard_word", "human_state", "in_turn", "is_remembered", "mix_colours"]
__all__ += ["one_of", "remember", "stop_program", "stop_rule", "times_seen", "together"]
__all__ += ["until_state", "wait", "wait_until", "was_seen"]
__all__ += ["add_item", "append_text", "as_list", "as_number", "as_text", "count_from"]
__all__ += ["deviation_of"]
__all__ += ["has_item", "has_part", "insert_item", "is_at_least", "is_at_most", "is_less"]
__all__ += ["is_more", "is_same", "item_of", "items_between", "join_items", "largest_of"]
__all__ += ["length_of", "letter_of", "list_with", "mean_of", "median_of", "number_in"]
__all__ += ["parts_of", "place_in_text", "place_of", "random_whole", "remove_item"]
__all__ += ["replace_part", "set_item", "smallest_of", "sorted_items", "sum_of", "take_item"]
__all__ += ["Kept", "Variables", "title_case", "to_nearest", "to_power"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"nep_core has no {name}")
    return getattr(import_module(f"nep_core.{_HOMES[name]}"), name)
