"""What BehaviorTree.CPP has and blocks have not, said with the parts that both have.

``Switch``, ``IfThenElse``, ``_skipIf`` and the like become sequences, fallbacks and scripts that
are asked in the same order and end the same way. What a part does when it is *skipped*, which
blocks do not know, depends on where it stands: a sequence goes on as after a success, a fallback as
after a failure. Semantics: https://www.behaviortree.dev/docs/nodes-library and, for those of Nav2,
https://docs.nav2.org/behavior_trees/overview/nav2_specific_nodes.html
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Literal

from ..arithmetic import is_number_text
from .elements import DEEPEST, MOST_ELEMENTS, Element, too_large
from .scripts import assigned, used

Skipped = Literal["success", "failure"]
"""How a part ends, for the part around it, when it is skipped."""
Tell = Callable[..., None]

MARK = re.compile(r"\$?\{\s*=?([^{}]*)\}")
_OTHER: dict[Skipped, Skipped] = {"success": "failure", "failure": "success"}
_SWITCH = re.compile(r"Switch([2-9])")
_COMPARED = re.compile(r"BlackboardCheck(Int|Double|String|Bool)")
_EXPLICIT = ("Action", "Condition", "Control", "Decorator")
"""Groot can write any part so, with what it is as its ID."""
_RENAMED = {
    "FallbackStar": "Fallback",
    "Selector": "Fallback",
    "SequenceStar": "SequenceWithMemory",
    "ParallelNode": "Parallel",
    "SubTreePlus": "SubTree",
    "RetryUntilSuccesful": "RetryUntilSuccessful",
}
"""Parts that earlier versions called otherwise."""
SEQUENCES = ("Sequence", "AsyncSequence", "ReactiveSequence", "SequenceWithMemory")
FALLBACKS = ("Fallback", "AsyncFallback", "ReactiveFallback")
AROUND = (
    "Inverter",
    "ForceSuccess",
    "ForceFailure",
    "RetryUntilSuccessful",
    "Repeat",
    "KeepRunningUntilFailure",
    "Timeout",
    "Delay",
    "CoolDown",
)
KNOWN = frozenset(
    (
        *SEQUENCES,
        *FALLBACKS,
        *AROUND,
        "Parallel",
        "AlwaysSuccess",
        "AlwaysFailure",
        "Script",
        "ScriptCondition",
        "SetBlackboard",
        "Sleep",
        "IfThenElse",
        "WhileDoElse",
        "Precondition",
        "RecoveryNode",
        "RoundRobin",
        "RunOnce",
        "ParallelAll",
        "SubTree",
        *_RENAMED,
    )
)
CONDITIONS = ("_failureIf", "_successIf", "_skipIf", "_while")
SKIPPING = ("_skipIf", "_while")
SCRIPTS = ("_onSuccess", "_onFailure", "_post")
_PLUS = "__plus"
_ASKS = re.compile(
    r"(?i:is|are|has|have|can|could|should|would|was|were|does|did|check|compare)(?=[A-Z_])"
)
_ASKED_IN_NAV2 = frozenset(
    {
        "GoalReached",
        "GoalUpdated",
        "GlobalUpdatedGoal",
        "TransformAvailable",
        "DistanceTraveled",
        "TimeExpired",
        "PathExpiringTimer",
        "InitialPoseReceived",
    }
)


def asks(tag: str) -> bool:
    """Whether a part of which the file tells no more is a condition, by its name."""
    return tag in _ASKED_IN_NAV2 or _ASKS.match(tag) is not None


def marked(text: str) -> str:
    """The name in ``{name}`` or ``${name}``, or an empty text; ``{=}`` has none."""
    found = MARK.fullmatch(text.strip())
    return found[1].strip() if found else ""


@dataclass(slots=True)
class Plain:
    """Makes the parts of the trees of a file plain.

    ``is_told`` is whether the file tells of a part of this name, ``tell`` is given a template and
    its values where something is not the same.
    """

    is_told: Callable[[str], bool]
    tell: Tell
    taken: set[str]
    """The names of values in the file, and those that were made here."""
    is_version_3: bool = False
    _made: dict[str, int] = field(default_factory=dict)
    _parts: int = 0

    def tree(self, elements: Iterable[Element]) -> list[Element]:
        """Plain parts of a tree; raises TreeFileError if they are too many."""
        plain = self.all(elements)
        if any(part.depth() > DEEPEST for part in plain):
            raise too_large()
        return plain

    def all(self, elements: Iterable[Element], skipped: Skipped = "success") -> list[Element]:
        """Plain parts for these."""
        return [self.part(element, skipped) for element in elements]

    def part(self, element: Element, skipped: Skipped = "success") -> Element:
        """A plain part for one with all that is in it."""
        self._parts += 1  # a condition that is asked twice has others in it twice
        if self._parts > MOST_ELEMENTS:
            raise too_large()
        bare = _bare(element)
        said = bare.attributes
        bare.attributes = {
            key: text for key, text in said.items() if key not in (*CONDITIONS, *SCRIPTS)
        }
        plain = self._inside(bare, skipped)
        plain = self._with_outcomes(plain, said)
        plain = self._when_allowed(plain, said, skipped)
        if plain is not bare and (name := said.get("name")) and "name" not in plain.attributes:
            plain.attributes["name"] = name
        return plain

    # Conditions before a part, scripts after it

    def _with_outcomes(self, part: Element, said: dict[str, str]) -> Element:
        """A part, with the conditions that end it before it begins, and the scripts at its end."""
        if code := said.get("_successIf"):
            part = _row("Fallback", part, _asked(code), part)
        if code := said.get("_failureIf"):
            part = _row("Sequence", part, _not(_asked(code)), part)
        after = [code for key in ("_onSuccess", "_post") if (code := said.get(key))]
        if after:
            part = _row("Sequence", part, part, *map(_script, after))
        after = [code for key in ("_onFailure", "_post") if (code := said.get(key))]
        if after:
            done = _row("ForceFailure", part, _one_of(list(map(_script, after)), part))
            part = _row("Fallback", part, part, done)
        return part

    def _when_allowed(self, part: Element, said: dict[str, str], skipped: Skipped) -> Element:
        """A part that is skipped when its conditions say so."""
        first = [f"!({said[key]})" for key in ("_failureIf", "_successIf") if said.get(key)]
        if code := said.get("_while"):
            if skipped == "failure":
                part = _row("ReactiveSequence", part, _asked(code), part)
            else:
                part = _row("ReactiveFallback", part, _not(_asked(code)), part)
        if code := said.get("_skipIf"):
            code = " && ".join([*first, f"({code})"]) if first else code
            if skipped == "failure":
                part = _row("Sequence", part, _not(_asked(code)), part)
            else:
                part = _row("Fallback", part, _asked(code), part)
        return part

    # Parts that are made of others

    def _inside(self, part: Element, skipped: Skipped) -> Element:
        tag, children = part.tag, part.children
        if tag == "IfThenElse" and len(children) in (2, 3):
            return self._if(part, skipped)
        if tag == "WhileDoElse" and len(children) in (2, 3):
            return self._while(part, skipped)
        if (found := _SWITCH.fullmatch(tag)) and children:
            return self._switch(part, int(found[1]), skipped)
        if tag == "Precondition" and part.attributes.get("if") and children:
            asked = _asked(part.attributes["if"])
            return self._guarded(part, asked, part.attributes.get("else"), "", skipped)
        if _COMPARED.fullmatch(tag) and children:
            same = _same(part.attributes.get("value_A", ""), part.attributes.get("value_B", ""))
            otherwise = part.attributes.get("return_on_mismatch")
            return self._guarded(part, _asked(same), otherwise, "Reactive", skipped)
        if tag == "RecoveryNode" and len(children) == 2:
            return self._recovery(part)
        if tag == "RoundRobin":
            self.tell("“{name}” begins with its first part each time.", name=_name_of(part))
            return _row("Fallback", part, *self.all(children, "failure"))
        if tag == "RunOnce" and children:
            return self._once(part, skipped)
        if tag in ("Parallel", "ParallelAll") and (counted := self._counted(part)) is not None:
            return counted
        if tag == "Sleep" and not children:
            wait = Element("Delay", {"delay_msec": part.attributes.get("msec", "")}, part.line)
            wait.children = [Element("AlwaysSuccess", {}, part.line)]
            return wait
        if tag == "SubTree":
            return self._sub_tree(part)
        self._tell_skipped(part, skipped)
        inner: Skipped = skipped if tag in AROUND else "success"
        if tag in FALLBACKS:
            inner = "failure"
        elif tag == "Inverter":
            inner = _OTHER[skipped]
        part.children = self.all(children, inner)
        return part

    def _tell_skipped(self, part: Element, skipped: Skipped) -> None:
        """Tell where all that is in a part may be skipped, which it would pass on."""
        ends = {"ForceFailure": "failure", "ForceSuccess": "success", "Sequence": "success"}
        can_skip = [any(key in one.attributes for key in SKIPPING) for one in part.children]
        if all(can_skip) and can_skip and ends.get(part.tag, skipped) != skipped:
            self.tell(
                "“{name}” ends as ever, also where all in it is skipped.", name=_name_of(part)
            )

    def _sub_tree(self, part: Element) -> Element:
        """Names of values around have no brackets in version 3."""
        is_plus = part.attributes.pop(_PLUS, None) is not None
        for key, text in part.attributes.items():
            is_value = not is_plus and self.is_version_3 and text in self.taken
            if is_value and key not in ("ID", "name") and not key.startswith("_"):
                part.attributes[key] = f"{{{text}}}"
        return part

    def _if(self, part: Element, skipped: Skipped) -> Element:
        """Asks once, and goes on with what was chosen, whatever the condition becomes."""
        asked, then, *other = part.children
        asked = self.part(self._as_asked(asked), "failure")
        then, *other = self.all([then, *other], skipped)
        if not other:
            return _row("Sequence", part, asked, then)
        if _always_succeeds(then):
            return _row("Fallback", part, _row("Sequence", part, asked, then), *other)
        chosen = self._name("chosen")
        return _row(
            "Sequence",
            part,
            _script(f"{chosen} := false"),
            _row(
                "Fallback",
                part,
                _row("Sequence", part, asked, _script(f"{chosen} := true"), then),
                _row("Sequence", part, _asked(f"!{chosen}"), *other),
            ),
        )

    def _while(self, part: Element, skipped: Skipped) -> Element:
        """Asks at each look, and changes over when the answer does."""
        asked, then, *other = part.children
        asked = self._as_asked(asked)
        then, *other = self.all([then, *other], skipped)
        first = _row("ReactiveSequence", part, self.part(asked, "failure"), then)
        if not other:
            return first
        codes = [one.attributes.get("code", "") for one in asked.inner()]
        self._tell_changed(part, set(itertools.chain(*map(used, codes))), [then, *other])
        # Asked a second time in the same look, so that a failure of the first is one of the whole
        again = _row("ReactiveSequence", part, _not(self.part(asked, "failure")), *other)
        return _row("ReactiveFallback", part, first, again)

    def _switch(self, part: Element, cases: int, skipped: Skipped) -> Element:
        """Compares at each look, and changes over when another case holds."""
        variable = part.attributes.get("variable", part.attributes.get("case", ""))
        inside = self.all(part.children, skipped)
        if len(inside) != cases + 1:
            self.tell(
                "“{name}” has {count} parts in it, not {expected}: one for each case, and one for "
                "all others.",
                name=_name_of(part),
                count=len(inside),
                expected=cases + 1,
            )
        self._tell_changed(part, {marked(variable)}, inside)
        rows, others, seen = [], [], set[str]()
        for number, child in enumerate(inside[:cases], 1):
            case = part.attributes.get(f"case_{number}", "")
            if case not in seen:  # of two the first one holds
                seen.add(case)
                same = _same(variable, case)
                rows.append(_row("ReactiveSequence", part, _asked(same), child))
                others.append(f"!({same})")
        if inside[cases:]:
            none = _asked(" && ".join(others))
            rows.append(_row("ReactiveSequence", part, none, inside[cases]))
        return _row("ReactiveFallback", part, *rows)

    def _guarded(
        self, part: Element, asked: Element, otherwise: str | None, kind: str, skipped: Skipped
    ) -> Element:
        """Does what is in it if something holds, or while it does; else it ends as it says.

        ``otherwise`` is that end, ``kind`` is “Reactive” if it is asked at each look.
        """
        ends = (otherwise or "FAILURE").strip().upper()
        inside = _one_of(self.all(part.children, skipped), part)
        if ends == "SUCCESS" or (ends == "SKIPPED" and skipped == "success"):
            return _row(f"{kind}Fallback", part, _not(asked), inside)
        if ends == "RUNNING":
            asked = Element("RetryUntilSuccessful", {"num_attempts": "-1"}, part.line, [asked])
        return _row(f"{kind}Sequence", part, asked, inside)

    def _recovery(self, part: Element) -> Element:
        """Tries the first; after a failure does the second, and tries again, so many times."""
        first, second = part.children
        tries, worked = self._name("tries_left"), self._name("worked")
        retries = part.attributes.get("number_of_retries", "1").strip()
        first, second = self.part(first, "success"), self.part(second, "failure")
        repaired = _row(
            "Sequence",
            part,
            _asked(f"{tries} > 0"),
            second,
            _script(f"{tries} := {tries} - 1"),
        )
        tried = _row("Sequence", part, first, _script(f"{worked} := true"))
        # It is tried again after a repair only: else the whole ends, and has worked or not
        again = Element("RetryUntilSuccessful", {"num_attempts": "-1"}, part.line)
        again.children = [_row("Fallback", part, tried, _not(repaired))]
        begun = _script(f"{tries} := {marked(retries) or retries}; {worked} := false")
        return _row("Sequence", part, begun, again, _asked(worked))

    def _once(self, part: Element, skipped: Skipped) -> Element:
        """Does what is in it a single time; it is skipped after that, or ends as it did then."""
        done, worked = self._name("done_once"), self._name("worked")
        is_skipped = part.attributes.get("then_skip", "true").strip().lower() in ("true", "1")
        inside = _one_of(self.all(part.children, skipped), part)
        well = _row("Sequence", part, inside, _script(f"{done} := true; {worked} := true"))
        badly = _row("ForceFailure", part, _script(f"{done} := true; {worked} := false"))
        first = _row("Fallback", part, well, badly)
        if is_skipped and skipped == "success":
            return _row("Fallback", part, _asked(done), first)
        first = _row("Sequence", part, _not(_asked(done)), first)
        if is_skipped:
            return first
        return _row("Fallback", part, _row("Sequence", part, _asked(done), _asked(worked)), first)

    def _counted(self, part: Element) -> Element | None:
        """Parts side by side of which some may fail; None where the first failure ends all."""
        is_all, children = part.tag == "ParallelAll", part.children
        enough = _count(part, len(children), "success_count", "success_threshold", default=-1)
        most = _count(part, len(children), "failure_count", "failure_threshold", default=1)
        if is_all:
            enough = len(children)
            most = _count(part, len(children), "max_failures", default=1)
        if enough is None or most is None or not children:
            return None
        ends = len(children) + 1 if is_all else min(most, len(children) - enough + 1)
        if not is_all and ends <= 1:
            if most != 1:  # the first failure makes it impossible that enough succeed
                for key in ("failure_count", "failure_threshold"):
                    part.attributes.pop(key, None)
            return None
        failed = self._name("failed")
        waits = Element("KeepRunningUntilFailure", {}, part.line, [Element("AlwaysSuccess", {})])
        rows = []
        for child in self.all(children):
            counts = [_script(f"{failed} := {failed} + 1")]
            if not is_all:
                counts += [_asked(f"{failed} < {ends}"), waits]
            rows.append(_row("Fallback", part, child, _one_of(counts, part)))
        beside = Element("Parallel", {"success_count": str(enough)}, part.line, rows)
        asked = [_asked(f"{failed} < {most}")] if is_all else []
        return _row("Sequence", part, _script(f"{failed} := 0"), beside, *asked)

    def _tell_changed(self, part: Element, names: set[str], inside: list[Element]) -> None:
        """Tell where what is asked for at each look is changed by what is done meanwhile."""
        for name in sorted(names):
            if any(
                name in assigned(one.attributes.get("code", ""))
                for row in inside
                for one in row.inner()
            ):
                self.tell(
                    "“{name}” asks for “{value}”, which changes in it: if it fails then, another "
                    "part of it may follow.",
                    name=_name_of(part),
                    value=name,
                )

    def _as_asked(self, part: Element) -> Element:
        """What stands where a condition does is one, if the file does not tell what it is."""
        if part.tag == "Inverter" and len(part.children) == 1:
            inside = [self._as_asked(part.children[0])]
            return Element(part.tag, part.attributes, part.line, inside)
        is_known = part.tag in (*_EXPLICIT, *KNOWN) or self.is_told(part.tag)
        if is_known or part.children:
            return part
        return Element("Condition", {"ID": part.tag, **part.attributes}, part.line)

    def _name(self, word: str) -> str:
        """A name for a value, which the file does not have."""
        while True:
            self._made[word] = number = self._made.get(word, 0) + 1
            name = word if number == 1 else f"{word}_{number}"
            if name not in self.taken:
                self.taken.add(name)
                return name


def _bare(element: Element) -> Element:
    """A copy of a part as version 4 writes it; what is in it is as it was."""
    tag, attributes = element.tag, dict(element.attributes)
    named = attributes.get("ID", "")
    is_made = named in KNOWN or _SWITCH.fullmatch(named) or _COMPARED.fullmatch(named)
    if tag in _EXPLICIT and is_made:
        tag = named
        del attributes["ID"]
    if tag == "SubTreePlus":
        attributes[_PLUS] = ""
    tag = _RENAMED.get(tag, tag)
    if tag == "Parallel" and "threshold" in attributes:
        attributes["success_count"] = attributes.pop("threshold")
    return Element(tag, attributes, element.line, list(element.children))


def _count(part: Element, parts: int, *keys: str, default: int) -> int | None:
    """How many of the parts an attribute means: one below zero counts from all of them."""
    text = next((part.attributes[key] for key in keys if key in part.attributes), str(default))
    if not is_number_text(text.strip()) or not text.strip().lstrip("-").isdigit():
        return None
    number = int(text)
    return number if number >= 0 else max(0, parts + number + 1)


def _row(tag: str, part: Element, *children: Element) -> Element:
    return Element(tag, {}, part.line, list(children))


def _one_of(parts: list[Element], part: Element) -> Element:
    return parts[0] if len(parts) == 1 else _row("Sequence", part, *parts)


def _asked(code: str) -> Element:
    return Element("ScriptCondition", {"code": code})


def _script(code: str) -> Element:
    return Element("Script", {"code": code})


def _not(asked: Element) -> Element:
    return Element("Inverter", {}, asked.line, [asked])


def _always_succeeds(part: Element) -> bool:
    return part.tag in ("ForceSuccess", "AlwaysSuccess")


def _name_of(part: Element) -> str:
    return part.attributes.get("name", part.attributes.get("ID", part.tag))


def _same(a: str, b: str) -> str:
    """A script that compares what two attributes hold."""
    return f"{_in_script(a)} == {_in_script(b)}"


def _in_script(text: str) -> str:
    if name := marked(text):
        return name
    is_plain = text in ("true", "false") or is_number_text(text)
    return text if is_plain else "'" + text.replace("'", "") + "'"
