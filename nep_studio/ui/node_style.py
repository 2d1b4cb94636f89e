"""How nodes and their states look and what they are called: icon, colour and word, always all."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import msgspec

from nep_core.errors import NepError
from nep_core.places import node_folders
from nep_core.processes.manifest import Manifest, NodeCatalog
from nep_core.wire.frames import CANNOT_ENCODE
from nep_studio.run.node_board import Health, NodeStatus
from nep_studio.ui.network_feed import NodeSeen, TopicSeen
from nep_studio.ui.words import count_words, tr

from .theme.icons import UnknownIcon, icon_path

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


# How the network view says numbers and nodes in words.

SUMMARY_LETTERS = 160


def rate_words(rate_hz: float) -> str:
    """“25 a second”, with a decimal below ten."""
    if rate_hz >= 9.95:
        return tr("{rate} a second", rate=f"{rate_hz:,.0f}")
    if rate_hz >= 0.05:
        return tr("{rate} a second", rate=f"{rate_hz:.1f}")
    return tr("quiet")


def short_rate(rate_hz: float) -> str:
    """The rate as it stands on a line of the graph; nothing when nothing comes."""
    if rate_hz < 0.05:
        return ""
    number = f"{rate_hz:,.0f}" if rate_hz >= 9.95 else f"{rate_hz:.1f}"
    return tr("{rate}/s", rate=number)


def ago_words(moment_s: float, now_s: float | None = None) -> str:
    """How long ago a moment was (both time.time())."""
    if moment_s <= 0:
        return tr("never")
    past_s = (time.time() if now_s is None else now_s) - moment_s
    if past_s < 1.5:
        return tr("now")
    if past_s < 90:
        return tr("{seconds} s ago", seconds=round(past_s))
    return tr("{minutes} min ago", minutes=round(past_s / 60))


def names(several: tuple[str, ...]) -> str:
    """Names in a row, or that there is nobody."""
    return ", ".join(several) or tr("nobody")


def topic_words(topic: TopicSeen) -> str:
    """All about a topic, in lines: for its tool tip and for screen readers."""
    lines = [
        topic.name,
        tr("From: {names}", names=names(topic.publishers)),
        tr("To: {names}", names=names(topic.subscribers)),
        tr("Messages: {rate}, {count} so far", rate=rate_words(topic.rate_hz), count=topic.count),
        tr("Last one: {ago}", ago=ago_words(topic.last_s)),
    ]
    if topic.lost:
        lines.append(count_words(topic.lost, "1 message was lost", "{n} messages were lost"))
    if topic.last is not None:
        lines.append(one_line(topic.last))
    return "\n".join(lines)


def node_words(node: NodeSeen, type_words: str) -> str:
    """All about a node, in lines."""
    lines = [
        node.name,
        type_words,
        tr("It sends: {names}", names=names(node.publishes)),
        tr("It hears: {names}", names=names(node.hears)),
        tr("Messages: {rate}", rate=rate_words(node.rate_hz)),
    ]
    return "\n".join(line for line in lines if line)


def one_line(message: Any, letters: int = SUMMARY_LETTERS) -> str:
    """A message as the beginning of its JSON."""
    text = as_json(message)
    return text if len(text) <= letters else text[: letters - 1] + "…"


def as_json(message: Any) -> str:
    """A message as JSON on one line; bytes, which no JSON can be made of, as Python has them."""
    if isinstance(message, str):
        return message
    if isinstance(message, bytes):
        return repr(message)
    try:
        return msgspec.json.encode(message).decode()
    except CANNOT_ENCODE:  # what MessagePack has and JSON has not, or nested too deep
        return _repr(message)


def _repr(message: Any) -> str:
    try:
        return repr(message)
    except RecursionError:
        return "…"


def pretty(message: Any) -> str:
    """A message as JSON in lines; short lists stay on one."""
    if isinstance(message, str | bytes):
        return as_json(message)
    try:
        return _pretty(msgspec.to_builtins(message), "")
    except CANNOT_ENCODE:
        return as_json(message)


def _pretty(value: Any, indent: str) -> str:
    flat = msgspec.json.encode(value).decode()
    if not isinstance(value, dict | list) or not value:
        return flat
    if isinstance(value, list) and not any(isinstance(one, dict | list) for one in value):
        return flat.replace(",", ", ")
    deeper = indent + "  "
    if isinstance(value, dict):
        items = [f'{deeper}"{key}": {_pretty(one, deeper)}' for key, one in value.items()]
        return "{\n" + ",\n".join(items) + "\n" + indent + "}"
    items = [deeper + _pretty(one, deeper) for one in value]
    return "[\n" + ",\n".join(items) + "\n" + indent + "]"
