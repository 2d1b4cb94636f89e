"""Touch game. Made with NEP Studio."""
from nep_core import Behavior, Robot, one_of, wait_until

nao = Robot("NAO")
behavior = Behavior("Touch game")
points = 0
hit = 0


@behavior.when_started
def when_started():
    global points
    points = 0
    nao.do("posture_stand")
    nao.say("Be quick, and touch what I name.", gesture="explain")
    for _ in range(3):
        def part_1():
            global hit
            nao.say("Touch my head.")
            wait_until(lambda: nao.is_touched("head"), 6)
            hit = nao.is_touched("head")

        def part_2():
            global hit
            nao.say("Touch my left hand.")
            wait_until(lambda: nao.is_touched("hand_left"), 6)
            hit = nao.is_touched("hand_left")

        def part_3():
            global hit
            nao.say("Touch my right foot.")
            wait_until(lambda: nao.is_touched("bumper_right"), 6)
            hit = nao.is_touched("bumper_right")

        one_of(part_1, part_2, part_3)
        if hit == True:
            points += 1
            nao.leds("FaceLeds", "#00cc44")
            nao.say("Yes!", gesture="happy")
        else:
            nao.leds("FaceLeds", "#ff3300")
            nao.say("Too slow.")
    nao.say("You have " + str(points) + " points.", gesture="explain")
    nao.leds_reset("FaceLeds")


behavior.run()
