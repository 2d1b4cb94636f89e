"""A program that offers a module of its own, and has ALMemory call it back at each touch."""

import os
import sys
import time

import qi


class Reactor:
    """Called by the robot: event, value, message."""

    def __init__(self):
        self.called = []

    def onTouched(self, event, value, message):  # noqa: N802 NAOqi programs name it so
        self.called.append((event, value))


if __name__ == "__main__":
    application = qi.Application(sys.argv)
    application.start()
    reactor = Reactor()
    application.session.registerService("Reactor", reactor)
    memory = application.session.service("ALMemory")
    memory.subscribeToEvent("FrontTactilTouched", "Reactor", "onTouched")
    print("waiting for a touch", flush=True)
    while not reactor.called:
        time.sleep(0.02)
    memory.unsubscribeToEvent("FrontTactilTouched", "Reactor")
    print(reactor.called[0], flush=True)
    os._exit(0)
