"""The block language as data: definitions, programs, edits, checks and code; no Qt, no network.

Enters what is true of a program that nobody sees and nobody runs: which blocks there are, what
fits where, every change with its undo, what is wrong in plain words, Python out of blocks
(``generate``) and blocks out of Python (``from_python``). What a block looks like is in
``ui/canvas``; which nodes this computer has is asked in ``run``.
"""
