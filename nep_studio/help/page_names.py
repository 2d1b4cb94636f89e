"""The names of help pages: of blocks, categories, nodes, and of what people have written."""

from __future__ import annotations

from nep_studio.blocks.procedures import CALL, DEFINE, PARAMETER

HOME = "home"
BLOCK, CATEGORY, NODE, HOW_TO = "block/", "blocks/", "node/", "howto/"
OWN_BLOCKS, PROBLEMS = "howto/own-blocks", "howto/problems"


def split(name: str) -> tuple[str, str]:
    """Take the name of a page and of a place in it apart."""
    page, _, anchor = name.partition("#")
    return page, anchor


def block_page(block_type: str, slot: str = "") -> str:
    """The page of a block, at one of its slots; own blocks share one page."""
    if block_type.startswith((CALL, DEFINE, PARAMETER)):
        return OWN_BLOCKS
    return f"{BLOCK}{block_type}#slot-{slot}" if slot else f"{BLOCK}{block_type}"


def error_anchor(title: str) -> str:
    """The place of a message in the page about messages, by its English title."""
    return "error-" + "".join(letter if letter.isalnum() else "-" for letter in title.lower())
