"""What a robot does, as a teacher would say it."""

from __future__ import annotations

import pytest

from nep_core.messages import ActionRequest
from nep_studio.action_words import action_words
from nep_studio.studio_language import studio_language


@pytest.mark.parametrize(
    ("action", "args", "words"),
    [
        ("say", {"text": "Hi", "gesture": "no_gesture"}, "says “Hi”"),
        ("say", {"text": "Hi", "gesture": "greet"}, "says “Hi” with a greeting"),
        ("do", {"posture": "posture_sit"}, "takes the posture sit"),
        ("imitate", {"animal": "elephant"}, "imitates the animal elephant"),
        ("play", {"animation": "wave"}, "plays the animation wave"),
        ("walk", {"forward_m": -0.5, "left_m": 0.2}, "walks 0.5 m back and 0.2 m to the left"),
        ("walk", {"forward_m": 0}, "stays where it is"),
        ("turn", {"degrees": -90}, "turns 90° to the right"),
        ("look", {"yaw_deg": 40, "pitch_deg": -10}, "looks 40° to the left and 10° up"),
        ("look", {"yaw_deg": 0, "pitch_deg": 0}, "looks ahead"),
        ("leds", {"group": "LeftFaceLeds", "colour": "#ff0000"}, "lights the left eye in #ff0000"),
        ("fly", {}, "fly"),
    ],
)
def test_an_action_in_words(action: str, args: dict[str, object], words: str) -> None:
    request = ActionRequest(id="1", robots=["NAO"], action=action, args=args)

    assert action_words(request, studio_language()) == words
