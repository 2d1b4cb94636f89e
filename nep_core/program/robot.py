"""Robot: what a program can ask a social robot to do, in the words of people."""

from __future__ import annotations

import math
import re
import threading
import time
from collections.abc import Callable, Collection, Sequence
from difflib import get_close_matches
from typing import Any, cast

from faults import Text
from nep_core.errors import RobotError
from nep_core.networks.network import Network
from nep_core.networks.transports import default_network
from nep_core.wire.messages import ROBOT_STATE, HumanBehavior, RobotState
from nep_core.wire.pubsub import Subscriber
from nep_core.wire.states import (
    NOISE,
    NOT_UNDERSTOOD,
    TOUCHES,
    plain,
    state_of_word,
    word_of_state,
)

from .actions import ActionClient, action_client, not_answering
from .choices import chosen
from .human import LONGEST_WAIT_S, human_listener, next_state, note_answer
from .tasks import POLL_S, Stamp, current_task, for_each, own_value
from .values import LOOK, PUT_ROBOT, as_text, noun_of, refuse, shown, spoken_language

# Where the robots of a program are, and what their sensors measure, as last heard.

FIRST_STATE_S = 5.0
"""A robot that says nothing about itself for so long does not answer."""
FRESH_STATE_S = 1.0
MOST_ROBOTS = 200
"""So many robots are known, those heard last: a stranger may make up a name each time."""


class RobotListener:
    """Hears ``/robot_state`` for a whole program."""

    def __init__(self, network: Network) -> None:
        self._states: dict[str, tuple[RobotState, Stamp]] = {}
        self._news = threading.Condition()
        self._subscriber = Subscriber(
            ROBOT_STATE, RobotState, network=network, callback=self._on_state
        )

    def newest(self, robot: str, *since: Stamp) -> RobotState | None:
        """The newest state of a robot, None when it does not tell any for 5 s.

        Waits up to a second for one that was told after all that it told at ``since``.
        """
        begun_s = time.monotonic()
        with self._news:
            while not self._is_told_after(robot, since):
                longest_s = FRESH_STATE_S if robot in self._states else FIRST_STATE_S
                if time.monotonic() - begun_s >= longest_s:
                    break
                current_task().check()
                self._news.wait(POLL_S)
            return self.heard_of(robot)

    def heard_of(self, robot: str) -> RobotState | None:
        """The state that a robot told last; None of what has told none, as of who is no robot."""
        with self._news:
            return self._states[robot][0] if robot in self._states else None

    def model(self, robot: str) -> str:
        """The model of a robot as it told it last; "" of a NAO, and of one not heard yet."""
        with self._news:
            return self._states[robot][0].model if robot in self._states else ""

    def _is_told_after(self, robot: str, since: tuple[Stamp, ...]) -> bool:
        if robot not in self._states:
            return False
        _, stamp = self._states[robot]
        return all(before.is_before(stamp) for before in since)

    def _on_state(self, state: RobotState) -> None:
        with self._news:
            self._states.pop(state.robot, None)
            self._states[state.robot] = state, Stamp(state.time, time.monotonic())
            if len(self._states) > MOST_ROBOTS:
                del self._states[next(iter(self._states))]
            self._news.notify_all()


def robot_listener(network: Network | None = None) -> RobotListener:
    """The listener of this program's network."""
    return (network or default_network()).shared(RobotListener)


CLOSE_M, MIDDLE_M = 1.0, 2.0
HEAD_UP_M = 0.45
"""How high the eyes of a standing robot are."""


MOST_QUESTIONS = 3
_NUMBER_WORDS = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen "
    "sixteen seventeen eighteen nineteen twenty",
    "null eins zwei drei vier fünf sechs sieben acht neun zehn elf zwölf dreizehn vierzehn "
    "fünfzehn sechzehn siebzehn achtzehn neunzehn zwanzig",
    "cero uno dos tres cuatro cinco seis siete ocho nueve diez once doce trece catorce quince "
    "dieciséis diecisiete dieciocho diecinueve veinte",
    "zéro un deux trois quatre cinq six sept huit neuf dix onze douze treize quatorze quinze seize "
    "dix-sept dix-huit dix-neuf vingt",
    "zero uno due tre quattro cinque sei sette otto nove dieci undici dodici tredici quattordici "
    "quindici sedici diciassette diciotto diciannove venti",
    "零 一 二 三 四 五 六 七 八 九 十 十一 十二 十三 十四 十五 十六 十七 十八 十九 二十",
)
_SPOKEN = {
    word.replace("-", " "): number
    for words in _NUMBER_WORDS
    for number, word in enumerate(words.split())
}


_MINUS = ("minus", "menos", "moins", "meno", "マイナス")
_DIGITS = re.compile(r"(\d{1,15})(?:\.(\d{1,15}))?|\.\d{1,15}", re.ASCII)


def number_in_words(heard: str) -> float | None:
    """The number that an answer is, None when it is something else, or may mean two numbers.

    “1,000” is a thousand to some and one to others.
    """
    words = heard.strip().casefold()
    sign, amount = (-1, words[1:]) if words.startswith("-") else (1, words)
    for minus in _MINUS:
        if words.startswith(minus):
            sign, amount = -1, words.removeprefix(minus).strip()
    if amount in _SPOKEN:
        return sign * _SPOKEN[amount]
    found = _DIGITS.fullmatch(amount)
    if found is None:
        return None
    whole, part = found[1] or "0", found[2]
    if part is not None and len(part) == 3 and len(whole) <= 3 and not whole.startswith("0"):
        return None
    return sign * (int(whole) if amount == whole else float(amount))


class Robot:
    """One robot by name, or several that act at once. A program may keep it as any value.

    Every call returns when all of them are done; it raises RobotNotAnswering or ActionFailed.
    What is measured is measured by the first; names of sensors are those of ``/robot_state``, and
    groups of lights are "FaceLeds", "ChestLeds", "AllLeds", ... What is chosen by a word may be
    called as in blocks, too; raises RobotError for a word that is not known.
    """

    NOUN = Text("a robot")

    def __init__(self, robots: str | list[str], *, network: Network | None = None) -> None:
        self.robots = [robots] if isinstance(robots, str) else list(robots)
        if not self.robots or not all(isinstance(name, str) and name for name in self.robots):
            raise RobotError(
                "A robot needs a name.",
                checklist=('Write Robot("NAO") or Robot(["NAO", "NAO2"]).',),
            )
        self._network = network
        self._has_language = False
        """Whether the program has set the language in which it speaks."""
        if isinstance(robots, str):
            _ROBOTS[robots] = self
        robot_listener(network)  # what robots tell from now on is known when it is asked for

    def with_others(self, others: Sequence[Robot]) -> Robot:
        """This robot and others, which act at once; each is one of them once."""
        names = dict.fromkeys(name for robot in (self, *others) for name in robot.robots)
        return Robot(list(names), network=self._network)

    def one_by_one(self) -> list[Robot]:
        """Each of these robots, by itself: the one that the program has, where it has it."""

        def of(name: str) -> Robot:
            known = _ROBOTS.get(name)
            is_here = known is not None and known._network is self._network
            return known if known and is_here else Robot(name, network=self._network)

        return [self] if len(self.robots) == 1 else list(map(of, dict.fromkeys(self.robots)))

    def __str__(self) -> str:
        """Its name; the names of several."""
        return as_text(self.robots if len(self.robots) > 1 else self.robots[0])

    def __repr__(self) -> str:
        """As a program writes it."""
        return f"Robot({(self.robots if len(self.robots) > 1 else self.robots[0])!r})"

    def __eq__(self, other: object) -> bool:
        """Whether it is the same robot, or the same ones."""
        return isinstance(other, Robot) and self.robots == other.robots

    def __hash__(self) -> int:
        """Robots that are the same have the same."""
        return hash(tuple(self.robots))

    def stop(self) -> None:
        """Stop all that the robot does, at once; does not wait."""
        self._client.send(self.robots, "stop", {})

    # Its voice and its ears

    def say(
        self,
        text: object,
        gesture: str = "no_gesture",
        language: str = "",
        *,
        speed: float = 100.0,
        pitch: float = 100.0,
    ) -> None:
        """Say a text aloud, perhaps with a gesture, in a language such as "en".

        Without one it is the program's, as long as the robot speaks that and is set to no other.
        ``speed`` and ``pitch`` are percent of the usual ones, 50 to 200.
        """
        gesture = self._chosen("say_gestures", gesture)
        language = self._chosen("languages", language) if language else ""
        voice = {"speed": speed, "pitch": pitch}
        changed: dict[str, object] = {name: to for name, to in voice.items() if to != 100.0}
        if not language and not self._has_language and spoken_language() != "en":
            changed["usual_language"] = spoken_language()
        self._perform("say", text=str(text), gesture=gesture, language=language, **changed)

    def ask(self, question: object, words: list[str] | None = None, seconds: float = 10.0) -> str:
        """Ask something, and give the word that is heard; "" when none is in time.

        With ``words`` any other answer ends the wait too: it is given as it was heard, "" when it
        was not understood. What a rule waits for is said to that rule, and no other answer.
        """
        note_answer("")
        wanted = {state_of_word(word): word for word in words or []}
        listener = human_listener(self._network)

        def counts(behavior: HumanBehavior) -> bool:
            state = behavior.human_state
            if state in wanted or (not wanted and _is_word(state)):
                return self._is_told(behavior.source)
            is_other = _is_word(state) and state not in listener.of_rules
            is_answer = bool(wanted) and (is_other or state == NOT_UNDERSTOOD)
            return is_answer and self._is_heard_by(behavior.source)

        with listener.following(counts) as heard:
            self.say(question)
            heard.clear()  # what was said before the question ended answers nothing
            state = self._listen(words or [], seconds, heard, str(question))
        answer = wanted.get(state) or word_of_state(state)
        note_answer(answer)
        return answer

    def _is_told(self, source: str) -> bool:
        """Whether what somebody has heard may be said to this robot: not to another that asks."""
        other = robot_listener(self._network).heard_of(source)
        return source in self.robots or other is None or not other.listening

    def _is_heard_by(self, source: str) -> bool:
        """Whether it was this robot that has heard something, or no robot, and none of its words.

        A robot that talks may hear itself.
        """
        robots = robot_listener(self._network)
        if source not in self.robots and robots.heard_of(source) is not None:
            return False
        own = map(robots.heard_of, self.robots)
        return not any(state is not None and state.saying for state in own)

    def ask_number(self, question: object, seconds: float = 10.0) -> float:
        """Ask for a number, and give it; an answer that is none is asked again, three times in all.

        It is heard as digits, or as a word from zero to twenty of a language of the studio. Raises
        RobotError when none is heard.
        """
        for _ in range(MOST_QUESTIONS):
            number = number_in_words(self.ask(question, seconds=seconds))
            if number is not None:
                return number
        raise RobotError(
            "{robot} has asked “{question}” {count} times and has heard no number.",
            checklist=(
                "Answer with the number alone, such as 7 or seven.",
                "Give more seconds for the answer.",
                "Use the block that asks for any answer, and decide what to do with it.",
            ),
            robot=self.robots[0],
            question=question,
            count=MOST_QUESTIONS,
        )

    def wait_for_word(self, *words: str, seconds: float = LONGEST_WAIT_S) -> str:
        """Wait until one of the words is heard, and give it; "" when none is in time."""
        wanted = {state_of_word(word): word for word in words}

        def counts(behavior: HumanBehavior) -> bool:
            state = behavior.human_state
            return state in wanted or (not wanted and _is_word(state))

        with human_listener(self._network).following(counts) as heard:
            state = self._listen(list(words), seconds, heard)
            return wanted.get(state) or word_of_state(state)

    def set_volume(self, percent: float) -> None:
        """Set how loud it speaks, 0 to 100."""
        self._perform("volume", percent=percent)

    def volume(self) -> float:
        """How loud it speaks, 0 to 100."""
        return float(self._state().settings.get("volume", 0.0))

    def set_language(self, language: str) -> None:
        """Set the language that it speaks and understands, such as "en"."""
        self._perform("language", language=self._chosen("languages", language))
        self._has_language = True

    def language(self) -> str:
        """The language that it speaks and understands."""
        return str(self._state().settings.get("language", ""))

    def _listen(
        self, words: list[str], seconds: float, heard: list[str], question: str = ""
    ) -> str:
        """Listen for an answer, and give its state; an interrupted question is asked once more."""
        listening = {"words": words, "seconds": min(seconds, LONGEST_WAIT_S)}

        def ask_again() -> None:
            if question:
                self._client.end(self.robots, "listen")
                self.say(question)
                self._client.begin(self.robots, "listen", listening)

        self._client.begin(self.robots, "listen", listening)
        try:
            return next_state(heard, seconds, ask_again)
        finally:
            self._client.end(self.robots, "listen")

    # Its body: hands, joints, walking, gaze, sleep

    def do(self, posture: str) -> None:
        """Take a posture: "posture_stand", "posture_sit", ..."""
        self._perform("do", posture=self._chosen("postures", posture))

    def imitate(self, animal: str) -> None:
        """Imitate an animal: "cat", "elephant", ..."""
        self._perform("imitate", animal=self._chosen("animals", animal))

    def play(
        self, animation: str, *, mirror: bool = False, reverse: bool = False, stretch: float = 1.0
    ) -> None:
        """Play an animation: left for right, backwards, or ``stretch`` times as long.

        ``mirror`` plays left for right, ``reverse`` backwards.
        """
        animation = self._chosen("animations", animation)
        self._perform("play", animation=animation, mirror=mirror, reverse=reverse, stretch=stretch)

    def open_hand(self, side: str = "both") -> None:
        """Open the "left" hand, the "right" one, or "both"."""
        self._perform("hand", side=self._one_of("hands", side), open=True)

    def close_hand(self, side: str = "both") -> None:
        """Close the "left" hand, the "right" one, or "both"."""
        self._perform("hand", side=self._one_of("hands", side), open=False)

    def move_joint(self, joint: str, degrees: float) -> None:
        """Move a joint, such as "LElbowRoll", to an angle."""
        joint = self._chosen("joints", joint)
        self._perform("move_joint", joint=joint, degrees=degrees)

    def move_joint_by(self, joint: str, degrees: float) -> None:
        """Move a joint by an angle from where it is."""
        joint = self._chosen("joints", joint)
        self._perform("move_joint", joint=joint, degrees=degrees, relative=True)

    def angle(self, joint: str) -> float:
        """The angle of a joint in degrees; of a hand ("LHand") how far it is open, 0 to 100."""
        joints = self._state().joints
        joint = self._one_of("joints", joint, joints)
        rad = joints.get(joint, 0.0)
        return round(rad * 100.0 if joint.endswith("Hand") else math.degrees(rad), 1)

    def lock(self, part: str = "body") -> None:
        """Switch the motors of a part on: "head", "left_arm", "legs", "body", ..."""
        self._perform("stiffness", part=self._chosen("lock_parts", part), on=True)

    def release(self, part: str = "body") -> None:
        """Switch the motors of a part off, so that a person can move it."""
        self._perform("stiffness", part=self._chosen("lock_parts", part), on=False)

    def wake_up(self) -> None:
        """Switch all motors on and stand up."""
        self._perform("wake_up")

    def rest(self) -> None:
        """Go down to a safe posture and switch all motors off."""
        self._perform("rest")

    def awareness(self, on: bool) -> None:
        """Look at people by itself, or not."""
        self._perform("awareness", on=_is_on(on))

    def breathing(self, on: bool) -> None:
        """Move a little as if it breathed, or not."""
        self._perform("breathing", on=_is_on(on))

    def walk(self, forward_m: float, left_m: float = 0.0, *, turn_deg: float = 0.0) -> None:
        """Walk so many metres forward (negative: back) and to the left, turning on the way."""
        turn = {"turn_deg": turn_deg} if turn_deg else {}
        self._perform("walk", forward_m=forward_m, left_m=left_m, **turn)

    def turn(self, degrees: float) -> None:
        """Turn on the spot, to the left (negative: to the right)."""
        self._perform("turn", degrees=degrees)

    def start_walking(self, forward: float, left: float = 0.0, turn: float = 0.0) -> None:
        """Walk on and on, each speed in percent of the highest; does not wait.

        It ends with ``stop_moving``, as soon as the legs are asked for something else, and about
        a second after this program is gone, however that ended.
        """
        speeds = {"forward": forward / 100, "left": left / 100, "turn": turn / 100}
        self._client.begin_renewed(self.robots, "walk_freely", speeds)

    def stop_moving(self) -> None:
        """Stop what moves joints, at once; what is said goes on. Does not wait."""
        self._client.send(self.robots, "stop_moving", {})

    def look(self, yaw_deg: float, pitch_deg: float = 0.0) -> None:
        """Turn the head: yaw to the left, pitch down, in degrees."""
        self._perform("look", yaw_deg=yaw_deg, pitch_deg=pitch_deg)

    def look_at(self, x_m: float, y_m: float, z_m: float, frame: str = "robot") -> None:
        """Turn the head to a place: metres in front of, left of and above its feet.

        ``frame`` "torso": as seen from the torso; "world": from where the robot has started.

        ``x_m`` is in front, ``y_m`` left, ``z_m`` up.
        """
        frame = self._one_of("frames", frame)
        self._perform("look_at", x_m=x_m, y_m=y_m, z_m=z_m, frame=frame)

    def point_at(
        self, x_m: float, y_m: float, z_m: float, frame: str = "robot", arm: str = ""
    ) -> None:
        """Point at a place with the "left" or "right" arm, else the one that is nearer.

        ``x_m``, ``y_m``, ``z_m`` and ``frame`` are as those of ``look_at``.
        """
        frame, arm = self._one_of("frames", frame), self._one_of("arms", arm, [""])
        self._perform("point_at", x_m=x_m, y_m=y_m, z_m=z_m, frame=frame, arm=arm)

    def look_at_seen(self, thing: str = "face") -> None:
        """Turn the head to what it sees or hears: "face", "ball", "sound"."""
        self._perform("look_at_seen", thing=self._chosen("things", thing))

    def track(self, thing: str, using: str = "head") -> None:
        """Keep the "head" or the whole "body" turned to something it sees; "off" ends it."""
        thing, using = self._chosen("things", thing), self._one_of("tracking", using)
        self._perform("track", thing=thing, using=using)

    # Its lights

    def leds(self, group: str, colour: str, seconds: float = 0.0) -> None:
        """Let a group of lights shine in a colour such as "#ff8800", reached in some seconds."""
        group = self._chosen("led_groups", group)
        fade = {"seconds": seconds} if seconds else {}
        self._perform("leds", group=group, colour=colour, **fade)

    def leds_brightness(self, group: str, percent: float) -> None:
        """Set how bright a group of lights is, 0 to 100."""
        self._perform("intensity", group=self._chosen("led_groups", group), percent=percent)

    def leds_off(self, group: str) -> None:
        """Switch a group of lights off."""
        self._perform("intensity", group=self._chosen("led_groups", group), percent=0.0)

    def leds_reset(self, group: str) -> None:
        """Light a group as it was at the start."""
        self._perform("reset_leds", group=self._chosen("led_groups", group))

    def random_eyes(self, seconds: float) -> None:
        """Let the eyes shine in colours by chance for some seconds."""
        self._perform("random_eyes", seconds=seconds)

    def rotate_eyes(self, seconds: float) -> None:
        """Let green, yellow and red go round the eyes for some seconds."""
        self._perform("rotate_eyes", seconds=seconds)

    # What it feels, sees and is doing, and what needs its cameras

    def sensor(self, name: str) -> float:
        """What a sensor measures: "sonar_left" in cm, "angle_x" in degrees, "battery" in percent.

        All others in SI units.
        """
        state = self._state()
        name = self._one_of("sensors", name, [*state.sensors, "battery"])
        if name == "battery":
            return round(state.battery * 100.0, 1)
        value = state.sensors.get(name, 0.0)
        if name.startswith("angle_"):
            return round(math.degrees(value), 1)
        return round(value * 100.0 if name.startswith("sonar") else value, 3)

    def current(self, joint: str) -> float:
        """How much current the motor of a joint takes, in A."""
        state = self._state()
        joint = self._one_of("joints", joint, state.joints)
        return state.sensors.get(f"current_{joint}", 0.0)

    def is_touched(self, part: str) -> bool:
        """Whether it is touched now: "head", "head_front", "hand_left", "bumper_right", ..."""
        sensors = self._state().sensors
        part = self._one_of("touch_parts", part, [*sensors, *TOUCHES])
        return any(sensors.get(name, 0.0) > 0.0 for name in TOUCHES.get(part, (part,)))

    def sees(self, thing: str, name: object = "") -> bool:
        """Whether it sees a "face" (any, or that of a name), "ball" or "mark", or hears a "sound".

        ``name`` of a mark is its number.
        """
        thing = self._one_of("things", thing, ["mark"])
        return _key(thing, name) in self._state().sees

    def seen_name(self, thing: str) -> str:
        """The name of the face, or the number of the mark, that it sees; "" when none."""
        names = [key.partition("_")[2] for key in self._state().sees if key.startswith(f"{thing}_")]
        return names[0].replace("_", " ") if names else ""

    def place_of(self, thing: str, measure: str = "distance") -> float:
        """Where something that it sees is; -1 when it sees none.

        ``measure``: "distance" in cm, "left" or "up" in degrees from straight ahead.
        """
        thing, measure = (
            self._one_of("placed_things", thing, ["mark"]),
            self._one_of("measures", measure),
        )
        place = self._state().sees.get(_key(thing, ""))
        if place is None:
            return -1.0
        x, y, z = place
        flat = math.hypot(x, y)
        if measure == "left":
            return round(math.degrees(math.atan2(y, x)), 1)
        if measure == "up":
            return round(math.degrees(math.atan2(z - HEAD_UP_M, flat)), 1)
        return round(flat * 100.0, 1)

    def person_is(self, distance: str) -> bool:
        """Whether the person it sees is "close" (under 1 m), "middle" (under 2 m) or "far"."""
        distance = self._one_of("distances", distance)
        place = self._state().sees.get("face")
        if place is None:
            return False
        way_m = math.hypot(*place[:2])
        return distance == ("close" if way_m < CLOSE_M else "middle" if way_m < MIDDLE_M else "far")

    def is_doing(self, what: str) -> bool:
        """Whether it is "speaking", "moving", "listening", "awake", "breathing", "aware".

        "fallen": it lies because it lost its balance.
        """
        state = self._state()
        doing = {
            "speaking": state.saying,
            "moving": state.moving,
            "listening": state.listening,
            "awake": state.settings.get("awake"),
            "breathing": state.settings.get("breathing"),
            "aware": state.settings.get("awareness"),
            "fallen": state.fallen,
        }
        return bool(doing.get(self._one_of("doings", what, doing)))

    def is_in(self, posture: str) -> bool:
        """Whether it is in a posture, such as "posture_sit"."""
        posture = self._chosen("postures", posture)
        return _word(posture) == _word(self._state().posture)

    def posture(self) -> str:
        """The posture that it is in, such as "Stand"."""
        return self._state().posture

    def learn_face(self, name: str) -> None:
        """Learn the face of the person in front of it, under a name."""
        self._perform("learn_face", name=name)

    def forget_face(self, name: str) -> None:
        """Forget a face: who has it is a plain face until it is learnt again."""
        self._perform("forget_face", name=name)

    def take_picture(self, file: str, camera: str = "top") -> None:
        """Take a picture with the "top" or "bottom" camera, into a file on the robot."""
        camera = self._one_of("cameras", camera)
        self._perform("take_picture", file=file, camera=camera)

    def record_video(self, file: str, seconds: float, camera: str = "top") -> None:
        """Record a video for some seconds, into a file on the robot."""
        camera = self._one_of("cameras", camera)
        self._perform("record_video", file=file, seconds=seconds, camera=camera)

    def play_sound(self, file: str) -> None:
        """Play a sound file of the robot, for the one on the screen of this computer."""
        self._perform("play_sound", file=file)

    # How it asks and looks: requests to all its robots, and the newest state of the first

    @property
    def _client(self) -> ActionClient:
        return action_client(self._network)

    def _perform(self, action: str, **args: Any) -> None:
        self._client.perform(self.robots, action, args)

    def _chosen(self, table: str, word: object) -> str:
        """What it is asked with for a word; it refuses itself what it does not know."""
        return chosen(word, table, self._model(), is_open=True)

    def _one_of(self, table: str, word: object, also: Collection[str] = ()) -> str:
        """The same, of words that are known here; raises RobotError for another one."""
        return chosen(word, table, self._model(), also=also)

    def _model(self) -> str:
        return robot_listener(self._network).model(self.robots[0])

    def _state(self) -> RobotState:
        """The newest state, told after all that the robot was seen to do, or told of the person."""
        robot = self.robots[0]
        done = self._client.last_done.get(robot, Stamp())
        # A rule may have fired just now
        told = human_listener(self._network).told.get(robot, Stamp())
        state = robot_listener(self._network).newest(robot, done, told)
        if state is None:
            raise not_answering(robot)
        return state


_ROBOTS: dict[str, Robot] = {}
"""The single robots of the program, by name."""


def as_robot(value: Any) -> Robot:
    """The same robot, or that of a name; of a list of them those that act at once.

    Raises ValueRefused for what is none of the program's.
    """
    if isinstance(value, Robot):
        return value
    if isinstance(value, list) and value and not any(isinstance(one, list) for one in value):
        every = [as_robot(one) for one in value]
        return every[0].with_others(every[1:])
    if not isinstance(value, str):
        refuse(
            "A robot belongs here, and {value} is {noun}.",
            LOOK,
            PUT_ROBOT,
            value=shown(value),
            noun=noun_of(value),
        )
    folded = {name.casefold(): name for name in _ROBOTS}
    name = value if value in _ROBOTS else folded.get(value.strip().casefold(), "")
    if name:
        return _ROBOTS[name]
    near = get_close_matches(value, _ROBOTS, 1)
    refuse(
        "There is no robot called {value}. There are: {known}.",
        *(["Did you mean “{near}”?"] if near else []),
        LOOK,
        value=shown(value),
        known=", ".join(_ROBOTS),
        near="".join(near),
    )


# What is done for each of several robots at once.


def for_each_robot(robots: Robot, function: Callable[[], object]) -> None:
    """Call the function once for each of the robots, side by side, and wait for all.

    In it ``this_robot()`` is the robot for which it is called. As ``together`` it ends all when
    one ends by an error, which is raised.
    """
    for_each(robots.one_by_one(), function)


def this_robot() -> Robot:
    """The robot for which this is done; raises RobotError outside of ``for_each_robot``."""
    robot = cast("Robot | None", own_value())
    if robot is None:
        raise RobotError(
            "“This robot” is known only inside of “do for each of … at once”.",
            checklist=(
                "Put it into a block “do for each of … at once”.",
                "Or choose a robot in its place.",
            ),
        )
    return robot


def _is_word(state: str) -> bool:
    """Whether a human state tells of a word: a noise is none."""
    return bool(word_of_state(state)) and state != NOISE


def _is_on(on: object) -> bool:
    """Whether something is switched on: True, or the word "on"."""
    return on is True or on == "on"


def _key(thing: str, name: object) -> str:
    return "_".join(filter(None, (thing, plain(str(name)))))


def _word(posture: str) -> str:
    letters = "".join(letter for letter in posture if letter.isalnum()).casefold()
    return letters.removeprefix("posture")


# Colours written as texts such as "#ff8800": made from their parts, and mixed.

_COLOUR = re.compile(r"#?([0-9a-fA-F]{2})([0-9a-fA-F]{2})([0-9a-fA-F]{2})")


def colour_from(red: float, green: float, blue: float) -> str:
    """The colour with these parts of red, green and blue, each from 0 to 255."""
    parts = [min(max(round(value), 0), 255) for value in (red, green, blue)]
    return "#" + bytes(parts).hex()


def mix_colours(first: str, second: str, percent: float = 50) -> str:
    """A colour between two others: the first at 0 percent, the second at 100."""
    share = min(max(percent, 0), 100) / 100
    pairs = zip(_parts(first), _parts(second), strict=True)
    red, green, blue = (a + (b - a) * share for a, b in pairs)
    return colour_from(red, green, blue)


def _parts(colour: str) -> tuple[int, ...]:
    parts = _COLOUR.fullmatch(colour)
    if parts is None:
        raise ValueError(f"{colour!r} is not a colour: a colour is written like #ff8800.")
    return tuple(int(part, 16) for part in parts.groups())
