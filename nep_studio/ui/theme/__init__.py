"""How the program looks: colours, fonts, icons and the style of its widgets.

Enters what a theme decides, and the one table of named colours that palette, style sheet, canvas
and plots read. No colour and no font is named anywhere else; no widget of the program is here.
"""
