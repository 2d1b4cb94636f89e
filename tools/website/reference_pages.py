"""What nobody writes twice: pages of all messages and commands, the table of benchmarks."""

from __future__ import annotations

import ast
import contextlib
import io
import os
import re
from collections.abc import Iterator, Mapping
from html import escape
from inspect import cleandoc
from pathlib import Path
from typing import Any

import msgspec
from msgspec.inspect import Field

from benchmarks.__main__ import FOLDER, benchmark_names
from nep_core.cli import overview
from nep_core.processes.manifest import Manifest
from nep_core.wire.messages import BY_TOPIC, LATCHED
from nep_studio.__main__ import USAGE, main

from .page import HERE, Page, scrolling_table

MESSAGES_PATH = "messages.html"
ABOUT_MESSAGES = "What nodes send each other: every topic with the keys of its messages."
_CODE = re.compile(r"``(.+?)``")


def messages_page(nodes: Mapping[str, Manifest], title_of: Mapping[str, str]) -> Page:
    """Every topic, its message, who hears and says it; ``title_of`` are titles of nodes by id."""
    parts = [
        '<h1 id="top">Messages</h1>',
        f"<p>{ABOUT_MESSAGES} A message travels as one JSON object. Keys that a receiver does not "
        "know are left aside; a key that is missing, or of another type, is an error that names "
        "it. Times are seconds since 1970, angles rad, lengths m, unless a name says else.</p>",
        f'<p>How they are put on the wire: <a href="{HERE}developers/wire.html">the wire</a>. '
        "To read them as they come: <code>nep echo TOPIC</code>.</p>",
    ]
    for topic, struct in BY_TOPIC.items():
        parts += _topic(topic, struct, nodes, title_of)
    return Page(MESSAGES_PATH, "Messages", "\n".join(parts), "messages", about=ABOUT_MESSAGES)


def _topic(
    topic: str,
    struct: type[msgspec.Struct],
    nodes: Mapping[str, Manifest],
    title_of: Mapping[str, str],
) -> Iterator[str]:
    yield f'<h2 id="{topic.strip("/")}"><code>{topic}</code>: {struct.__name__}</h2>'
    yield _told(struct)
    if topic in LATCHED:
        yield "<p>Who comes late gets the last message at once.</p>"
    for verb, side in (("Said", "says"), ("Heard", "hears")):
        links = [
            f'<a href="{HERE}nodes/{name.replace("/", "-")}.html">{escape(title_of[name])}</a>'
            for name, manifest in nodes.items()
            if topic in getattr(manifest, side)
        ]
        if links:
            yield f"<p>{verb} by: {', '.join(links)}.</p>"
    yield _keys(struct)
    for inner in _inner(struct):
        yield f"<h3>{inner.__name__}</h3>"
        yield _told(inner)
        yield _keys(inner)


def _told(struct: type[msgspec.Struct]) -> str:
    paragraphs = cleandoc(struct.__doc__ or "").split("\n\n")
    return "".join(f"<p>{_CODE.sub(_code, escape(part))}</p>" for part in paragraphs)


def _code(found: re.Match[str]) -> str:
    return f"<code>{found[1]}</code>"


def _keys(struct: type[msgspec.Struct]) -> str:
    heads = "".join(f"<th>{head}</th>" for head in ("Key", "What it holds", "Usually"))
    info = msgspec.inspect.type_info(struct)
    assert isinstance(info, msgspec.inspect.StructType)
    rows = "".join(_row(field) for field in info.fields)
    return scrolling_table(f"<tr>{heads}</tr>{rows}")


def _row(field: Field) -> str:
    usual = "must be there"
    if not field.required:
        default = field.default if field.default is not msgspec.NODEFAULT else _made(field)
        usual = "" if default == "" else f"<code>{escape(_json(default))}</code>"
    kind = escape(_kind(field.type))
    return f"<tr><td><code>{field.encode_name}</code></td><td>{kind}</td><td>{usual}</td></tr>"


def _made(field: Field) -> object:
    """What a default that is made anew each time is: empty things, or the time now."""
    made = field.default_factory()
    return made if isinstance(made, list | dict) else "now"


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode() if value != "now" else "now"


def _kind(told: Any) -> str:
    """A type in words."""
    inspect = msgspec.inspect
    match told:
        case inspect.StrType():
            return "text"
        case inspect.BoolType():
            return "true or false"
        case inspect.IntType():
            return "whole number"
        case inspect.FloatType():
            return "number"
        case inspect.NoneType():
            return "null"
        case inspect.LiteralType():
            return "one of: " + ", ".join(str(value) or '""' for value in told.values)
        case inspect.ListType() | inspect.VarTupleType():
            return f"list of ({_kind(told.item_type)})"
        case inspect.TupleType():
            return f"{len(told.item_types)} values: {', '.join(_kind(t) for t in told.item_types)}"
        case inspect.DictType():
            return f"object: {_kind(told.value_type)} by name"
        case inspect.UnionType():
            return " or ".join(_kind(each) for each in told.types)
        case inspect.StructType():
            return told.cls.__name__
    return "anything"


def _inner(struct: type[msgspec.Struct]) -> Iterator[type[msgspec.Struct]]:
    """The structs that stand inside of a message."""
    info = msgspec.inspect.type_info(struct)
    assert isinstance(info, msgspec.inspect.StructType)
    for field in info.fields:
        item = getattr(field.type, "item_type", None)
        if isinstance(item, msgspec.inspect.StructType):
            yield item.cls


COMMANDS_PATH = "commands.html"
ABOUT_COMMANDS = "What can be done in a terminal: every command, with what it says about itself."
COLUMNS = "80"
_JOB = re.compile(r"^  nep-studio (\w+)", re.M)


def commands_page() -> Page:
    """Every job of ``nep-studio`` with its help; those of ``nep`` have a page of their own."""
    parts = [
        '<h1 id="top">Commands</h1>',
        f"<p>{ABOUT_COMMANDS}</p>",
        '<h2 id="nep-studio">nep-studio</h2>',
        _shown(USAGE),
    ]
    for job in jobs():
        parts += [f'<h3 id="{job}">nep-studio {job}</h3>', _shown(help_of(job))]
    parts += [
        '<h2 id="nep">nep</h2>',
        f'<p>For robot developers; <a href="{HERE}developers/command_line.html">the command line '
        "nep</a> has each command with examples.</p>",
        _shown(overview()),
    ]
    return Page(COMMANDS_PATH, "Commands", "\n".join(parts), "commands", about=ABOUT_COMMANDS)


def jobs() -> list[str]:
    """What ``nep-studio`` can do, as it says itself; jobs that only it asks for are not told."""
    return _JOB.findall(USAGE)


def help_of(job: str) -> str:
    """What ``nep-studio JOB --help`` prints."""
    os.environ["COLUMNS"] = COLUMNS
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.suppress(SystemExit):
        main([job, "--help"])
    return printed.getvalue()


def _shown(text: str) -> str:
    return f'<pre tabindex="0"><code>{escape(text.strip())}</code></pre>'


def benchmark_rows() -> str:
    """A row for each benchmark: its name, and what it measures."""
    return "\n".join(
        f"| `{name}` | {_measured(FOLDER / f'{name}.py')} |" for name in benchmark_names(FOLDER)
    )


def _measured(path: Path) -> str:
    """The first line of a module's docstring; it is read without running the module."""
    told = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return told.splitlines()[0].replace("|", "\\|")
