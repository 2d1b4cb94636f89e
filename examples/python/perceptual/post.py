"""Tells that somebody has brought a letter."""

from nep_core.wire.messages import HUMAN_BEHAVIOR, HumanBehavior


def run(node):
    """Publish the human state "letter_came" whenever there are more letters than before."""
    letterbox = node.subscriber("/letterbox")
    states = node.publisher(HUMAN_BEHAVIOR)
    node.ready("waits for letters")
    before = None
    for message in letterbox:
        if before is not None and message["letters"] > before:
            states.send(HumanBehavior(human_state="letter_came", source=node.name))
        before = message["letters"]
