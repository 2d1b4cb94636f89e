"""ALPhotoCapture and ALVideoRecorder: the robot on the screen has no camera, and says so."""

from __future__ import annotations

from typing import Any

from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import number
from nodes.action.naoqi.services.module import Module, kept

CAMERAS = ("top", "bottom")
RECORDING_S = 3600.0


class _Camera(Module):
    """What a picture and a video can be set to."""

    set_camera, camera = kept("setCameraID::v(i)", "getCameraID::i()", 0, (0, 1))
    set_resolution, resolution = kept("setResolution::v(i)", "getResolution::i()", 1)
    set_colours, colours = kept("setColorSpace::v(i)", "getColorSpace::i()", 13)

    def _name(self) -> str:
        return CAMERAS[int(self.camera())]


class ALPhotoCapture(_Camera):
    """Takes pictures into files of the robot."""

    set_format, picture_format = kept("setPictureFormat::v(s)", "getPictureFormat::s()", "jpg")
    set_interval, interval = kept("setCaptureInterval::v(i)", "getCaptureInterval::i()", 200)
    set_half_press, half_press = kept("setHalfPressEnabled::v(b)", "isHalfPressEnabled::b()", False)

    @method("takePicture::m(ss)")
    def take_picture(self, folder: str, name: str) -> Any:
        """Take a picture; get the names of its files."""
        file = f"{folder.rstrip('/')}/{name}.{self.picture_format()}"
        return self._do("take_picture", [file], file=file, camera=self._name())

    @method("takePicture::m(ssb)")
    def take_picture_over(self, folder: str, name: str, overwrite: bool) -> Any:
        """Take a picture, also in the place of another one."""
        return self.take_picture(folder, name)

    @method("takePictures::m(iss)")
    def take_pictures(self, count: int, folder: str, name: str) -> Any:
        """Take several pictures; get the names of their files."""
        if number(count) < 1:
            raise CallFailed("At least one picture can be taken.")
        return self.take_picture(folder, name)

    @method("takePictures::m(issb)")
    def take_pictures_over(self, count: int, folder: str, name: str, overwrite: bool) -> Any:
        """Take several pictures, also in the place of others."""
        return self.take_pictures(count, folder, name)


class ALVideoRecorder(_Camera):
    """Records videos into files of the robot."""

    set_format, video_format = kept("setVideoFormat::v(s)", "getVideoFormat::s()", "MJPG")
    set_rate, rate = kept("setFrameRate::v(f)", "getFrameRate::i()", 10)

    @method("startRecording::v(ss)")
    def start_recording(self, folder: str, name: str) -> Any:
        """Begin a video."""
        file = f"{folder.rstrip('/')}/{name}.avi"
        self._set("record_video", file=file, seconds=RECORDING_S, camera=self._name())

    @method("startRecording::v(ssb)")
    def start_recording_over(self, folder: str, name: str, overwrite: bool) -> Any:
        """Begin a video, also in the place of another one."""
        return self.start_recording(folder, name)

    @method("stopRecording::m()")
    def stop_recording(self) -> Any:
        """End the video. Raises CallFailed when there is none."""
        raise CallFailed("There is no video to stop.")

    @method("isRecording::b()")
    def is_recording(self) -> bool:
        """Return whether a video is recorded."""
        return False
