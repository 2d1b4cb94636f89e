"""Which values the trees of a file need and set, and what each gets from the tree around it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from .elements import Element
from .plain import CONDITIONS, SCRIPTS, marked
from .scripts import NAME, assigned, happens

NOT_PORTS = frozenset({"ID", "name"})
_CODE = frozenset(("code", *CONDITIONS, *SCRIPTS, "_onHalted"))
_SHARED = ("_autoremap", "__autoremap", "__shared_blackboard")


@dataclass(slots=True)
class Values:
    """The values of one tree by name: what it needs first, what it sets, what it is given.

    ``events`` are what happens with them, in the order of the file: “needs” and “sets” with a
    name, or a tree in it.
    """

    events: list[tuple[str, str] | Element] = field(default_factory=list)
    needed: dict[str, None] = field(default_factory=dict)
    sets: dict[str, None] = field(default_factory=dict)
    given: set[str] = field(default_factory=set)

    def missing(self) -> list[str]:
        """What it needs and nothing gives it."""
        return [key for key in self.needed if key not in self.given]


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
            elif key in _CODE:
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
    found = {name: Values() for name in trees}
    for name, parts in trees.items():
        for element in (one for part in parts for one in part.inner()):
            found[name].events += _events(element, is_output, is_entry)
    for _ in range(len(found) + 1):  # what a tree needs may come from one in it
        for values in found.values():
            _follow(values, found)
    for values in found.values():
        for call in (one for one in values.events if isinstance(one, Element)):
            for key in _SHARED:
                call.attributes.pop(key, None)
            if (inside := found.get(call.attributes.get("ID", ""))) is not None:
                inside.given |= _given(call).keys()
    return found


def _events(
    element: Element,
    is_output: Callable[[Element, str], bool],
    is_entry: Callable[[str], bool],
) -> Iterator[tuple[str, str] | Element]:
    if element.tag == "SubTree":
        yield element
        return
    code = element.attributes.get("code", "")
    if element.tag in ("Script", "ScriptCondition"):
        yield from (event for event in happens(code) if is_entry(event[1]))
        return
    after = []
    for key, text in ports_of(element).items():
        if is_output(element, key):
            after.append(output_name(text))
        elif (name := marked(text)) and key not in ("output_key", "key"):
            yield "needs", name
    if element.tag == "SetBlackboard":
        after.append(key_of(element))
    yield from (("sets", name) for name in after if name)


def _follow(values: Values, found: dict[str, Values]) -> None:
    """Reckon what a tree needs before it is set, with what is known of those in it by now."""
    needed, sets = dict[str, None](), dict[str, None]()
    for event in values.events:
        if isinstance(event, Element):
            inside = found.get(event.attributes.get("ID", ""))
            if inside is not None:
                _share(event, inside)
            for key, text in _given(event).items():
                if (name := marked(text)) and inside is not None and key in inside.needed:
                    needed.update({} if name in sets else {name: None})
                if name and (inside is None or key in inside.sets):
                    sets.setdefault(name)
        elif event[0] == "sets":
            sets.setdefault(event[1])
        elif event[1] not in sets:
            needed.setdefault(event[1])
    values.needed, values.sets = needed, sets


def _given(call: Element) -> dict[str, str]:
    given = ports_of(call)
    for remap in call.named("remap"):  # as version 3 says it
        inner, outer = (remap.attributes.get(key, "") for key in ("internal", "external"))
        given[inner] = f"{{{outer}}}"
    return given


def _share(call: Element, inside: Values) -> None:
    """Write out what a tree shares with the one around it: all, or what is of the whole file."""
    is_all = any(_is_true(call.attributes.get(key, "")) for key in _SHARED)
    known = _given(call)
    # Those of the whole file are last, as they are not written out again
    for key in sorted([*inside.needed, *inside.sets], key=lambda key: key.startswith("@")):
        is_shared = key.startswith("@") or (is_all and not key.startswith("_"))
        if is_shared and key not in known:
            call.attributes[key] = f"{{{key}}}"


def _is_true(text: str) -> bool:
    return text.strip().lower() in ("1", "true", "yes")


def given_to(call: Element) -> Iterator[tuple[str, str]]:
    """What goes into a tree, by name, as the file writes it."""
    yield from _given(call).items()
