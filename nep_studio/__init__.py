"""NEP Studio: give a social robot its behaviour with blocks.

The program, by rooms: ``blocks`` is the language as data; ``project`` what is saved; ``run`` what
happens after Run; ``support``, ``help``, ``study``, ``commands`` what stands beside; ``ui`` all
that has a widget. Only the latter imports more of Qt than its core. Nothing outside imports this
package: a node or a robot must work without it.
"""

__version__ = "0.1.0"
