"""The languages that a NAO speaks, by NAOqi's names, and by the codes of this program."""

from __future__ import annotations

from nodes.action.naoqi.server import CallFailed

CODES = {
    "Arabic": "ar",
    "Brazilian": "pt_br",
    "Chinese": "zh",
    "Czech": "cs",
    "Danish": "da",
    "Dutch": "nl",
    "English": "en",
    "Finnish": "fi",
    "French": "fr",
    "German": "de",
    "Italian": "it",
    "Japanese": "ja",
    "Korean": "ko",
    "Polish": "pl",
    "Portuguese": "pt",
    "Russian": "ru",
    "Spanish": "es",
    "Swedish": "sv",
    "Turkish": "tr",
}
NAMES = {code: name for name, code in CODES.items()}


def code_of(language: str) -> str:
    """Return the code of a language. Raises CallFailed with those there are."""
    if language not in CODES:
        raise CallFailed(f"There is no language “{language}”. Possible: {', '.join(CODES)}.")
    return CODES[language]
