"""What is wrong with a text that is no Python, and what to try: by the message and the line."""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Sequence

from faults import Words

from .learning import CodeUnread

_USUAL = (
    "Look at this line, and at the one above: is a bracket, a quote or a colon missing?",
    "Undo the last change of the code.",
)
_BRACKET = ("Count the brackets in this line: each one that opens needs one that closes.",)
_QUOTE = ("Begin and end the text with the same quote, on one line.",)
_INDENT = ("Are the lines inside a block moved in by the same number of spaces?",)
_EMPTY = (
    "Write below this line what it does, moved in by four spaces: “pass” does nothing.",
    *_INDENT,
)
_ALONE = ("Below a line with “@” comes one that begins with “def”.",)
_TABS = ("Use spaces alone at the beginning of lines, four for each step, and no tabs.",)
_OTHER_LANGUAGE = ("This looks like another language: write it in Python.",)
_SIGNS = (
    "Type the spaces and signs in this line again: some are characters that Python does not know.",
)
_KEYWORD = ("Give it another name: this word has a meaning in Python already.",)

_BY_LINE: tuple[tuple[str, Sequence[Words]], ...] = (
    (
        "[\u201c\u201d\u201e\u201f\u00ab\u00bb\u2018\u2019\u201a\u201b\u2032\u2033\u00b4`]",
        ("Type the quotes in this line again: Python knows \" and ' only.",),
    ),
    (
        "[\u00a0\u1680\u2000-\u200f\u2028-\u202f\u205f\u2060\u3000\ufeff]",
        _SIGNS,
    ),
    (
        "[\u00d7\u00f7\u2212\u2013\u2014\u2264\u2265\u2260]",
        _SIGNS,
    ),
    (
        "[\uff0c\u3002\uff1b\uff1a\uff08\uff09\uff3b\uff3d\uff5b\uff5d\uff01\uff1f\uff1d\uff0b]",
        _SIGNS,
    ),
    (
        r"^\s*(else\s+if|elseif|elsif|elif)\b(?!.*:\s*(#.*)?$)|^\s*(else\s+if|elseif|elsif)\b",
        ("Write “elif” and a condition, then a colon.",),
    ),
    (
        r"^\s*(If|IF|Elif|Else|While|For|Def|Return|Class|Try|Except|Import|From|With)\b",
        ("Write the words of Python in small letters: “if”, “while”, “def”.",),
    ),
    (
        r"^\s*for\s+\w+\s*(=|from\b|to\b)",
        ("Write “for i in range(3):” to count, and “for one in names:” to go through a list.",),
    ),
    (
        r"^\s*print\s+[^=(\s]",
        ("Write what is printed in brackets behind “print”.",),
    ),
    (
        r"^\s*(var|let|const)\s+\w+|^\s*function\b|\bfunction\s*\(|^\s*#include\b|;\s*$"
        r"|\{\s*$|^\s*\}|&&|\|\||===|=>|^\s*//|^\s*/\*|\w(\+\+|--)\s*;?\s*$"
        r"|^\s*(int|float|double|string|String|bool|void|public|private)\s+\w+\s*[=({;]"
        r"|^\s*(switch|foreach|repeat|then|end|begin)\b",
        _OTHER_LANGUAGE,
    ),
    (
        r"^\s*(if|elif|while)\b[^=!<>]*[^=!<>:]=(?!=)",
        ("Compare with two signs: == asks whether both are the same, = puts a value in.",),
    ),
    (
        r"^\s*(if|elif|else|while|for|def|class|try|except|finally|with|match|case)\b[^:]*$",
        ("Write a colon at the end of this line.",),
    ),
    (
        r"^\s*(?!(?:if|elif|while|for|return|not|in|and|or|lambda)\b)"
        r"[^\W\d]\w*\s+\w+\s*=(?!=)|^\s*\d+[^\W\d]\w*\s*=(?!=)|^\s*\w+-\w+\s*=(?!=)",
        ("Write the name as one word, such as my_name: it begins with a letter.",),
    ),
)
"""What the line itself shows, the surest first."""

_FOREIGN = [row for row in _BY_LINE if row[1] is _OTHER_LANGUAGE]

_BY_MESSAGE: tuple[tuple[str, Sequence[Words]], ...] = (
    ("inconsistent use of tabs", _TABS),
    ("indent", _INDENT),
    ("expected ':'", ("Write a colon at the end of this line.",)),
    ("unterminated", _QUOTE),
    ("was never closed", _BRACKET),
    ("unmatched", _BRACKET),
    ("does not match opening", _BRACKET),
    (
        "Maybe you meant '=='",
        ("Compare with two signs: == asks whether both are the same, = puts a value in.",),
    ),
    ("perhaps you forgot a comma", ("Is a comma or a sign missing between two values?",)),
    ("invalid non-printable", _SIGNS),
    ("global declaration", ("Write the “global” line first in the function.",)),
    ("parameter and global", ("Give the variable another name.",)),
    ("outside function", ("Put it into a function below a “when” line.",)),
    ("outside loop", ("Put it into a “repeat”, “while” or “for each” block.",)),
    ("not properly in loop", ("Put it into a “repeat”, “while” or “for each” block.",)),
)
"""What the message of Python says, wherever it finds it."""


def checklist_of(error: SyntaxError, lines: Sequence[str]) -> Sequence[Words]:
    """What to try after a mistake: what fits this one first."""
    number, message = error.lineno or 1, error.msg or ""
    line = lines[number - 1] if 0 < number <= len(lines) else ""
    if "inconsistent use of tabs" in message or "indent" in message:
        above = lines[number - 2] if number > 1 else ""
        is_foreign = _fitting(_FOREIGN, above)
        usual = _EMPTY if message.startswith("expected an indented block after") else _INDENT
        return (*(is_foreign or ()), *(_TABS if "tabs" in message else usual))
    before = next((one for one in reversed(lines[: number - 1]) if one.strip()), "")
    if before.lstrip().startswith("@") and not line.lstrip().startswith(("def", "async", "@")):
        return (*_ALONE, _USUAL[-1])
    plain = _without_texts(line)
    found = _keyword_as_name(plain) or _fitting(_BY_LINE, plain)
    if found is None:
        found = next((told for part, told in _BY_MESSAGE if part in message), None)
    return (*found, _USUAL[-1]) if found is not None else _USUAL


def too_deep(tree: ast.AST | None, lines: Sequence[str]) -> CodeUnread:
    """That something is nested too deep to be read; the tree is None when there is none."""
    if tree is None:
        line = max(range(len(lines)), key=lambda n: len(lines[n]), default=0) + 1
    else:
        line = _deepest_line(tree)
    return CodeUnread(
        "This goes too deep into itself to be read.",
        line,
        checklist=("Divide it into several lines: put a part of it into a variable first.",),
    )


def _deepest_line(tree: ast.AST) -> int:
    """The line of the statement that goes deepest, as one outside of the functions or in one."""
    deepest, at = 0, 1
    waiting: list[tuple[ast.AST, int, int]] = [(tree, 0, 1)]
    while waiting:
        node, depth, line = waiting.pop()
        if isinstance(node, ast.stmt) and depth < _STATEMENTS:
            line = node.lineno
        if depth > deepest:
            deepest, at = depth, line
        waiting += [(child, depth + 1, line) for child in ast.iter_child_nodes(node)]
    return at


_STATEMENTS = 4
"""How deep a statement may be to be named itself, not the one around it."""


def _fitting(table: Sequence[tuple[str, Sequence[Words]]], line: str) -> Sequence[Words] | None:
    return next((told for pattern, told in table if re.search(pattern, line)), None)


def _without_texts(line: str) -> str:
    """A line without what is in its closed quotes, and without its comment."""
    kept = re.sub(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'", '""', line)
    return kept.partition("#")[0].rstrip() if not kept.lstrip().startswith("#include") else kept


def _keyword_as_name(line: str) -> Sequence[Words] | None:
    """Whether a word of Python is used as a name: “class = 5”, “def for():”."""
    found = re.search(r"^\s*(\w+)\s*[-+*/]?=(?!=)|^\s*(?:def|class|import|global)\s+(\w+)", line)
    named = found is not None and keyword.iskeyword(found[1] or found[2] or "")
    return _KEYWORD if named else None
