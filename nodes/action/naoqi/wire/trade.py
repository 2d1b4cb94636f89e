"""Objects that go over a connection within messages, in both directions."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from .metaobject import MetaObject
from .remote import RemoteObject
from .service import description_of

if TYPE_CHECKING:
    from .peer import Peer


class Trade:
    """Gives and takes the objects in the messages of one service on one connection."""

    __slots__ = ("_peer", "_service")

    def __init__(self, peer: Peer, service: int) -> None:
        self._peer = peer
        self._service = service

    def give_object(self, value: Any) -> tuple[bytes, int, int]:
        """Describe an object that the other side can call now. Raises TypeError."""
        if isinstance(value, RemoteObject):
            raise TypeError("an object that is on a robot already")
        number = self._peer.add_object(value, self._service)
        return description_of(type(value)).meta.encoded, self._service, number

    def take_object(self, meta: MetaObject, service: int, number: int) -> RemoteObject:
        """Return the object of the other side that a message refers to; let it go when unused."""
        remote = RemoteObject(self._peer, meta, service, number)
        weakref.finalize(remote, self._peer.note_dropped, service, number).atexit = False
        return remote
