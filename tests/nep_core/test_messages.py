"""Messages between rules: who begins, what comes with them, and who is waited for."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.behavior import Behavior, what_went_wrong
from nep_core.program.human import heard_answer, note_answer
from nep_core.program.messages import MessageRefused, tell, told_value
from nep_core.program.tasks import (
    Cancelled,
    end_actions,
    own_value,
    stop_rule,
    together,
    wait,
)

WAIT_S = 10.0


class Play:
    """A behaviour that runs in a thread, and what its rules write down."""

    def __init__(self, network: PeerNetwork) -> None:
        self.behavior = Behavior("Messages", network=network)
        self._written: queue.Queue[object] = queue.Queue()
        self.error: BaseException | None = None
        self._thread = threading.Thread(target=self._run)

    def write(self, entry: object) -> None:
        self._written.put(entry)

    def next(self) -> object:
        return self._written.get(timeout=WAIT_S)

    def all(self) -> list[object]:
        """What was written when the behaviour has ended by itself."""
        self._thread.join(WAIT_S)
        assert not self._thread.is_alive(), "the program does not end"
        return list(self._written.queue)

    def start(self) -> Play:
        self._thread.start()
        return self

    def stop(self) -> None:
        tasks.PROGRAM.cancel()
        if self._thread.ident is not None:
            self._thread.join(WAIT_S)
            assert not self._thread.is_alive()

    def _run(self) -> None:
        try:
            self.behavior.run()
        except BaseException as error:
            self.error = error


@pytest.fixture
def play(network: PeerNetwork) -> Iterator[Play]:
    made = Play(network)
    yield made
    made.stop()


def begin(play: Play) -> Callable[[Callable[[], object]], Callable[[], object]]:
    return play.behavior.when_started


def test_every_rule_for_a_message_begins_and_the_program_ends_when_all_are_done(play: Play) -> None:
    for name in ("one", "two"):
        play.behavior.when_told("dance")(lambda name=name: play.write((name, told_value())))
    play.behavior.when_told("sleep")(lambda: play.write("not meant"))
    begin(play)(lambda: tell("dance", 3))

    assert sorted(play.start().all()) == [("one", 3), ("two", 3)]


def test_who_waits_goes_on_when_all_that_was_started_has_ended(play: Play) -> None:
    @play.behavior.when_told("dance")
    def slow() -> None:
        wait(0.2)
        play.write("slow")

    play.behavior.when_told("dance")(lambda: play.write("quick"))

    @begin(play)
    def start() -> None:
        tell("dance", wait=True)
        play.write("after")

    assert play.start().all() == ["quick", "slow", "after"]


def test_a_message_that_nobody_hears_is_waited_for_by_nobody(play: Play) -> None:
    @begin(play)
    def start() -> None:
        tell("dance", wait=True)
        play.write("after")

    assert play.start().all() == ["after"]


@pytest.mark.parametrize("end", [stop_rule, lambda: 1 // 0])
def test_a_rule_that_is_stopped_or_fails_has_ended(play: Play, end: Callable[[], object]) -> None:
    play.behavior.when_told("dance")(end)

    @begin(play)
    def start() -> None:
        tell("dance", wait=True)
        play.write("after")

    assert play.start().all() == ["after"]


def test_a_start_that_is_ignored_is_not_waited_for(play: Play) -> None:
    go_on = threading.Event()

    @play.behavior.when_told("dance")
    def rule() -> None:
        play.write("dances")
        tasks.wait_until(go_on.is_set)

    @begin(play)
    def start() -> None:
        tell("dance")
        tell("dance", wait=True)
        play.write("after")
        go_on.set()

    assert sorted(play.start().all()) == ["after", "dances"]


def test_queued_starts_are_waited_for_and_keep_their_values(play: Play) -> None:
    @play.behavior.when_told("dance", again="queue")
    def rule() -> None:
        wait(0.05)
        play.write(told_value())

    @begin(play)
    def start() -> None:
        tell("dance", 1)
        tell("dance", 2)
        tell("dance", 3, wait=True)
        play.write("after")

    assert play.start().all() == [1, 2, 3, "after"]


def test_a_restart_ends_the_wait_for_the_run_that_is_given_up(play: Play) -> None:
    begun = threading.Semaphore(0)

    @play.behavior.when_told("dance", again="restart")
    def rule() -> None:
        begun.release()
        wait(0.0 if told_value() == 2 else 60.0)
        play.write(told_value())

    @begin(play)
    def first() -> None:
        tell("dance", 1, wait=True)
        play.write("first goes on")

    @begin(play)
    def second() -> None:
        begun.acquire(timeout=WAIT_S)
        tell("dance", 2, wait=True)
        play.write("second goes on")

    play.start()

    assert sorted(map(str, play.all())) == ["2", "first goes on", "second goes on"]


def test_the_value_is_known_in_the_parts_of_the_rule_and_nowhere_else(play: Play) -> None:
    @play.behavior.when_told("dance")
    def rule() -> None:
        together(lambda: play.write(told_value()), lambda: play.write(told_value()))

    @play.behavior.when_told("plain")
    def plain() -> None:
        play.write(told_value())

    @begin(play)
    def start() -> None:
        tell("dance", [1], wait=True)
        play.write(told_value())
        tell("plain", wait=True)

    assert play.start().all() == [[1], [1], "", ""]


def test_a_rule_that_tells_itself_and_waits_is_refused(play: Play) -> None:
    @play.behavior.when_told("dance")
    def rule() -> None:
        try:
            tell("dance", wait=True)
        except MessageRefused as error:
            play.write(str(error.sentence))

    begin(play)(lambda: tell("dance"))

    assert "would never end" in str(play.start().all())


def test_rules_that_would_wait_for_each_other_are_refused(play: Play) -> None:
    @play.behavior.when_told("ping", again="queue")
    def ping() -> None:
        tell("pong", wait=True)
        play.write("ping ends")

    @play.behavior.when_told("pong")
    def pong() -> None:
        try:
            tell("ping", wait=True)
        except MessageRefused:
            play.write("refused")

    begin(play)(lambda: tell("ping"))

    assert play.start().all() == ["refused", "ping ends"]


def test_two_rules_that_wait_crosswise_are_refused_whoever_is_first(play: Play) -> None:
    ready = threading.Barrier(2, timeout=WAIT_S)

    def cross(other: str) -> None:
        ready.wait()
        try:
            tell(other, wait=True)
        except MessageRefused:
            play.write("refused")

    def own(name: str, other: str) -> None:
        is_first = [True]

        @play.behavior.when_told(name, again="queue")
        def rule() -> None:
            if is_first:
                is_first.clear()
                cross(other)

    own("a", "b")
    own("b", "a")

    @begin(play)
    def start() -> None:
        tell("a")
        tell("b")

    assert play.start().all() == ["refused"]


def test_stopping_the_program_ends_the_wait(play: Play) -> None:
    play.behavior.when_told("dance")(lambda: wait(60))

    @begin(play)
    def start() -> None:
        play.write("waits")
        try:
            tell("dance", wait=True)
        except Cancelled:
            play.write("cancelled")
            raise

    play.start()
    assert play.next() == "waits"
    play.stop()

    assert play.next() == "cancelled"


def test_a_rule_stops_another_which_can_begin_again(play: Play) -> None:
    begun = threading.Semaphore(0)

    @play.behavior.when_told("dance", again="queue")
    def dance() -> None:
        begun.release()
        try:
            wait(60 if told_value() < 3 else 0)
        finally:
            play.write(told_value())

    @begin(play)
    def start() -> None:
        tell("dance", 1)
        tell("dance", 2)
        begun.acquire(timeout=WAIT_S)
        play.behavior.stop(dance)
        play.write("stopped")
        tell("dance", 3, wait=True)

    assert play.start().all() == [1, "stopped", 3]


def test_a_rule_that_only_computes_is_stopped_too(play: Play) -> None:
    begun = threading.Event()

    @play.behavior.when_told("count")
    def count() -> None:
        begun.set()
        number = 0
        while True:
            number += 1

    @begin(play)
    def start() -> None:
        tell("count")
        begun.wait(WAIT_S)
        play.behavior.stop(count)
        play.write("stopped")

    assert play.start().all() == ["stopped"]


def test_who_waits_for_a_rule_that_is_stopped_goes_on(play: Play) -> None:
    begun = threading.Event()

    @play.behavior.when_told("dance")
    def dance() -> None:
        begun.set()
        wait(60)

    @begin(play)
    def waits() -> None:
        tell("dance", wait=True)
        play.write("goes on")

    @begin(play)
    def stops() -> None:
        begun.wait(WAIT_S)
        play.behavior.stop(dance)

    assert play.start().all() == ["goes on"]


def test_a_rule_that_stops_itself_ends_there_also_in_a_part(play: Play) -> None:
    @play.behavior.when_told("dance", again="queue")
    def dance() -> None:
        play.write(told_value())
        together(lambda: play.behavior.stop(dance), lambda: wait(60))
        play.write("not reached")

    @begin(play)
    def start() -> None:
        tell("dance", 1)
        tell("dance", 2, wait=True)

    written = play.start().all()

    assert "not reached" not in written and written[0] == 1


def test_what_begins_with_the_program_can_be_stopped(play: Play) -> None:
    begun = threading.Event()

    @begin(play)
    def first() -> None:
        begun.set()
        wait(60)

    @begin(play)
    def second() -> None:
        begun.wait(WAIT_S)
        play.behavior.stop(first)
        play.write("stopped")

    assert play.start().all() == ["stopped"]


def test_what_is_no_rule_cannot_be_stopped(play: Play) -> None:
    begin(play)(lambda: play.behavior.stop(print))
    play.start().all()

    assert "no rule" in str(play.error)


def test_what_went_wrong_is_told_where_it_is_handled_and_in_its_parts(play: Play) -> None:
    @play.behavior.when_told("look")
    def look() -> None:
        play.write(what_went_wrong())

    @begin(play)
    def start() -> None:
        play.write(what_went_wrong())
        try:
            play.behavior.stop(print)
        except Exception:
            play.write(what_went_wrong())
            together(lambda: play.write(what_went_wrong()))
            tell("look", wait=True)
        play.write(what_went_wrong())

    sentence = "What is to be stopped here is no rule."
    assert play.start().all() == ["", sentence, sentence, "", ""]


def test_a_rule_that_is_told_is_for_no_robot_and_has_no_answer(play: Play) -> None:
    @play.behavior.when_told("look")
    def look() -> None:
        play.write(f"{heard_answer()}{own_value()}")

    @begin(play)
    def start() -> None:
        note_answer("yes")
        tasks.for_each(["NAO"], lambda: play.write(f"{heard_answer()} {own_value()}"))
        tasks.for_each(["NAO"], lambda: tell("look", wait=True))

    assert play.start().all() == ["yes NAO", "None"]


def test_what_was_begun_is_ended_where_something_else_is_done(play: Play) -> None:
    @begin(play)
    def start() -> None:
        tasks.current_task().undo["walk",] = tasks.Begun(lambda: play.write("stops walking"))
        try:
            raise ValueError("no way")
        except Exception:
            end_actions()
            play.write("goes on")

    assert play.start().all() == ["stops walking", "goes on"]
