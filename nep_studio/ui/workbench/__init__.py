"""The workbench: what stands directly around the canvas, and cannot be left out.

Enters palette, pages, code, outline, problems, find and insert bars, minimap, trash. They know
the canvas and the services, never the window or a plugin. What can be left out is a plugin.
"""
