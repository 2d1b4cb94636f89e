"""Plugins: panels, dialogs and tools, each a folder that can be added or left out.

A plugin sees the ``Host`` and the ``Services``, never the window, and no other plugin.
"""
