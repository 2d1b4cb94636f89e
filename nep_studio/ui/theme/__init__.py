"""How the program looks: colours, fonts, icons and the style of its widgets.

Enters what a theme decides, and the one table of named colours that palette, style sheet, canvas
and plots read. No colour and no font is named anywhere else; no widget of the program is here.
"""

from nep_studio.ui.theme.colours import (
    DARK,
    DISABLED,
    HIGH_CONTRAST,
    LIGHT,
    PLACEHOLDER,
    BlockColours,
    Theme,
    UnknownColour,
    load_theme,
    themes,
)
from nep_studio.ui.theme.icons import (
    APPLICATION_ICON,
    CATEGORY_ICONS,
    UnknownIcon,
    application_icon,
    category_icon_name,
    icon,
    icon_path,
    icon_pixmap,
    paint_icon,
)
from nep_studio.ui.theme.look import SYSTEM, Look

from .look import (
    Fonts,
    apply_theme,
    base_point_size,
    code_font,
    load_fonts,
    palette,
    style_sheet,
    text_font,
)

__all__ = [
    "APPLICATION_ICON",
    "CATEGORY_ICONS",
    "DARK",
    "DISABLED",
    "HIGH_CONTRAST",
    "LIGHT",
    "PLACEHOLDER",
    "SYSTEM",
    "BlockColours",
    "Fonts",
    "Look",
    "Theme",
    "UnknownColour",
    "UnknownIcon",
    "application_icon",
    "apply_theme",
    "base_point_size",
    "category_icon_name",
    "code_font",
    "icon",
    "icon_path",
    "icon_pixmap",
    "load_fonts",
    "load_theme",
    "paint_icon",
    "palette",
    "style_sheet",
    "text_font",
    "themes",
]
