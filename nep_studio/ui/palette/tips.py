"""What a block of the palette does, in a few lines: its sentence, its help, its Python."""

from __future__ import annotations

from html import escape

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.to_python import python_of
from nep_studio.blocks.program import Project
from nep_studio.help.texts import BlockText, block_texts
from nep_studio.ui.words import language_code, tr

from .stock import Stock

LONGEST_CODE = 400


def tip(stock: Stock, sample: str) -> str:
    """The tool tip of a sample, as rich text."""
    parts = [f"<b>{escape(stock.words(sample))}</b>"]
    parts += [f"<p>{escape(text)}</p>" for text in does(stock.definition(sample)) if text]
    code = python(stock.project, stock.language, sample)
    if code:
        parts.append(f"<p>{escape(tr('In Python:'))}</p><pre>{escape(code)}</pre>")
    return "".join(parts)


def python(project: Project, language: Language, block: str) -> str:
    """The Python of a block; empty when it makes none by itself."""
    try:
        code = python_of(project, language, [block]).strip()
    except BlocksError:
        return ""
    return code if len(code) <= LONGEST_CODE else code[:LONGEST_CODE].rstrip() + " …"


def does(definition: Definition) -> list[str]:
    """What the blocks of a definition do, in sentences; some may be empty."""
    told = [block_texts(language_code()).get(definition.id, BlockText()).about]
    if "takes_time" in definition.flags:
        told.append(tr("The program waits here until it is done."))
    if "needs_real_robot" in definition.flags:
        told.append(tr("Needs a real robot: the one on the screen cannot do it."))
    return told
