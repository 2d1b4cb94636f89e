"""How the network view says numbers and nodes in words."""

from __future__ import annotations

import time
from typing import Any

import msgspec

from nep_studio.ui.network_feed import NodeSeen, TopicSeen
from nep_studio.ui.words import count_words, tr

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
    return msgspec.json.encode(message).decode()


def pretty(message: Any) -> str:
    """A message as JSON in lines; short lists stay on one."""
    if isinstance(message, str | bytes):
        return as_json(message)
    return _pretty(msgspec.to_builtins(message), "")


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
