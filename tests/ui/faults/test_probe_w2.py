import os, signal, time, sys
import psutil, pytest
from nep_core import messages as m

def show(stage):
    for one in stage.told: print("TOLD", one.kind, "|", one.title, "|", one.sentence, "|", one.checklist, [a.words for a in one.answers], one.passes)
    print("SHOWN", stage.shown)
    print("SAID", stage.said)
    print("BOARD", {n:(s.health,s.event,s.description) for n,s in stage.runner.board.nodes.items()})

def soak(qtbot, s):
    end=time.monotonic()+s
    qtbot.waitUntil(lambda: time.monotonic()>end, timeout=60000)

@pytest.mark.parametrize("who", ["karate","NAO","watch","program"])
def test_kill(stage, qtbot, who):
    stage.run()
    stage.until(lambda: stage.said)
    pid=stage.kill(who)
    t=time.monotonic()
    stage.until(stage.is_back(who,pid))
    print("BACK", time.monotonic()-t)
    soak(qtbot, 6)
    show(stage); print(stage.runner.state, stage.window.running.stage.marks.glowing, stage.window.running.stage.marks.counts)

def test_master(stage, qtbot):
    stage.run()
    stage.until(lambda: stage.said)
    node=stage.local._master_launcher.nodes["master"]
    pid=node.pid
    os.kill(pid, 9)
    stage.until(lambda: node.pid!=pid)
    soak(qtbot, 8)
    show(stage); print(stage.runner.state)
    stage.press("stop"); stage.state_is("idle")
    stage.run()
    show(stage)
    stage.press("stop"); stage.state_is("idle")

def test_stopped_robot(stage, qtbot):
    stage.run()
    stage.until(lambda: stage.said)
    pid=stage.pid("NAO")
    os.kill(pid, signal.SIGSTOP)
    soak(qtbot, 5); show(stage)
    os.kill(pid, signal.SIGCONT)
    soak(qtbot, 5); show(stage)
    os.kill(pid, signal.SIGSTOP)
    t=time.monotonic()
    stage.press("stop"); stage.state_is("idle")
    print("STOPPED in", time.monotonic()-t)
    soak(qtbot, 1); show(stage)
