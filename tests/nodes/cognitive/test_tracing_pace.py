"""Pause, breakpoints, steps and slow motion of a traced program."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest
from program_following import Followed

Follow = Callable[[str], Followed]

FOR_EVER = """
    x = 0
    while True:
        x += 1
    """


def test_a_breakpoint_in_a_loop_pauses_in_every_round(follow: Follow) -> None:
    program = follow("for i in range(3):\n    x = i\ny = 5")
    program.order("set", breakpoints=[2])
    heard = program.start()

    for i in range(3):
        assert heard.paused() == (2, "breakpoint")
        heard.value("i", str(i))
        program.order("resume")

    program.join()
    heard.value("y", "5")


@pytest.mark.parametrize("head", [4, 5])
def test_a_breakpoint_on_the_head_of_a_rule_pauses_where_it_begins(
    follow: Follow, head: int
) -> None:
    program = follow("""
        x = 0
        def often(function):
            return function
        @often
        def rule():
            "What it does."
            global x
            x = 1
            x = 2
        rule()
        """)
    program.order("set", breakpoints=[head])

    heard = program.start()

    assert heard.paused() == (8, "breakpoint")


@pytest.mark.parametrize("line", [2, 5])
def test_a_breakpoint_pauses_where_a_function_inside_is_made_and_where_nothing_is_done(
    follow: Follow, line: int
) -> None:
    program = follow("""
        def rule():
            def part():
                x = 1
            def empty():
                pass
            part()
            empty()
        rule()
        """)
    program.order("set", breakpoints=[line])

    heard = program.start()

    assert heard.paused() == (line, "breakpoint")


def test_a_program_that_runs_for_ever_pauses_and_goes_on(follow: Follow) -> None:
    program = follow(FOR_EVER)
    heard = program.start()
    heard.lines(lambda lines: bool(lines))

    program.order("pause")
    assert heard.paused("program")[1] == "pause"
    program.order("resume")
    heard.until(lambda s: s.event == "resumed")
    program.order("set", breakpoints=[3])

    assert heard.paused("program") == (3, "breakpoint")


def test_steps_go_from_line_to_line_through_own_functions(follow: Follow) -> None:
    program = follow("""
        import math

        def add(a):
            b = a + 1
            return b

        x = add(1)
        y = 2
        """)
    program.order("pause")
    heard = program.start()

    lines = [heard.paused()]
    for _ in range(3):
        program.order("step", thread="program")
        lines.append(heard.paused())
    program.order("step")
    program.join()

    assert lines == [(7, "pause"), (4, "step"), (5, "step"), (8, "step")]


def test_a_step_of_a_program_that_runs_pauses_it(follow: Follow) -> None:
    program = follow(FOR_EVER)
    heard = program.start()
    heard.lines(lambda lines: bool(lines))

    program.order("step")

    assert heard.paused()[1] == "step"


def test_where_rules_are_the_program_what_makes_them_is_no_step(follow: Follow) -> None:
    program = follow("""
        Behavior = list
        behavior = Behavior()
        x = 0

        def rule():
            global x
            def part():
                pass
            x = 1

        rule()
        """)
    program.order("pause")
    heard = program.start()

    assert heard.paused() == (9, "pause")


def test_a_step_of_one_thread_leaves_the_others_paused(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import together

        def one():
            a = 1
            a = 2
            a = 3

        def two():
            b = 1
            b = 2

        together(one, two)
        """)
    program.order("set", breakpoints=[4])
    heard = program.start()
    heard.paused("part-1")
    heard.paused("part-2")

    program.order("step", thread="program-part-1")

    assert heard.paused() == (5, "step")
    program.order("step", thread="program-part-1")
    assert heard.paused() == (6, "step")
    assert [s.line for s in heard.states if s.event == "paused" and "part-2" in s.thread] == [9]
    program.order("resume")
    program.join()


def test_a_thread_that_is_in_a_long_wait_pauses_at_its_next_line(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait_until
        gate = []
        wait_until(lambda: gate)
        x = 1
        """)
    heard = program.start()
    heard.lines(lambda lines: lines == {"program": [3]})

    program.order("pause")
    program.tracer._values.namespace["gate"].append("open")

    assert heard.paused() == (4, "pause")


def test_orders_before_the_beginning_are_in_force_from_the_first_line(follow: Follow) -> None:
    program = follow("x = 1\nx = 2")
    program.order("set", breakpoints=[1])

    heard = program.start()

    assert heard.paused() == (1, "breakpoint")


@pytest.mark.parametrize("order", [{"command": "pause"}, {"command": "set", "line_s": 600}])
@pytest.mark.parametrize("source", [FOR_EVER, "x = 1\nx = 2\nx = 3"])
def test_a_paused_or_slow_program_stops_at_once(follow: Follow, order: dict, source: str) -> None:
    program = follow(source)
    program.order(**order)
    heard = program.start()
    heard.lines(lambda lines: bool(lines))

    program.stop()

    assert program.error is None
    assert heard.lines(lambda lines: not lines) == {}


def test_a_traced_loop_that_never_waits_can_be_stopped(follow: Follow) -> None:
    program = follow(FOR_EVER)
    heard = program.start()
    heard.lines(lambda lines: bool(lines))

    program.stop()

    assert program.error is None


def test_slow_motion_ends_as_soon_as_it_is_set_to_nothing(follow: Follow) -> None:
    program = follow("x = 1\nx = 2\nx = 3")
    program.order("set", line_s=600)
    heard = program.start()
    heard.lines(lambda lines: lines == {"program": [1]})

    program.order("set")

    program.join()
    heard.value("x", "3")


def test_slow_motion_can_be_paused(follow: Follow) -> None:
    program = follow("x = 1\nx = 2\nx = 3")
    program.order("set", line_s=600)
    heard = program.start()
    heard.lines(lambda lines: lines == {"program": [1]})

    program.order("pause")

    assert heard.paused() == (1, "pause")


def test_a_program_may_end_by_an_error_while_one_of_its_parts_is_paused(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import together, wait_until
        gate = []

        def failing():
            wait_until(lambda: gate)[0]

        def paused():
            x = 1

        together(failing, paused)
        """)
    program.order("set", breakpoints=[8])
    heard = program.start()
    heard.paused("part-2")
    heard.lines(lambda lines: lines.get("program-part-1") == [5])

    program.tracer._values.namespace["gate"].append("open")
    program.join()

    assert isinstance(program.error, TypeError)


def test_a_condition_is_a_piece_of_its_line_and_is_never_held(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait_until
        looks = []
        wait_until(lambda: looks.append(1) or len(looks) > 3)
        x = 1
        """)
    program.order("set", breakpoints=[3, 4], line_s=0.01)

    heard = program.start()
    lines = []
    for _ in range(2):
        lines.append(heard.paused()[0])
        program.order("resume")

    program.join()
    assert lines == [3, 4]


WAITS = """
    import time
    from nep_core import wait, wait_until

    def told(take):
        begun_s = time.monotonic()
        take()
        return time.monotonic() - begun_s

    waited = told(lambda: {take})
    done = 1
    """


@pytest.mark.parametrize("take", ["wait(4)", "wait_until(lambda: False, 4)"])
def test_a_wait_stands_still_while_the_program_is_paused(follow: Follow, take: str) -> None:
    program = follow(WAITS.replace("{take}", take))
    heard = program.start()
    heard.lines(lambda lines: 9 in lines.get("program", []))

    program.order("pause")
    threading.Event().wait(1.5)
    program.order("resume")
    program.join()

    waited_s = float(heard.until(lambda s: "waited" in s.values).values["waited"])
    assert waited_s > 4.8  # how long the orders took to arrive, nobody knows


def test_a_step_over_a_wait_takes_its_time(follow: Follow) -> None:
    program = follow("from nep_core import wait\nx = 1\nwait(0.3)\ny = 2")
    program.order("pause")
    heard = program.start()
    heard.paused()
    program.order("step")
    assert heard.paused() == (3, "step")

    program.order("step")

    assert heard.paused() == (4, "step")
