"""The texts and colours of the phone page."""

import re
import tomllib

import pytest

from nodes.resources import resource_folder
from nodes.sensory.phone_page.site import NAMES, TYPES, page_files

FOLDER = resource_folder() / "phone_page"
FILES = page_files()
HINTED = ("denied", "none", "insecure", "refused", "lost", "busy")
STYLE = FILES.texts["style.css"]
STUDIO = {"ground": "canvas", "text": "text", "accent": "accent", "focus": "focus", "bad": "error"}
"""Colours of the page, and the same ones in the themes of the studio."""


@pytest.mark.parametrize("language", ["es", "it", "fr", "de", "ja"])
def test_every_sentence_is_there_in_every_language_and_is_translated(language):
    english, told = FILES.words["en"], FILES.words[language]

    same = {name for name in english if english[name] == told.get(name)}

    assert list(told) == list(english)
    assert same <= {"rate"}
    assert all("{hz}" not in text or name == "rate" for name, text in told.items())


@pytest.mark.parametrize("state", HINTED)
def test_every_trouble_has_a_hint_and_no_exclamation_mark(state):
    for words in FILES.words.values():
        assert words[f"{state}_hint"]
        assert "!" not in words[state] + words[f"{state}_hint"]


def test_every_word_of_the_page_has_a_text_and_nothing_comes_from_elsewhere():
    named = set(re.findall(r'data-word="(\w+)"', FILES.texts["index.html"]))
    named |= set(re.findall(r"words\.(\w+)", FILES.texts["page.js"]))

    assert named - {"json"} <= set(FILES.words["en"])
    for name in NAMES:
        links = re.findall(r"(?:https?|wss?):(?://)?[^\s\"'`)]+", FILES.texts[name])
        assert set(links) <= {"http://www.w3.org/2000/svg", "https://"} or name == "words.json"
    assert {name[name.rindex(".") :] for name in NAMES} <= set(TYPES)


def colours(scheme):
    """The colours of the page by name, in light or dark."""
    light, dark = STYLE.split("@media (prefers-color-scheme: dark)")
    found = dict(re.findall(r"--([\w-]+): (#\w{6})", light))
    return found | (dict(re.findall(r"--([\w-]+): (#\w{6})", dark)) if scheme == "dark" else {})


def brightness(colour):
    """The relative luminance of WCAG."""
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts
    ]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    dark, light = sorted((brightness(one), brightness(other)))
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(
    ("text", "ground", "least"),
    [
        *[("text", ground, 4.5) for ground in ("ground", "card", "good-card", "wait-card")],
        *[("text", "bad-card", 4.5), ("accent-text", "accent", 4.5)],
        *[("muted", ground, 4.5) for ground in ("ground", "card")],
        *[("good", "good-card", 3), ("wait", "wait-card", 3), ("bad", "bad-card", 3)],
        *[(axis, "card", 3) for axis in "xyz"],
        *[("field-line", "card", 3), ("focus", "ground", 3), ("accent", "card", 3)],
    ],
)
def test_it_can_be_read_by_people_who_see_little(scheme, text, ground, least):
    found = colours(scheme)

    assert contrast(found[text], found[ground]) >= least


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_its_colours_are_those_of_the_studio(scheme):
    theme = tomllib.loads((FOLDER.parent / "themes" / f"{scheme}.toml").read_text())["colours"]
    found = colours(scheme)

    assert {name: found[name] for name in STUDIO} == {
        name: theme[studio] for name, studio in STUDIO.items()
    }
