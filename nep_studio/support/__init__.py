"""What keeps the program usable: start, safe mode, portable mode, updates, the report.

Enters what must work when something else does not. Nothing here knows a project, and nothing
needs Qt: the report is written where Qt cannot start.
"""
