"""ALPhotoCapture and ALVideoRecorder: into files of the computer that the robot is on."""

from __future__ import annotations

import contextlib
from typing import Any

from nep_core.messages import ActionResult
from nodes.action.naobody.camera_tasks import picture_path, video_path
from nodes.action.naobody.picture_files import frames_in
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import number, within
from nodes.action.naoqi.services.module import Module, kept
from nodes.action.naoqi.serving import ServedRobot

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

    @method("takePicture::m(ss)")
    def take_picture(self, folder: str, name: str) -> Any:
        """Take a picture; get the names of its files."""
        file = str(picture_path(self._robot.name, name))
        return self._do("take_picture", [file], file=name, camera=self._name())

    @method("takePicture::m(ssb)")
    def take_picture_over(self, folder: str, name: str, overwrite: bool) -> Any:
        """Take a picture, also in the place of another one."""
        return self.take_picture(folder, name)

    @method("takePictures::m(iss)")
    def take_pictures(self, count: int, folder: str, name: str) -> Any:
        """Take several pictures; get the names of their files."""
        within(count, 1, MOST_PICTURES, "The number of pictures")
        names = [f"{name}_{i}" for i in range(int(number(count)))]
        files = [str(picture_path(self._robot.name, one)) for one in names]
        for one in names[:-1]:
            self._robot.ask("take_picture", file=one, camera=self._name())
        return self._do("take_picture", files, file=names[-1], camera=self._name())

    @method("takePictures::m(issb)")
    def take_pictures_over(self, count: int, folder: str, name: str, overwrite: bool) -> Any:
        """Take several pictures, also in the place of others."""
        return self.take_pictures(count, folder, name)


class ALVideoRecorder(_Camera):
    """Records videos; all are animated PNG files in the folder of the robot."""

    set_format, video_format = kept("setVideoFormat::v(s)", "getVideoFormat::s()", "MJPG")
    set_rate, rate = kept("setFrameRate::v(f)", "getFrameRate::i()", 10)

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._asked = self._name_asked = self._failed = ""

    @method("startRecording::v(ss)")
    def start_recording(self, folder: str, name: str) -> Any:
        """Begin a video."""
        if self.is_recording():
            raise CallFailed("There is a video already that has to be stopped.")
        with contextlib.suppress(OSError):  # then the recording says why
            video_path(self._robot.name, name).unlink(missing_ok=True)
        self._failed, self._name_asked = "", name
        self._asked = self._robot.ask(
            "record_video", self._on_end, file=name, seconds=RECORDING_S, camera=self._name()
        )

    @method("startRecording::v(ssb)")
    def start_recording_over(self, folder: str, name: str, overwrite: bool) -> Any:
        """Begin a video, also in the place of another one."""
        return self.start_recording(folder, name)

    @method("stopRecording::m()")
    def stop_recording(self) -> Any:
        """End the video; get how many pictures it has, and its file. Raises CallFailed."""
        if not self._asked:
            raise CallFailed("There is no video to stop.")
        asked, self._asked = self._asked, ""
        self._robot.stop_one(asked)
        path = video_path(self._robot.name, self._name_asked)
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
