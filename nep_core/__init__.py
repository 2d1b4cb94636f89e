"""What every node needs to talk: publish and subscribe, the master, the launcher, robots, rules.

The public names are loaded when they are first used, so that a small node starts fast.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from nep_core.behavior import Behavior
    from nep_core.broker import Broker
    from nep_core.broker_network import BrokerNetwork
    from nep_core.choosing import in_turn, one_of
    from nep_core.colours import colour_from, mix_colours
    from nep_core.errors import NepError
    from nep_core.human import (
        heard_word,
        human_state,
        is_remembered,
        remember,
        times_seen,
        until_state,
        was_seen,
    )
    from nep_core.launcher import Launcher
    from nep_core.master import Master
    from nep_core.node import Node
    from nep_core.p2p import PeerNetwork
    from nep_core.pubsub import Publisher, Subscriber
    from nep_core.robot import Robot
    from nep_core.tasks import stop_program, together, wait, wait_until
    from nep_core.zmq_network import DirectNetwork

_HOMES = {
    "Behavior": "behavior",
    "Broker": "broker",
    "BrokerNetwork": "broker_network",
    "DirectNetwork": "zmq_network",
    "Launcher": "launcher",
    "Master": "master",
    "NepError": "errors",
    "Node": "node",
    "PeerNetwork": "p2p",
    "Publisher": "pubsub",
    "Robot": "robot",
    "Subscriber": "pubsub",
    "colour_from": "colours",
    "heard_word": "human",
    "human_state": "human",
    "in_turn": "choosing",
    "is_remembered": "human",
    "mix_colours": "colours",
    "one_of": "choosing",
    "remember": "human",
    "stop_program": "tasks",
    "times_seen": "human",
    "together": "tasks",
    "until_state": "human",
    "was_seen": "human",
    "wait": "tasks",
    "wait_until": "tasks",
}

__all__ = [
    "Behavior",
    "Broker",
    "BrokerNetwork",
    "DirectNetwork",
    "Launcher",
    "Master",
    "NepError",
    "Node",
    "PeerNetwork",
    "Publisher",
    "Robot",
    "Subscriber",
    "colour_from",
    "heard_word",
    "human_state",
    "in_turn",
    "is_remembered",
    "mix_colours",
    "one_of",
    "remember",
    "stop_program",
    "times_seen",
    "together",
    "until_state",
    "wait",
    "wait_until",
    "was_seen",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"nep_core has no {name}")
    return getattr(import_module(f"nep_core.{_HOMES[name]}"), name)
