"""A node's description: one TOML file beside its code, ``nodes/<type>/<name>.toml``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from keyword import iskeyword
from pathlib import Path
from typing import Any, Literal, get_args

import msgspec

from faults import Text, Words
from faults.files import read_toml
from nep_core.errors import ManifestError, NodeNotFound, ParameterError
from nep_core.wire.messages import NodeType

ParameterType = Literal["text", "number", "integer", "boolean", "choice", "file"]
Restart = Literal["on-crash", "always", "on-kill", "never"]
"""When a node is started again: when it was killed, or failed after it had been ready (on-crash);
also when it ended by itself (always); only when it was killed (on-kill); never."""
READY_S = 10.0
MOST_READY_S = 3600.0
STOP_S, MOST_STOP_S = 2.0, 60.0
MOST_KEPT = 256
"""So many manifests are remembered, more than there are nodes to choose from."""

Value = str | float | int | bool

_EXAMPLES: dict[str, str] = {
    "text": 'a text, such as "karate"',
    "number": "a number, such as 0.5",
    "integer": "a whole number, such as 50",
    "boolean": "true or false",
    "choice": "one of the choices",
    "file": "the name of a file",
}


class Parameter(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """One setting of a node.

    ``reach``: what it lets the node reach that is not this program: other computers, or files. A
    setting that is ``secret`` is handed to the node where nobody else reads it.
    """

    type: ParameterType
    default: Value | None = None
    required: bool = False
    help: str = ""
    choices: list[str] = []
    minimum: float | None = None
    maximum: float | None = None
    reach: Literal["", "network", "file"] = ""
    secret: bool = False

    def read(self, name: str, value: object) -> Value:
        """``value`` (perhaps text, from a command line) as this type; raises ParameterError."""
        read: Value | None = None
        if self.type in ("number", "integer"):
            number = finite_number(value)
            if number is not None and self.allows(number):
                if self.type == "number":
                    read = number
                elif number == int(number):
                    read = int(number)
        elif self.type == "boolean":
            words = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
            if isinstance(value, bool):
                read = value
            elif isinstance(value, str):
                read = words.get(value.lower())
        elif isinstance(value, str):
            is_usable = value in self.choices if self.type == "choice" else "\0" not in value
            read = value if is_usable else None
        if read is None:
            raise ParameterError(
                'The setting "{name}" is {value}, but it takes {wanted}.',
                checklist=("Set {name} to {wanted}.",),
                name=name,
                value=repr(value),
                wanted=self._wanted(),
            )
        return read

    def allows(self, number: float) -> bool:
        """Whether the number is within its limits."""
        low = -math.inf if self.minimum is None else self.minimum
        high = math.inf if self.maximum is None else self.maximum
        return low <= number <= high

    def _wanted(self) -> Words:
        if self.type == "choice":
            return "one of " + ", ".join(self.choices)
        limits = [
            f"{word} {limit:g}"
            for word, limit in (("from", self.minimum), ("to", self.maximum))
            if limit is not None
        ]
        if limits:
            return " ".join([_EXAMPLES[self.type].partition(",")[0], *limits])
        return Text(_EXAMPLES[self.type])


class Manifest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """What a node is, hears, says and can be set to; ``command`` starts one that is not Python.

    ``titles`` are its title in other languages: ``{ de = "Gesten" }``. ``ready_s``: how long it may
    take to be ready; ``stop_s``: how long to end when it is asked, as a robot needs that goes to
    rest; ``restart``: when it is started again.
    """

    type: NodeType
    name: str
    title: str
    titles: dict[str, str] = {}
    description: str
    icon: str = "box"
    help: str = ""
    hears: list[str] = []
    says: list[str] = []
    aliases: list[str] = []
    parameters: dict[str, Parameter] = {}
    command: list[str] = []
    ready_s: float = READY_S
    stop_s: float = STOP_S
    restart: Restart = "on-crash"
    path: str = ""

    @property
    def id(self) -> str:
        """How the node is started: "sensory/virtual_watch"."""
        return f"{self.type}/{self.name}"

    @property
    def module(self) -> str:
        """The Python file's name beside the manifest."""
        return str(Path(self.path).with_suffix(".py"))

    def read_parameters(self, given: dict[str, Any]) -> dict[str, Value]:
        """All parameters, typed, defaults filled in; raises ParameterError."""
        for name in given:
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise ParameterError(
                    'The node {id} has no setting "{name}".',
                    checklist=("Its settings are: {known}.",),
                    id=self.id,
                    name=name,
                    known=known,
                )
        read = {}
        for name, parameter in self.parameters.items():
            if name not in given and (parameter.required or parameter.default is None):
                raise ParameterError(
                    'The node {id} needs the setting "{name}": {help}',
                    checklist=("Add {name}=... to it.",),
                    id=self.id,
                    name=name,
                    help=parameter.help,
                )
            read[name] = parameter.read(name, given.get(name, parameter.default))
        return read


def finite_number(value: object) -> float | None:
    """A finite number, from a number or its text; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None


def read_manifest(path: Path) -> Manifest:
    """The manifest in ``path``; raises ManifestError that names the file and the place.

    One that is read again, as by each check of a project, is read from the disk only when its file
    has changed.
    """
    try:
        state = path.stat()
    except OSError as error:
        raise _wrong(path, error) from error
    manifest = _read(path, state.st_mtime_ns, state.st_size)
    if not manifest.command and not path.with_suffix(".py").is_file():
        raise _wrong(path, f"there is no {path.stem}.py beside it, and it has no command")
    return manifest


@lru_cache(maxsize=MOST_KEPT)
def _read(path: Path, _changed_ns: int, _size: int) -> Manifest:
    try:
        manifest = msgspec.convert(read_toml(path), Manifest)
        manifest.path = str(path)
        _check(manifest)
    except (OSError, ParameterError) as error:
        raise _wrong(path, error) from error
    except (ValueError, RecursionError) as error:  # of TOML, UTF-8, numbers and types too
        raise _wrong(path, str(error)) from error
    if (manifest.type, manifest.name) != (path.parent.name, path.stem):
        raise _wrong(path, f"it describes {manifest.id}, but its place says otherwise")
    return manifest


def _check(manifest: Manifest) -> None:
    if not 0 < manifest.ready_s <= MOST_READY_S:
        raise ParameterError(
            "ready_s is {ready_s}, but 0 to {most_ready_s} s can be",
            ready_s=f"{manifest.ready_s:g}",
            most_ready_s=f"{MOST_READY_S:g}",
        )
    if not 0 < manifest.stop_s <= MOST_STOP_S:
        raise ParameterError(
            "stop_s is {stop_s}, but 0 to {most_stop_s} s can be",
            stop_s=f"{manifest.stop_s:g}",
            most_stop_s=f"{MOST_STOP_S:g}",
        )
    if any(not part or "\0" in part for part in manifest.command):
        raise ParameterError("its command has an empty word")
    for topic in (*manifest.hears, *manifest.says):
        if not topic.startswith("/"):
            raise ParameterError('the topic "{topic}" does not begin with /', topic=topic)
    for name, parameter in manifest.parameters.items():
        if not name.isidentifier() or iskeyword(name) or name == "node":
            raise ParameterError(
                '"{name}" cannot name a setting: use letters, digits and _', name=name
            )
        has_limits = parameter.minimum is not None or parameter.maximum is not None
        if has_limits and parameter.type not in ("number", "integer"):
            raise ParameterError('the setting "{name}" has limits, but is no number', name=name)
        if parameter.minimum is not None and not parameter.allows(parameter.minimum):
            raise ParameterError('the setting "{name}" has a minimum above its maximum', name=name)
        if parameter.type == "choice" and not parameter.choices:
            raise ParameterError('the setting "{name}" has no choices', name=name)
        if parameter.default is not None:
            parameter.read(name, parameter.default)


def _wrong(path: Path, reason: object) -> ManifestError:
    return ManifestError(
        "The description {name}/{name_2} cannot be used: {reason}.",
        checklist=(
            "Open {path} and correct the place that is named above.",
            "Compare it with the description of a node that works, such as "
            "sensory/virtual_watch.toml.",
            "It belongs into a folder named after its type: {get_args}.",
        ),
        name=path.parent.name,
        name_2=path.name,
        reason=reason,
        path=path,
        get_args=", ".join(get_args(NodeType)),
    )


@dataclass(frozen=True)
class NodeCatalog:
    """The nodes that can be started: all manifests in some folders, the first folder first."""

    folders: tuple[Path, ...]

    def find(self, type_and_name: str) -> Manifest:
        """The manifest of "sensory/virtual_watch" (or an alias); NodeNotFound, ManifestError."""
        type_, _, name = type_and_name.partition("/")
        for folder in self.folders:
            path = folder / type_ / f"{name}.toml"
            if type_ in get_args(NodeType) and name.isidentifier() and path.is_file():
                return read_manifest(path)
        for path in self.paths():
            if path.parent.name == type_ and name in _aliases(path):
                return read_manifest(path)
        known = ", ".join(f"{path.parent.name}/{path.stem}" for path in self.paths())
        raise NodeNotFound(
            'There is no node "{type_and_name}".',
            checklist=("These can be started: {known}.", "Check the spelling."),
            type_and_name=type_and_name,
            known=known,
        )

    def paths(self) -> list[Path]:
        """Where the manifests are."""
        return [
            path
            for folder in self.folders
            for type_ in get_args(NodeType)
            for path in sorted((folder / type_).glob("*.toml"))
        ]


def _aliases(path: Path) -> list[str]:
    try:
        return read_manifest(path).aliases
    except ManifestError:
        return []  # a wrong neighbour must not hide the others; starting it tells what is wrong
