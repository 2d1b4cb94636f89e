"""What a robot does, as a teacher would say it."""

from __future__ import annotations

import pytest

from nep_core.wire.messages import ActionRequest
from nep_studio.run.installation import studio_language
from nep_studio.run.timeline import action_words
from robots.body.actions import BODY_ACTIONS, SENSE_ACTIONS


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
        ("walk", {"forward_m": 1, "turn_deg": -90}, "walks 1 m forward and turns 90° to the right"),
        ("hand", {"side": "both", "open": True}, "opens both hands"),
        ("move_joint", {"joint": "HeadYaw", "degrees": 20}, "moves HeadYaw to 20°"),
        ("stiffness", {"part": "legs", "on": False}, "releases both legs"),
        ("breathing", {"on": False}, "no longer breathes"),
        ("breathing", {"on": True}, "breathes"),
        ("track", {"thing": "ball", "using": "head"}, "follows the red ball with its head"),
        ("listen", {"words": ["yes", "no"]}, "listens for “yes” or “no”"),
        ("language", {"language": "fr"}, "speaks French from now on"),
        ("learn_face", {"name": "Anna"}, "learns the face of Anna"),
        ("fly", {}, "fly"),
    ],
)
def test_an_action_in_words(action: str, args: dict[str, object], words: str) -> None:
    request = ActionRequest(id="1", robots=["NAO"], action=action, args=args)

    assert action_words(request, studio_language()) == words


def test_every_action_of_the_robot_has_words() -> None:
    for action in (*BODY_ACTIONS, *SENSE_ACTIONS):
        request = ActionRequest(id="1", robots=["NAO"], action=action)

        assert action_words(request, studio_language()) not in ("", action)
