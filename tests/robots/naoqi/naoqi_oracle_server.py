"""The official package plays the robot with the lamp: prints its port, ends with its input."""

import os
import sys

import qi

qi.logging.setLevel(qi.logging.FATAL)


class Subscriber:
    def __init__(self):
        self.signal = qi.Signal("(m)")


@qi.multiThreaded()
class Lamp:
    def __init__(self):
        self.subscribers = {}
        self.touched = qi.Signal("(m)")
        self.level = qi.Property("f")
        self.level.setValue(0.5)
        self._set = None

    @qi.bind(qi.Bool, (qi.String, qi.Float), "goToPosture")
    def go(self, name, speed):
        promise = qi.Promise(lambda it: it.setCanceled())
        self.last = promise
        if name == "Now":
            promise.setValue(True)
        return promise.future()

    @qi.bind(qi.String, (qi.String,), "say")
    def say(self, text):
        return f"s {text}"

    @qi.bind(qi.String, (qi.String, qi.String), "say")
    def say_in(self, text, language):
        return f"ss {text} {language}"

    @qi.bind(qi.String, (qi.String, qi.Map(qi.String, qi.Dynamic)), "say")
    def say_with(self, text, settings):
        return f"s{{sm}} {text} {sorted(settings)}"

    @qi.bind(qi.List(qi.Float), (qi.Dynamic, qi.Bool), "getAngles")
    def angles(self, names, uses_sensors):
        return [0.25] * (26 if names == "Body" else len(names))

    @qi.bind(qi.Void, (qi.Dynamic, qi.Dynamic, qi.Float), "setAngles")
    def set_angles(self, names, angles, speed):
        self._set = (names, angles, speed)

    @qi.bind(qi.Dynamic, (), "lastAngles")
    def last_angles(self):
        return self._set

    def echo(self, value):
        return value

    @qi.bind(
        qi.Map(qi.String, qi.List(qi.Int32)), (qi.Map(qi.String, qi.List(qi.Float)),), "counts"
    )
    def counts(self, values):
        return values

    @qi.bind(qi.Object, (qi.String,), "subscriber")
    def subscriber(self, key):
        return self.subscribers.setdefault(key, Subscriber())

    def raiseEvent(self, key, value):  # noqa: N802 NAOqi's name
        if key in self.subscribers:
            self.subscribers[key].signal(value)
        self.touched([key, value])

    def fails(self):
        raise RuntimeError("The lamp is too hot.")

    @qi.bind(qi.Int32, (qi.Object,), "asks")
    def asks(self, counter):
        return counter.count(41)

    @qi.bind(qi.Bool, (qi.String,), "callBack")
    def call_back(self, name):
        session.service(name).called("key", 1.5, "message")
        return True


session = qi.Session()
session.listenStandalone("tcp://127.0.0.1:0")
session.registerService("Lamp", Lamp())
print(session.endpoints()[0].rsplit(":", 1)[1], flush=True)
sys.stdin.read()
sys.stdout.flush()
os._exit(0)  # the package aborts at a usual exit
