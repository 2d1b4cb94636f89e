"""How the link to a NAOqi robot is, in sentences, with a checklist of what to try."""

from __future__ import annotations

from typing import Literal

from nodes.action.naobody.driver import Connection

Steps = tuple[str, ...]
Event = Literal["connecting", "connected", "connection_failed", "disconnected", "warning"]

LOWEST_BATTERY = 0.15
HOTTEST_C = 75.0
"""Motors of NAO slow down from about here on, and stop not much later."""


def no_answer(robot: str, place: str) -> tuple[str, Steps]:
    """Nobody answers at the address."""
    return (
        f"{robot} does not answer: the program could not reach it at {place}.",
        (
            f"Is {robot} switched on? Its chest button should glow.",
            f"Is this computer on the same network as {robot}?",
            f"Press {robot}'s chest button once: it says its address. Is it {place}?",
            "Try the program on the robot on your screen first.",
        ),
    )


def not_naoqi(robot: str, place: str) -> tuple[str, Steps]:
    """Something answers, but not as a NAO does."""
    return (
        f"What answers at {place} is not a NAOqi robot.",
        (
            f"Press {robot}'s chest button once: it says its address. Is it {place}?",
            "Leave the port out of the address: 9559 is the usual one.",
            "Has the robot just been switched on? It needs about two minutes to wake up.",
        ),
    )


def login_refused(robot: str, place: str) -> tuple[str, Steps]:
    """User or password are wrong, or there are none."""
    return (
        f"{robot} at {place} does not let this program in: user and password do not fit.",
        (
            'Open "Connect a robot" on the Robots page and write user and password anew.',
            "The user is mostly nao. The password is the one of the robot's own web page.",
        ),
    )


def needs_tls(robot: str, place: str) -> tuple[str, Steps]:
    """The robot talks only over a secure connection."""
    return (
        f"{robot} at {place} asks for a secure connection, with user and password.",
        (
            'Open "Connect a robot" on the Robots page and write user and password.',
            "Write the address without a port: the secure one, 9503, is tried by itself.",
        ),
    )


def frozen(robot: str, place: str) -> tuple[str, Steps]:
    """The link is there, but nothing comes over it."""
    return (
        f"{robot} does not answer any more: nothing has come from {place} for a while.",
        (
            f"Is {robot} still switched on, and in reach of the network?",
            "The program looks for it again by itself.",
            "If that goes on, switch the robot off and on again.",
        ),
    )


def lost(robot: str, place: str) -> tuple[str, Steps]:
    """The link has ended."""
    return (
        f"The connection to {robot} at {place} has ended.",
        (
            f"Is {robot} still switched on, and in reach of the network?",
            "The program looks for it again by itself.",
        ),
    )


def low_battery(robot: str, battery: float) -> tuple[str, Steps]:
    """The battery will soon be empty."""
    return (
        f"{robot}'s battery is nearly empty: {battery * 100:.0f} %.",
        (f"Plug {robot} in. It should sit or rest meanwhile.",),
    )


def too_hot(robot: str, joint: str, celsius: float) -> tuple[str, Steps]:
    """A motor is hot; it will soon have no strength."""
    return (
        f"{robot} is hot: the motor of {joint} has {celsius:.0f} °C.",
        (f"Let {robot} rest for some minutes.", "Let it sit between what it does standing."),
    )


def asleep(robot: str) -> tuple[str, Steps]:
    """The motors are off."""
    return (
        f"{robot} is asleep: its motors are off, it can speak but not move.",
        (
            f'Put the block "{robot} wakes up" before what moves it.',
            "Or press its chest button twice.",
        ),
    )


def strange_answer(robot: str) -> str:
    """The robot has answered something that nobody understands."""
    return (
        f"{robot} gave an answer that this program does not understand. "
        "Try it again; if that goes on, switch the robot off and on."
    )


def connection(event: Event, told: tuple[str, Steps]) -> Connection:
    """Return how the link is as the node tells it: the sentence, then a box for each step."""
    sentence, steps = told
    words = "\n".join([sentence, *(f"[ ] {step}" for step in steps)])
    return Connection(event, words)
