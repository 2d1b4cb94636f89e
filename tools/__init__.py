"""Programs for those who work on NEP Studio: they make what docs/ and resources/ show.

What may enter: scripts that draw a picture, write a page or a table, or measure the house itself
(``house.py``). Each says in its head how it is called. They may import everything, tests too, and
nothing of the program imports them; pages and pictures themselves lie in docs/.
"""
