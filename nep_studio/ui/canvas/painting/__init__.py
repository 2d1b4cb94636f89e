"""How everything on a page looks: shapes, layers, overlays; nothing here changes a program."""
