"""Every block of the programs that ours is measured by has a block that does the same."""

from __future__ import annotations

import pytest

from nep_studio.blocks.language import Language

OPEN_ROBERTA = {
    "naoActions_applyPosture": "robot.do",
    "naoActions_hand": "robot_moves.open_hand robot_moves.close_hand",
    "naoActions_moveJoint": "robot_moves.move_joint robot_moves.move_joint_by",
    "naoActions_stiffness": "robot_moves.lock robot_moves.release",
    "naoActions_walk": "robot.walk",
    "naoActions_turn": "robot.turn",
    "naoActions_walkTo": "robot_moves.walk_to",
    "naoActions_walk_async": "robot_moves.start_walking",
    "naoActions_stop": "robot_moves.stop_moving",
    "naoActions_animation": "robot.play robot_moves.play_changed",
    "naoActions_autonomous": "robot_moves.awareness robot_moves.breathing",
    "naoActions_pointLookAt": "robot_moves.look_at robot_moves.point_at",
    "robActions_sayText": "robot.say",
    "robActions_sayText_parameters": "robot_speech.say_with_voice",
    "robActions_setLanguage": "robot_speech.set_language",
    "naoActions_getLanguage": "robot_speech.language",
    "naoActions_setVolume": "robot_speech.set_volume",
    "naoActions_getVolume": "robot_speech.volume",
    "naoActions_learnFace": "robot_camera.learn_face",
    "naoActions_forgetFace": "robot_camera.forget_face",
    "naoActions_takePicture": "robot_camera.take_picture",
    "naoActions_recordVideo": "robot_camera.record_video",
    "actions_rgbLed_on_nao": "robot.leds robot_lights.fade",
    "actions_led_on_nao": "robot_lights.brightness",
    "actions_rgbLed_off_nao": "robot_lights.off robot_lights.reset",
    "actions_led_off_nao": "robot_lights.off robot_lights.reset",
    "naoActions_randomEyes": "robot_lights.random_eyes",
    "naoActions_rasta": "robot_lights.rotate_eyes",
    "robSensors_touch_getSample": "robot_senses.is_touched robot_events.touched",
    "robSensors_ultrasonic_getSample": "robot_senses.sensor robot_events.sensor",
    "robSensors_detectmark_getSample": "robot_senses.sees_mark robot_senses.seen_mark",
    "naoSensors_getMarkInformation": "robot_senses.place_of",
    "robSensors_detectface_getSample": "robot_senses.sees_face_of robot_senses.seen_face",
    "naoSensors_getFaceInformation": "robot_senses.place_of",
    "naoSensors_recognizeWord": "robot_speech.wait_for_word robot_events.heard",
    "robSensors_gyro_getSample": "robot_senses.sensor",
    "robSensors_accelerometer_getSample": "robot_senses.sensor",
    "robSensors_fsr_getSample": "robot_senses.sensor",
    "robSensors_electriccurrent_getSample": "robot_senses.current",
}
"""The 39 blocks for NAO of Open Roberta Lab."""

PAPER = {
    "set_robots": "robots.robot",
    "robots_add": "robots.robot",
    "wake_up": "robot_moves.wake_up",
    "rest": "robot_moves.rest",
    "robot_say_simple": "robot.say",
    "robot_say_body_expression": "robot.say",
    "set_voice_parameter": "robot_speech.say_with_voice robot_speech.set_volume",
    "do_animal": "robot.imitate",
    "do_anime": "robot.play",
    "execute_behavior": "event.started",
    "robot_behavior": "event.human_state",
    "robot_behavior_reactive": "event.human_state",
    "behavior_action_reaction": "event.human_state",
    "behavior_action_exit_times": "goal.until_state_at_most",
    "say_counter_reactive_action": "sensing.times_seen text.join",
    "arm_gesture_selector": "event.gesture",
    "human_state": "sensing.human_state",
    "wait_until": "control.wait_until",
    "use_smartwatch": "nodes.launch",
    "add_arm_gesture": "nodes.launch",
    "at_the_same_time": "control.together",
    "repeat_until_times": "control.repeat",
    "repeat_until_trigger": "goal.until_state",
    "nep_robot_reactive": "goal.goal",
    "rule_exit": "goal.goal control.stop_program",
    "wait": "control.wait",
    "request_response": "robot_speech.ask",
}

RIZE = {
    "goal": "goal.goal",
    "goal if cancelled": "goal.when_goal",
    "goal return": "goal.when_goal",
    "reaction": "event.human_state",
    "idle behaviour": "robot_events.idle",
    "module sequence": "event.started",
    "module random": "goal.one_of",
    "selector": "goal.in_turn",
    "two options question": "robot_speech.ask",
    "remember": "sensing.remember sensing.was_seen",
    "animation(flip, reverse, time)": "robot_moves.play_changed",
    "say(pitch, velocity)": "robot_speech.say_with_voice",
    "walk": "robot.walk",
    "turn": "robot.turn",
    "track_people_with": "robot_moves.track",
    "track_redball_with": "robot_moves.track",
    "track_sound_with": "robot_moves.track",
    "open_hand": "robot_moves.open_hand",
    "close_hand": "robot_moves.close_hand",
    "mode": "robot_moves.wake_up robot_moves.rest",
    "take_photo": "robot_camera.take_picture",
    "change_leds": "robot_lights.fade",
    "language": "robot_speech.set_language",
    "volume": "robot_speech.set_volume",
    "posture": "robot.do",
    "sound": "robot_camera.play_sound",
    "breathing": "robot_moves.breathing",
    "human_emotion": "sensing.emotion robot_events.emotion",
    "human_detected": "robot_senses.sees robot_events.sees",
    "human_distance": "robot_senses.person_is robot_events.person",
    "object_detected": "robot_senses.sees",
    "touched": "robot_senses.is_touched robot_events.touched",
    "word": "robot_events.heard robot_speech.heard_word",
}


def test_open_roberta_has_39_blocks_for_nao() -> None:
    assert len(OPEN_ROBERTA) == 39


@pytest.mark.parametrize("theirs", [OPEN_ROBERTA, PAPER, RIZE], ids=["roberta", "paper", "rize"])
def test_what_others_have_is_there(language: Language, theirs: dict[str, str]) -> None:
    missing = {
        name: block
        for name, blocks in theirs.items()
        for block in blocks.split()
        if block not in language.definitions
    }

    assert missing == {}


@pytest.mark.parametrize(
    ("table", "least"),
    [
        ("postures", 9),
        ("languages", 19),
        ("led_groups", 12),
        ("hands", 3),
        ("lock_parts", 8),
        ("touch_parts", 7),
        ("animations", 12),
    ],
)
def test_there_is_as_much_to_choose(language: Language, table: str, least: int) -> None:
    assert len(language.choices[table]) >= least


def test_every_joint_can_be_chosen(language: Language) -> None:
    joints = {
        joint
        for part in language.choices["body_parts"]
        for joint in language.choices[f"joints.{part}"]
    }

    assert len(joints) == 24
