"""How nodes and their states look and what they are called: icon, colour and word, always all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from nep_core.errors import NepError
from nep_core.places import node_folders
from nep_core.processes.manifest import Manifest, NodeCatalog
from nep_studio.run.node_board import Health, NodeStatus

from .theme.icons import UnknownIcon, icon_path
from .words import tr

TYPE_ICONS: Mapping[str, str] = {
    "sensory": "activity",
    "perceptual": "eye",
    "cognitive": "brain",
    "action": "bot",
}
OTHER_ICON = "box"

TYPE_COLOURS: Mapping[str, str] = {
    "sensory": "sensing",
    "perceptual": "logic",
    "cognitive": "control",
    "action": "robot",
}
"""The block colours (theme.block) by which types are told apart in the graph, beside their icon."""


@dataclass(frozen=True)
class StateLook:
    """An icon with a shape of its own, the name of a colour, and the word."""

    icon: str
    colour: str
    word: str


def state_look(status: NodeStatus) -> StateLook:
    """How the state of a node is shown."""
    if status.event == "connection_failed" and status.health != "frozen":
        return StateLook("unplug", "error", tr("No connection"))
    if status.event == "disconnected" and status.health == "warning":
        return StateLook("unplug", "warning", tr("Not connected"))
    if status.event == "connecting" and status.health == "starting":
        return StateLook("hourglass", "info", tr("Connecting"))
    looks: dict[Health, StateLook] = {
        "planned": StateLook("circle-dashed", "muted", tr("Not started")),
        "starting": StateLook("hourglass", "info", tr("Starting")),
        "ready": StateLook("circle-check", "success", tr("Ready")),
        "busy": StateLook("activity", "info", tr("Busy")),
        "warning": StateLook("triangle-alert", "warning", tr("Needs attention")),
        "frozen": StateLook("snowflake", "warning", tr("Does not answer")),
        "crashed": StateLook("octagon-x", "error", tr("Ended unexpectedly")),
        "stopped": StateLook("square", "muted", tr("Stopped")),
    }
    return looks[status.health]


def is_running(status: NodeStatus) -> bool:
    """Whether its process runs: a robot's node that found no robot goes on looking."""
    return status.is_there or status.event == "connection_failed"


def type_words(type_: str) -> str:
    """A node type in words, with what such a node does."""
    words = {
        "sensory": tr("Sensory node: measures"),
        "perceptual": tr("Perceptual node: recognises"),
        "cognitive": tr("Cognitive node: decides"),
        "action": tr("Action node: acts"),
    }
    return words.get(type_, tr("Another program"))


@lru_cache(maxsize=64)
def manifest_of(node: str) -> Manifest | None:
    """The manifest of "type/name"; None when there is none that can be read."""
    try:
        return NodeCatalog(node_folders()).find(node) if node else None
    except NepError:
        return None


def icon_of(node: str, type_: str) -> str:
    """The icon that a node's manifest names, else that of its type."""
    manifest = manifest_of(node)
    if manifest is not None and is_there(manifest.icon):
        return manifest.icon
    return TYPE_ICONS.get(type_, OTHER_ICON)


def is_there(icon_name: str) -> bool:
    """Whether there is such an icon: manifests of others may name any."""
    try:
        icon_path(icon_name)
    except UnknownIcon:
        return False
    return True
