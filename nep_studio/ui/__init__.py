"""Everything with a widget: the window, the canvas, the panels."""
