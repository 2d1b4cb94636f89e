"""Question and answer. Made with NEP Studio."""
from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("Question and answer")
score = 0


@behavior.when_started
def when_started():
    nao.do("posture_stand")
    nao.say("Touch my head when you are ready for my quiz.", gesture="explain")


@behavior.when("touched_head", source="NAO")
def when_touched_head():
    global score
    score = 0
    answer = nao.ask("How many legs does a spider have?", ["eight"], seconds=10)
    if answer == "eight":
        score += 1
        nao.play("nod")
        nao.say("Eight is right.", gesture="happy")
    else:
        nao.play("shake_head")
        nao.say("It has eight.")
    answer = nao.ask("Which animal says meow?", ["cat"], seconds=10)
    if answer == "cat":
        score += 1
        nao.play("nod")
        nao.say("Yes, the cat.", gesture="happy")
    else:
        nao.play("shake_head")
        nao.say("It is the cat.")
    answer = nao.ask("Which planet do we live on?", ["earth"], seconds=10)
    if answer == "earth":
        score += 1
        nao.play("nod")
        nao.say("Yes, we are at home.", gesture="happy")
    else:
        nao.play("shake_head")
        nao.say("We live on the earth.")
    if score == 3:
        nao.say("All three right! You know more than I do.", gesture="happy")
        nao.play("clap")
    else:
        nao.say("You have " + str(score) + " of three. Touch my head to try again.")


behavior.run()
