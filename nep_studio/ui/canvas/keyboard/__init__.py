"""The canvas without a mouse: moving between blocks, picking up and placing."""
