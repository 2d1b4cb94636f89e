"""The graph of what is seen of a network: which of it is shown, and of which type nodes are."""

from __future__ import annotations

from collections.abc import Mapping

from nep_core.messages import NODE_STATE
from nep_studio.local_network import STUDIO

from .graph_layout import Graph
from .seen import Seen


def graph_of(seen: Seen, types: Mapping[str, str], *, is_whole: bool = False) -> Graph:
    """The graph to show; ``types`` are those of the nodes that have said theirs.

    Unless it ``is_whole`` the studio itself is left out, and ``/node_state``, which every node
    publishes: lines to both would cover all others.
    """
    nodes = {name: types.get(name, "") for name in sorted(seen.nodes) if is_whole or name != STUDIO}
    topics = [name for name in sorted(seen.topics) if is_whole or name != NODE_STATE]
    says = [
        (node, topic) for topic in topics for node in seen.topics[topic].publishers if node in nodes
    ]
    hears = [
        (node, topic)
        for topic in topics
        for node in seen.topics[topic].subscribers
        if node in nodes
    ]
    used = {topic for _, topic in (*says, *hears)}
    shown = tuple(topic for topic in topics if is_whole or topic in used)
    return Graph(nodes, shown, tuple(says), tuple(hears))
