"""Who takes part in the network, in a few words for a panel."""

from __future__ import annotations

from dataclasses import dataclass

from nep_core.security.keys import Keys
from nep_studio.sharing import Sharing
from nep_studio.ui.words import count_words, tr

from .refusal_words import refusal_sentence


@dataclass(frozen=True)
class SharingTold:
    """Nothing in ``words`` while only this computer takes part."""

    words: str = ""
    more: str = ""
    icon_name: str = ""


def told_of(sharing: Sharing) -> SharingTold:
    """How the network is now."""
    if sharing.joined is not None:
        return SharingTold(joined_words(sharing.joined), "", "monitor")
    if sharing.opening is None:
        return SharingTold()
    words = tr("The network is open")
    if refusals := sharing.refusals.newest_first:
        return SharingTold(words, refusal_sentence(refusals[0]), "triangle-alert")
    count = len(sharing.computers)
    more = count_words(count, "1 computer may come in.", "{n} computers may come in.")
    return SharingTold(words, more if count else "", "monitor")


def joined_words(keys: Keys) -> str:
    """In whose network this studio is."""
    computer = keys.computers[0].name if keys.computers else keys.title
    return tr("In the network of “{computer}”", computer=computer)
