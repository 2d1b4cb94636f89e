"""What keeps the program usable: start, safe mode, portable mode, updates, the report.

Nothing here knows a project, and nothing needs Qt: the report must work where Qt does not.
"""
