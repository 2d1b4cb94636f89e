"""What is seen of a network at one moment: its nodes and topics, with what goes through."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Route = tuple[str, str]
"""The name of a node and a topic that it publishes."""


@dataclass(frozen=True)
class Use:
    """What a process and those that it started take: percent of one core, bytes of memory."""

    cpu_percent: float
    memory_bytes: int


@dataclass(frozen=True)
class Flow:
    """Messages of a node on a topic: how many a second now, how many since it is watched."""

    rate_hz: float = 0.0
    count: int = 0


@dataclass(frozen=True)
class NodeSeen:
    """A node that is registered; ``use`` is None for one on another computer."""

    name: str
    publishes: tuple[str, ...] = ()
    hears: tuple[str, ...] = ()
    pid: int = 0
    use: Use | None = None
    rate_hz: float = 0.0


@dataclass(frozen=True)
class TopicSeen:
    """A topic; ``lost`` counts what was sent but did not arrive in the studio.

    ``last_s`` is when its last message was sent (time.time()), 0 when none was heard yet.
    """

    name: str
    publishers: tuple[str, ...] = ()
    subscribers: tuple[str, ...] = ()
    rate_hz: float = 0.0
    count: int = 0
    lost: int = 0
    last_s: float = 0.0
    last: Any = None


@dataclass(frozen=True)
class Seen:
    """A whole network, by names; ``is_up`` is False when there is none."""

    is_up: bool = False
    nodes: Mapping[str, NodeSeen] = field(default_factory=dict)
    topics: Mapping[str, TopicSeen] = field(default_factory=dict)
    flows: Mapping[Route, Flow] = field(default_factory=dict)
