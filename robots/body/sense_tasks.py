"""What a virtual robot does with its cameras, lights and sounds, and to know faces."""

from __future__ import annotations

import contextlib
import math
import random
import struct
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from faults.files import content, is_elsewhere
from robots.errors import ActionFailed

from . import actions as s
from . import body
from .actions import PlaySound
from .body import Camera
from .camera import ENDING, VideoFile, picture, safe_name, write_picture
from .driver import plain
from .motion import TICK_S
from .pose import VirtualRobot
from .schedule import Task
from .surroundings import seen_things

FRAME_S = 0.2
RESTING = 2.0
"""A frame waits for so many times as long as the last one took: the robot has to live too."""


def picture_path(robot: VirtualRobot, file: str) -> Path:
    """Return where a robot keeps a picture."""
    return robot.files / "pictures" / (safe_name(file, "picture") + ENDING)


def video_path(robot: VirtualRobot, file: str) -> Path:
    """Return where a robot keeps a video."""
    return robot.files / "videos" / (safe_name(file, "video") + ENDING)


def take_picture(robot: VirtualRobot, action: s.TakePicture) -> Task:
    """Keep what a camera sees now in a file."""
    path, camera = picture_path(robot, action.file), _camera(robot, action.camera)
    try:
        write_picture(path, picture(robot, camera))
    except OSError as error:
        raise _not_kept(robot, path) from error
    yield
    return f"{robot.name} keeps it in {path}"


def record_video(robot: VirtualRobot, action: s.RecordVideo) -> Task:
    """Keep what a camera sees in a file, for some seconds or until this is stopped."""
    path, camera = video_path(robot, action.file), _camera(robot, action.camera)
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
        raise ActionFailed("{name} has no camera.", name=robot.name)
    return cameras[0] if which == "top" else cameras[-1]


def _not_kept(robot: VirtualRobot, path: Path) -> ActionFailed:
    return ActionFailed(
        "{name} cannot keep {name_2} in {parent}. Is there room on the disk, and may files be "
        "written there?",
        name=robot.name,
        name_2=path.name,
        parent=path.parent,
    )


# What a virtual robot does to learn and to forget the face of somebody it sees.

FACE = "face_"
LOOKING_TICKS = 20
"""After these the robot has looked around again: the name is noticed when the block ends."""


def learn_face(robot: VirtualRobot, name: str) -> Task:
    """Give the nearest face that the robot sees a name, by which it is noticed from then on."""
    yield
    if not plain(name):
        raise ActionFailed("The name of a face needs a letter or a number, as in Anna.")
    if told := _told_face(robot):
        place = robot.sees[told] if told == "face" else robot.sees.pop(told)
        robot.sees[FACE + plain(name)] = place
        robot.faces.learn(robot.faces.told_as(told.removeprefix("face").strip("_")), name)
        return ""
    people = [thing for thing in seen_things(robot) if thing.kind == "person"]
    if not people:
        raise ActionFailed(
            "{name} sees nobody whose face it could learn. Show it a face, or place a person in "
            "front of it who looks at it.",
            name=robot.name,
        )
    robot.noticed.pop(FACE + robot.faces.name_of(people[0].id, people[0].name), None)
    robot.faces.learn(people[0].id, name)
    for _ in range(LOOKING_TICKS):
        yield
    return ""


def forget_face(robot: VirtualRobot, name: str) -> Task:
    """Notice a name no more, also that of a person who was placed under it."""
    yield
    placed = {plain(thing.name) for thing in robot.things if thing.kind == "person"}
    told = {key.removeprefix(FACE) for key in robot.sees if key.startswith(FACE)}
    if not robot.faces.forget(name, placed | told):
        raise ActionFailed(
            '{name} has learnt no face called "{name_2}".', name=robot.name, name_2=name
        )
    _notice_no_more(robot, name)
    return ""


def forget_all_faces(robot: VirtualRobot) -> None:
    """Forget all names that were learnt; people who were placed under a name keep it."""
    for name in list(robot.faces.learnt.values()):
        robot.faces.unlearn(name)
        _notice_no_more(robot, name)


def _notice_no_more(robot: VirtualRobot, name: str) -> None:
    robot.sees.pop(FACE + plain(name), None)
    robot.noticed.pop(FACE + plain(name), None)


def _told_face(robot: VirtualRobot) -> str:
    """The nearest face that the robot was told to see, "face_anna" or "face"; "" for none."""
    named = [key for key in robot.sees if key.startswith(FACE)]
    if not named:
        return "face" if "face" in robot.sees else ""
    return min(named, key=lambda key: math.dist(robot.sees[key][:2], robot.base[:2]))


# What a virtual robot does with its lights: brightness, as at the start, a play of colours.

EYES = ("LeftFaceLeds", "RightFaceLeds")
CHANGE_S = 0.2
RASTA = (0x00FF00, 0xFFFF00, 0xFF0000)


def set_intensity(robot: VirtualRobot, group: str, percent: float) -> Task:
    """Make lights brighter or darker; those that are off become white or blue, as they can."""
    for light in body.lights(group):
        lit = body.shining(robot.leds, light) or body.at_start(light) or body.WHITE
        body.shine(robot.leds, light, body.mixed(body.OFF, body.brightest(lit), percent / 100.0))
    yield
    return ""


def reset(robot: VirtualRobot, group: str) -> Task:
    """Light a group as it was when the robot started."""
    for light in body.lights(group):
        body.shine(robot.leds, light, body.at_start(light))
    yield
    return ""


def random_eyes(robot: VirtualRobot, seconds: float) -> Task:
    """Change the colour of each eye by chance, then let them be as they were."""
    chance = random.Random(robot.name)

    def colour(_: int) -> None:
        for eye in EYES:
            body.shine(robot.leds, eye, chance.randrange(0x1000000))

    return (yield from _play_of_colours(robot, seconds, colour))


def rotate_eyes(robot: VirtualRobot, seconds: float) -> Task:
    """Let three colours go round each eye, lamp by lamp, then let them be as they were."""

    def colour(turn: int) -> None:
        for eye in EYES:
            lamps = body.LAMPS[eye]
            body.shine(robot.leds, eye, RASTA[turn % len(RASTA)])
            for place, lamp in enumerate(lamps):
                part = (place + turn) % len(lamps) * len(RASTA) // len(lamps)
                body.shine(robot.leds, lamp, RASTA[part])

    return (yield from _play_of_colours(robot, seconds, colour))


def _play_of_colours(robot: VirtualRobot, seconds: float, change: Callable[[int], None]) -> Task:
    before = dict(robot.leds)
    try:
        for tick in range(round(seconds / TICK_S)):
            turn, rest = divmod(tick, round(CHANGE_S / TICK_S))
            if rest == 0:
                change(turn)
            yield
    finally:
        for eye in EYES:
            body.shine(robot.leds, eye, before[eye])
            robot.leds |= {lamp: before[lamp] for lamp in body.LAMPS[eye] if lamp in before}
    return ""


# Sound files of this computer: where a robot finds them, and how long they last.

LARGEST_SOUND = 300_000_000
ROBOTS_HOME = "/home/nao/"
"""Where a real NAO has its files; its part here is the folder of who uses this computer."""
PLACES = (Path(), Path("Music"))
KINDS = ("wav", "mp3", "ogg")
MP3_KBPS = (0, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320)
MP3_KBPS_OF_LOW_RATES = (0, 8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160)
"""Bit rates of layer 3 by their number: for MPEG 1, and for MPEG 2 and 2.5."""
ID3_HEAD = 10
OPUS_HZ = 48000
"""The rate in which the pages of Opus are counted, whatever the sound's own one is."""


def found(file: str) -> Path | None:
    """Return the file of a name or path, in the home folder or in its Music; None for none."""
    named = file.removeprefix(ROBOTS_HOME)
    if is_elsewhere(named):  # a robot plays what is on it, and so does its part here
        return None
    path = Path(named).expanduser()
    possible = [Path.home() / place / path for place in PLACES]
    return next((one for one in possible if one.is_file()), None)


def length_s(file: Path) -> float:
    """Return how long a sound lasts. Raises ValueError for what is no such sound, OSError."""
    sound = content(file, LARGEST_SOUND)
    try:
        if sound[:4] == b"RIFF" and sound[8:12] == b"WAVE":
            return _wav_s(sound)
        if sound[:4] == b"OggS":
            # The place of the last page, in samples, by the samples a second
            (samples,) = struct.unpack_from("<q", sound, sound.rindex(b"OggS") + 6)
            head = sound.find(b"\x01vorbis")
            if head < 0:
                return float(max(0, samples) / (OPUS_HZ if b"OpusHead" in sound[:200] else 0))
            (rate_hz,) = struct.unpack_from("<I", sound, head + 12)
            return float(max(0, samples) / rate_hz)
        # The size by the bits a second of the first frame: right where all frames have the same
        start = 0
        if sound[:3] == b"ID3":
            start = ID3_HEAD + sum((sound[6 + i] & 0x7F) << (21 - 7 * i) for i in range(4))
        if sound[start] != 0xFF or sound[start + 1] & 0xE6 != 0xE2:
            raise ValueError("no sound of a known kind")
        is_mpeg_1 = sound[start + 1] & 0x18 == 0x18
        kbps = (MP3_KBPS if is_mpeg_1 else MP3_KBPS_OF_LOW_RATES)[sound[start + 2] >> 4]
        return (len(sound) - start) * 8.0 / (kbps * 1000.0)
    except (struct.error, ZeroDivisionError, IndexError) as error:
        raise ValueError(f"{file.name} is broken") from error


def _wav_s(sound: bytes) -> float:
    """The sound data by their bytes a second; a header may say more than there is."""
    at, bytes_per_s = 12, 0
    while at + 8 <= len(sound):
        kind, size = struct.unpack_from("<4sI", sound, at)
        if kind == b"fmt ":
            (bytes_per_s,) = struct.unpack_from("<I", sound, at + 16)
        elif kind == b"data":
            return float(min(size, len(sound) - at - 8) / bytes_per_s)
        at += 8 + size + size % 2
    raise ValueError("no sound data")


# What a virtual robot does to play a sound: it is busy with it for as long as it lasts.

PLAYING = "playing"
"""The setting that says which file is played, "" for none."""


def play_sound(robot: VirtualRobot, action: PlaySound) -> Task:
    """Play a sound file of this computer to its end, or until it is stopped."""
    path = found(action.file)
    if path is None:
        raise ActionFailed(
            "{name} finds no sound file “{file}”. Put it into your home folder or its folder "
            "Music, or write the whole path.",
            name=robot.name,
            file=action.file,
        )
    seconds = _seconds(robot, path)
    robot.settings[PLAYING] = str(path)
    try:
        yield from _pass(seconds - action.start_s)
        while action.again:
            yield from _pass(seconds)
    finally:
        robot.settings[PLAYING] = ""
    return ""


def _pass(seconds: float) -> Iterator[None]:
    for _ in range(max(1, round(seconds / TICK_S))):
        yield


def _seconds(robot: VirtualRobot, path: Path) -> float:
    try:
        return length_s(path)
    except (ValueError, OSError) as error:
        raise ActionFailed(
            "{name} cannot play “{name_2}”: it is not a sound that it knows. Possible: {kinds}.",
            name=robot.name,
            name_2=path.name,
            kinds=", ".join(KINDS),
        ) from error
