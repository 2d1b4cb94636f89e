"""Running a project: which nodes it needs, its session, and what is told of them.

Enters what starts, watches and stops; without a window. What a run looks like is in ``ui``.
"""
