"""Recordings of a network in MCAP files: making them, reading them, playing them."""
