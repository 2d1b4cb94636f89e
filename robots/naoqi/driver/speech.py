"""What a real robot does with voice and ears, movements beside words, files, cameras and lights."""

from __future__ import annotations

import logging
from pathlib import PurePosixPath

from faults import Fault
from robots.body import actions as a
from robots.body import body
from robots.body.animations import NO_GESTURE, Animation
from robots.body.keyframes import Keyframes
from robots.body.schedule import Task
from robots.body.speech import Spoken, speaking_time_s
from robots.body.tasks import at_once, changed, fitted, spoken
from robots.errors import ActionFailed
from robots.naoqi.services.arguments import NAMES

from .calls import waited
from .moving import play_keyframes, return_to_posture, take_posture
from .real import RealRobot, language_code

log = logging.getLogger(__name__)


SLOWEST_VOICE = 4.0
VOLUME_OFF = 2.0


def say(robot: RealRobot, action: a.Say) -> Task:
    """Speak, moving as the gesture says meanwhile."""
    parts = spoken(robot.known, action)
    tasks = [speak(robot, action)]
    if any(part.gesture != NO_GESTURE for part in parts):
        tasks.append(_gestures(robot, parts, action.speed / 100.0))
    return (yield from beside(tasks))


def speak(robot: RealRobot, action: a.Say) -> Task:
    """Say a text, perhaps in a language of its own, faster or higher."""
    words = action.text.replace("\\", " ")  # begins what NAOqi's voice takes as a command
    if not words.strip():
        return ""
    seconds = speaking_time_s(words) * 100.0 / action.speed
    # What NAOqi's voice takes as a wish for another speed and pitch, before the words
    wishes = {"rspd": action.speed, "vct": action.pitch}
    told = [
        "".join(f"\\{name}={round(to)}\\ " for name, to in wishes.items() if to != 100.0) + words
    ]
    if action.language:
        told.append((yield from _language_name(robot, action.language)))
    elif action.usual_language:
        usual = NAMES.get(action.usual_language, action.usual_language)
        if usual in (yield from robot.call("ALTextToSpeech", "getAvailableLanguages")):
            told.append(usual)
    robot.known.saying = action.text
    try:
        yield from robot.call(
            "ALTextToSpeech", "say", *told, limit_s=10.0 + SLOWEST_VOICE * seconds
        )
    finally:
        robot.known.saying = ""
    return ""


def imitate(robot: RealRobot, action: a.Imitate) -> Task:
    """Imitate an animal."""
    return play(robot, robot.known.animations.get(action.animal, "animal"))


def play_changed(robot: RealRobot, action: a.Play) -> Task:
    """Play an animation, mirrored, backwards or slower if that is wanted."""
    animation = robot.known.animations.get(action.animation)
    return play(robot, animation, changed(animation.keyframes, action))


def play(robot: RealRobot, animation: Animation, keyframes: Keyframes | None = None) -> Task:
    """Play an animation with its sound, and go back to the posture that it began in."""
    yield from robot.take_over()
    if animation.starts_from and animation.starts_from != robot.known.posture:
        yield from take_posture(robot, animation.starts_from)
    tasks = [_act(robot, keyframes or animation.keyframes)]
    if animation.says:
        tasks.append(speak(robot, a.Say(animation.says)))
    return (yield from beside(tasks))


def set_volume(robot: RealRobot, action: a.Volume) -> Task:
    """Set how loud the robot is, and look that it is."""
    percent = round(action.percent)
    yield from robot.call("ALAudioDevice", "setOutputVolume", percent)
    found = yield from robot.call("ALAudioDevice", "getOutputVolume")
    if abs(float(found) - percent) > VOLUME_OFF:
        raise ActionFailed(
            "{name} speaks with volume {found} %, not with {percent} %.",
            name=robot.name,
            found=found,
            percent=percent,
        )
    robot.known.settings["volume"] = float(action.percent)
    return ""


def set_language(robot: RealRobot, action: a.SetLanguage) -> Task:
    """Set the language that the robot speaks and understands."""
    name = yield from _language_name(robot, action.language)
    yield from robot.call("ALTextToSpeech", "setLanguage", name, limit_s=10.0)
    if robot.calls.has("ALSpeechRecognition", "setLanguage"):
        yield from robot.call("ALSpeechRecognition", "setLanguage", name, limit_s=10.0)
    robot.known.settings["language"] = action.language
    return ""


def beside(tasks: list[Task]) -> Task:
    """Run tasks side by side; when one fails, or this is stopped, the others are ended too."""
    all_of_them = list(tasks)
    try:
        return (yield from at_once(tasks))
    finally:
        for task in all_of_them:
            task.close()


def _act(robot: RealRobot, keyframes: Keyframes) -> Task:
    notes = yield from play_keyframes(robot, keyframes)
    yield from return_to_posture(robot, list(keyframes.tracks))
    return notes


def _gestures(robot: RealRobot, parts: list[Spoken], speed: float) -> Task:
    """Make the gesture of each part of what is said, in about the time that it takes."""
    for part in parts:
        seconds = speaking_time_s(part.text) / speed
        if part.gesture == NO_GESTURE or seconds <= 0.0:
            yield from waited(seconds)
            continue
        animation = robot.known.animations.get(part.gesture, "gesture")
        yield from play(robot, animation, fitted(robot.known, animation.keyframes, seconds))
    return ""


def _language_name(robot: RealRobot, code: str) -> Task:
    name = NAMES.get(code, code)
    known = yield from robot.call("ALTextToSpeech", "getAvailableLanguages")
    if name not in known:
        spoken = ", ".join(language_code(one) for one in known)
        raise ActionFailed(
            "{name} does not speak {name_2}. Languages on it: {spoken}.",
            name=robot.name,
            name_2=name,
            spoken=spoken,
        )
    return name


# Words that people often answer with, for questions that may be answered with anything.
#
# A NAO understands only words that it was told before.

WORDS = {
    "en": "yes, no, maybe, okay, hello, goodbye, please, thank you, sorry, stop, help, again, "
    "good, bad, happy, sad, tired, fine, left, right, red, green, blue, yellow, white, black, one, "
    "two, three, four, five, six, seven, eight, nine, ten, robot, music, dance, sit down, stand up",
    "de": "ja, nein, vielleicht, okay, hallo, tschüss, bitte, danke, entschuldigung, stopp, hilfe, "
    "noch einmal, gut, schlecht, froh, traurig, müde, links, rechts, rot, grün, blau, gelb, weiß, "
    "schwarz, eins, zwei, drei, vier, fünf, sechs, sieben, acht, neun, zehn, Roboter, Musik",
    "es": "sí, no, quizás, vale, hola, adiós, por favor, gracias, perdón, para, ayuda, otra vez, "
    "bien, mal, contento, triste, cansado, izquierda, derecha, rojo, verde, azul, amarillo, "
    "blanco, negro, uno, dos, tres, cuatro, cinco, seis, siete, ocho, nueve, diez, robot",
    "fr": "oui, non, peut-être, d'accord, bonjour, au revoir, s'il te plaît, merci, pardon, stop, "
    "aide, encore, bien, mal, content, triste, fatigué, gauche, droite, rouge, vert, bleu, jaune, "
    "blanc, noir, un, deux, trois, quatre, cinq, six, sept, huit, neuf, dix, robot, musique",
    "it": "sì, no, forse, va bene, ciao, arrivederci, per favore, grazie, scusa, fermo, aiuto, "
    "ancora, bene, male, contento, triste, stanco, sinistra, destra, rosso, verde, blu, giallo, "
    "bianco, nero, uno, due, tre, quattro, cinque, sei, sette, otto, nove, dieci, robot, musica",
    "ja": "はい, いいえ, たぶん, こんにちは, さようなら, お願いします, ありがとう, ごめんなさい, "
    "止まって, 助けて, もう一度, いい, わるい, うれしい, かなしい, 左, 右, 赤, 緑, 青, 黄色, 白, "
    "黒, 一, 二, 三, 四, 五, 六, 七, 八, 九, 十, ロボット, 音楽, 踊って",
}
"""By our word for the language."""


def common_words(language: str) -> tuple[str, ...]:
    """Return common answers in a language, in English where we have none."""
    return tuple(WORDS.get(language, WORDS["en"]).split(", "))


# The words that a robot listens for: those that rules wait for, and those asked for just now.
#
# NAOqi has one vocabulary for all; it is changed when what is wanted differs from what it has.

SERVICE = "ALSpeechRecognition"
EARS = "NEP_Studio"
"""By this name the robot knows who listens."""
VOCABULARY_S = 10.0


class Hearing:
    """``expected`` are the words of rules, which are listened for all the time."""

    def __init__(self, robot: RealRobot, expected: tuple[str, ...] = ()) -> None:
        self.expected = expected
        self._robot = robot
        self._asked: list[tuple[str, ...]] = []
        self._has: tuple[str, ...] = ()
        self._change: Task | None = None
        self._refused: tuple[str, ...] = ()
        self._problem: Fault | None = None

    def step(self) -> None:
        """Go on changing what the robot listens for, if that is wanted."""
        wanted = tuple(
            dict.fromkeys(word for words in (self.expected, *self._asked) for word in words)
        )
        if self._change is None and wanted not in (self._has, self._refused):
            self._problem, self._refused = None, ()
            self._change = self._changing(wanted)
        if self._change is None:
            return
        try:
            next(self._change)
        except StopIteration:
            self._change = None
        except ActionFailed as problem:
            self._change, self._refused, self._problem = None, wanted, problem.fault
            log.warning("%s does not listen: %s", self._robot.name, problem)

    def listen(self, action: a.Listen) -> Task:
        """Listen for words for some seconds; they come as human states. No words: common ones."""
        language = str(self._robot.known.settings.get("language", "en"))
        words = tuple(action.words) or common_words(language)
        self._asked.append(words)
        try:
            while not set(words) <= set(self._has):
                if self._problem:
                    raise ActionFailed.of(self._problem)
                yield
            self._robot.known.listening = tuple(action.words) or ("",)
            yield from waited(action.seconds)
        finally:
            self._asked.remove(words)
            self._robot.known.listening = ()
        return ""

    def _changing(self, words: tuple[str, ...]) -> Task:
        robot = self._robot
        if self._has:
            yield from robot.call(SERVICE, "unsubscribe", EARS)
        self._has = ()
        if not words:
            return ""
        yield from robot.call(SERVICE, "pause", True)
        yield from robot.call(SERVICE, "setVocabulary", list(words), True, limit_s=VOCABULARY_S)
        yield from robot.call(SERVICE, "pause", False)
        yield from robot.call(SERVICE, "subscribe", EARS)
        self._has = words
        return ""


# What a real robot does with its cameras and files: faces, pictures, videos, sounds.

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
