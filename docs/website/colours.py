"""The colours of the site, from the same tables as those of the window."""

from __future__ import annotations

from nep_studio.ui.theme.colours import load_theme

NAMES = (
    "canvas",
    "panel",
    "panel_alt",
    "menu",
    "line",
    "text",
    "muted",
    "link",
    "focus",
    "accent",
    "info",
    "info_panel",
    "field",
    "field_text",
    "field_line",
)
USED_WHEN = {
    "light": "",
    "dark": "@media screen and (prefers-color-scheme: dark)",
    "high_contrast": "@media screen and (prefers-contrast: more)",
}
"""Which theme is used when; a later one wins."""


def colours_css() -> str:
    """The named colours of each theme as properties."""
    rules = []
    for name, condition in USED_WHEN.items():
        theme = load_theme(name)
        told = "".join(f"--{n.replace('_', '-')}:{theme.colour(n).name()};" for n in NAMES)
        scheme = "dark" if theme.is_dark else "light"
        rule = f":root{{color-scheme:{scheme};{told}}}"
        rules.append(f"{condition} {{ {rule} }}" if condition else rule)
    return "\n".join(rules) + "\n"
