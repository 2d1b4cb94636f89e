"""A project: what is saved in a .nep file, what goes with it, and how nothing of it is lost.

Enters what is true of a project that nobody runs. No widget.
"""
