"""The driver of a real NAO: plays actions over NAOqi, and says true things about the robot."""

from __future__ import annotations

import logging
import math
import queue
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import Any

from faults import fault_of
from robots.body import actions as a
from robots.body.actions import Action, Listen
from robots.body.body import SINGLE_PARTS
from robots.body.driver import Connection, Ended, RobotState, SenseRequest, Thing
from robots.body.inverse import from_world
from robots.body.limbs import MOVING, Limb
from robots.body.pose import VirtualRobot
from robots.body.repertoire import limbs_of
from robots.body.schedule import Running, Task, advance
from robots.errors import ActionFailed
from robots.naoqi.discovery import read_address
from robots.naoqi.wire.remote import RemoteObject

from . import link, moving, speech
from .calls import Calls, waited
from .lease import Lease, left_on, this_owner
from .link import Heard, Link, reach
from .real import RealRobot
from .speech import Hearing
from .watching import Noticing, Watching

log = logging.getLogger(__name__)


# The task by which a real robot does each action; it needs the limbs that the virtual one needs.

STOPPING_S, LEAVING_S = 6.0, 12.0
"""So long a robot may need to stop, and to be left as it was found, before it is given up."""

ANY_MOTORS = (a.Do, a.WakeUp, a.Rest, a.Stiffness, a.SetStiffness, a.Approach)
"""What is done with motors that are off as well."""

TASKS: dict[type[a.Action], Callable[[RealRobot, Any], Task]] = {
    a.Say: speech.say,
    a.Do: moving.posture_task,
    a.Imitate: speech.imitate,
    a.Play: speech.play_changed,
    a.Walk: lambda robot, it: moving.walk(
        robot, it.forward_m, it.left_m, math.radians(it.turn_deg)
    ),
    a.Turn: lambda robot, it: moving.walk(robot, 0.0, 0.0, math.radians(it.degrees)),
    a.Look: lambda robot, it: moving.look(
        robot, math.radians(it.yaw_deg), math.radians(it.pitch_deg)
    ),
    a.Leds: speech.light,
    a.Hand: moving.move_hands,
    a.MoveJoint: moving.move_joint,
    a.Stiffness: lambda robot, it: moving.lock(robot, it.part, on=it.on),
    a.WakeUp: lambda robot, _: moving.wake_up(robot),
    a.Rest: lambda robot, _: moving.rest(robot),
    a.Awareness: moving.set_life,
    a.Breathing: moving.set_life,
    a.WalkFreely: lambda robot, it: moving.while_fit(robot, moving.walk_freely(robot, it)),
    a.LookAt: lambda robot, it: moving.look_at(robot, (it.x_m, it.y_m, it.z_m), it.frame),
    a.LookAtSeen: lambda robot, it: moving.look_at_seen(robot, it.thing),
    a.PointAt: moving.point_at,
    a.Track: moving.track,
    a.Approach: moving.approach,
    a.ReachAngles: moving.reach_angles,
    a.MoveThrough: moving.move_through,
    a.SetStiffness: moving.set_stiffness,
    a.Silence: lambda _, it: waited(it.seconds),
    a.Volume: speech.set_volume,
    a.SetLanguage: speech.set_language,
    a.Intensity: speech.set_intensity,
    a.ResetLeds: speech.reset,
    a.RandomEyes: speech.play_of_colours,
    a.RotateEyes: speech.play_of_colours,
    a.LearnFace: speech.learn_face,
    a.ForgetFace: speech.forget_face,
    a.TakePicture: speech.take_picture,
    a.RecordVideo: speech.record_video,
    a.PlaySound: speech.play_sound,
}
"""How a real robot does each action; a test sees that none is missing."""


def task_of(robot: RealRobot, action: a.Action) -> Task:
    """Return the task that does an action; what it moves must be locked."""
    task = TASKS[type(action)](robot, action)
    limbs = limbs_of(robot.known, action)
    if isinstance(action, ANY_MOTORS) or not limbs & MOVING:
        return task
    return _moving(robot, limbs, task)


def _moving(robot: RealRobot, limbs: frozenset[Limb], task: Task) -> Task:
    yield from robot.take_over()
    robot.check_locked(limbs)
    return (yield from task)


class NaoqiDriver:
    """Plays actions on a robot that speaks NAOqi. Nothing here waits; threads only bring news."""

    def __init__(self, known: VirtualRobot, address: str, *, takes_over: bool = False) -> None:
        """``known``: a body like the robot's, which becomes a picture of it.

        ``takes_over``: a robot that somebody else drives is taken from them, once.
        """
        place = read_address(address)
        self._heard: Heard = queue.SimpleQueue()
        connect = partial(reach, place, self._heard)
        self._link = Link(known.name, place, connect)
        self._own = this_owner()
        self._takes_over = takes_over
        self._has_met_before = False
        self._robot: RealRobot
        self._lease: Lease
        self._meet(known, {})
        self._hearing = Hearing(self._robot)
        self._running: dict[str, Running] = {}
        self._noticed: list[str] = []

    @property
    def connection(self) -> Connection:
        """How the link to the robot is, and what a person should look at."""
        return self._link.connection

    @property
    def moving(self) -> bool:
        """Whether the robot does something."""
        return bool(self._running) or self._robot.calls.is_stopping

    def connect(self) -> None:
        """Begin to connect, and keep trying until ``disconnect``."""
        self._link.connect()

    def disconnect(self) -> None:
        """Stop what the robot does, leave it as it was found, and give it up."""
        self.stop(list(self._running))
        renew = self._ask_for_lease if self._has_lease else lambda: None
        self._robot.calls.wait_for_stops(STOPPING_S, renew)
        if self._has_lease:
            self._robot.calls.wait_for(self._lease.leave(), LEAVING_S)
        left = self._has_lease and self._lease.leaves_on
        self._link.disconnect()
        if left:
            self._link.connection = Connection("disconnected", left_on(robot=self._robot.name))

    def limbs(self, action: Action) -> frozenset[Limb]:
        """Return the limbs that an action needs. Raises ActionFailed if it cannot be done."""
        if not self._is_met:
            raise ActionFailed.of(self._link.connection.fault)
        return limbs_of(self._robot.known, action)

    def start(self, command_id: str, action: Action) -> None:
        """Begin an action; ``step`` tells when it has ended."""
        if isinstance(action, Listen):
            task = self._hearing.listen(action)
        else:
            task = task_of(self._robot, action)
        limbs = limbs_of(self._robot.known, action)
        moves = isinstance(action, ANY_MOTORS) or bool(limbs & MOVING)
        task = self._robot.calls.after_stops(task, moves=moves)
        self._running[command_id] = Running(task, limbs)

    def stop(self, command_ids: Collection[str]) -> None:
        """End some actions at once: each ends what it has begun on the robot."""
        for command_id in command_ids:
            if stopped := self._running.pop(command_id, None):
                stopped.task.close()

    def halt(self) -> None:
        """Stop motion, posture, speech and following, whoever began them; not a robot of others.

        Where that has not been asked for a moment, as on a slow line, all that can end gently ends.
        """
        if self._has_lease:
            self._robot.calls.stop_all(kills=self._is_mine)
            self._robot.known.settings["tracking"] = ""

    def step(self, now_s: float) -> list[Ended]:
        """Take in what has come from the robot; return what has ended."""
        if reached := self._link.step():
            self._meet(self._robot.known, reached.services)
            self._hearing = Hearing(self._robot, self._hearing.expected)
        if self._link.state != "ready":
            return self._fail_all()  # also what has waited for its limbs, and begins only now
        self._robot.calls.step()
        self._ask_for_lease()
        if self._lease.state != "held":
            return self._fail_all()
        self._watching.step(is_moving=self.moving)
        if self._watching.is_frozen:
            self.halt()  # which arrives if the network has only one way left
            self._link.freeze()
            return self._fail_all()
        if not self._is_mine:
            return []  # it is asked first whose the robot is: this process may have stood still
        while not self._heard.empty():
            self._noticed += self._noticing.hear(*self._heard.get())
        self._noticing.forget()
        if self._watching.has_met:
            self._tell_condition()
            self._hearing.step()
        return [end for name in tuple(self._running) if (end := self._advance(name))]

    def expect(self, words: Sequence[str]) -> None:
        """Listen for the words that rules wait for, from now on, also after a lost link."""
        self._hearing.expected = tuple(words)

    def noticed(self) -> list[str]:
        """Return the human states that the robot has noticed by itself since the last call."""
        noticed, self._noticed = self._noticed, []
        return noticed

    def state(self) -> RobotState | None:
        """Return where the robot's body is, or None when that is not known."""
        if not self._is_met:
            return None
        known = self._robot.known
        x, y, theta = (float(value) for value in known.base)
        return RobotState(
            robot=known.name,
            model=known.model,
            joints=dict(zip(known.body.names, known.angles.round(5).tolist(), strict=True)),
            base=(x, y, theta),
            torso=self._robot.torso or known.stance.pose,
            fallen=self._robot.has_fallen,
            posture=known.posture,
            leds=dict(known.leds),
            saying=known.saying,
            moving=any(one.limbs & MOVING for one in self._running.values()),
            battery=self._robot.battery,
            sensors=self._robot.sensors | self._noticing.touched,
            sees={thing: from_world(known, place) for thing, place in known.sees.items()},
            settings=known.settings
            | {f"locked_{part}": part not in known.released for part in SINGLE_PARTS},
            listening=list(known.listening),
        )

    def sense(self, request: SenseRequest) -> list[str]:
        """Return nothing: a real robot senses by itself."""
        return []

    def surroundings(self, things: Sequence[Thing]) -> None:
        """Do nothing: a real robot sees by itself what stands around it."""

    @property
    def _is_mine(self) -> bool:
        """Whether the robot is there, and nobody else drives it."""
        return self._link.state == "ready" and self._lease.is_held

    @property
    def _has_lease(self) -> bool:
        """Whether the robot is there, and was driven from here when that was asked last."""
        return self._link.state == "ready" and self._lease.state == "held"

    @property
    def _is_met(self) -> bool:
        """Whether the robot is there, is driven from here, and has told how it is."""
        return self._has_lease and self._watching.has_met

    def _meet(self, known: VirtualRobot, services: Mapping[str, RemoteObject]) -> None:
        """Begin with what is true of a robot that was just met."""
        legs = [known.body.names[column] for column in known.body.columns({Limb.LEGS})]
        self._was_finishing = self._has_met_before and self._robot.calls.is_finishing
        calls = Calls(known.name, services, known.body.names, legs)
        self._robot = RealRobot(known, calls)
        self._noticing = Noticing(self._robot)
        self._watching = Watching(self._robot)
        taken = None
        if self._has_met_before and self._lease.state == "taken":
            taken = self._lease.other
        takes_over = self._takes_over and not self._has_met_before
        self._lease = Lease(self._robot, self._own, takes_over=takes_over, is_taken=taken)
        known.saying, known.listening = "", ()
        known.sees.clear()

    def _ask_for_lease(self) -> None:
        """Go on asking for the lease; what goes on when it is given, or taken, is ended."""
        had = self._lease.state == "held"
        self._lease.step()
        if had and self._lease.state == "taken":
            self._robot.calls.let_go()
        elif not had and self._lease.state == "held":
            if self._has_met_before:
                self._robot.calls.stop_all(kills=not self._was_finishing)
            elif self._lease.has_followed:  # who may just stand it up, or let it rest
                self._robot.calls.stop_all(kills=False)
            self._has_met_before = True
        if fault := self._lease.fault():
            self._link.connection = Connection("connection_failed", fault)

    def _fail_all(self) -> list[Ended]:
        """The robot is gone: what it was doing has failed, with the reason."""
        ended = [Ended(name, "failed", self._link.connection.fault) for name in self._running]
        running, self._running = self._running, {}
        for one in running.values():
            one.task.close()
        return ended

    def _tell_condition(self) -> None:
        """Warn of what keeps the robot from acting soon; tell when that is over."""
        known, place = self._robot.known, self._link.place
        joint, heat = self._robot.hottest
        warning = None
        if self._robot.battery < link.LOWEST_BATTERY:
            warning = link.low_battery(robot=known.name, battery=f"{self._robot.battery * 100:.0f}")
        elif heat >= link.HOTTEST_C:
            warning = link.too_hot(robot=known.name, joint=joint, celsius=f"{heat:.0f}")
        elif known.released >= set(self._robot.parts) and not self._running:
            warning = link.asleep(robot=known.name)
        if warning is None:
            words = fault_of("{name} at {place} is connected.", name=known.name, place=place)
            self._link.connection = Connection("connected", words)
        else:
            self._link.connection = Connection("warning", warning)

    def _advance(self, command_id: str) -> Ended | None:
        try:
            return advance(self._running, command_id)
        except (TypeError, ValueError, LookupError, ArithmeticError):
            log.exception("what the robot answered to %s", command_id)
            del self._running[command_id]
            return Ended(command_id, "failed", link.strange_answer(robot=self._robot.name))
