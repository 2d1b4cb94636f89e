"""What a real robot does with its cameras and files: faces, pictures, videos, sounds."""

from __future__ import annotations

from pathlib import PurePosixPath

from nep_core.errors import ActionFailed
from nodes.action.naobody import sense_actions as s
from nodes.action.naobody.running import Task
from nodes.action.naoqi.driver.calls import waited
from nodes.action.naoqi.driver.real import RealRobot

HOME = PurePosixPath("/home/nao")
PICTURES = HOME / "recordings" / "cameras"
CAMERAS = {"top": 0, "bottom": 1}
VGA, QVGA = 2, 1
VIDEO_RATE_HZ = 10.0
LEARNING_S, FILE_S, LONGEST_SOUND_S = 15.0, 10.0, 3600.0


def learn_face(robot: RealRobot, action: s.LearnFace) -> Task:
    """Learn the face of the person in front."""
    learnt = yield from robot.call("ALFaceDetection", "learnFace", action.name, limit_s=LEARNING_S)
    if not learnt:
        raise ActionFailed(
            f"{robot.name} did not learn the face: it saw none, more than one, or knows the name. "
            "Let one person look at it from about half a metre."
        )
    return ""


def forget_face(robot: RealRobot, action: s.ForgetFace) -> Task:
    """Forget a face."""
    forgotten = yield from robot.call("ALFaceDetection", "forgetPerson", action.name)
    if not forgotten:
        raise ActionFailed(f'{robot.name} has learnt no face called "{action.name}".')
    return ""


def take_picture(robot: RealRobot, action: s.TakePicture) -> Task:
    """Take a picture into a file on the robot."""
    service = "ALPhotoCapture"
    yield from robot.call(service, "setCameraID", CAMERAS[action.camera])
    yield from robot.call(service, "setResolution", VGA)
    yield from robot.call(service, "setPictureFormat", "jpg")
    file = _file(action.file)
    made = yield from robot.call(service, "takePicture", str(PICTURES), file.name, limit_s=FILE_S)
    if not made:
        raise ActionFailed(f"{robot.name} took no picture. Is there room in its memory?")
    return f"{robot.name} keeps it in {made[0] if isinstance(made, list) else made}"


def record_video(robot: RealRobot, action: s.RecordVideo) -> Task:
    """Record a video into a file on the robot."""
    service = "ALVideoRecorder"
    yield from robot.call(service, "setCameraID", CAMERAS[action.camera])
    yield from robot.call(service, "setResolution", QVGA)
    yield from robot.call(service, "setFrameRate", VIDEO_RATE_HZ)
    yield from robot.call(service, "setVideoFormat", "MJPG")
    yield from robot.call(
        service, "startRecording", str(PICTURES), _file(action.file).name, limit_s=FILE_S
    )
    ended = False
    try:
        yield from waited(action.seconds)
        ended = True
        made = yield from robot.call(service, "stopRecording", limit_s=FILE_S)
    finally:
        if not ended:
            robot.calls.tell(service, "stopRecording")
    if not made:
        raise ActionFailed(f"{robot.name} recorded no video. Is there room in its memory?")
    return f"{robot.name} keeps it in {made[-1] if isinstance(made, list) else made}"


def play_sound(robot: RealRobot, action: s.PlaySound) -> Task:
    """Play a sound file that is on the robot, to its end."""
    file = HOME / action.file  # a path that begins with / stays as it is
    robot.known.settings["playing"] = str(file)
    try:
        yield from robot.call("ALAudioPlayer", "playFile", str(file), limit_s=LONGEST_SOUND_S)
    finally:
        robot.known.settings["playing"] = ""
    return ""


def _file(name: str) -> PurePosixPath:
    """The name of a file without folders: recordings all go to one place on the robot."""
    return PurePosixPath(PurePosixPath(name).name or "recording")
