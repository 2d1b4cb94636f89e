"""The key expressions of a zenoh network: where frames go, and the tokens that say who is there.

Each part of a key is percent-encoded, since topics and names may hold what zenoh gives a meaning
to: ``/``, ``*``, ``$``, ``?``, ``#``. Tokens are zenoh's liveliness tokens: they end with their
program, whatever ends it.
"""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import quote, unquote

from nep_core.registry import Registration

ALL_TOKENS = "nep/alive/**"


def frames_key(topic: str, subscriber: str = "*") -> str:
    """Where the frames of ``topic`` go: to every subscriber, or to one."""
    return f"nep/frames/{_part(topic)}/{subscriber}"


def stop_key(instance: str) -> str:
    """Where a program hears that it is asked to stop."""
    return f"nep/stop/{instance}"


def node_token(node: str, instance: str, pid: int, host: str) -> str:
    """The token of a program that has the name ``node``."""
    return f"nep/alive/node/{_part(node)}/{instance}/{pid}/{_part(host or '?')}"


def node_tokens(node: str) -> str:
    """The tokens of all programs that have the name ``node``, or try to get it."""
    return f"nep/alive/node/{_part(node)}/**"


def says_token(topic: str, instance: str = "*") -> str:
    """The token of a program that publishes ``topic``."""
    return f"nep/alive/says/{_part(topic)}/{instance}"


def hears_token(topic: str, instance: str = "*", subscriber: str = "*") -> str:
    """The token of a subscriber of ``topic``."""
    return f"nep/alive/hears/{_part(topic)}/{instance}/{subscriber}"


def last_part(token: str) -> str:
    """The id with which a token ends: a publisher's instance, a subscriber's own."""
    return token.rpartition("/")[2]


def registrations_of(tokens: Iterable[str], endpoint: str) -> list[Registration]:
    """Who is there, by all their tokens; ``endpoint`` is where they are reached."""
    said = sorted([unquote(part) for part in token.split("/")[2:]] for token in tokens)
    told: dict[str, Registration] = {}
    for parts in said:
        match parts:
            case ["node", node, instance, pid, host] if pid.isdecimal():
                told[instance] = Registration(
                    instance=instance, node=node, pid=int(pid), host=host, endpoint=endpoint
                )
    for parts in said:
        match parts:
            case ["says", topic, instance] if instance in told:
                told[instance].publishes.append(topic)
            case ["hears", topic, instance, subscriber] if instance in told:
                told[instance].subscribes[subscriber] = topic
    return list(told.values())


def _part(text: str) -> str:
    return quote(text, safe="")
