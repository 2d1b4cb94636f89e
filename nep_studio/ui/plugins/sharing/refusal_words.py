"""Who was not let in, and what to do, in the words of the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.sharing import Refusal


def refusal_sentence(refusal: Refusal) -> str:
    """Who it was."""
    at = refusal.address or "?"
    match refusal.kind:
        case "own_program":
            return tr("A program of this computer has no key of this network.")
        case "unable":
            return tr(
                "The program at {address} does not know the keys of this network.", address=at
            )
        case "wrong_code":
            return tr("A computer at {address} gave a wrong code.", address=at)
        case "code_used_up":
            return tr("A computer at {address} gave three wrong codes.", address=at)
    return tr("A program at {address} has no key of this network.", address=at)


def refusal_steps(refusal: Refusal, keys: Path) -> tuple[str, ...]:
    """What to do about it."""
    match refusal.kind:
        case "own_program":
            return (
                tr("Start it from NEP Studio, which gives it the keys."),
                tr("Or start it with the variable NEP_KEYS set to {file}.", file=str(keys)),
            )
        case "unable":
            return (
                tr("Start that program anew."),
                tr("If that does not help, pair the two computers again."),
            )
        case "wrong_code" | "code_used_up":
            return (
                tr("Make a new code here, and type its six digits there."),
                tr("Do you not know that computer? Close the network."),
            )
    return (
        tr("Is it one of yours? Make a new code here, and type it there."),
        tr("If it is not yours, nothing has to be done: it stays outside."),
    )


def refusal_message(refusal: Refusal, keys: Path, show: Callable[[], object]) -> Message:
    """The message for the window; ``show`` opens the dialog."""
    return Message(
        "warning",
        tr("A computer was not let in"),
        refusal_sentence(refusal),
        refusal_steps(refusal, keys),
        answers=(Answer(tr("Show who may come in"), show),),
        outlives_project=True,
    )


# The addresses of this computer, in words that say which network each is of.

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

    from nodes.sensory.connectors.servers import lan_addresses

    cards = {
        address.address: card
        for card, addresses in psutil.net_if_addrs().items()
        for address in addresses
    }
    return [Place(address, cards.get(address, "")) for address in lan_addresses()]
