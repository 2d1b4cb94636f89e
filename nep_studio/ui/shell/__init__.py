"""The shell: the window with its menus, start page, messages, settings and command palette.

The only room that knows ``MainWindow``. What stands around the canvas is in ``workbench``, what
can be added or left out is in ``plugins``.
"""
