"""What each block about robots must have done to the robot: looked at afterwards, not at the call.

Each look says how the block is filled in, what happens before, and what the robot's own state
must be then. The same looks are taken at the virtual robot and at one that is driven over NAOqi.
"""

from __future__ import annotations

import math

from tests.stories.robot_block_pictures import BALL, shows_the_ball
from tests.stories.robot_block_seen import (
    LONG,
    Look,
    joint,
    light,
    rule,
    sense,
    setting,
    sound_file,
    value_is,
    value_near,
    went,
)
from tests.stories.robot_theatre import B

FACE = sense("face", name="Anna", place=(0.8, 0.2, 0.5))
STRANGER = sense("face", place=(0.8, 0.2, 0.5))
MARK = sense("mark", name="64", place=(1.0, 0.0, 0.4))
RED = B("robot.leds", {"group": "AllLeds", "colour": "#ff0000"})
LEARN_BEN = B("robot_camera.learn_face", {"name": "Ben"})
SOUND = sound_file()
SEE_YAW = math.degrees(math.atan2(0.2, 0.8))

LOOKS: dict[str, Look] = {
    "robot.say": Look(
        "the words it says, and its arms moving meanwhile",
        lambda seen: LONG in seen.said and seen.moved("RElbowRoll") > 0.1,
        {"text": LONG, "gesture": "explain"},
    ),
    "robot.do": Look(
        "its posture, and its knees",
        lambda seen: seen.after.posture == "Sit" and seen.after.joints["LHipPitch"] < -1.0,
        {"posture": "posture_sit"},
    ),
    "robot.imitate": Look(
        "its arms while it moves, and its posture after that",
        lambda seen: seen.moved("RShoulderPitch") > 0.3 or seen.moved("LShoulderPitch") > 0.3,
    ),
    "robot.play": Look(
        "its right arm while it waves", lambda seen: seen.moved("RShoulderPitch") > 0.8
    ),
    "robot.walk": Look("where it stands", went(0.3, 0.1, 0), {"forward": 0.3, "left": 0.1}),
    "robot.turn": Look("where it faces", went(0, 0, 90)),
    "robot.look": Look("its head", joint("HeadYaw", 30), {"yaw": 30, "pitch": 5}),
    "robot.leds": Look("the colour of its eyes", light("LeftFaceLeds", 0x00AAFF)),
    "robot.stop": Look(
        "that it stands still",
        lambda seen: not seen.after.moving and seen.moved("LHipPitch") > 0.05,
        first=(B("robot_moves.start_walking"), B("control.wait", {"seconds": 0.5})),
    ),
    "robot_camera.learn_face": Look(
        "whose face it sees, once it has learnt somebody's",
        lambda seen: "face_ben" not in seen.before.sees and "face_ben" in seen.after.sees,
        {"name": "Ben"},
        senses=(STRANGER,),
    ),
    "robot_camera.forget_face": Look(
        "whose face it sees: nobody's whom it knows, after it knew the name",
        lambda seen: (
            any("face_ben" in state.sees for state in seen.states)
            and "face" in seen.after.sees
            and "face_ben" not in seen.after.sees
        ),
        {"name": "Ben"},
        first=(LEARN_BEN, B("control.wait", {"seconds": 0.3})),
        senses=(STRANGER,),
    ),
    "robot_camera.take_picture": Look(
        "the file: a picture of the red ball before it",
        shows_the_ball("pictures", "picture"),
        things=(BALL,),
    ),
    "robot_camera.record_video": Look(
        "the file: a video of the red ball before it",
        shows_the_ball("videos", "video"),
        {"seconds": 1},
        things=(BALL,),
    ),
    "robot_camera.play_sound": Look(
        "the file that it plays, and that it ends",
        lambda seen: (
            any(state.settings["playing"] == SOUND for state in seen.states)
            and not seen.after.settings["playing"]
        ),
        {"file": SOUND},
    ),
    "robot_events.touched": rule("its head is touched", sense("head_middle")),
    "robot_events.heard": rule("the word is said", sense("word", name="hello")),
    "robot_events.sees": rule("a face comes", FACE),
    "robot_events.sees_face_of": rule("Anna comes", FACE),
    "robot_events.sees_mark": rule("mark 64 comes", MARK),
    "robot_events.person": rule("somebody comes close", FACE),
    "robot_events.sensor": rule("something is near its sonar", sense("sonar_left", 0.2)),
    "robot_events.emotion": rule("somebody looks happy", state="emotion_happy"),
    "robot_events.idle": rule("nothing happens for a while", seconds=0.5),
    "robot_lights.fade": Look(
        "the colour of its eyes, and colours on the way",
        lambda seen: (
            seen.after.leds["LeftFaceLeds"] == 0xFF8800
            and len({state.leds["LeftFaceLeds"] for state in seen.states}) > 2
        ),
    ),
    "robot_lights.brightness": Look(
        "how bright its ears are", lambda seen: 100 < seen.after.leds["LeftEarLeds"] < 156
    ),
    "robot_lights.off": Look(
        "that no light is on", lambda seen: not any(seen.after.leds.values()), first=(RED,)
    ),
    "robot_lights.reset": Look(
        "its eyes and its chest",
        lambda seen: (
            seen.after.leds["LeftFaceLeds"] == 0xFFFFFF and not seen.after.leds["ChestLeds"]
        ),
        first=(RED,),
    ),
    "robot_lights.random_eyes": Look(
        "its eyes changing colours, and as before after that",
        lambda seen: (
            len({state.leds["LeftFaceLeds"] for state in seen.states}) > 2
            and seen.after.leds["LeftFaceLeds"] == seen.before.leds["LeftFaceLeds"]
        ),
        {"seconds": 4},
    ),
    "robot_lights.rotate_eyes": Look(
        "its eyes green and red, and as before after that",
        lambda seen: (
            {0x00FF00, 0xFF0000} <= {state.leds["LeftFaceLeds"] for state in seen.states}
            and seen.after.leds["LeftFaceLeds"] == seen.before.leds["LeftFaceLeds"]
        ),
        {"seconds": 12},
    ),
    "robot_moves.open_hand": Look("its hand", lambda seen: seen.after.joints["LHand"] > 0.9),
    "robot_moves.close_hand": Look(
        "its hand",
        lambda seen: seen.after.joints["LHand"] < 0.1,
        first=(B("robot_moves.open_hand"),),
    ),
    "robot_moves.move_joint": Look("the joint", joint("HeadYaw", 30)),
    "robot_moves.move_joint_by": Look(
        "the joint", joint("HeadYaw", 40), first=(B("robot_moves.move_joint"),)
    ),
    "robot_moves.lock": Look(
        "the motors of its arm",
        setting("locked_left_arm", True),
        first=(B("robot_moves.release"),),
    ),
    "robot_moves.release": Look("the motors of its arm", setting("locked_left_arm", False)),
    "robot_moves.wake_up": Look(
        "its motors, and that it stands",
        lambda seen: seen.after.settings["awake"] and seen.after.posture.startswith("Stand"),
        first=(B("robot_moves.rest"),),
    ),
    "robot_moves.rest": Look(
        "its motors, and that it crouches",
        lambda seen: not seen.after.settings["awake"] and seen.after.joints["LKneePitch"] > 1.0,
    ),
    "robot_moves.awareness": Look("that it looks at people", setting("awareness", True)),
    "robot_moves.breathing": Look("that it breathes", setting("breathing", True)),
    "robot_moves.play_changed": Look(
        "its left arm, for the mirrored wave",
        lambda seen: seen.moved("LShoulderPitch") > 0.8 and seen.moved("RShoulderPitch") < 0.3,
        {"mirror": True, "stretch": 1.5},
    ),
    "robot_moves.walk_to": Look("where it stands and faces", went(0.3, 0, 90)),
    "robot_moves.start_walking": Look(
        "where it stands after a while",
        lambda seen: seen.way()[0] > 0.1,
        # A driver joins its legs in real time: on a robot that lives faster it stands after each
        then=(B("control.wait", {"seconds": 3.0}),),
    ),
    "robot_moves.stop_moving": Look(
        "that it stands still, and speaks on",
        lambda seen: not seen.after.moving and seen.moved("LHipPitch") > 0.05,
        first=(B("robot_moves.start_walking"), B("control.wait", {"seconds": 0.5})),
    ),
    "robot_moves.look_at": Look(
        "its head", joint("HeadYaw", math.degrees(math.atan2(0.5, 1.0))), {"y": 0.5}
    ),
    "robot_moves.point_at": Look(
        "its arm",
        lambda seen: (
            seen.moved("LShoulderPitch") > 0.5 and abs(seen.after.joints["LElbowRoll"]) < 0.1
        ),
    ),
    "robot_moves.look_at_seen": Look("its head", joint("HeadYaw", SEE_YAW), senses=(FACE,)),
    "robot_moves.track": Look("its head", joint("HeadYaw", SEE_YAW), senses=(FACE,)),
    "robot_senses.is_touched": Look(
        "the answer, with a hand on its head", value_is(True), senses=(sense("head_front"),)
    ),
    "robot_senses.sensor": Look(
        "the distance that it measures", value_near(25), senses=(sense("sonar_left", 0.25),)
    ),
    "robot_senses.angle": Look(
        "the angle, after a move", value_near(30, 3), first=(B("robot_moves.move_joint"),)
    ),
    "robot_senses.current": Look("the current, A", value_near(0.05, 0.04)),
    "robot_senses.sees": Look("the answer, with a face before it", value_is(True), senses=(FACE,)),
    "robot_senses.sees_face_of": Look("the answer, with Anna", value_is(True), senses=(FACE,)),
    "robot_senses.sees_mark": Look("the answer, with a mark", value_is(True), senses=(MARK,)),
    "robot_senses.seen_face": Look("the name", value_is("anna"), senses=(FACE,)),
    "robot_senses.seen_mark": Look("the number", value_is("64"), senses=(MARK,)),
    "robot_senses.place_of": Look(
        "the distance in cm", value_near(100 * math.hypot(0.8, 0.2), 12), senses=(FACE,)
    ),
    "robot_senses.person_is": Look("the answer, with Anna", value_is(True), senses=(FACE,)),
    "robot_senses.is_doing": Look(
        "the answer, as it walks",
        value_is(True),
        {"doing": "moving"},
        (B("robot_moves.start_walking"), B("control.wait", {"seconds": 0.7})),
    ),
    "robot_senses.is_in": Look("the answer", value_is(True), {"posture": "posture_stand"}),
    "robot_speech.say_with_voice": Look(
        "the words it says",
        lambda seen: LONG in seen.said,
        {"text": LONG, "speed": 80, "pitch": 120},
    ),
    "robot_speech.ask": Look(
        "its question, and that it listens",
        lambda seen: LONG in seen.said and any(state.listening for state in seen.states),
        {"question": LONG, "seconds": 1},
    ),
    "robot_speech.ask_for": Look(
        "the answer that somebody gave it", value_is("yes"), {"question": LONG, "seconds": 20}
    ),
    "robot_speech.ask_number": Look(
        "the number that somebody answered", value_near(7), {"question": LONG, "seconds": 20}
    ),
    "robot_speech.wait_for_word": Look(
        "that it listens",
        lambda seen: any(state.listening for state in seen.states),
        {"seconds": 1},
    ),
    "robot_speech.heard_word": Look(
        "the word", value_is("yes"), first=(B("robot_speech.wait_for_word", {"seconds": 20}),)
    ),
    "robot_speech.answer": Look(
        "the answer", value_is("yes"), first=(B("robot_speech.ask", {"seconds": 20}),)
    ),
    "robot_speech.set_volume": Look("its volume", setting("volume", 30.0), {"percent": 30}),
    "robot_speech.volume": Look(
        "the volume", value_near(45), first=(B("robot_speech.set_volume", {"percent": 45}),)
    ),
    "robot_speech.set_language": Look(
        "its language", setting("language", "de"), {"language": "de"}
    ),
    "robot_speech.language": Look(
        "the language",
        value_is("fr"),
        first=(B("robot_speech.set_language", {"language": "fr"}),),
    ),
}
"""By the id of the block."""

ANSWERS = {
    "robot_speech.ask_for": "yes",
    "robot_speech.heard_word": "yes",
    "robot_speech.answer": "yes",
    "robot_speech.ask_number": "seven",
}
"""What somebody says as soon as the robot listens."""
