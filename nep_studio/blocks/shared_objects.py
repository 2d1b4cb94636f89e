"""What the variables of the whole program, and of all its runs, are attributes of in Python.

The same as in nep_core.program.variables, which no program of blocks needs: a test sees to it.
"""

SHARED_OBJECTS = ("program", "kept")
