"""The text of a file as JSON values; what is wrong with it is told with its place, in plain words.

Nothing here trusts the file. Nothing is read by recursion but the JSON, which msgspec limits.
"""

from __future__ import annotations

import re

import msgspec

from faults import Text, Words, text_of

from .errors import BlocksError, ProjectFileError

OLD_COPY = "Open an older copy of the file, if there is one."

_WORDS = {
    "str": "a text",
    "int": "a whole number",
    "float": "a number",
    "bool": "yes or no",
    "object": "a group of values",
    "array": "a list",
    "null": "nothing",
}


class Flaw(BlocksError):
    """What is wrong with a file, and with which block."""

    def __init__(self, sentence: Words, block: str = "", /, **values: object) -> None:
        super().__init__(text_of(sentence, **values))
        self.block = block


MOST_VALUES = 400_000
"""So many values can be in a file: each takes some hundred bytes of memory, and two of the file."""


def decode(data: bytes, file_name: str) -> object:
    """The values in a JSON file, or ProjectFileError."""
    if data.count(b",") > MOST_VALUES:
        raise ProjectFileError(
            "{file_name} holds too many values: {most} at most.",
            checklist=("Take blocks or recordings out of it into another project.", OLD_COPY),
            file_name=file_name,
            most=MOST_VALUES,
        )
    try:
        return msgspec.json.decode(data.removeprefix(b"\xef\xbb\xbf"))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        sentence, place = _why_not_json(data, error)
        raise ProjectFileError(
            "{file_name} cannot be read{place}: {sentence}",
            checklist=("Was the file copied completely? Copy it again.", OLD_COPY),
            details=str(error),
            file_name=file_name,
            place=place,
            sentence=sentence,
        ) from error


def place_in(data: bytes, block: str) -> Text:
    """Where a block is in a file, as " at line 3, block b2"; nothing when no block is meant."""
    if not block:
        return Text("")
    entry = re.search(rb'"id"\s*:\s*"' + re.escape(block.encode()) + rb'"', data)
    if entry is None:
        return text_of(" at block {block}", block=block)
    line = _line_at(data, entry.start())
    return text_of(" at line {line}, block {block}", line=line, block=block)


def in_words(error: msgspec.ValidationError) -> Text:
    """Turn “Expected `str`, got `int` - at `$.name`” into words."""
    what, _, where = str(error).partition(" - at ")
    place = re.sub(r"\[(\d+)\]", _entry, where.strip("`").removeprefix("$").lstrip("."))
    place = place.replace("[...]", "").replace(" .", ", ").strip()
    return _what_in_words(what, place or Text("its beginning"))


def is_deeper(value: object, limit: int) -> bool:
    """Whether lists and groups of values are in each other more than ``limit`` times."""
    layer = [value]
    for _ in range(limit):
        layer = [
            inner
            for outer in layer
            if isinstance(outer, dict | list)
            for inner in (outer.values() if isinstance(outer, dict) else outer)
        ]
        if not layer:
            return False
    return True


def _what_in_words(what: str, place: Text | str) -> Text:
    missing = re.fullmatch(r"Object missing required field `(\w+)`", what)
    if missing:
        return text_of("at {place}: “{missing}” is missing.", place=place, missing=missing[1])
    expected = re.fullmatch(r"Expected `([^`]+)`, got `(\w+)`", what)
    if expected is None:
        return text_of("at {place}: this is not what belongs here.", place=place)
    kinds = [_WORDS.get(word, "a value") for word in expected[1].split(" | ")]
    return text_of(
        "at {place}: {wanted} belongs here, not {told}.",
        place=place,
        wanted=Text(kinds[0]) if len(kinds) == 1 else " or ".join(kinds),
        told=Text(_WORDS.get(expected[2], "this")),
    )


def _entry(match: re.Match[str]) -> str:
    return f" number {int(match[1]) + 1} "


def _why_not_json(data: bytes, error: Exception) -> tuple[Text, Text]:
    """A sentence and a place for what msgspec says about a file that is no JSON."""
    if isinstance(error, UnicodeDecodeError):
        return Text("it is not text in UTF-8."), Text("")
    if isinstance(error, RecursionError):
        return Text("groups are nested too deep in it."), Text("")
    if isinstance(error, msgspec.ValidationError):
        return Text("there is a number in it that is too large."), _place_of_number(data)
    # Whether data that is no JSON only lacks its end: then what follows it changes the fault
    longer = data + bytes(8)  # more than any letter that is cut in two
    if _json_fault(data) != _json_fault(longer):
        return Text("it ends too early, as if a part of it were missing."), Text("")
    byte = re.search(r"\(byte (\d+)\)", str(error))
    line = _line_at(data, int(byte[1]) if byte else 0)
    return Text("this is not how a project is written."), text_of(" at line {number}", number=line)


def _json_fault(data: bytes) -> str:
    try:
        msgspec.json.decode(data.removeprefix(b"\xef\xbb\xbf"))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        return str(error)
    return ""


def _line_at(data: bytes, offset: int) -> int:
    return data.count(b"\n", 0, offset) + 1


def _place_of_number(data: bytes) -> Text:
    for number, line in enumerate(data.splitlines(), start=1):
        try:
            msgspec.json.decode(line.strip().rstrip(b","))
        except msgspec.ValidationError:
            return text_of(" at line {number}", number=number)
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            continue
    return Text("")
