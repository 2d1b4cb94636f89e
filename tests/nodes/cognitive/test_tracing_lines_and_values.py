"""Where a traced program is, and what its variables hold."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest
from program_following import Followed

from nep_core.program import tasks
from nep_core.program.tasks import PROGRAM
from nep_core.program.values import speak

Follow = Callable[[str], Followed]


def test_the_lines_of_own_functions_are_told_the_outermost_first(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait

        def inner():
            wait(600)

        def outer():
            inner()

        outer()
        """)

    heard = program.start()

    assert heard.lines(lambda lines: len(lines.get("program", [])) == 3) == {"program": [9, 7, 4]}


def test_of_very_many_calls_the_first_and_the_last_are_told(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait

        def deeper(n):
            if n:
                deeper(n - 1)
            else:
                wait(600)

        deeper(300)
        """)

    heard = program.start()

    stack = heard.lines(lambda lines: lines.get("program", [0])[-1] == 7)["program"]
    assert stack == [9, *[5] * 48, 7]


def test_a_program_that_ends_before_anybody_looks_tells_its_values(follow: Follow) -> None:
    program = follow("x = 1")

    heard = program.start()
    program.join()

    assert [s.values for s in heard.states if s.event == "value"] == [{"x": "1"}]


def test_an_end_is_told_after_every_line(follow: Follow) -> None:
    program = follow("from nep_core.program.tasks import wait\nwait(600)")

    heard = program.start()
    heard.lines(lambda lines: lines == {"program": [2]})
    program.stop()

    assert heard.lines(lambda lines: not lines) == {}


def test_nothing_is_told_twice(follow: Follow) -> None:
    program = follow("from nep_core.program.tasks import wait\nx = 1\nwait(600)")
    heard = program.start()
    heard.lines(lambda lines: lines == {"program": [3]})
    heard.value("x", "1")
    known = len(heard.states)

    for _ in range(5):
        program.tracer.look()

    assert len(heard.states) == known


def test_the_parts_of_a_program_have_names_of_their_own(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import together, wait

        def one():
            together(leaf, leaf)

        def leaf():
            wait(600)

        together(one, one)
        """)

    heard = program.start()

    lines = heard.lines(lambda lines: len(lines) == 7)
    assert set(lines) == {
        "program",
        "program-part-1",
        "program-part-2",
        *(f"program-part-{n}-part-{m}" for n in (1, 2) for m in (1, 2)),
    }


def test_parts_of_one_name_get_numbers_while_they_run() -> None:
    parts = [tasks.Part(lambda: tasks.wait(600), "nep-karate", PROGRAM) for _ in range(3)]

    names = [part.start()._thread.name for part in parts]
    PROGRAM.cancel()
    for part in parts:
        part.join(20)
    again = tasks.Part(lambda: None, "nep-karate", PROGRAM).start()
    again.join(20)

    assert names == ["nep-karate", "nep-karate-2", "nep-karate-3"]
    assert again._thread.name == "nep-karate"


def test_a_quick_loop_is_told_30_times_a_second_at_most(follow: Follow) -> None:
    program = follow("""
        total = 0
        for i in range(400_000):
            total += i
            total -= 1
        """)
    begun_s = time.monotonic()

    heard = program.start()
    program.join()

    most = 30 * (time.monotonic() - begun_s) + 2
    assert 0 < sum(state.event == "line" for state in heard.states) <= most
    assert sum(state.event == "value" for state in heard.states) <= most
    heard.value("total", str(sum(range(400_000)) - 400_000))


def test_variables_of_the_program_and_of_functions_are_told(follow: Follow) -> None:
    program = follow("""
        from nep_core import Variables
        from nep_core.program.tasks import wait

        program = Variables(score=1, names=[])

        def ended(given):
            best = 3

        def rule():
            best = 2
            n = 5
            program.score += 4
            program.names.append("Ada")
            wait(600)

        ended(9)
        rule()
        """)

    heard = program.start()

    held = dict[str, str]()
    wanted = {"program.score": "5", "program.names": '["Ada"]', "n": "5", "best": "2"}
    heard.until(lambda state: held.update(state.values) or wanted.items() <= held.items())
    assert "given" not in held


def test_only_values_that_have_changed_are_told(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait
        kept = "same"
        words = ["a"]
        x = 1
        wait(0)
        x = 2
        words.append("b")
        wait(600)
        """)
    program.order("set", breakpoints=[5])

    heard = program.start()
    heard.until(lambda s: s.values == {"kept": '"same"', "words": '["a"]', "x": "1"})
    program.order("resume")

    heard.until(lambda s: s.values == {"words": '["a", "b"]', "x": "2"})


def test_values_are_told_as_the_program_tells_them(
    follow: Follow, request: pytest.FixtureRequest
) -> None:
    request.addfinalizer(lambda: speak("en"))  # the program runs in this process
    program = follow("""
        from nep_core import Behavior
        from nep_core.program.tasks import wait
        behavior = Behavior("Test", language="de")
        quotient = 6 / 3
        half = 0.1 + 0.2
        truth = True
        mixed = [1.5, "a\\nb", False]
        none = float("inf")
        wait(600)
        """)

    heard = program.start()

    heard.until(lambda s: "none" in s.values)
    told = {name: text for state in heard.states for name, text in state.values.items()}
    assert told["quotient"] == "2" and told["half"] == "0,3" and told["truth"] == "wahr"
    assert told["mixed"] == '[1,5, "a\\nb", falsch]' and told["none"] == "inf"


def test_no_code_of_the_program_is_run_to_show_a_value(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait

        class Sly(int):
            def __repr__(self):
                raise RuntimeError("never")

            __str__ = __eq__ = __repr__

        sly = Sly(3)
        among = [1, sly]
        x = 1
        x = sly
        wait(600)
        """)
    program.order("set", breakpoints=[12])

    heard = program.start()
    heard.until(lambda s: s.values == {"among": "[1, …]", "x": "1"})
    program.order("resume")

    heard.until(lambda s: s.values == {"x": "…"})


def test_what_a_call_gives_is_told_with_its_place(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.robot import mix_colours
        from nep_core.program.tasks import wait, wait_until
        colour = "is " + mix_colours("#ff0000", "#ff0000")
        wait_until(lambda: mix_colours("#000000", "#000000"))
        wait(600)
        """)

    heard = program.start()

    heard.value("@3:17-50", '"#ff0000"')
    assert any("@4:19-52" in state.values for state in heard.states)


def test_an_error_keeps_its_line_and_its_kind(follow: Follow) -> None:
    program = follow("def broken():\n    return 1 / 0\n\nbroken()")
    program.order("set", breakpoints=[2])

    heard = program.start()
    heard.paused()
    heard.lines(lambda lines: lines == {"program": [4, 2]})
    program.order("resume")
    program.join()

    assert isinstance(program.error, ZeroDivisionError)
    assert heard.lines(lambda lines: not lines) == {}


def test_generators_go_in_and_out_of_their_lines(follow: Follow) -> None:
    program = follow("""
        from nep_core.program.tasks import wait

        def numbers():
            yield 1
            yield 2

        for n in numbers():
            wait(0)
        wait(600)
        """)
    program.order("set", breakpoints=[5, 8])

    heard = program.start()

    assert heard.paused()[0] == 8
    assert heard.lines(lambda lines: bool(lines)) == {"program": [8]}
    program.order("resume")
    assert heard.paused()[0] == 5
    assert heard.lines(lambda lines: lines == {"program": [7, 5]})
    program.order("set")
    program.order("resume")
    assert heard.lines(lambda lines: lines == {"program": [9]})


@pytest.mark.parametrize("seconds", [0.0, -1.0])
def test_a_pace_of_no_seconds_a_line_is_none(follow: Follow, seconds: float) -> None:
    program = follow("x = 1\nx = 2")
    program.order("set", line_s=seconds)

    program.start()

    program.join()
