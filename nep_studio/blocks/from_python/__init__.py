"""From Python back to blocks: the inverse of generate/, learned from it block by block."""
