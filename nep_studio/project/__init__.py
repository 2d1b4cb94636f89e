"""A project: what is saved in a .nep file, what goes with it, and how nothing of it is lost.

Enters what is true of a project that nobody runs: its journal, its lock, the files kept in it,
the examples, what its program waits for. Changes of the program are ``blocks``' business; what is
open in the window is in ``ui``. No widget.
"""
