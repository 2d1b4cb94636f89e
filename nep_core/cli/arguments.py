"""Kinds of arguments that several commands take."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable

OWN = "--own"
"""Told to a master that a session starts for itself: other sessions do not join it."""

MOST_SECONDS = 1e6
"""Nearly twelve days; the longest wait of some systems is not much longer."""


def seconds(text: str) -> float:
    """A time for argparse, 0 to 1,000,000 s; raises ArgumentTypeError."""
    return _number(text, 0.0, MOST_SECONDS)


def factor(text: str) -> float:
    """A speed for argparse, 0.001 to 1000; raises ArgumentTypeError."""
    return _number(text, 0.001, 1000.0)


def rate(text: str) -> float:
    """A rate for argparse, 0.001 to 10,000 Hz; raises ArgumentTypeError."""
    return _number(text, 0.001, 10_000.0)


def count(text: str) -> int:
    """A number of messages for argparse, 1 or more; raises ArgumentTypeError."""
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f'"{text}" is not a number from 1')
    return int(text)


def _number(text: str, least: float, most: float) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not least <= number <= most:
        raise argparse.ArgumentTypeError(f'"{text}" is not a number from {least:g} to {most:.0f}')
    return number


def add_json(parser: argparse.ArgumentParser, told: str = "for machines: one line of JSON") -> None:
    """Let the command speak JSON."""
    parser.add_argument("--json", action="store_true", help=told)


def add_times(parser: argparse.ArgumentParser, verb: str) -> None:
    """Let the command end by itself."""
    add: Callable[..., object] = parser.add_argument
    add("--count", type=count, default=0, metavar="N", help=f"{verb} N messages, then end")
    add("--seconds", type=seconds, metavar="S", help="end after S seconds")
