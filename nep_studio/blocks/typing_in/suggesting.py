"""Suggestions for what a person types: "say hello", "repeat 10", "set score to 5", "x + 1"."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from nep_studio.blocks.definitions import Definition, Group, Slot
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.edits.project import AddVariable
from nep_studio.blocks.from_python.learning import Made, blocks_of
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, clip_of
from nep_studio.blocks.operations.finding import folded
from nep_studio.blocks.operations.moving import why_not_create
from nep_studio.blocks.places import NewStack, Place
from nep_studio.blocks.program import Parent, Project, Variable
from nep_studio.blocks.text import sentence

from .vocabulary import Entry, Filler, Filling, Vocabulary, is_quoted, number_in, spaced, vocabulary

# The sentence of a suggested block, and where in it the typed words are.


def label_of(
    made: Made, language: Language, project: Project, new_variables: Mapping[str, str]
) -> str:
    """What the block will say."""
    shown = Project(project.name)
    shown.variables = [*project.variables]
    shown.variables += [Variable(new, name) for new, name in new_variables.items()]
    roots, blocks = blocks_of(shown, language, [made])
    shown.blocks = {block.id: block for block in blocks}
    shown.parents = {root: Parent("s0") for root in roots}
    return sentence(shown, language, roots[0])


def spans_in(label: str, matched: Sequence[str]) -> tuple[tuple[int, int], ...]:
    """Where the matched words stand in a label, in its order and without overlaps."""
    plain = folded(label)
    if len(plain) != len(label):
        return ()  # letters that fold into two: no places can be told
    spans: list[tuple[int, int]] = []
    for word in matched:
        start = _place(plain, folded(word), spans)
        if start >= 0:
            spans.append((start, start + len(folded(word))))
    return tuple(sorted(spans))


def _place(plain: str, word: str, taken: Sequence[tuple[int, int]]) -> int:
    """The first place of a word, at the beginning of a word where there is one."""
    start = plain.find(word) if word else -1
    best = -1
    while start >= 0:
        is_free = all(start >= end or start + len(word) <= begin for begin, end in taken)
        if is_free and (start == 0 or not plain[start - 1].isalnum()):
            return start
        if is_free and best < 0:
            best = start
        start = plain.find(word, start + 1)
    return best


MOST_SUGGESTIONS = 12
_TOKEN = re.compile(r"\"[^\"]*\"|“[^”]*”|'[^']*'(?!\w)|\S+")
_UNIMPORTANT = frozenset(
    ("a", "an", "the", "to", "of", "is", "by", "with", "and", "in", "at", "please")
)
_TIMES = re.compile(
    r"^(?P<what>.+?)\s+(?:(?P<word>twice|thrice)|(?P<number>[0-9]{1,6})\s+times)$", re.I
)
REPEAT, REPEAT_SLOT, REPEAT_BODY = "control.repeat", "times", "do"

# What counts beside the typed words themselves (EXACT to NEAR in vocabulary.py) and what they are
# in slots (CHOSEN to FREE there). All of it together weighs less than one word more that fits.

IN_ORDER = 1.0
"""A word that stands right behind the one before, as in the sentence."""
BEHIND, RIGHT_BEHIND = 0.5, 1.5
"""A place behind the word before it: likelier than one in front, the very next one more."""
UNTYPED_WORD = 0.5
"""Taken off for each word of a sentence that nobody typed: the shorter sentence was meant."""
UNFOLDING = 4.0
"""Taken off for a value of a part that a new block does not have, when no word of it was typed."""
SLOT = 0.1
"""Taken off for each slot: of sentences that fit alike the simpler block comes first."""
LITERAL, EXPRESSION = 9.0, 14.0
"""Nothing but a number, a quoted text or a variable, less than a word that says a block; nothing
but an expression, which can hardly be meant as words of a sentence."""
REPEATED = 8.0
"""“… twice” behind a sentence: about what a word gives that begins another (BEGUN)."""
RECENT = 2.0
"""The block that was used last, half of it for the one before, and so on: it decides between
sentences that fit alike."""

Fits = Callable[[Definition], bool]


@dataclass(frozen=True, slots=True)
class Suggestion:
    """A block that the typed words may mean, with the values that they fill in.

    ``label`` is its sentence, ``spans`` the parts of it (from, to) that were typed;
    ``new_variables`` are names by the ids that stand for them in ``made``.
    """

    block_type: str
    fields: Mapping[str, object]
    label: str
    spans: tuple[tuple[int, int], ...]
    score: float
    made: Made = field(repr=False)
    new_variables: Mapping[str, str] = field(default_factory=dict)


def suggestions(
    text: str,
    language: Language,
    project: Project,
    fits: Fits | None = None,
    *,
    recents: Sequence[str] = (),
    limit: int = MOST_SUGGESTIONS,
) -> list[Suggestion]:
    """What a person may mean, the best first; ``recents`` are block types, the latest first.

    ``fits`` says which blocks can be where the new one is to go.
    """
    typed = text.strip()
    if not typed:
        return _recent(language, project, fits, recents)[:limit]
    typed = spaced(typed, vocabulary(language).by_word)
    filler = Filler(language, project)
    found = [*_sentences(typed, filler, fits, recents), *_values(typed, filler, fits)]
    found += _repeated(typed, filler, fits, recents)
    found.sort(key=lambda suggestion: (-suggestion.score, len(suggestion.label)))
    return found[:limit]


@dataclass(slots=True)
class _Try:
    """One definition tried for the typed words."""

    entry: Entry
    score: float = 0.0
    used: set[int] = field(default_factory=set)
    matched: list[str] = field(default_factory=list)
    fillings: dict[str, Filling] = field(default_factory=dict)
    unfolded: set[str] = field(default_factory=set)
    """The groups of the sentence that were meant."""


def _sentences(
    typed: str, filler: Filler, fits: Fits | None, recents: Sequence[str]
) -> list[Suggestion]:
    words = vocabulary(filler.language)
    tokens = _TOKEN.findall(typed)
    plain = [folded(token).strip(".,:;?!") or token for token in tokens]
    likes = [
        {} if is_quoted(token) else words.words_like(word)
        for token, word in zip(tokens, plain, strict=True)
    ]
    found = []
    for number in _candidates(words, plain, likes):
        entry = words.entries[number]
        if fits is not None and not fits(entry.definition):
            continue
        attempt = _attempt(entry, tokens, plain, likes, filler)
        if attempt is not None:
            found.append(_suggestion(attempt, filler, recents))
    return found


def _candidates(
    words: Vocabulary, plain: Sequence[str], likes: Sequence[Mapping[str, float]]
) -> list[int]:
    numbers: set[int] = set()
    for typed, like in zip(plain, likes, strict=True):
        for word in like:
            numbers |= words.by_word[word]
        for word, entries in words.by_choice.items():
            if word.startswith(typed):
                numbers |= entries
    return sorted(numbers)


def _attempt(
    entry: Entry,
    tokens: Sequence[str],
    plain: Sequence[str],
    likes: Sequence[Mapping[str, float]],
    filler: Filler,
) -> _Try | None:
    """Give each typed word a word of the sentence, or a slot; None when one has no place."""
    attempt = _Try(entry)
    runs: list[tuple[int, list[str]]] = []
    after, last = -1, -1
    is_in_run = False
    for token, word, like in zip(tokens, plain, likes, strict=True):
        index = _best_word(entry, like, attempt.used, last)
        if index is None:
            if not is_in_run:
                runs.append((after, []))
            runs[-1][1].append(token)
            is_in_run = True
            continue
        attempt.used.add(index)
        said = entry.words[index][0]
        attempt.matched.append(word if word in said else said[: len(word)])
        attempt.score += like[said] + (IN_ORDER if index == last + 1 else 0.0)
        last, after, is_in_run = index, entry.words[index][1], False
    for after, run in runs:
        if not _place_run(attempt, run, after, filler):
            return None
    unfolded = {entry.words[index][1] for index in attempt.used} & entry.folded.keys()
    attempt.unfolded |= {entry.folded[place] for place in unfolded}
    there = sum(1 for _, place in entry.words if place not in entry.folded or place in unfolded)
    attempt.score -= UNTYPED_WORD * (there - len(attempt.used))
    attempt.score -= SLOT * len(entry.definition.slots)
    return attempt


def _best_word(entry: Entry, like: Mapping[str, float], used: set[int], last: int) -> int | None:
    """The word of a sentence that a typed word is, the next one by preference."""
    best, quality = None, 0.0
    for index, (word, _) in enumerate(entry.words):
        if index in used or word not in like:
            continue
        better = like[word] + (BEHIND if index > last else 0.0)
        if better > quality:
            best, quality = index, better
    return best


def _place_run(attempt: _Try, run: list[str], after: int, filler: Filler) -> bool:
    """Put typed words that are none of the sentence into a slot together, else each into one."""
    if _fill(attempt, " ".join(run), after, filler):
        return True
    kept = [token for token in run if folded(token) not in _UNIMPORTANT]
    if len(kept) < len(run) and kept and _fill(attempt, " ".join(kept), after, filler):
        return True
    return all(_fill(attempt, token, after, filler) for token in kept)


def _fill(attempt: _Try, text: str, after: int, filler: Filler) -> bool:
    best: tuple[float, Slot, Filling] | None = None
    for place, slot in _open_slots(attempt):
        filling = filler.fill(attempt.entry, slot, text)
        if filling is None:
            continue
        is_right_behind = place == after + 1 or (bool(slot.group) and place == after)
        near = RIGHT_BEHIND if is_right_behind else BEHIND if place > after else 0.0
        is_said = any(attempt.entry.words[index][1] == place for index in attempt.used)
        is_away = place in attempt.entry.folded and not is_said
        quality = filling.quality + near - (UNFOLDING if is_away else 0.0)
        if best is None or quality > best[0]:
            best = (quality, slot, filling)
    if best is None:
        return False
    attempt.fillings[best[1].name] = best[2]
    if best[1].group:
        attempt.unfolded.add(best[1].group)
    attempt.score += best[0]
    if not isinstance(best[2].value, Made):
        attempt.matched.append(text.strip("\"'“”"))
    return True


def _open_slots(attempt: _Try) -> Iterator[tuple[int, Slot]]:
    """The slots that nothing was typed for yet, with their places; those that unfold are last."""
    entry = attempt.entry
    for place, part in enumerate(entry.definition.parts):
        if isinstance(part, Slot) and part.name not in attempt.fillings:
            yield place, part
    for place in entry.folded:
        group = entry.definition.parts[place]
        for part in group.parts if isinstance(group, Group) else ():
            if isinstance(part, Slot) and part.name not in attempt.fillings:
                yield place, part


def _suggestion(attempt: _Try, filler: Filler, recents: Sequence[str]) -> Suggestion:
    definition = attempt.entry.definition
    made = Made(definition.id, groups=dict.fromkeys(attempt.unfolded, 1))
    new_variables = {}
    for name, filling in attempt.fillings.items():
        slot = f"{name}.1" if definition.slots[name].group else name
        if filling.new_variable:
            made.fields[slot] = f"new_{slot}"
            new_variables[f"new_{slot}"] = filling.new_variable
        elif isinstance(filling.value, Made):
            made.inputs[slot] = filling.value
        else:
            made.fields[slot] = filling.value
    score = attempt.score + _recency(definition.id, recents)
    return _as_suggestion(made, filler, score, attempt.matched, new_variables)


def _as_suggestion(
    made: Made,
    filler: Filler,
    score: float,
    matched: Sequence[str] = (),
    new_variables: Mapping[str, str] | None = None,
) -> Suggestion:
    new = dict(new_variables or {})
    label = label_of(made, filler.language, filler.project, new)
    spans = spans_in(label, matched)
    return Suggestion(made.type, dict(made.fields), label, spans, score, made, new)


def _values(typed: str, filler: Filler, fits: Fits | None) -> list[Suggestion]:
    """Numbers, texts in quotes, and expressions as value blocks."""
    made: list[tuple[Made, float]] = []
    definitions = filler.language.definitions
    number = number_in(typed)
    if number is not None and "math.number" in definitions:
        made.append((Made("math.number", {"number": number}), LITERAL))
    elif is_quoted(typed) and "text.text" in definitions:
        made.append((Made("text.text", {"text": typed[1:-1]}), LITERAL))
    elif (found := filler.expression(typed)) is not None:
        made.append((found[0], EXPRESSION))
    elif folded(typed) in filler.variables and "variable.get" in definitions:
        variable = filler.variables[folded(typed)]
        made.append((Made("variable.get", {"variable": variable}), LITERAL))
    return [
        _as_suggestion(one, filler, score, [typed])
        for one, score in made
        if fits is None or fits(definitions[one.type])
    ]


def _repeated(
    typed: str, filler: Filler, fits: Fits | None, recents: Sequence[str]
) -> list[Suggestion]:
    """ "say hello twice": what is said, inside a repeat."""
    match = _TIMES.match(typed)
    repeat = filler.language.definitions.get(REPEAT)
    if match is None or repeat is None or (fits is not None and not fits(repeat)):
        return []
    word = (match["word"] or "").lower()
    times = {"twice": 2, "thrice": 3}.get(word) or int(match["number"])
    found = []
    for inner in _sentences(match["what"], filler, _is_statement, recents):
        made = Made(REPEAT, {REPEAT_SLOT: times}, bodies={REPEAT_BODY: [inner.made]})
        label = f"{label_of(made, filler.language, filler.project, {})}: {inner.label}"
        spans = spans_in(label, [str(times), *(inner.label[a:b] for a, b in inner.spans)])
        new = inner.new_variables
        score = inner.score + REPEATED
        found.append(Suggestion(REPEAT, made.fields, label, spans, score, made, new))
    return found


def _is_statement(definition: Definition) -> bool:
    return definition.shape in ("statement", "c") and not definition.is_last


def _recent(
    language: Language, project: Project, fits: Fits | None, recents: Sequence[str]
) -> list[Suggestion]:
    known = [language.definitions[name] for name in recents if name in language.definitions]
    filler = Filler(language, project)
    return [
        _as_suggestion(Made(definition.id), filler, _recency(definition.id, recents))
        for definition in known
        if fits is None or fits(definition)
    ]


def _recency(block_type: str, recents: Sequence[str]) -> float:
    return RECENT / (1 + recents.index(block_type)) if block_type in recents else 0.0


# The block of a suggestion, to be put into a program.


def clip_of_suggestion(editor: Editor, suggestion: Suggestion) -> Clip:
    """A clip of the block of a suggestion, to be shown or to be put into a place."""
    clip = Clip()
    project = clip.project
    for variable in editor.project.variables:
        AddVariable(variable.id, variable.name, len(project.variables)).apply(project)
    names = {variable.name for variable in editor.project.variables}
    for new, name in suggestion.new_variables.items():
        if name not in names:
            AddVariable(new, name, len(project.variables)).apply(project)
    for procedure in editor.project.procedures.values():
        project.procedures[procedure.id] = procedure
    project.touch_procedures()
    roots, blocks = blocks_of(project, editor.language, [suggestion.made])
    page = editor.language.definitions[suggestion.block_type].page
    place = NewStack(page, project.new_id("s"), 0, 0, 0)
    CreateBlocks(roots, blocks, place).apply(project)
    return clip


def fitting(editor: Editor, place: Place) -> Fits:
    """A filter for suggestions: the blocks that can be put into a place."""
    known: dict[str, bool] = {}

    def fits(definition: Definition) -> bool:
        if definition.id not in known:
            clip = clip_of(editor.language, definition.id)
            known[definition.id] = why_not_create(editor, clip, place) is None
        return known[definition.id]

    return fits
