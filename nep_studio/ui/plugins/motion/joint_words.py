"""What the joints of a robot are called."""

from __future__ import annotations

from nep_studio.blocks.language import Language
from nep_studio.ui.words import tr
from robots.body.body import Body, part_of

from .timeline_painter import limb_words


def joint_words(language: Language, body: Body, name: str) -> str:
    """What a joint does, such as "elbow, bent"; its own name where nobody has said it."""
    if name.endswith("Hand"):
        return tr("hand, open")
    part = part_of(body, name)
    words = language.choices.get(f"joints.{part}", {}).get(name, name)
    if not name.startswith(("L", "R")):
        return words
    if part.endswith("_leg") and name not in body.same_motor.values():
        side = tr("left") if name.startswith("L") else tr("right")
        return f"{side}: {words}"
    return words


def limb_of_joint_words(body: Body, name: str) -> str:
    """The limb that a joint is in, in words."""
    limb = body.joints[body.index[name]].limb
    return limb_words().get(limb, str(limb))
