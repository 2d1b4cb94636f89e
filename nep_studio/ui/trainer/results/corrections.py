"""What "it missed it" and "false alarm" add to the project: the last seconds, as movement."""

from __future__ import annotations

from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.keeping import Keeping
from nep_studio.ui.trainer.live import Samples

BEFORE_S, AFTER_S = 1.0, 0.5
"""So much around a movement is kept with it."""
SHORTEST_S, LONGEST_S = 0.3, 8.0


def keep_missed(desk: TrainerDesk, name: str, start_s: float, end_s: float) -> bool:
    """Keep a movement (on the clock of the live stream) as a take more of a gesture.

    What is around it may be anything, so nothing is learned from that. False when too little of
    the movement is still known.
    """
    samples = _around(desk, start_s, end_s)
    if not len(samples):
        return False
    first_s, last_s = float(samples.t[0]), float(samples.t[-1])
    take = (max(start_s, first_s), min(end_s, last_s))
    if not SHORTEST_S <= take[1] - take[0] <= LONGEST_S:
        return False
    unknown = [span for span in ((first_s, take[0]), (take[1], last_s)) if span[1] > span[0]]
    label = "add what was missed"
    return bool(Keeping(desk).keep_session(name, samples, [take], unknown, label))


def keep_false_alarm(desk: TrainerDesk, start_s: float, end_s: float) -> bool:
    """Keep a movement as everyday movement; False when too little of it is still known."""
    samples = _around(desk, start_s, end_s)
    return samples.seconds >= SHORTEST_S and Keeping(desk).keep_everyday(samples)


def _around(desk: TrainerDesk, start_s: float, end_s: float) -> Samples:
    live = desk.live
    return Samples.none() if live is None else live.between(start_s - BEFORE_S, end_s + AFTER_S)
