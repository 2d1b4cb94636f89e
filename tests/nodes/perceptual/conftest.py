"""Small models that are trained once, and movement to try them on."""

from __future__ import annotations

import pytest

from nodes.perceptual.recognition.model import Model
from nodes.perceptual.recognition.training import train
from nodes.recordings import Recording
from nodes.sensory.arm.people import simulate_everyday, simulate_session

GESTURES = ("hand_up", "karate")


@pytest.fixture(scope="session")
def sessions() -> list[Recording]:
    """Three simulated people who make two gestures twice."""
    return [simulate_session(person, GESTURES, 2) for person in range(3)]


@pytest.fixture(scope="session")
def model(sessions: list[Recording]) -> Model:
    """Both recognisers of the two gestures."""
    return train(sessions, [simulate_everyday(60, 40.0)])


@pytest.fixture(scope="session")
def stranger() -> Recording:
    """Another simulated person, making the two gestures three times."""
    return simulate_session(150, GESTURES, 3)


@pytest.fixture(scope="session")
def brief() -> Recording:
    """The same person, making them once."""
    return simulate_session(150, GESTURES, 1)
