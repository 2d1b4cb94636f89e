"""NEP Studio: give a social robot its behaviour with blocks."""

__version__ = "0.1.0"
