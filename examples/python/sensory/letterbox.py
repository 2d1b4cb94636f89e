"""Tells how many letters lie in a folder of this computer."""

from pathlib import Path


def run(node, *, folder, rate_hz):
    """Look into the folder again and again, and publish how many files are in it."""
    letterbox = Path(folder)
    letterbox.mkdir(parents=True, exist_ok=True)
    letters = node.publisher("/letterbox")
    node.ready(f"looks into {letterbox.resolve()}")
    while not node.stopping:
        letters.send({"letters": len(list(letterbox.iterdir()))})
        node.wait(1 / rate_hz)
