"""What the menus of blocks and of the canvas offer."""

from .context_menu import Section

BLOCK_SECTIONS: tuple[Section, ...] = ()
PAGE_SECTIONS: tuple[Section, ...] = ()
