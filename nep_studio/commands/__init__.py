"""The jobs of ``nep-studio`` that need no window: run, code, check, doctor, naoqi.

Enters what reads a command line and prints. The work itself is in ``run``, ``project`` and
``blocks``: what a command can do, the window can do, by the same functions. No widget.
"""
