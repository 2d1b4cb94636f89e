"""Takes out of a text what tells who somebody is, or lets somebody in."""

from __future__ import annotations

import contextlib
import getpass
import ipaddress
import json
import os
import re
import socket
import unicodedata
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

# Takes the names of folders and of people's files out of the paths in a text.

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

OUR_FOLDERS = frozenset(
    ("nep_studio", "nep_core", "nodes", "resources", "site-packages", "_internal")
)
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
        is_ours = is_ours or name.lower() in OUR_FOLDERS
        told += slash + (name if is_ours or name.lower() in USUAL else FOLDER)
    return found["root"] + told


SHORTEST_NAME, SHORTEST_SECRET = 3, 4
OURS = frozenset(
    (
        *("admin", "administrator", "computer", "debian", "guest", "home", "linux", "localhost"),
        *("nao", "nep", "node", "nodes", "pepper", "python", "root", "runner", "studio", "system"),
        *("ubuntu", "user", "users", "windows"),
    )
)
"""Names that tell nothing of anybody; they are also words of other things in a report."""

_ADDRESSES = (
    re.compile(r"(?<![\w.])\d{1,3}(?:\.\d{1,3}){3}(?![\w]|\.\d)"),
    re.compile(r"(?<![\w.:])[0-9a-fA-F]{0,4}(?::[0-9a-fA-F]{0,4}){2,7}(?![\w:])"),
)
_CODE = r"(?<![\d.])\d{3}[ \u00a0-]?\d{3}(?![\d.]\d|\d)"
"""A pairing code, as people type it."""
_IN_KEY = r"[0-9A-Za-z.:+=^!/*?&<>()\[\]{}@%$#-]"
"""The letters of Z85, in which CURVE keys are written: forty of them, whichever half it is."""
_PATTERNS: tuple[tuple[re.Pattern[str], str], ...] = (
    (
        re.compile(
            rf"(?:(?<!{_IN_KEY})|(?<=[=:(\[<{{]))(?:(?={_IN_KEY}{{0,39}}[+=^!*?&<>()\[\]{{}}@%$#])"
            # or, as one key in a thousand, of letters and digits alone
            rf"|(?={_IN_KEY}{{0,39}}[A-Z])(?={_IN_KEY}{{0,39}}[a-z])(?={_IN_KEY}{{0,39}}[0-9]))"
            rf"{_IN_KEY}{{40}}(?=[).:\]}}>!?]?(?!{_IN_KEY}))"
        ),
        HIDDEN,
    ),
    (re.compile(r"-----BEGIN [\w ]+-----.*?(-----END [\w ]+-----|\Z)", re.DOTALL), HIDDEN),
    (re.compile(r"(?<=://)[^/\s:@]+:[^/\s@]+@"), f"{HIDDEN}@"),
    (re.compile(r"(?<=://)([^/\s]+/)[\w-]{12,}(?![\w.-])"), rf"\g<1>{HIDDEN}"),
    (re.compile(r"(?i)([?&#](?:key|token|code|secret|t|k)=)[^&\s]+"), rf"\g<1>{HIDDEN}"),
    (re.compile(r"(?i)(code\b[^\d\n]{0,12})\d{3}[ -]?\d{3}(?!\d)"), rf"\g<1>{HIDDEN}"),
    (re.compile(rf"(?i)(\bpair\w*\b[^\n]{{0,80}}?){_CODE}"), rf"\g<1>{HIDDEN}"),
    (
        re.compile(rf"(?i)((?:\bcode|código|codice|コード)[^\d\n]{{0,40}}){_CODE}"),
        rf"\g<1>{HIDDEN}",
    ),
    (re.compile(rf"(?m)^(\s*){_CODE}(?=\s*$)"), rf"\g<1>{HIDDEN}"),
    (re.compile(r"(?i)(\bbearer\s+|\bauthorization:\s*\w+\s+)\S+"), rf"\g<1>{HIDDEN}"),
    (re.compile(r"(?i)(--(?:token|password|pin|secret|code)[= ])\S+"), rf"\g<1>{HIDDEN}"),
    (
        re.compile(
            r"(?i)(?<![^\W_])((?:\w*password|passwd|passphrase|pass|pin|token|login|ssid|psk|"
            r"(?:secret|private|api)[ _-]?key|secret)[\"']?\s*(?:=|:|\bis\b)\s*)"
            r"(?:\"[^\"\n]*\"|'[^'\n]*'|[^\s\"',;]+)"
        ),
        rf"\g<1>{HIDDEN}",
    ),
    (re.compile(r"[\w.+-]+@[\w-]+(?:\.[\w-]+)+"), "<address of a person>"),
    (re.compile(r"\b[0-9A-Fa-f]{2}(?:([:-])[0-9A-Fa-f]{2})(?:\1[0-9A-Fa-f]{2}){4}\b"), HIDDEN),
    (re.compile(r"(?i)(?<![\w.-])[\w-]+\.local\b(?![\\/])"), f"{COMPUTER}.local"),
    (re.compile(r"(?m)(^|[\s\"'=(])(\\\\(?:\\\\)?)[^\\/\s]+(?=\\)"), rf"\g<1>\g<2>{COMPUTER}"),
    (
        re.compile(
            r"(?i)((?:^|[\\/])(?:users|home)[\\/]+)(?!<)"
            r"(?:[^\\/:\"'\n]+(?=[\\/])|[^\\/\s:\"']+)"
        ),
        rf"\g<1>{USER}",
    ),
)
"""Keys, logins and tokens in links, pairing codes, passwords, e-mail, hardware addresses,
computers of the network, homes of others."""


@dataclass(frozen=True)
class Anonymous:
    """What is known of the person and the computer, and is taken out."""

    home: str = ""
    names: tuple[str, ...] = ()
    computer: str = ""
    secrets: tuple[str, ...] = ()

    @classmethod
    def here(cls, secrets: Iterable[str] = ()) -> Anonymous:
        """The person at this computer."""
        home = _or_nothing(lambda: str(Path.home()))
        names = (_or_nothing(getpass.getuser), Path(home).name, *_full_name())
        told = dict.fromkeys(one for one in names if one)
        return cls(home, tuple(told), socket.gethostname(), tuple(secrets))

    def text(self, text: str) -> str:
        """The text without them, and without letters that no file or terminal takes."""
        text = readable(text)
        for secret in sorted(self.secrets, key=len, reverse=True):
            if len(secret) >= SHORTEST_SECRET:
                text = text.replace(secret, HIDDEN)
        text = self._without_home(text)
        for pattern, instead in _PATTERNS:
            text = pattern.sub(instead, text)
        for pattern in _ADDRESSES:
            text = pattern.sub(_address, text)
        text = without_folders(text)
        for name in sorted(self.names, key=len, reverse=True):
            text = _without_word(text, name, USER)
        for name in (self.computer, self.computer.partition(".")[0]):
            text = _without_word(text, name, COMPUTER)
        return text

    def _without_home(self, text: str) -> str:
        parts = [re.escape(part) for part in re.split(r"[\\/]+", self.home) if part]
        if not parts:
            return text
        is_from_root = self.home.startswith(("/", "\\"))
        start = r"(?<![\w.])[\\/]+" if is_from_root else ""
        pattern = start + r"[\\/]+".join(parts) + r"(?![\w.-])"
        return re.sub(pattern, "~", text, flags=re.IGNORECASE)


def _address(found: re.Match[str]) -> str:
    """An address of the internet is the person's; those of a local network help, and are kept."""
    try:
        address = ipaddress.ip_address(found[0])
    except ValueError:
        return found[0]
    if address.version == 6 and address.is_link_local:
        return f"fe80::{HIDDEN}"  # most are made of the hardware's address
    return HIDDEN if address.is_global else found[0]


def _without_word(text: str, word: str, instead: str) -> str:
    word = readable(word)
    is_latin = word.lower() != word.upper()  # others write words without space between them
    shortest = SHORTEST_NAME if word.isascii() else SHORTEST_NAME - 1
    if len(word) < shortest or word.casefold() in OURS:
        return text
    for written in {word, quote(word), json.dumps(word)[1:-1]}:
        pattern = re.escape(written)
        if is_latin:
            pattern = rf"(?<![^\W_]){pattern}(?![^\W_])"
        text = re.sub(pattern, instead, text, flags=re.IGNORECASE)
    return text


def _full_name() -> tuple[str, ...]:
    """What the system knows of the person's name, whole and in its parts."""
    if os.name != "posix":
        return ()
    import pwd

    with contextlib.suppress(KeyError):
        name = pwd.getpwuid(os.getuid()).pw_gecos.partition(",")[0].strip()
        return (name, *name.split())
    return ()


def _or_nothing(ask: Callable[[], str]) -> str:
    """Not every process has a home, or a user whom the system knows."""
    try:
        return ask()
    except (OSError, KeyError, RuntimeError, ImportError):
        return ""
