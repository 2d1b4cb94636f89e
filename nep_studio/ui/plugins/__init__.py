"""Plugins: panels, dialogs and tools, each a folder that can be added or left out.

Enters what the program could do without. A plugin sees what it is given of the window, never the
window itself, and no other plugin: what two of them need stands in ``ui`` or ``ui/widgets``.
What is slow to import is imported when a plugin is made; a hidden panel does no work.
"""
