"""What a virtual robot does with its cameras: pictures and videos, in files of this computer."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path

from nep_core.errors import ActionFailed
from nep_core.places import robot_folder
from nodes.action.naobody import sense_actions as s
from nodes.action.naobody.body import Camera
from nodes.action.naobody.camera_view import picture
from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.picture_files import ENDING, VideoFile, safe_name, write_picture
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task

FRAME_S = 0.2
RESTING = 2.0
"""A frame waits for so many times as long as the last one took: the robot has to live too."""


def picture_path(robot: str, file: str) -> Path:
    """Return where a robot keeps a picture."""
    return _folder(robot) / "pictures" / (safe_name(file, "picture") + ENDING)


def video_path(robot: str, file: str) -> Path:
    """Return where a robot keeps a video."""
    return _folder(robot) / "videos" / (safe_name(file, "video") + ENDING)


def take_picture(robot: VirtualRobot, action: s.TakePicture) -> Task:
    """Keep what a camera sees now in a file."""
    path, camera = picture_path(robot.name, action.file), _camera(robot, action.camera)
    try:
        write_picture(path, picture(robot, camera))
    except OSError as error:
        raise _not_kept(robot, path) from error
    yield
    return f"{robot.name} keeps it in {path}"


def record_video(robot: VirtualRobot, action: s.RecordVideo) -> Task:
    """Keep what a camera sees in a file, for some seconds or until this is stopped."""
    path, camera = video_path(robot.name, action.file), _camera(robot, action.camera)
    try:
        video = VideoFile(path)
        try:
            yield from _record(robot, camera, video, max(1, round(action.seconds / TICK_S)))
        except GeneratorExit:
            with contextlib.suppress(OSError):  # nobody waits for the file of a stopped video
                video.end()
            raise
        video.end()
    except OSError as error:
        raise _not_kept(robot, path) from error
    return f"{robot.name} keeps it in {path}"


def _record(robot: VirtualRobot, camera: Camera, video: VideoFile, ticks: int) -> Task:
    """Add a frame some times a second; a robot that lives faster leaves out some of them."""
    shown, free_s = 0, 0.0
    try:
        for tick in range(ticks):
            start_s = time.perf_counter()
            if tick == 0 or (shown * TICK_S >= FRAME_S - TICK_S / 2 and start_s >= free_s):
                video.show(shown * TICK_S)
                shown = 0
                video.add(picture(robot, camera))
                end_s = time.perf_counter()
                free_s = end_s + RESTING * (end_s - start_s)
            shown += 1
            yield
    finally:
        video.show(shown * TICK_S)
    return ""


def _camera(robot: VirtualRobot, which: str) -> Camera:
    cameras = robot.body.cameras
    if not cameras:
        raise ActionFailed(f"{robot.name} has no camera.")
    return cameras[0] if which == "top" else cameras[-1]


def _folder(robot: str) -> Path:
    return robot_folder(safe_name(robot, "robot"))


def _not_kept(robot: VirtualRobot, path: Path) -> ActionFailed:
    return ActionFailed(
        f"{robot.name} cannot keep {path.name} in {path.parent}. "
        "Is there room on the disk, and may files be written there?"
    )
