"""How a message lies in an MCAP file, so that Foxglove shows it and play gives back its bytes.

| encoding | in the file | schema |
|---|---|---|
| json | as it was sent | of its topic's struct, else "any object" |
| text | {"text": ...} | nep.Text |
| msgpack, bytes | as it was sent | none |

A channel is one topic of one node in one encoding; its metadata says node and encoding.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import msgspec

from nep_core.frames import Encoding
from nep_core.messages import BY_TOPIC
from nep_core.recordings.raw import RawMessage

Json = dict[str, Any]
_ENCODINGS: dict[str, Encoding] = {"json": "json", "msgpack": "msgpack"}
"""Of channels that another program wrote, by MCAP's name."""
_BYTES = "x-nep-bytes"


class Text(msgspec.Struct):
    """A text message as Foxglove shows it."""

    text: str


@dataclass(frozen=True)
class Channel:
    """What all messages of one channel have in common; ``schema`` is empty when there is none."""

    topic: str
    node: str
    encoding: Encoding
    is_text: bool = False

    @property
    def message_encoding(self) -> str:
        """The encoding by its name in MCAP."""
        if self.encoding == "json" or self.is_text:
            return "json"
        return "msgpack" if self.encoding == "msgpack" else _BYTES

    @property
    def metadata(self) -> dict[str, str]:
        """What only play needs to know."""
        return {"nep.node": self.node, "nep.encoding": self.encoding}

    @property
    def schema_name(self) -> str:
        """The name of the schema; "" when there is none."""
        if self.is_text:
            return "nep.Text"
        if self.encoding != "json":
            return ""
        kind = BY_TOPIC.get(self.topic)
        return f"nep.{kind.__name__}" if kind else "nep.Any"

    @property
    def schema(self) -> bytes:
        """The JSON schema, simple enough for Foxglove."""
        if self.is_text:
            return plain_schema(Text)
        kind = BY_TOPIC.get(self.topic)
        return plain_schema(kind) if kind else b'{"type":"object","properties":{}}'


def channel_of(message: RawMessage) -> tuple[Channel, bytes]:
    """The channel that a message belongs to, and its data there."""
    if message.encoding == "text":
        try:
            text = Text(message.payload.decode())
        except UnicodeDecodeError:  # not a text after all: it is kept as the bytes that it is
            return Channel(message.topic, message.node, "text"), message.payload
        return Channel(message.topic, message.node, "text", True), msgspec.json.encode(text)
    return Channel(message.topic, message.node, message.encoding), message.payload


def read_channel(topic: str, message_encoding: str, metadata: dict[str, str]) -> Channel | None:
    """The channel as the file tells it; None when NEP has no such encoding."""
    told = metadata.get("nep.encoding", "")
    node = metadata.get("nep.node", "")
    if told == "text":
        return Channel(topic, node, "text", message_encoding == "json")
    if told == "bytes":
        return Channel(topic, node, "bytes")
    encoding = _ENCODINGS.get(message_encoding)
    return None if encoding is None else Channel(topic, node, encoding)


def payload_of(channel: Channel, data: bytes) -> bytes:
    """The payload as it was sent; raises msgspec.MsgspecError when the data are not of its kind."""
    return msgspec.json.decode(data, type=Text).text.encode() if channel.is_text else data


def plain_schema(kind: type[Any]) -> bytes:
    """The schema of a struct without what Foxglove does not know.

    It wants an object at the top, a plain type for each field, and no lists of lists; a field
    that cannot be said so is left out (its values stay in the messages).
    """
    schema = msgspec.json.schema(kind)
    definitions: Json = schema.get("$defs", {})
    return msgspec.json.encode(_plain(schema, definitions))


def _plain(schema: Json, definitions: Json) -> Json | None:
    """One schema in plain types; None when there is no plain way to say it."""
    schema = _one_way(schema, definitions)
    kind = schema.get("type") or ("string" if _is_choice(schema) else None)
    about = {"description": schema["description"]} if "description" in schema else {}
    if kind == "object":
        fields = {
            name: plain
            for name, field in schema.get("properties", {}).items()
            if (plain := _plain(field, definitions)) is not None
        }
        named = {"title": schema["title"]} if "title" in schema else {}
        return {"type": "object", **named, **about, "properties": fields}
    if kind == "array":
        items = _plain((schema.get("prefixItems") or [schema.get("items")])[0], definitions)
        usable = items is not None and items["type"] != "array"
        return {"type": "array", "items": items} if usable else None
    if kind == "string" and "contentEncoding" in schema:
        return {"type": "string", "contentEncoding": schema["contentEncoding"]}
    return {"type": kind} if kind in ("string", "number", "integer", "boolean") else None


def _one_way(schema: Json, definitions: Json) -> Json:
    """Follow a reference; of "this or null", take this."""
    while True:
        if "$ref" in schema:
            schema = definitions[schema["$ref"].rpartition("/")[2]]
            continue
        ways = [way for way in schema.get("anyOf", []) if way.get("type") != "null"]
        if len(ways) != 1:
            return schema
        schema = ways[0]


def _is_choice(schema: Json) -> bool:
    return all(isinstance(value, str) for value in schema.get("enum", [0]))
