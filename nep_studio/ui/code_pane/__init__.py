"""The Python beside the blocks: shown live, found by its blocks, and turned back into them."""
