"""What came of a recording, in words, and kept in the project."""

from __future__ import annotations

from collections import Counter

from nep_studio.ui.trainer.keeping import Keeping
from nep_studio.ui.trainer.live import Samples
from nep_studio.ui.trainer.session import Session
from nep_studio.ui.trainer.strip_marks import fault_words
from nep_studio.ui.words import count_words, tr


def keep_session(keeping: Keeping, session: Session) -> bool:
    """Keep the takes of a recording; False when there are none."""
    if not session.takes:
        return False
    return bool(
        keeping.keep_session(session.gesture, session.samples, session.takes, session.forgotten)
    )


def session_words(session: Session) -> str:
    """How many takes there are now, and why others do not count."""
    count = len(session.takes)
    said = [count_words(count, "1 take is kept.", "{n} takes are kept.")] if count else []
    for fault, times in Counter(one.fault for one in session.movements if one.fault).items():
        said.append(
            count_words(
                times,
                "1 movement does not count: {reason}.",
                "{n} movements do not count: {reason}.",
                reason=fault_words(fault),
            )
        )
    if session.ending == "lost":
        said.insert(0, tr("The watch or phone fell silent, so the recording ended."))
    elif session.ending == "late":
        said.insert(0, tr("The recording ended after two minutes."))
    if not count and session.ending != "lost":
        said.append(tr("No take was found. Rest, make the movement clearly, and rest again."))
    return " ".join(said)


def everyday_words(samples: Samples, is_kept: bool) -> str:
    """How much everyday movement is kept."""
    if not is_kept:
        return tr("Nothing was recorded: the watch or phone is silent.")
    return tr("{seconds} s of everyday movement are kept.", seconds=round(samples.seconds))
