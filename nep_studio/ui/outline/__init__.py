"""The program as a tree: a second view of the same blocks."""
