"""The shell: the window with its menus, start page, messages, settings and command palette.

The only room that knows ``MainWindow``. Enters what there is once, whatever is open. What stands
around the canvas is in ``workbench``, what can be added or left out is in ``plugins``; nobody
imports the shell but the program's start.
"""
