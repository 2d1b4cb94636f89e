"""Blocks of your own. Made with NEP Studio."""
from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("Blocks of your own")


def greet_and_wave_times(name, times):
    nao.say("Hello, " + name + ".", gesture="greet")
    for _ in range(int(times)):
        nao.play("wave")


def years_in_months(years):
    return years * 12


@behavior.when_started
def when_started():
    nao.do("posture_stand")
    greet_and_wave_times("Anna", 1)
    greet_and_wave_times("Ben", 2)
    nao.say("I am " + str(years_in_months(3)) + " months old.")


behavior.run()
