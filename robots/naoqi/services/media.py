"""ALAudioPlayer and ALAudioDevice: files and tones that are played, and how loud."""

from __future__ import annotations

import contextlib
from typing import Any

from robots.body.camera import frames_in
from robots.body.driver import ActionResult
from robots.body.sense_tasks import picture_path, video_path
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import number, within
from .module import Module, always, kept

NO_MICROPHONE = "The robot on the screen has no microphones. A real NAO has."


class ALAudioPlayer(Module):
    """Plays sound files: those of the computer that the robot on the screen is on."""

    set_master, master = kept("setMasterVolume::v(f)", "getMasterVolume::f()", 1.0)

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
        """Play a file from so many seconds on."""
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

    set_camera, camera = kept("setCameraID::v(i)", "getCameraID::i()", 0, (0, 1))
    set_resolution, resolution = kept("setResolution::v(i)", "getResolution::i()", 1)
    set_colours, colours = kept("setColorSpace::v(i)", "getColorSpace::i()", 13)

    def _name(self) -> str:
        return CAMERAS[int(self.camera())]


class ALPhotoCapture(_Camera):
    """Takes pictures; all are PNG files in the folder of the robot, whatever folder is asked."""

    set_format, picture_format = kept("setPictureFormat::v(s)", "getPictureFormat::s()", "jpg")
    set_interval, interval = kept("setCaptureInterval::v(i)", "getCaptureInterval::i()", 200)
    set_half_press, half_press = kept("setHalfPressEnabled::v(b)", "isHalfPressEnabled::b()", False)

    @method("takePicture::m(ss)", "takePicture::m(ssb)")
    def take_picture(self, folder: str, name: str, overwrite: bool = False) -> Any:
        """Take a picture; get the names of its files."""
        file = str(picture_path(self._robot.robot, name))
        return self._do("take_picture", [file], file=name, camera=self._name())

    @method("takePictures::m(iss)", "takePictures::m(issb)")
    def take_pictures(self, count: int, folder: str, name: str, overwrite: bool = False) -> Any:
        """Take several pictures; get the names of their files."""
        within(count, 1, MOST_PICTURES, "The number of pictures")
        names = [f"{name}_{i}" for i in range(int(number(count)))]
        files = [str(picture_path(self._robot.robot, one)) for one in names]
        for one in names[:-1]:
            self._robot.ask("take_picture", file=one, camera=self._name())
        return self._do("take_picture", files, file=names[-1], camera=self._name())


class ALVideoRecorder(_Camera):
    """Records videos; all are animated PNG files in the folder of the robot."""

    set_format, video_format = kept("setVideoFormat::v(s)", "getVideoFormat::s()", "MJPG")
    set_rate, rate = kept("setFrameRate::v(f)", "getFrameRate::i()", 10)

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
