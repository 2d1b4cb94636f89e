"""The command ``fuzz``: tries targets for minutes or hours, and says what was found and where."""

from __future__ import annotations

import argparse
import random
import sys
import threading
from collections.abc import Sequence

from fuzz.runner import Run, Tally
from fuzz.targets import NAMES, target

DONE, FOUND_SOME, WRONG_USE = 0, 1, 2


def main(arguments: Sequence[str]) -> int:
    """Do what the command line asks; 1 when something was found or one was not tried to its end."""
    given = _parser().parse_args(arguments)
    names = given.targets or list(NAMES)
    if unknown := [name for name in names if name not in NAMES]:
        print(f"There is no target {', '.join(unknown)}. There are: {', '.join(NAMES)}.")
        return WRONG_USE
    seed = random.randrange(2**32) if given.seed is None else given.seed
    seconds = given.minutes * 60 * given.at_once / len(names) if given.minutes else 0.0
    if not (given.count or seconds):
        seconds = 60.0
    print(f"The seed is {seed}. Ctrl+C ends it.", flush=True)
    runs = [Run(target(name), seed=seed, say=_say) for name in names]
    try:
        tallies = _all(runs, given.count, seconds, given.at_once)
    except KeyboardInterrupt:
        tallies = [run.tally for run in runs if run.tally.done]
        print("Ended.", flush=True)
    return _told(tallies)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="dev.py fuzz", description=__doc__, epilog=f"Targets: {', '.join(NAMES)}."
    )
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="all, where none is named")
    parser.add_argument("--minutes", type=float, default=0.0, help="for all targets together")
    parser.add_argument("--count", type=int, default=0, help="inputs of each target")
    parser.add_argument("--seed", type=int, help="the same seed gives the same inputs")
    parser.add_argument("--at-once", type=int, default=1, help="targets beside each other")
    return parser


def _say(words: str) -> None:
    print(words, flush=True)


def _all(runs: list[Run], count: int, seconds: float, at_once: int) -> list[Tally]:
    """Try all, some at once; KeyboardInterrupt ends the children too."""
    waiting = list(runs)
    ended = threading.Event()

    def work() -> None:
        while waiting and not ended.is_set():
            _say(waiting.pop(0).random(count=count, seconds=seconds).words)

    threads = [threading.Thread(target=work, daemon=True) for _ in range(max(1, at_once))]
    for thread in threads:
        thread.start()
    try:
        while any(thread.is_alive() for thread in threads):
            for thread in threads:
                thread.join(0.2)
    except KeyboardInterrupt:
        ended.set()
        for run in runs:
            run.stop()
        raise
    return [run.tally for run in runs]


def _told(tallies: list[Tally]) -> int:
    """Print what was found; the exit code."""
    print()
    for tally in tallies:
        print(tally.words)
    found = [one for tally in tallies for one in tally.findings]
    for one in found:
        print(f"\n{one.target}, {one.kind}: {one.signature}\n  {one.path or one.words}")
    print(f"\n{len(found)} found." if found else "\nNothing found.")
    return FOUND_SOME if found else DONE


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
