"""XML that may come from anywhere, as plain elements: no entities, no endless depth."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from ..errors import BlocksError

LARGEST = 2_000_000
DEEPEST = 100
MOST_ELEMENTS = 10_000
LARGEST_INCLUDED = 50
"""So many files may be included."""

_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_LOOSE_AND = re.compile(rb"&(?!#?\w+;)")
"""BehaviorTree.CPP takes lines of dashes in comments, and “&&” in scripts, as its own examples have
them; XML forbids both."""

_FROM_GROOT = "Is it a file that Groot or BehaviorTree.CPP wrote?"


class TreeFileError(BlocksError):
    """A file of behaviour trees that cannot be read."""

    title = "These behaviour trees cannot be read"


@dataclass(slots=True)
class Element:
    """An element with what is in it, besides text; ``line`` is where it begins, from 1."""

    tag: str
    attributes: dict[str, str]
    line: int = 0
    children: list[Element] = field(default_factory=list)

    def named(self, *tags: str) -> Iterator[Element]:
        """The elements directly in it that have one of these tags."""
        return (child for child in self.children if child.tag in tags)

    def depth(self) -> int:
        """How many elements are inside each other, itself one of them."""
        deepest, waiting = 0, [(self, 1)]
        while waiting:
            element, depth = waiting.pop()
            deepest = max(deepest, depth)
            waiting += [(child, depth + 1) for child in element.children]
        return deepest

    def inner(self) -> Iterator[Element]:
        """All elements in it, and itself, the outer ones first."""
        waiting = [self]
        while waiting:
            element = waiting.pop()
            yield element
            waiting += reversed(element.children)


def too_large() -> TreeFileError:
    """What is said of trees with too many parts."""
    return TreeFileError(
        "The trees are too large: {deepest} parts inside each other, and {most} in all, at most.",
        checklist=(_FROM_GROOT, "Make smaller trees, and several files."),
        deepest=DEEPEST,
        most=MOST_ELEMENTS,
    )


def read_elements(content: bytes) -> Element:
    """The outermost element of an XML file, or TreeFileError."""
    if len(content) > LARGEST:
        raise TreeFileError(
            "The file is too large: {size} bytes, {largest} at most.",
            checklist=(_FROM_GROOT, "Make smaller trees, and several files."),
            size=len(content),
            largest=LARGEST,
        )
    builder = _Builder()
    try:
        plain = _LOOSE_AND.sub(b"&amp;", _COMMENT.sub(_blank, content))
        builder.parser.Parse(plain, True)
    except expat.ExpatError as error:
        raise TreeFileError(
            "Line {line} is no XML: {reason}.",
            checklist=(_FROM_GROOT, "Open it in a text editor, and look at this line."),
            line=error.lineno,
            reason=expat.ErrorString(error.code),
        ) from error
    except (ValueError, LookupError) as error:  # an encoding that is not known
        raise TreeFileError(
            "The file is no XML that can be read: {reason}.",
            checklist=(_FROM_GROOT, "Save it as UTF-8."),
            reason=str(error),
        ) from error
    return builder.outermost


def read_file(path: Path) -> Element:
    """The outermost element of a file, with what stands in the files that it includes.

    Those lie beside it or in folders there; an “include” stays where one cannot be read. Raises
    TreeFileError or OSError for the file itself.
    """
    root = _read(path)
    seen, left = {path.resolve()}, LARGEST_INCLUDED
    waiting = [(path, include) for include in root.named("include")]
    root.children = [child for child in root.children if child.tag != "include"]
    while waiting:
        beside, include = waiting.pop(0)
        inside = _included(beside, include)
        if inside is None or left == 0:
            root.children.append(include)
        elif inside.resolve() not in seen:
            seen.add(inside.resolve())
            left -= 1
            added = _read(inside)
            waiting += [(inside, one) for one in added.named("include")]
            root.children += [one for one in added.children if one.tag != "include"]
    return root


def _read(path: Path) -> Element:
    with path.open("rb") as file:
        return read_elements(file.read(LARGEST + 1))


def _included(beside: Path, include: Element) -> Path | None:
    """The file that another one includes, if it is there."""
    said = include.attributes.get("path", "").replace("\\", "/")
    if not said or "ros_pkg" in include.attributes or Path(said).is_absolute():
        return None
    inside = beside.parent / said
    is_near = inside.resolve().is_relative_to(beside.parent.resolve().parent)
    return inside if is_near and inside.is_file() else None


def _blank(comment: re.Match[bytes]) -> bytes:
    """The lines of a comment, empty."""
    return b"\n" * comment[0].count(b"\n")


class _Builder:
    """Puts the elements of a file together as the parser meets them."""

    def __init__(self) -> None:
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        # Entities are declared there: a few lines of them can fill all memory, or open files
        self.parser.StartDoctypeDeclHandler = self._refuse_declarations
        self._around = [Element("", {})]
        self._count = 0

    @property
    def outermost(self) -> Element:
        return self._around[0].children[0]

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if len(self._around) > DEEPEST or self._count > MOST_ELEMENTS:
            raise too_large()
        element = Element(tag, attributes, self.parser.CurrentLineNumber)
        self._around[-1].children.append(element)
        self._around.append(element)

    def _end(self, _tag: str) -> None:
        self._around.pop()

    def _refuse_declarations(self, *_declared: object) -> None:
        raise TreeFileError(
            "The file declares things of its own (DOCTYPE), as no file of behaviour trees does.",
            checklist=("Take the lines with “DOCTYPE” out.", _FROM_GROOT),
        )
