"""A program for a real NAO, written with the official qi package as its tutorials do."""

import json
import os
import sys
import time

import qi


class Greeter:
    """Greets with voice, lights and body, and reacts to a touch of the head."""

    def __init__(self, app):
        app.start()
        session = self.session = app.session
        self.memory = session.service("ALMemory")
        self.tts = session.service("ALTextToSpeech")
        self.animated = session.service("ALAnimatedSpeech")
        self.motion = session.service("ALMotion")
        self.posture = session.service("ALRobotPosture")
        self.leds = session.service("ALLeds")
        self.life = session.service("ALAutonomousLife")
        self.told = {}
        self.touches = []
        self.subscriber = self.memory.subscriber("MiddleTactilTouched")
        self.subscriber.signal.connect(self.touches.append)

    def run(self):
        if self.life.getState() != "disabled":
            self.life.setState("disabled")
        self.motion.wakeUp()
        self.tell("went", self.posture.goToPosture("StandInit", 0.8))
        self.leds.fadeRGB("FaceLeds", "magenta", 0.2)
        self.tts.say("Hello")
        self.animated.say(
            "I am ^start(animations/Stand/Gestures/Hey_1) a robot", {"bodyLanguageMode": "disabled"}
        )
        self.motion.setStiffnesses("Head", 1.0)
        self.motion.angleInterpolation(
            ["HeadYaw", "HeadPitch"], [[0.5, 0.3], [0.1]], [[0.6, 1.2], [0.5]], True
        )
        self.tell("head", self.motion.getAngles("Head", True))
        self.motion.setAngles("HeadYaw", -0.4, 0.5)
        self.motion.openHand("RHand")
        self.tell("hand", self.motion.getAngles("RHand", True))
        self.tell("moved", self.motion.moveTo(0.06, 0.0, 0.0))
        self.tell("place", self.motion.getRobotPosition(True))
        self.memory.insertData("greeter/name", "Anna")
        self.tell("name", self.memory.getData("greeter/name"))
        self.cancel_a_posture()
        self.fail()
        print("waiting for a touch", flush=True)
        while not self.touches:
            time.sleep(0.02)
        self.tell("touches", self.touches)

    def cancel_a_posture(self):
        future = self.posture.goToPosture("Sit", 0.3, _async=True)
        time.sleep(0.1)  # in the middle of its way
        start = time.time()
        future.cancel()
        self.tell("state", str(future.wait(2000)))
        self.tell("cancel_s", time.time() - start)

    def fail(self):
        for name, call in {
            "joint": lambda: self.motion.getAngles("Nose", True),
            "posture": lambda: self.posture.goToPosture("Headstand", 0.5),
            "key": lambda: self.memory.getData("NoSuchKey"),
            "arguments": lambda: self.tts.say(1, 2, 3),
            "service": lambda: self.session.service("ALTeleport"),
        }.items():
            try:
                call()
                self.tell(name, "no error")
            except RuntimeError as error:
                self.tell(name, str(error))

    def tell(self, what, value):
        self.told[what] = value


if __name__ == "__main__":
    application = qi.Application(sys.argv)
    greeter = Greeter(application)
    greeter.run()
    print(json.dumps(greeter.told), flush=True)
    os._exit(0)
