"""Following who is in a zenoh network, for tools that show it."""

from __future__ import annotations

import atexit
import contextlib
import logging
import threading
from collections.abc import Iterable
from typing import TYPE_CHECKING, Self

from nep_core.master_feed import OnChange
from nep_core.over_zenoh.keys import ALL_TOKENS, registrations_of
from nep_core.over_zenoh.session import open_client, router_endpoints
from nep_core.registry import Registration

if TYPE_CHECKING:
    import zenoh

log = logging.getLogger(__name__)


class ZenohFeed:
    """Calls ``on_change``, in a thread of its own, with all registrations whenever they change.

    While no router answers the last registrations stay, as those of a master's feed do. Raises
    RouterNotFound when none answers at the beginning.
    """

    def __init__(self, on_change: OnChange, connect: Iterable[str] = ()) -> None:
        self._on_change = on_change
        self._router, *_ = routers = list(connect) or router_endpoints()
        self._session = open_client(routers)
        atexit.register(self.close)  # zenoh's threads must end before the interpreter does
        self._tokens: set[str] = set()
        self._told: list[Registration] = []
        self.is_answered = True
        self._changes = self._session.liveliness().declare_subscriber(ALL_TOKENS, history=True)
        self._thread = threading.Thread(target=self._run, name="nep-zenoh-feed", daemon=True)
        self._thread.start()

    @property
    def registrations(self) -> list[Registration]:
        """Who is there, or was when the router was last heard."""
        return self._told

    def close(self) -> None:
        """Follow no more; waits for a callback that is running, unless it is the caller."""
        self._session.close()
        atexit.unregister(self.close)
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _run(self) -> None:
        import zenoh

        with contextlib.suppress(zenoh.ZError):  # the session was closed
            for change in self._changes.handler:
                self._take_in(change)
                while (more := self._changes.try_recv()) is not None:
                    self._take_in(more)
                self.is_answered = bool(self._session.info.routers_zid())
                if self.is_answered:
                    self._told = registrations_of(self._tokens, self._router)
                self._tell()

    def _take_in(self, change: zenoh.Sample) -> None:
        import zenoh

        note = self._tokens.add if change.kind == zenoh.SampleKind.PUT else self._tokens.discard
        note(str(change.key_expr))

    def _tell(self) -> None:
        try:
            self._on_change(self.registrations)
        except Exception:
            log.exception("the callback of the feed failed")
