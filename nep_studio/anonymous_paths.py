"""Takes the names of folders and of people's files out of the paths in a text."""

from __future__ import annotations

import re
import unicodedata

HIDDEN = "<hidden>"
USER, COMPUTER, FOLDER, FILE = "<user>", "<computer>", "<folder>", "<file>"

USUAL = frozenset(
    (
        *("documents", "desktop", "downloads", "appdata", "local", "locallow", "roaming", "temp"),
        *("library", "application support", "caches", "preferences", "logs", "log", "programs"),
        *(".config", ".local", ".cache", "share", "state", "tmp", ".venv", "venv", "bin", "lib"),
        *("nep-studio", "nep studio", "nep studio data", "nep studio.app", "nep recordings"),
        *("settings", "projects", "robots", "keys", "journals", "snippets", "cache", "scripts"),
    )
)
"""Folders that are called so on many computers."""

OURS = frozenset(("nep_studio", "nep_core", "nodes", "resources", "site-packages", "_internal"))
"""Behind one of these all is a program's."""

_NAME = r"[^\\/\n\"':<>|*?]+"
_FOLDERS = re.compile(
    rf"(?P<root>~|(?:/run)?/media(?:/{USER})?|/Volumes|/mnt|\b[D-Zd-z]:|[\\/]{USER})"
    rf"(?P<folders>(?:[\\/]+{_NAME}(?=[\\/]))+)"
)
_ENDINGS = r"\.(?:nep|mcap|csv)(?![\w.])"
_OPENING, _CLOSING = "\"'“„«\u2018「『", "\"'“”«»\u2018\u2019」』"
_FILES = (
    re.compile(rf"(?<=[\\/]){_NAME}?({_ENDINGS})", re.IGNORECASE),
    re.compile(rf"(?<=[{_OPENING}])[^\\/\n{_CLOSING}<>|]+({_ENDINGS})", re.IGNORECASE),
    re.compile(rf"[^\s\\/\"'<>|:=(,]+({_ENDINGS})", re.IGNORECASE),
)


def without_folders(text: str) -> str:
    """The text without what a person called folders, projects and recordings."""
    text = _FOLDERS.sub(_usual_ones, text)
    for pattern in _FILES:
        text = pattern.sub(rf"{FILE}\g<1>", text)
    return text


def readable(text: str) -> str:
    """The text with each letter as one sign, and without what only steers a terminal."""
    text = unicodedata.normalize("NFC", text.encode("utf-8", "replace").decode())
    return "".join(one if one.isprintable() or one in "\n\t" else "?" for one in text)


def _usual_ones(found: re.Match[str]) -> str:
    told, is_ours = "", False
    for slash, name in re.findall(r"([\\/]+)([^\\/]+)", found["folders"]):
        is_ours = is_ours or name.lower() in OURS
        told += slash + (name if is_ours or name.lower() in USUAL else FOLDER)
    return found["root"] + told
