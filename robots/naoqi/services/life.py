"""The services of a NAO's life of its own: awareness, autonomous life, small movements."""

from __future__ import annotations

import time
from typing import Any

from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .module import Module, kept

STATES = ("solitary", "interactive", "disabled", "safeguard")
STIMULI = ("Sound", "Movement", "NavigationMotion", "People", "Touch", "TabletTouch")
ABILITIES = (
    "AutonomousBlinking",
    "BackgroundMovement",
    "BasicAwareness",
    "ListeningMovement",
    "SpeakingMovement",
)


class ALBasicAwareness(Module):
    """Looks at people by itself."""

    set_engagement, engagement = kept(
        "setEngagementMode::v(s)",
        "getEngagementMode::s()",
        "Unengaged",
        ("Unengaged", "SemiEngaged", "FullyEngaged"),
    )
    set_tracking, tracking = kept(
        "setTrackingMode::v(s)",
        "getTrackingMode::s()",
        "Head",
        ("Head", "BodyRotation", "WholeBody", "MoveContextually"),
    )

    @method("setEnabled::v(b)")
    def set_enabled(self, is_on: bool) -> Any:
        """Begin or end looking at people."""
        return self._do("awareness", on=is_on)

    @method("isEnabled::b()")
    def is_enabled(self) -> bool:
        """Return whether it looks at people by itself."""
        return bool(self._robot.state().settings["awareness"])

    @method("isRunning::b()")
    def runs(self) -> bool:
        """Return whether it looks at people by itself."""
        return self.is_enabled()

    @method("startAwareness::v()")
    def begin(self) -> Any:
        """Begin looking at people."""
        return self.set_enabled(True)

    @method("stopAwareness::v()")
    def end(self) -> Any:
        """End looking at people."""
        return self.set_enabled(False)

    @method("pauseAwareness::v()")
    def pause(self) -> Any:
        """End looking at people for a while."""
        return self.set_enabled(False)

    @method("resumeAwareness::v()")
    def resume(self) -> Any:
        """Look at people again."""
        return self.set_enabled(True)

    @method("isAwarenessRunning::b()")
    def is_awareness_running(self) -> bool:
        """Return whether it looks at people by itself."""
        return self.is_enabled()

    @method("isAwarenessPaused::b()")
    def is_awareness_paused(self) -> bool:
        """Return whether it does not look at people now."""
        return not self.is_enabled()

    @method("setStimulusDetectionEnabled::v(sb)")
    def set_stimulus(self, stimulus: str, is_on: bool) -> None:
        """Remember what may draw its attention."""
        self._kept[_stimulus(stimulus)] = is_on

    @method("isStimulusDetectionEnabled::b(s)")
    def stimulus(self, stimulus: str) -> bool:
        """Return whether something may draw its attention."""
        return bool(self._kept.get(_stimulus(stimulus), True))

    @method("setParameter::v(sm)")
    def set_parameter(self, name: str, value: Any) -> None:
        """Remember how it looks at people."""
        self._kept[f"parameter {name}"] = value

    @method("getParameter::m(s)")
    def parameter(self, name: str) -> Any:
        """Return how it looks at people."""
        if f"parameter {name}" not in self._kept:
            raise CallFailed("There is no parameter “{name}”.", name=name)
        return self._kept[f"parameter {name}"]

    @method("resetAllParameters::v()")
    def reset_all_parameters(self) -> None:
        """Forget what was set."""
        self._kept.clear()


class ALAutonomousLife(Module):
    """What the robot does by itself when nobody asks anything: nothing, until it is told to."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._state = "disabled"
        self._history = [(self._state, int(time.time()))]
        self._abilities = dict.fromkeys(ABILITIES, True)

    @method("setState::v(s)")
    def set_state(self, state: str) -> Any:
        """Let it live by itself (solitary, interactive), or not (disabled)."""
        if state not in STATES:
            raise CallFailed(
                "There is no state “{state}”. Possible: {states}.",
                state=state,
                states=", ".join(STATES),
            )
        self._state = state
        self._history.append((state, int(time.time())))
        return self._do("awareness", on=state in ("solitary", "interactive"))

    @method("getState::s()")
    def state(self) -> str:
        """Return whether it lives by itself."""
        return self._state

    @method("getStateHistory::[(si)]()")
    def state_history(self) -> list[tuple[str, int]]:
        """Return the states that it was in, with the seconds of their beginning."""
        return list(self._history)

    @method("focusedActivity::s()")
    def focused_activity(self) -> str:
        """Return the program that it plays by itself: none."""
        return ""

    @method("stopFocus::v()")
    def stop_focus(self) -> None:
        """Stop the program that it plays by itself: there is none."""

    @method("stopAll::v()")
    def stop_all(self) -> None:
        """Stop the programs that it plays by itself: there are none."""

    @method("setAutonomousAbilityEnabled::v(sb)")
    def set_ability(self, ability: str, is_on: bool) -> None:
        """Remember which of its abilities may work by themselves."""
        self.ability(ability)
        self._abilities[ability] = is_on

    @method("getAutonomousAbilityEnabled::b(s)")
    def ability(self, ability: str) -> bool:
        """Return whether one of its abilities may work by itself."""
        if ability not in self._abilities:
            known = ", ".join(self._abilities)
            raise CallFailed(
                "There is no ability “{ability}”. Possible: {known}.", ability=ability, known=known
            )
        return self._abilities[ability]

    @method("setSafeguardEnabled::v(sb)")
    def set_safeguard(self, name: str, is_on: bool) -> None:
        """Remember what it takes care of."""
        self._kept[f"safeguard {name}"] = is_on

    @method("isSafeguardEnabled::b(s)")
    def safeguard(self, name: str) -> bool:
        """Return what it takes care of."""
        return bool(self._kept.get(f"safeguard {name}", True))

    @method("setRobotOffsetFromFloor::v(f)")
    def set_offset(self, metres: float) -> None:
        """Remember how high above the floor it stands, m."""
        self._kept["offset"] = metres

    @method("getRobotOffsetFromFloor::f()")
    def offset(self) -> float:
        """Return how high above the floor it stands, m."""
        return float(self._kept.get("offset", 0.0))

    @method("getLifeTime::i()")
    def life_time(self) -> int:
        """Return for how many seconds it has been switched on."""
        return int(time.time()) - self._history[0][1]


class ALBackgroundMovement(Module):
    """Moves a little, as if it breathed, while nothing else moves it."""

    @method("setEnabled::v(b)")
    def set_enabled(self, is_on: bool) -> Any:
        """Begin or end moving a little."""
        return self._do("breathing", on=is_on)

    @method("isEnabled::b()")
    def is_enabled(self) -> bool:
        """Return whether it moves a little."""
        return bool(self._robot.state().settings["breathing"])

    @method("isRunning::b()")
    def runs(self) -> bool:
        """Return whether it moves a little."""
        return self.is_enabled()


class ALSpeakingMovement(Module):
    """Remembers whether it may move while it speaks."""

    set_enabled, enabled = kept("setEnabled::v(b)", "isEnabled::b()", True)
    set_mode, mode = kept(
        "setMode::v(s)", "getMode::s()", "contextual", ("contextual", "random", "disabled")
    )

    @method("isRunning::b()")
    def runs(self) -> bool:
        """Return whether it speaks and may move."""
        return bool(self.enabled() and self._robot.state().saying)


class ALListeningMovement(Module):
    """Remembers whether it may move while it listens."""

    set_enabled, enabled = kept("setEnabled::v(b)", "isEnabled::b()", True)

    @method("isRunning::b()")
    def runs(self) -> bool:
        """Return whether it listens and may move."""
        return bool(self.enabled() and self._robot.state().listening)


class ALAutonomousBlinking(Module):
    """Remembers whether its eyes may blink."""

    set_enabled, enabled = kept("setEnabled::v(b)", "isEnabled::b()", True)


def _stimulus(name: str) -> str:
    if name not in STIMULI:
        raise CallFailed(
            "There is no stimulus “{name}”. Possible: {stimuli}.",
            name=name,
            stimuli=", ".join(STIMULI),
        )
    return f"stimulus {name}"
