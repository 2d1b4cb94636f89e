"""The addresses of this computer, in words that say which network each is of."""

from __future__ import annotations

from dataclasses import dataclass

from nep_studio.ui.words import tr

WIRELESS = ("wl", "wi-fi", "wifi", "airport")
WIRED = ("eth", "enp", "eno", "ens", "enx", "lan")


@dataclass(frozen=True)
class Place:
    """An address of this computer, and the network card that it is of."""

    address: str
    card: str = ""

    @property
    def words(self) -> str:
        """What a person chooses."""
        card = self.card.lower()
        if card.startswith(WIRELESS):
            return tr("Wi-Fi: {address}", address=self.address)
        if card.startswith(WIRED):
            return tr("Cable: {address}", address=self.address)
        return f"{self.card}: {self.address}" if self.card else self.address


def own_places() -> list[Place]:
    """Where this computer can be reached, the most likely one first."""
    import psutil

    from nodes.sensory.addresses import lan_addresses

    cards = {
        address.address: card
        for card, addresses in psutil.net_if_addrs().items()
        for address in addresses
    }
    return [Place(address, cards.get(address, "")) for address in lan_addresses()]
