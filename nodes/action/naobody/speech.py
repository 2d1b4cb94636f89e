"""How long a robot takes to say something."""

from __future__ import annotations

import unicodedata
from itertools import pairwise

CHARACTERS_PER_S = 14.0
"""About 2.6 words a second of English: NAO's voice at its usual speed."""
SHORTEST_S = 0.3
PAUSE_S = {",": 0.2, ";": 0.3, ":": 0.3, ".": 0.45, "!": 0.45, "?": 0.45, "、": 0.2, "。": 0.45}
WIDE_CHARACTER = 2.0
"""A Chinese, Japanese or Korean sign takes about as long as this many letters."""


def speaking_time_s(text: str) -> float:
    """Return the seconds that saying ``text`` takes: its letters, and a pause after each mark.

    The last mark makes no pause, nothing to say takes no time.
    """
    # NFKC makes the wide "!" of Japanese text the same mark as ours.
    words = unicodedata.normalize("NFKC", text).strip().rstrip("".join(PAUSE_S))
    if not words:
        return 0.0
    letters = sum(WIDE_CHARACTER if _is_wide(letter) else 1.0 for letter in words)
    pauses_s = sum(
        PAUSE_S.get(mark, 0.0)
        for mark, following in pairwise(words)
        if following.isspace() or _is_wide(following)
    )
    return max(SHORTEST_S, letters / CHARACTERS_PER_S + pauses_s)


def _is_wide(letter: str) -> bool:
    return unicodedata.east_asian_width(letter) in "WF"
