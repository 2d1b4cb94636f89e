"""The phone page as a way that a phone's sensors reach the node."""

from __future__ import annotations

from pathlib import Path

from nodes.sensory.phone_page.server import PhonePage
from nodes.sensory.ways.way import Arrived, Settings


class PhonePageWay:
    """Serves the page while the node runs; ``folder`` is where the certificate is kept."""

    def __init__(self, settings: Settings, folder: Path | None = None) -> None:
        self._settings = settings
        self.page = PhonePage(settings, folder)

    @property
    def where(self) -> str:
        """What the node is ready for; the link is told only where nobody else knows its token."""
        is_known = bool(self._settings.token)
        told = f"its page on port {self.page.port}" if is_known else self.page.urls[0]
        return f"waits for a phone that opens {told} ({self._settings.who})"

    @property
    def missing(self) -> str:
        """What to check when no phone has come."""
        if self._settings.listen_on == "this computer":
            return (
                "No phone has come yet. Only this computer is let in: for a phone, set "
                "“listen on” to network."
            )
        return (
            "No phone has come yet. Is it in the same Wi-Fi as this computer, was the warning of "
            "the browser accepted, and does this computer's firewall let it in?"
        )

    @property
    def hand(self) -> str:
        """Where the phone is, as chosen on it: left, right or hand; empty: not known yet."""
        return self.page.hand

    def open(self) -> None:
        """Serve the page. Raises PortTaken, NodeStartError."""
        self.page.start()

    def readings(self, until_s: float) -> list[Arrived]:
        """What the phone has sent up to then."""
        return self.page.take(until_s)

    def close(self) -> None:
        """Serve it no more."""
        self.page.stop()
