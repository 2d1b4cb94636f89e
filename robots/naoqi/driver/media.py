"""What a real robot does with its cameras and files: faces, pictures, videos, sounds."""

from __future__ import annotations

from pathlib import PurePosixPath

from robots.body import actions as a
from robots.body import body
from robots.body.schedule import Task
from robots.errors import ActionFailed

from .calls import waited
from .real import RealRobot

HOME = PurePosixPath("/home/nao")
PICTURES = HOME / "recordings" / "cameras"
CAMERAS = {"top": 0, "bottom": 1}
VGA, QVGA = 2, 1
VIDEO_RATE_HZ = 10.0
LEARNING_S, FILE_S, LONGEST_SOUND_S = 15.0, 10.0, 3600.0


def learn_face(robot: RealRobot, action: a.LearnFace) -> Task:
    """Learn the face of the person in front."""
    learnt = yield from robot.call("ALFaceDetection", "learnFace", action.name, limit_s=LEARNING_S)
    if not learnt:
        raise ActionFailed(
            "{name} did not learn the face: it saw none, more than one, or knows the name. Let one "
            "person look at it from about half a metre.",
            name=robot.name,
        )
    return ""


def forget_face(robot: RealRobot, action: a.ForgetFace) -> Task:
    """Forget a face."""
    forgotten = yield from robot.call("ALFaceDetection", "forgetPerson", action.name)
    if not forgotten:
        raise ActionFailed(
            '{name} has learnt no face called "{name_2}".', name=robot.name, name_2=action.name
        )
    return ""


def take_picture(robot: RealRobot, action: a.TakePicture) -> Task:
    """Take a picture into a file on the robot."""
    service = "ALPhotoCapture"
    yield from robot.call(service, "setCameraID", CAMERAS[action.camera])
    yield from robot.call(service, "setResolution", VGA)
    yield from robot.call(service, "setPictureFormat", "jpg")
    file = _file(action.file)
    made = yield from robot.call(service, "takePicture", str(PICTURES), file.name, limit_s=FILE_S)
    if not made:
        raise ActionFailed("{name} took no picture. Is there room in its memory?", name=robot.name)
    return f"{robot.name} keeps it in {made[0] if isinstance(made, list) else made}"


def record_video(robot: RealRobot, action: a.RecordVideo) -> Task:
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
        raise ActionFailed(
            "{name} recorded no video. Is there room in its memory?", name=robot.name
        )
    return f"{robot.name} keeps it in {made[-1] if isinstance(made, list) else made}"


def play_sound(robot: RealRobot, action: a.PlaySound) -> Task:
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


# What a real robot does with its lights; NAOqi cannot tell how they shine, so we remember it.

ONE_COLOUR = frozenset({"LeftEarLeds", "RightEarLeds", "BrainLeds"})
"""Lights that can only be brighter or darker: blue."""
SLACK_S = 3.0


def light(robot: RealRobot, action: a.Leds) -> Task:
    """Fade a group of lights to a colour."""
    colour = body.colour_number(action.colour)
    seconds = float(action.seconds)
    yield from robot.call(
        "ALLeds", "fadeRGB", action.group, colour, seconds, limit_s=seconds + SLACK_S
    )
    for name in body.lights(action.group):
        robot.known.leds[name] = colour
    return ""


def set_intensity(robot: RealRobot, action: a.Intensity) -> Task:
    """Make lights brighter or darker, with the hue that they have."""
    for name in body.lights(action.group):
        before = robot.known.leds[name] or body.AT_START[name] or body.WHITE
        colour = body.mixed(body.OFF, body.brightest(before), action.percent / 100.0)
        if name in ONE_COLOUR:
            yield from robot.call("ALLeds", "setIntensity", name, action.percent / 100.0)
        else:
            yield from robot.call("ALLeds", "fadeRGB", name, colour, 0.0)
        robot.known.leds[name] = colour
    return ""


def reset(robot: RealRobot, action: a.ResetLeds) -> Task:
    """Light a group as it was when the robot started."""
    yield from robot.call("ALLeds", "reset", action.group)
    for name in body.lights(action.group):
        robot.known.leds[name] = body.AT_START[name]
    return ""


def play_of_colours(robot: RealRobot, action: a.RandomEyes | a.RotateEyes) -> Task:
    """Let the eyes change colours for some seconds, then be as they were."""
    method = "randomEyes" if isinstance(action, a.RandomEyes) else "rasta"
    eyes = body.lights("FaceLeds")
    before = {name: robot.known.leds[name] for name in eyes}
    seconds = float(action.seconds)
    try:
        yield from robot.call("ALLeds", method, seconds, limit_s=seconds + SLACK_S)
    finally:
        for name, colour in before.items():
            robot.calls.tell("ALLeds", "fadeRGB", name, colour, 0.1)
    return ""
