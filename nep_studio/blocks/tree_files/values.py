"""Which values the trees of a file need and set, and what each gets from the tree around it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

from .elements import Element
from .plain import marked
from .scripts import NAME, assigned, used

NOT_PORTS = frozenset({"ID", "name"})
_SHARED = ("_autoremap", "__autoremap", "__shared_blackboard")


@dataclass(slots=True)
class Values:
    """The values of one tree by name: what it needs, what it sets, what it is given."""

    needed: dict[str, None] = field(default_factory=dict)
    sets: dict[str, None] = field(default_factory=dict)
    given: set[str] = field(default_factory=set)
    calls: list[Element] = field(default_factory=list)

    def missing(self) -> list[str]:
        """What it needs and nothing gives it."""
        return [key for key in self.needed if key not in self.sets and key not in self.given]


def ports_of(element: Element) -> dict[str, str]:
    """The attributes of a part that are ports."""
    return {
        key: text
        for key, text in element.attributes.items()
        if key not in NOT_PORTS and not key.startswith("_")
    }


def output_name(text: str) -> str:
    """The value that an output port goes to: version 3 may name it without brackets."""
    return marked(text) or (text if NAME.fullmatch(text) else "")


def names_in(root: Element) -> set[str]:
    """The names of all values in a file, as far as it says that they are some."""
    found: set[str] = set()
    for element in root.inner():
        for key, text in element.attributes.items():
            if name := marked(text):
                found.add(name)
            elif key == "code" or (key.startswith("_") and key != "_description"):
                found.update(assigned(text))
        if element.tag == "SetBlackboard" or element.attributes.get("ID") == "SetBlackboard":
            found.add(key_of(element))
        if element.tag in ("input_port", "output_port", "inout_port"):
            found.add(element.attributes.get("name", ""))
        if element.tag == "remap":
            found.update(element.attributes.values())
    return found


def key_of(element: Element) -> str:
    """The name of the value that a SetBlackboard sets."""
    key = element.attributes.get("output_key", element.attributes.get("key", ""))
    return marked(key) or key


def values_of(
    trees: dict[str, list[Element]],
    is_output: Callable[[Element, str], bool],
    is_entry: Callable[[str], bool],
) -> dict[str, Values]:
    """The values of the trees of a file, by their names; ports that it shares are written out."""
    found = {name: _own_values(parts, is_output, is_entry) for name, parts in trees.items()}
    for _ in found:  # what a tree shares may come from one in it
        for values in found.values():
            for call in values.calls:
                if (inside := found.get(call.attributes.get("ID", ""))) is not None:
                    _share(call, values, inside)
    for values in found.values():
        for call in values.calls:
            for key in _SHARED:
                call.attributes.pop(key, None)
            inside = found.get(call.attributes.get("ID", ""))
            for key, text in _given(call).items():
                name = marked(text)
                if inside is not None:
                    inside.given.add(key)
                if name and (inside is None or key in inside.sets):
                    values.sets.setdefault(name)
    return found


def _own_values(
    parts: Iterable[Element],
    is_output: Callable[[Element, str], bool],
    is_entry: Callable[[str], bool],
) -> Values:
    values = Values()
    for element in (one for part in parts for one in part.inner()):
        if element.tag == "SubTree":
            values.calls.append(element)
            continue
        if element.tag == "SetBlackboard":
            values.sets.setdefault(key_of(element))
        if element.tag in ("Script", "ScriptCondition"):
            code = element.attributes.get("code", "")
            values.needed.update(dict.fromkeys(filter(is_entry, used(code))))
            values.sets.update(dict.fromkeys(assigned(code)))
            continue
        for key, text in ports_of(element).items():
            if is_output(element, key):
                if name := output_name(text):
                    values.sets.setdefault(name)
            elif (name := marked(text)) and key not in ("output_key", "key"):
                values.needed.setdefault(name)
    return values


def _given(call: Element) -> dict[str, str]:
    given = ports_of(call)
    for remap in call.named("remap"):  # as version 3 says it
        inner, outer = (remap.attributes.get(key, "") for key in ("internal", "external"))
        given[inner] = f"{{{outer}}}"
    return given


def _share(call: Element, around: Values, inside: Values) -> None:
    """Write out what a tree shares with the one around it: all, or what is of the whole file."""
    is_all = any(_is_true(call.attributes.get(key, "")) for key in _SHARED)
    known = _given(call)
    for key in [*inside.needed, *inside.sets]:
        is_shared = key.startswith("@") or (is_all and not key.startswith("_"))
        if is_shared and key not in known:
            call.attributes[key] = f"{{{key}}}"
            if key in inside.needed and key not in inside.sets:
                around.needed.setdefault(key)
            if key in inside.sets:
                around.sets.setdefault(key)


def _is_true(text: str) -> bool:
    return text.strip().lower() in ("1", "true", "yes")


def given_to(call: Element) -> Iterator[tuple[str, str]]:
    """What goes into a tree, by name, as the file writes it."""
    yield from _given(call).items()
