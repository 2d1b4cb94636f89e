"""Announces an opened network to the computers around, and finds those that are announced.

By zeroconf (mDNS), which many guest and school networks do not pass on: a typed address always
works, and a failure here is told in the log only.
"""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .endpoints import LAST_PORT
from .security.addresses import endpoint_at, host_of, is_ours, own_addresses

if TYPE_CHECKING:
    from zeroconf import ServiceInfo, Zeroconf

log = logging.getLogger(__name__)

SERVICE = "_nep._tcp.local."
FIND_S = 2.0
LONGEST_LABEL = 60
MOST_FOUND = 50


@dataclass(frozen=True)
class Found:
    """An opened network as it is announced; nothing of it is proven before pairing."""

    title: str
    computer: str
    network: str
    master: str
    door_port: int

    @property
    def host(self) -> str:
        """The address of the computer that opened it."""
        return host_of(self.master)


@dataclass(frozen=True)
class Announcement:
    """Announces until it is closed; without ``zeroconf`` others cannot find the network by it."""

    zeroconf: Zeroconf | None

    def close(self) -> None:
        """Take it back."""
        if self.zeroconf is not None:
            with contextlib.suppress(Exception):
                self.zeroconf.unregister_all_services()
            self.zeroconf.close()


def announce(found: Found) -> Announcement:
    """Announce a network on the address where its master is."""
    zeroconf = None
    try:
        from zeroconf import Zeroconf

        zeroconf = Zeroconf(interfaces=_usable([found.host]))
        zeroconf.register_service(_service_of(found), allow_name_change=True)
    except Exception as error:  # no multicast here, or another program holds the port
        log.warning("The network cannot be announced: %s. Type its address instead.", error)
        if zeroconf is not None:
            zeroconf.close()
        return Announcement(None)
    return Announcement(zeroconf)


def find(
    timeout_s: float = FIND_S,
    *,
    is_enough: Callable[[list[Found]], bool] = lambda found: False,
    interfaces: list[str] | None = None,
) -> list[Found]:
    """The opened networks around, after ``timeout_s`` or when ``is_enough``; never raises."""
    try:
        from zeroconf import ServiceBrowser, Zeroconf

        zeroconf = Zeroconf(interfaces=_usable(interfaces or own_addresses()))
    except Exception as error:
        log.info("networks cannot be looked for: %s", error)
        return []
    names: list[str] = []
    news = threading.Event()

    def on_change(name: str, **_rest: Any) -> None:
        if name not in names and len(names) < MOST_FOUND:
            names.append(name)
            news.set()

    found: dict[str, Found] = {}
    try:
        ServiceBrowser(zeroconf, SERVICE, handlers=[on_change])
        end_s = time.monotonic() + timeout_s
        while (left_s := end_s - time.monotonic()) > 0 and not is_enough(list(found.values())):
            news.wait(min(left_s, 0.2))
            news.clear()
            for name in [name for name in names if name not in found]:
                if time.monotonic() > end_s:
                    break
                try:
                    info = zeroconf.get_service_info(SERVICE, name, timeout=300)
                except Exception as error:  # one odd announcement must not hide the others
                    log.info("an announcement cannot be asked for: %s", error)
                    names.remove(name)
                    continue
                if info is not None and (one := _found_of(info)) is not None:
                    found[name] = one
    except Exception as error:
        log.info("looking for networks failed: %s", error)
    finally:
        zeroconf.close()
    return sorted(found.values(), key=lambda one: (one.title, one.computer, one.master))


def _usable(addresses: list[str]) -> list[str]:
    """Those where mDNS may be spoken: IPv4, of this computer; raises OSError when there is none."""
    usable = [address for address in addresses if ":" not in address and is_ours(address)]
    if not usable:
        raise OSError(f"{', '.join(addresses) or 'nothing'} is no network of this computer")
    return usable


def _service_of(found: Found) -> ServiceInfo:
    from zeroconf import ServiceInfo

    label = "".join(c if c.isalnum() or c in " -" else "-" for c in found.title)
    name = f"{label} {found.network[:6]}".encode()[:LONGEST_LABEL].decode(errors="ignore")
    return ServiceInfo(
        SERVICE,
        f"{name}.{SERVICE}",
        parsed_addresses=[found.host],
        port=int(found.master.rpartition(":")[2]),
        properties={
            "network": found.network,
            "title": found.title,
            "computer": found.computer,
            "door": str(found.door_port),
        },
        server=f"nep-{found.network[:12]}.local.",
    )


def _found_of(info: ServiceInfo) -> Found | None:
    """What an announcement says; None when it cannot be read."""
    try:
        told = {
            key.decode(): (value or b"").decode() for key, value in (info.properties or {}).items()
        }
        address = info.parsed_scoped_addresses()[0]
        door_port = int(told["door"])
        if not 0 < door_port <= LAST_PORT:
            raise ValueError(f"there is no port {door_port}")
        return Found(
            title=_shown(told["title"]),
            computer=_shown(told["computer"]),
            network=_shown(told["network"]),
            master=endpoint_at(address, info.port or 0),
            door_port=door_port,
        )
    except (LookupError, ValueError, TypeError, AttributeError) as error:
        log.info("an announcement cannot be read: %s", error)
        return None


def _shown(text: str) -> str:
    return "".join(c for c in text if c.isprintable())[:LONGEST_LABEL]
