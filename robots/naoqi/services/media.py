"""Sounds, pictures, videos and lights: ALAudioPlayer, ALAudioDevice, cameras, ALLeds."""

from __future__ import annotations

import contextlib
from typing import Any

from robots.body import body
from robots.body.camera import frames_in
from robots.body.driver import ActionResult
from robots.body.sense_tasks import picture_path, video_path
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import lists, number, one_of, within
from .module import Module, always, kept, one_by_one, play_script

NO_MICROPHONE = "The robot on the screen has no microphones. A real NAO has."


class ALAudioPlayer(Module):
    """Plays sound files: those of the computer that the robot on the screen is on."""

    master = kept("getMasterVolume::f()", 1.0)

    @method("playFile::v(s)", "playFile::v(sff)", "playSoundSetFile::v(s)")
    def play_file(self, path: str, volume: float = 1.0, pan: float = 0.0) -> Any:
        """Play a file, so loud (0 to 1), more on the left (-1) or on the right (1); wait for it."""
        return self._play(volume, pan, file=path)

    @method("playFileInLoop::v(s)", "playFileInLoop::v(sff)")
    def play_file_in_loop(self, path: str, volume: float = 1.0, pan: float = 0.0) -> Any:
        """Play a file again and again."""
        return self._play(volume, pan, file=path, again=True)

    @method("playFileFromPosition::v(sf)", "playFileFromPosition::v(sfff)")
    def play_file_from(
        self, path: str, position: float, volume: float = 1.0, pan: float = 0.0
    ) -> Any:
        """Play the file at ``path`` from ``position`` (s); ``volume``, ``pan`` as play_file."""
        start_s = within(position, 0, 3600, "The start")
        return self._play(volume, pan, file=path, start_s=start_s)

    def _play(self, volume: float, pan: float, **args: Any) -> Any:
        within(volume, 0.0, 1.0, "The volume")
        within(pan, -1.0, 1.0, "The balance")
        return self._do("play_sound", **args)

    @method("stopAll::v()")
    def stop_all(self) -> None:
        """Stop all files."""
        self._robot.stop(lambda command: type(command.action).__name__ == "PlaySound")

    # There are no sets of sounds
    sound_sets = always([], "getInstalledSoundSetsList::[s]()", "getLoadedSoundSetsList::[s]()")
    is_sound_set_installed = always(False, "isSoundSetInstalled::b(s)")

    @method("playSoundSetFile::v(ss)")
    def play_sound_of_set(self, sound_set: str, file: str) -> Any:
        """Play a file of a set of sounds."""
        return self.play_file(f"{sound_set}/{file}")


class ALAudioDevice(Module):
    """How loud the robot is; its microphones hear nothing."""

    def _muted(self) -> bool:
        return bool(self._kept.get("muted", False))

    @method("setOutputVolume::v(i)")
    def set_output_volume(self, volume: int) -> Any:
        """Choose how loud it is, 0 to 100."""
        return self._do("volume", percent=within(volume, 0, 100, "The volume"))

    @method("getOutputVolume::i()")
    def output_volume(self) -> int:
        """Return how loud it is, 0 to 100."""
        return round(float(self._robot.state().settings["volume"]))

    @method("muteAudioOut::v(b)")
    def mute_audio_out(self, is_muted: bool) -> Any:
        """Be silent, or as loud as before."""
        if is_muted == self._muted():
            return None
        self._kept["muted"] = is_muted
        if is_muted:
            self._kept["volume"] = self.output_volume()
        return self.set_output_volume(0 if is_muted else self._kept["volume"])

    is_audio_out_muted = method("isAudioOutMuted::b()")(lambda self: self._muted())
    # How loud it is around: it is silent
    energy_computation = always(
        None, "enableEnergyComputation::v()", "disableEnergyComputation::v()"
    )
    energy = always(
        0.0, *(f"get{side}MicEnergy::f()" for side in ("Front", "Rear", "Left", "Right"))
    )
    # Nothing comes from the microphones
    is_input_closed = always(True, "isInputClosed::b()")
    is_output_closed = always(False, "isOutputClosed::b()")

    @method("startMicrophonesRecording::v(s)")
    def start_microphones_recording(self, file: str) -> None:
        """Raise CallFailed: there is nothing to record."""
        raise CallFailed(NO_MICROPHONE)


# ALPhotoCapture and ALVideoRecorder: into files of the computer that the robot is on.

CAMERAS = ("top", "bottom")
RECORDING_S = 3600.0
MOST_PICTURES = 20


class _Camera(Module):
    """What a picture and a video can be set to."""

    camera = kept("getCameraID::i()", 0, (0, 1))
    resolution = kept("getResolution::i()", 1)
    colours = kept("getColorSpace::i()", 13)

    def _name(self) -> str:
        return CAMERAS[int(self.camera())]


class ALPhotoCapture(_Camera):
    """Takes pictures; all are PNG files in the folder of the robot, whatever folder is asked."""

    picture_format = kept("getPictureFormat::s()", "jpg")
    interval = kept("getCaptureInterval::i()", 200)
    half_press = kept("isHalfPressEnabled::b()", False)

    @method("takePicture::m(ss)", "takePicture::m(ssb)")
    def take_picture(self, folder: str, name: str, overwrite: bool = False) -> Any:
        """Take a picture; get the names of its files."""
        file = str(picture_path(self._robot.robot, name))
        return self._do("take_picture", [file], file=name, camera=self._name())

    @method("takePictures::m(iss)", "takePictures::m(issb)")
    def take_pictures(self, count: int, folder: str, name: str, overwrite: bool = False) -> Any:
        """Take ``count`` pictures; get their files. ``folder`` and ``overwrite`` change nothing.

        ``name`` is followed by the number of each.
        """
        within(count, 1, MOST_PICTURES, "The number of pictures")
        names = [f"{name}_{i}" for i in range(int(number(count)))]
        files = [str(picture_path(self._robot.robot, one)) for one in names]
        for one in names[:-1]:
            self._robot.ask("take_picture", file=one, camera=self._name())
        return self._do("take_picture", files, file=names[-1], camera=self._name())


class ALVideoRecorder(_Camera):
    """Records videos; all are animated PNG files in the folder of the robot."""

    video_format = kept("getVideoFormat::s()", "MJPG")
    rate = kept("getFrameRate::i()", 10, setter="setFrameRate::v(f)")

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._asked = self._name_asked = self._failed = ""

    @method("startRecording::v(ss)", "startRecording::v(ssb)")
    def start_recording(self, folder: str, name: str, overwrite: bool = False) -> Any:
        """Begin a video."""
        if self.is_recording():
            raise CallFailed("There is a video already that has to be stopped.")
        with contextlib.suppress(OSError):  # then the recording says why
            video_path(self._robot.robot, name).unlink(missing_ok=True)
        self._failed, self._name_asked = "", name
        self._asked = self._robot.ask(
            "record_video", self._on_end, file=name, seconds=RECORDING_S, camera=self._name()
        )

    @method("stopRecording::m()")
    def stop_recording(self) -> Any:
        """End the video; get how many pictures it has, and its file. Raises CallFailed."""
        if not self._asked:
            raise CallFailed("There is no video to stop.")
        asked, self._asked = self._asked, ""
        self._robot.stop_one(asked)
        path = video_path(self._robot.robot, self._name_asked)
        try:
            return [frames_in(path), str(path)]
        except OSError as error:
            raise CallFailed(self._failed or "There is no video to stop.") from error

    @method("isRecording::b()")
    def is_recording(self) -> bool:
        """Return whether a video is recorded."""
        with self._robot.lock:
            return any(command.id == self._asked for command in self._robot.commands())

    def _on_end(self, result: ActionResult) -> None:
        if result.state == "failed":
            self._failed = result.description


# ALLeds: the lights of eyes, ears, head, chest and feet.

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
        """Fade lights ``name`` to ``red``, ``green``, ``blue`` (0 to 1) in ``seconds``; wait."""
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
        return [part / 255.0 for light in lights for part in state.get(light, 0).to_bytes(3)]

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
    return int.from_bytes(round(part * 255) for part in parts)
