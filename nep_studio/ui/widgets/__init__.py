"""Small widgets and layouts that several rooms use, and that know nothing of this program.

Enters a widget that would be as useful in another program: a label that shortens itself, a layout
that flows. No project, no robot, no message: what knows those stays in its own room.
"""
