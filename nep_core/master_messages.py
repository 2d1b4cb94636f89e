"""What programs and the master say to each other: one JSON object a frame, told apart by "do"."""

from __future__ import annotations

import msgspec

from nep_core.registry import Publishing, Registration


class Register(msgspec.Struct, tag="register", tag_field="do", kw_only=True):
    """Here I am, with all my topics; ``version`` counts my changes."""

    version: int
    registration: Registration


class Alive(msgspec.Struct, tag="alive", tag_field="do", kw_only=True):
    """My heartbeat, every half second."""

    instance: str


class Bye(msgspec.Struct, tag="bye", tag_field="do", kw_only=True):
    """I leave."""

    instance: str


class List(msgspec.Struct, tag="list", tag_field="do"):
    """Who is there?"""


Request = Register | Alive | Bye | List


class Registered(msgspec.Struct, tag="registered", tag_field="do", kw_only=True):
    """The answer to Register: who is already there for my topics."""

    epoch: str
    version: int
    publishers: dict[str, list[Publishing]]
    subscribers: dict[str, list[str]]


class Refused(msgspec.Struct, tag="refused", tag_field="do", kw_only=True):
    """The answer to a Register that cannot be: the name is taken."""

    version: int
    sentence: str
    checklist: list[str]


class Heard(msgspec.Struct, tag="heard", tag_field="do", kw_only=True):
    """The answer to Alive; ``known`` is False when I should register again."""

    epoch: str
    known: bool


class Publishers(msgspec.Struct, tag="publishers", tag_field="do", kw_only=True):
    """The publishers of a topic that I subscribe to have changed: this is the whole list."""

    topic: str
    publishers: list[Publishing]


class Listing(msgspec.Struct, tag="listing", tag_field="do", kw_only=True):
    """The answer to List: the master's process, and everything that is registered."""

    epoch: str
    pid: int
    registrations: list[Registration]


class Mistake(msgspec.Struct, tag="error", tag_field="do", kw_only=True):
    """The answer to a request that cannot be read."""

    sentence: str


Answer = Registered | Refused | Heard | Publishers | Listing | Mistake

decode_request = msgspec.json.Decoder(Request).decode
decode_answer = msgspec.json.Decoder(Answer).decode
encode = msgspec.json.Encoder().encode
