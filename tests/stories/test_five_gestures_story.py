"""The paper's figure: five gestures, each with a reaction of its own, by somebody unseen."""

from __future__ import annotations

import re

import pytest

from nep_studio import paths
from tests.stories.playing import SPEED, playing, result_of, says

pytestmark = pytest.mark.long

REACTIONS = {
    "karate": "Impressive!",
    "hand_up": "Yes, please? You have a question.",
    "strech_up": "That feels good. I stretch, too.",
    "katana": "A samurai! I had better hide.",
    "batting": "What a hit! Home run!",
}


@pytest.mark.timeout(180)
def test_each_of_five_gestures_has_its_own_reaction() -> None:
    with playing(paths.examples() / "five_gestures.nep", "--speed", SPEED) as play:
        last = play.wait_for(says(REACTIONS["batting"]), 120)
        play.find(result_of(last, "done"))
        play.interrupt()
        assert play.finish() == 0, play.errors()

    words = [event.get("description", "") for event in play.events]
    made = [found[1] for word in words if (found := re.match(r"makes the gesture (\w+)", word))]
    assert made == list(REACTIONS)
    assert play.rules() == [f"gesture_{gesture}" for gesture in made]
    assert play.said()[1:] == [REACTIONS[gesture] for gesture in made]
