"""A zenoh router in this process: programs of one site connect to it, and it to other sites."""

from __future__ import annotations

import atexit
from collections.abc import Iterable

from nep_core.over_zenoh.session import (
    check_private,
    check_zenoh_endpoint,
    open_router,
    router_endpoints,
)


class ZenohRouter:
    """Passes messages on between its programs and to the routers that it knows of.

    ``listen``: its endpoints (default: NEP_ZENOH); ``connect``: routers of other sites, which it
    looks for as long as it lives. Endpoints that anybody could read must be allowed by
    ``is_private``. Raises PortTaken, NetworkError.
    """

    def __init__(
        self,
        listen: Iterable[str] = (),
        connect: Iterable[str] = (),
        *,
        is_private: bool = False,
    ) -> None:
        places = [check_zenoh_endpoint(one) for one in listen] or router_endpoints()
        if not is_private:
            for place in places:
                check_private(place)
        self._session = open_router(places, [check_zenoh_endpoint(one) for one in connect])
        self._told_sites = 0
        self.endpoint = " and ".join(places)
        atexit.register(self.close)  # zenoh's threads must end before the interpreter does

    def sites(self) -> int:
        """How many other routers it is connected with now."""
        return len(self._session.info.routers_zid())

    def take_warning(self) -> str:
        """How many other sites are connected, if that has changed since the last time; or ""."""
        before, self._told_sites = self._told_sites, self.sites()
        changed = self._told_sites != before
        return f"Connected with other sites: {self._told_sites}." if changed else ""

    def close(self) -> None:
        """Stop passing messages on."""
        self._session.close()
        atexit.unregister(self.close)
