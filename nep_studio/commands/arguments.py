"""Kinds of arguments that several commands take."""

from __future__ import annotations

import argparse
import math

SLOWEST, FASTEST = 0.1, 50


def speed(word: str) -> float:
    """How many times as fast something goes, for argparse; raises ArgumentTypeError."""
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not SLOWEST <= number <= FASTEST:
        raise argparse.ArgumentTypeError(f'"{word}" is not a number from {SLOWEST} to {FASTEST}')
    return number
