"""The official package plays a simple NAO: it prints its port, then its state for each line read.

It has no body: joints are where they were sent, after a moment, and words take a moment too.
"""

import json
import os
import sys
import threading

import qi

qi.logging.setLevel(qi.logging.FATAL)

MOMENT_S = 0.15
SIDE = ["ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand"]
LEG = ["HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll"]
NAOQI_JOINTS = ["HeadYaw", "HeadPitch", *(side + name for side in "LR" for name in SIDE + LEG)]
STATE = {
    "angles": dict.fromkeys(NAOQI_JOINTS, 0.0),
    "base": [0.0, 0.0, 0.0],
    "posture": "Stand",
    "leds": {},
    "said": [],
    "saying": "",
    "stopped": [],
    "volume": 50,
}
VALUE = "/Position/Sensor/Value"


def later(value, *then):
    """A promise that is kept after a moment; giving it up ends it."""
    promise = qi.Promise(lambda it: end(timer, it))

    def keep():
        for one in then:
            one()
        promise.setValue(value)

    timer = threading.Timer(MOMENT_S, keep)
    timer.daemon = True
    timer.start()
    return promise.future()


def end(timer, promise):
    timer.cancel()
    promise.setCanceled()


def put(names, angles):
    STATE["angles"].update(zip(names, angles, strict=True))


@qi.multiThreaded()
class ALMotion:
    @qi.bind(qi.List(qi.Float), (qi.Dynamic, qi.Bool), "getAngles")
    def angles(self, names, uses_sensors):
        return [STATE["angles"][name] for name in names]

    @qi.bind(qi.Void, (qi.Dynamic, qi.Dynamic, qi.Float), "angleInterpolationWithSpeed")
    def go(self, names, angles, speed):
        return later(None, lambda: put(names, angles))

    @qi.bind(qi.Void, (qi.List(qi.String), qi.Dynamic, qi.Dynamic), "angleInterpolationBezier")
    def bezier(self, names, times, keys):
        return later(None, lambda: put(names, [key[-1][0] for key in keys]))

    @qi.bind(qi.Bool, (qi.Float, qi.Float, qi.Float), "moveTo")
    def move_to(self, x, y, theta):
        return later(True, lambda: STATE.update(base=[x, y, theta]))

    @qi.bind(qi.List(qi.Float), (qi.Bool,), "getRobotPosition")
    def place(self, uses_sensors):
        return STATE["base"]

    @qi.bind(qi.Bool, (), "robotIsWakeUp")
    def awake(self):
        return True

    @qi.bind(qi.Void, (), "stopMove")
    def stop_move(self):
        STATE["stopped"].append("stopMove")

    @qi.bind(qi.Bool, (), "moveIsActive")
    def walks(self):
        return False

    @qi.bind(qi.Void, (), "killAll")
    def kill_all(self):
        STATE["stopped"].append("killAll")


@qi.multiThreaded()
class ALRobotPosture:
    @qi.bind(qi.Bool, (qi.String, qi.Float), "goToPosture")
    def go(self, name, speed):
        return later(True, lambda: STATE.update(posture=name))

    @qi.bind(qi.String, (), "getPosture")
    def posture(self):
        return STATE["posture"]

    @qi.bind(qi.Void, (), "stopMove")
    def stop_move(self):
        STATE["stopped"].append("posture")


@qi.multiThreaded()
class ALTextToSpeech:
    @qi.bind(qi.Void, (qi.String,), "say")
    def say(self, text):
        STATE["saying"] = text
        self.last = qi.Promise(lambda it: it.setCanceled())
        if len(text) > 100:  # until it is stopped
            return self.last.future()
        return later(None, lambda: STATE["said"].append(text), lambda: STATE.update(saying=""))

    @qi.bind(qi.Void, (), "stopAll")
    def stop_all(self):
        STATE["stopped"].append("stopAll")
        STATE["saying"] = ""

    @qi.bind(qi.String, (), "getLanguage")
    def language(self):
        return "English"


@qi.multiThreaded()
class ALLeds:
    @qi.bind(qi.Void, (qi.String, qi.Int32, qi.Float), "fadeRGB")
    def fade(self, name, colour, seconds):
        return later(None, lambda: STATE["leds"].update({name: colour}))

    @qi.bind(qi.Void, (qi.String, qi.String, qi.Float), "fadeRGB")
    def fade_named(self, name, colour, seconds):
        raise RuntimeError("The colour has a number.")


class Subscriber:
    def __init__(self):
        self.signal = qi.Signal("(m)")


@qi.multiThreaded()
class ALMemory:
    def __init__(self):
        self.subscribers = {}

    @qi.bind(qi.Dynamic, (qi.Dynamic,), "getListData")
    def values(self, keys):
        return [self._value(key) for key in keys]

    @qi.bind(qi.Object, (qi.String,), "subscriber")
    def subscriber(self, key):
        return self.subscribers.setdefault(key, Subscriber())

    def _value(self, key):
        joint = key.removeprefix("Device/SubDeviceList/").removesuffix(VALUE)
        if joint in STATE["angles"]:
            return STATE["angles"][joint]
        return 0.5 if "Battery" in key else None


memory = ALMemory()
session = qi.Session()
session.listenStandalone("tcp://127.0.0.1:0")
for service in (ALMotion(), ALRobotPosture(), ALTextToSpeech(), ALLeds(), memory):
    session.registerService(type(service).__name__, service)
print(session.endpoints()[0].rsplit(":", 1)[1], flush=True)
for line in sys.stdin:
    if line.startswith("touch"):
        memory.subscribers["MiddleTactilTouched"].signal(float(line.split()[1]))
    print(json.dumps(STATE), flush=True)
os._exit(0)  # the package aborts at a usual exit
