"""The files of the phone page, and the page that refuses a wrong link."""

from __future__ import annotations

import html
import json
from dataclasses import dataclass
from pathlib import Path

from nodes.resources import resource_folder

TYPES = {
    ".css": "text/css",
    ".html": "text/html",
    ".js": "text/javascript",
    ".json": "application/json",
    ".svg": "image/svg+xml",
}
NAMES = (
    *("index.html", "style.css", "page.js", "motion.js", "line.js", "graph.js"),
    *("words.json", "icon.svg"),
)
ENGLISH = "en"


@dataclass(frozen=True)
class PageFiles:
    """What is served: the text of each file by its name, and the texts by language."""

    texts: dict[str, str]
    words: dict[str, dict[str, str]]
    refusal: str

    def refused(self, accepted: str, nonce: str) -> str:
        """The page for a wrong link, in the first language of ``Accept-Language`` that we have."""
        language = self.language(accepted)
        told = {name: html.escape(text) for name, text in self.words[language].items()}
        return self.refusal.format(
            language=language, nonce=nonce, style=self.texts["style.css"], **told
        )

    def language(self, accepted: str) -> str:
        """The best language for an ``Accept-Language`` header, which lists them by preference."""
        wanted = [part.strip().split(";")[0][:2].lower() for part in accepted.split(",")]
        return next((name for name in wanted if name in self.words), ENGLISH)


def page_files(folder: Path | None = None) -> PageFiles:
    """Read the page. Raises OSError when a file is not there."""
    folder = folder or resource_folder() / "phone_page"
    texts = {name: (folder / name).read_text(encoding="utf-8") for name in NAMES}
    refusal = (folder / "refused.html").read_text(encoding="utf-8")
    return PageFiles(texts, json.loads(texts["words.json"]), refusal)


def content_type(name: str) -> str:
    """The media type of a file of the page."""
    return TYPES[Path(name).suffix]
