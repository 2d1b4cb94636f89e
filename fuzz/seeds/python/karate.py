"""Karate greeting. Made with NEP Studio."""
from nep_core import Behavior, Robot, together

nao = Robot("NAO")
behavior = Behavior("Karate greeting")
times = 0


@behavior.when_started
def when_started():
    global times
    nao.do("posture_stand")
    times = 0
    nao.say("Show me karate", gesture="explain")


@behavior.when("gesture_karate")
def when_gesture_karate():
    nao.say("Impressive!")

    def part_1():
        nao.play("karate")

    def part_2():
        global times
        times += 1
        nao.say("Karate number " + str(times))

    together(part_1, part_2)


behavior.run()
