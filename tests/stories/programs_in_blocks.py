"""The programs of ``programs/*.toml``, written in blocks: the language as people use it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from nep_studio.blocks.program import Project
from nep_studio.help.texts import Example
from nep_studio.run.installation import studio_language

FOLDER = Path(__file__).parent / "programs"
LANGUAGE = studio_language()
_VARIABLE = re.compile(r"\$(\w+)")


@dataclass(frozen=True)
class BlockProgram:
    """A small program, and in one sentence what it is to do."""

    name: str
    about: str
    program: str

    def project(self, **replaced: str) -> Project:
        """The program with the robots that it needs; some words in it may be ``replaced``."""
        text = _VARIABLE.sub(r'(variable.get variable="\1")', self.program)
        for word, other in replaced.items():
            assert word in text, word
            text = text.replace(word, other)
        return Example(self.name, (), text).project(LANGUAGE, "en", self.name)


def programs() -> Mapping[str, BlockProgram]:
    """All programs by their names."""
    read = (tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.iterdir()))
    return {
        name: BlockProgram(name, told["about"], told["program"])
        for tables in read
        for name, told in tables.items()
    }
