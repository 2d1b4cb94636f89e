"""The official package uses the lamp of a server: does what it is asked, prints it as JSON."""

import json
import os
import sys
import threading
import time

import qi

qi.logging.setLevel(qi.logging.FATAL)


class Login:
    """How the official package logs in."""

    def __init__(self, user, password):
        self.words = {"user": user, "token": password}

    def newAuthenticator(self):  # noqa: N802 the package's name
        return self

    def initialAuthData(self):  # noqa: N802 the package's name
        return self.words

    def _processAuth(self, data):  # noqa: N802 the package's name
        return {}


def failure(call):
    try:
        return repr(call())
    except Exception as problem:
        return f"{type(problem).__name__}: {problem}"


def use(session):
    lamp = session.service("Lamp")
    yield "say", [lamp.say("a"), lamp.say("a", "English"), lamp.say("a", {"speed": 90})]
    yield "angles", [lamp.getAngles("Body", True), lamp.getAngles(["HeadYaw"], False)]
    lamp.setAngles(["HeadYaw", "HeadPitch"], [0.5, -0.25], 0.125)
    values = [True, -3, 2**40, 0.1, "é", [], [1, "a", [2.5]], {"a": [1], "b": None}, None]
    yield "echo", [lamp.echo(value) for value in values]
    yield "counts", lamp.counts({"a": [1.0, 2.0]})
    yield "pair", list(lamp.pair((1, "a")))
    yield "raw", list(bytes(lamp.raw(bytearray(b"abc"))))
    yield "waits", lamp.waits(0.05)
    yield (
        "failures",
        [
            failure(lambda: lamp.fails()),
            failure(lambda: lamp.breaks()),
            failure(lambda: lamp.nothing()),
            failure(lambda: lamp.say(1, 2, 3)),
            failure(lambda: lamp.say([1])),
            failure(lambda: session.service("Nobody")),
        ],
    )
    yield "properties", [lamp.level.value(), lamp.level.setValue(0.75), lamp.level.value()]
    yield "module", [lamp.ping(), "say" in lamp.getMethodList(), lamp.getBrokerName()]
    going = lamp.goToPosture("Sit", 0.5, _async=True)
    time.sleep(0.05)  # in the middle of its way
    going.cancel()
    going.wait(2000)
    yield "cancel", going.isCanceled()
    yield "now", lamp.goToPosture("Now", 0.5)
    subscriber = lamp.subscriber("Touch")
    yield "events", heard(subscriber.signal, lambda: lamp.raiseEvent("Touch", [1, "a"]), 2)
    yield "signal", heard(lamp.touched, lambda: lamp.raiseEvent("Other", 0.5), 1)
    yield "posted", heard(subscriber.signal, lambda: subscriber.signal("mine"), 1)
    yield "told level", heard(lamp.level, lambda: lamp.level.setValue(0.25), 1)
    yield "own object", lamp.asks(Counter())
    session.registerService("Caller", caller)
    yield "called back", [lamp.callBack("Caller"), caller.waited()]
    yield "services", [it["name"] for it in session.services()]


def heard(signal, raising, times):
    got = []
    there = threading.Event()
    link = signal.connect(lambda value: (got.append(value), len(got) >= times and there.set()))
    for _ in range(times):
        raising()
    there.wait(3)
    signal.disconnect(link)
    return got


class Counter:
    def count(self, number):
        return number + 1


class Caller:
    def __init__(self):
        self.there = threading.Event()
        self.got = None

    def called(self, key, value, message):
        self.got = [key, value, message]
        self.there.set()

    def waited(self):
        self.there.wait(3)
        return self.got


caller = Caller()


def main(url, *login):
    session = qi.Session()
    if login:
        session.setClientAuthenticatorFactory(Login(*login))
    try:
        session.connect(url)
    except RuntimeError as problem:
        print(json.dumps({"refused": str(problem)}), flush=True)
        return
    results = {}
    try:
        for name, value in use(session):
            results[name] = value
    except Exception as problem:
        results["broken"] = repr(problem)
    print(json.dumps(results, default=str), flush=True)


main(*sys.argv[1:])
sys.stdout.flush()
os._exit(0)  # the package aborts at a usual exit
