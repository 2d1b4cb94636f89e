"""ALLeds: the lights of eyes, ears, head, chest and feet."""

from __future__ import annotations

from typing import Any

from robots.body import body
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import lists, number, one_of, within
from .module import Module, one_by_one, play_script

COLOURS = {
    "white": 0xFFFFFF,
    "red": 0xFF0000,
    "green": 0x00FF00,
    "blue": 0x0000FF,
    "yellow": 0xFFFF00,
    "magenta": 0xFF00FF,
    "cyan": 0x00FFFF,
}
"""NAOqi's names of colours."""


class ALLeds(Module):
    """Lights, by NAOqi's names of groups; groups can be made."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._made: dict[str, list[str]] = {}

    @method("fadeRGB::v(sffff)")
    def fade_parts(self, name: str, red: float, green: float, blue: float, seconds: float) -> Any:
        """Fade lights to a colour, given by its parts (0 to 1); wait for the end."""
        parts = [within(part, 0.0, 1.0, "A part of a colour") for part in (red, green, blue)]
        return self._fade(name, _colour(parts), seconds)

    @method("fadeRGB::v(ssf)")
    def fade_name(self, name: str, colour: str, seconds: float) -> Any:
        """Fade lights to a colour with a name."""
        one_of(colour, COLOURS, "There is no colour “{colour}”. Possible: {colours}.")
        return self._fade(name, COLOURS[colour], seconds)

    @method("fadeRGB::v(sif)")
    def fade_number(self, name: str, rgb: int, seconds: float) -> Any:
        """Fade lights to a colour 0x00RRGGBB."""
        return self._fade(name, rgb, seconds)

    @method("fadeListRGB::v(smm)")
    def fade_list(self, name: str, colours: Any, times: Any) -> Any:
        """Fade lights through colours 0x00RRGGBB, each reached at its time (s)."""
        numbers = [int(value) for value in lists(colours, 1, "lists of colours")[0]]
        ends = lists(times, 1, "lists of times")[0]
        if len(numbers) != len(ends):
            raise CallFailed(
                "There are {count} colours for {count_2} times.",
                count=len(numbers),
                count_2=len(ends),
            )
        lengths = [end - start for start, end in zip([0.0, *ends], ends, strict=False)]
        if min(lengths, default=0.0) < 0.0:
            raise CallFailed("Each time must be later than the one before.")
        steps = [
            step
            for colour, seconds in zip(numbers, lengths, strict=True)
            for step in self._fades(name, colour, seconds)
        ]
        return play_script(self._robot, one_by_one(steps))

    @method("fade::v(sff)")
    def fade(self, name: str, intensity: float, seconds: float) -> Any:
        """Fade lights to a brightness, 0 to 1; those with colours become white."""
        level = within(intensity, 0.0, 1.0, "The intensity")
        return self._fade(name, _colour([level] * 3), seconds)

    @method("setIntensity::v(sf)")
    def set_intensity(self, name: str, intensity: float) -> Any:
        """Make lights as bright as this, 0 to 1, in the colour that they have."""
        percent = 100.0 * within(intensity, 0.0, 1.0, "The intensity")
        return self._each("intensity", name, percent=percent)

    on = method("on::v(s)")(lambda self, name: self.set_intensity(name, 1.0))
    off = method("off::v(s)")(lambda self, name: self._fade(name, body.OFF, 0.0))
    reset = method("reset::v(s)")(lambda self, name: self._each("reset_leds", name))

    @method("getIntensity::m(s)")
    def intensity(self, name: str) -> list[float]:
        """Return how bright lights are: red, green and blue of each, 0 to 1."""
        state = self._robot.state().leds
        lights = [light for group in self._groups(name) for light in body.lights(group)]
        return [
            ((state.get(light, 0) >> shift) & 0xFF) / 255.0
            for light in lights
            for shift in (16, 8, 0)
        ]

    random_eyes = method("randomEyes::v(f)")(
        lambda self, seconds: self._do("random_eyes", seconds=number(seconds))
    )

    @method("rasta::v(f)")
    def rasta(self, seconds: float) -> Any:
        """Let green, yellow and red go round the eyes."""
        return self._do("rotate_eyes", seconds=number(seconds))

    @method("rotateEyes::v(iff)")
    def rotate_eyes(self, rgb: int, turn_s: float, seconds: float) -> Any:
        """Let a colour go from eye to eye, each turn so many seconds; off at the end."""
        half_s = max(number(turn_s) / 2.0, 0.05)
        steps: list[tuple[str, dict[str, Any]]] = []
        for turn in range(max(1, round(number(seconds) / half_s))):
            lit, dark = ("LeftFaceLeds", "RightFaceLeds")[:: 1 if turn % 2 == 0 else -1]
            steps += self._fades(dark, body.OFF, 0.0) + self._fades(lit, rgb, half_s)
        steps += self._fades("FaceLeds", body.OFF, 0.0)
        return play_script(self._robot, one_by_one(steps))

    @method("earLedsSetAngle::v(ifb)")
    def ear_leds_set_angle(self, degrees: int, seconds: float, leave_on: bool) -> Any:
        """Fill the ears' rings up to an angle: a part of 360 degrees is a part of brightness."""
        level = min(abs(degrees), 360) / 360.0
        steps = self._fades("EarLeds", _colour([0.0, 0.0, level]), number(seconds))
        if not leave_on:
            steps += self._fades("EarLeds", body.OFF, 0.0)
        return play_script(self._robot, one_by_one(steps))

    @method("createGroup::v(s[s])")
    def create_group(self, name: str, lights: list[str]) -> None:
        """Make a group of lights and groups."""
        self._made[name] = [group for light in lights for group in self._groups(light)]

    list_groups = method("listGroups::[s]()")(lambda self: [*body.GROUPS, *self._made])

    list_group = method("listGroup::[s](s)", "listLED::[s](s)")(
        lambda self, name: [light for group in self._groups(name) for light in body.lights(group)]
    )
    list_leds = method("listLEDs::[s]()")(lambda self: list(body.lights("AllLeds")))

    def _groups(self, name: str) -> list[str]:
        if name in self._made:
            return self._made[name]
        known = [*body.GROUPS, *self._made]
        return [one_of(name, known, "There are no lights called “{name}”. Possible: {known}.")]

    def _fade(self, name: str, colour: int, seconds: float) -> Any:
        steps = self._fades(name, colour, seconds)
        return play_script(self._robot, one_by_one(steps))

    def _fades(self, name: str, colour: int, seconds: float) -> list[tuple[str, dict[str, Any]]]:
        """Return the actions that fade lights; several groups are done in one go at the end."""
        text = f"#{int(colour) & 0xFFFFFF:06x}"
        groups = self._groups(name)
        lengths = [0.0] * (len(groups) - 1) + [max(0.0, number(seconds))]
        return [
            ("leds", {"group": group, "colour": text, "seconds": length})
            for group, length in zip(groups, lengths, strict=True)
        ]

    def _each(self, action: str, name: str, **args: Any) -> Any:
        steps = [(action, {"group": group, **args}) for group in self._groups(name)]
        return play_script(self._robot, one_by_one(steps))


def _colour(parts: list[float]) -> int:
    red, green, blue = (round(part * 255) for part in parts)
    return red << 16 | green << 8 | blue
