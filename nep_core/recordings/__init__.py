"""Recordings of a network in MCAP files: making them, reading them, playing them.

Enters what knows how messages lie in a file. What they mean is not known here: any topic can be
recorded, and is played as it came.
"""
