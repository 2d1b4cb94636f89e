"""Kinds of arguments that several commands take."""

from __future__ import annotations

import argparse
import math

MOST_SECONDS = 1e6
"""Nearly twelve days; the longest wait of some systems is not much longer."""


def seconds(text: str) -> float:
    """A time for argparse, 0 to 1,000,000 s; raises ArgumentTypeError."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0 <= number <= MOST_SECONDS:
        raise argparse.ArgumentTypeError(f'"{text}" is not a number from 0 to {MOST_SECONDS:.0f}')
    return number
