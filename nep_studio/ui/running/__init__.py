"""Running a project in the window: start, stop, pause, step, and what is heard meanwhile.

Enters what shows a run, and the coat of Qt around ``nep_studio/run``: threads, signals, the glow
on the canvas. What is to happen when somebody presses Run is decided there, not here.
"""
