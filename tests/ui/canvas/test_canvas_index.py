"""The grid of stacks: it finds what a plain search through all rectangles finds."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from nep_studio.ui.canvas.layout.index import GridIndex, Rect

places = st.floats(-5000, 5000, allow_nan=False)
sizes = st.floats(0, 3000, allow_nan=False)
rects = st.builds(Rect, places, places, sizes, sizes)


@given(st.lists(rects, max_size=30), rects)
def test_the_grid_finds_what_a_search_through_all_finds(known: list[Rect], asked: Rect) -> None:
    grid = GridIndex()
    for number, rect in enumerate(known):
        grid.set(f"s{number}", rect)

    found = set(grid.near(asked))

    assert found == {f"s{n}" for n, rect in enumerate(known) if rect.touches(asked)}


@given(st.lists(rects, min_size=1, max_size=20), st.data())
def test_a_rectangle_that_was_moved_or_taken_out_is_found_where_it_is(known, data) -> None:
    grid = GridIndex()
    for number, rect in enumerate(known):
        grid.set(f"s{number}", rect)
    moved = data.draw(rects)

    grid.set("s0", moved)
    grid.remove(f"s{len(known) - 1}")

    left = {f"s{n}": rect for n, rect in enumerate(known[:-1])}
    if len(known) > 1:
        left["s0"] = moved
    everything = Rect(-1e6, -1e6, 2e6, 2e6)
    assert set(grid.near(everything)) == set(left)
    assert set(grid.near(moved)) == {name for name, rect in left.items() if rect.touches(moved)}


def test_a_stack_of_ten_thousand_blocks_does_not_fill_the_grid() -> None:
    grid = GridIndex()

    grid.set("long", Rect(40, 40, 300, 360_000))
    grid.set("short", Rect(40, 1000, 300, 100))

    assert set(grid.near(Rect(50, 200_000, 10, 10))) == {"long"}
    assert set(grid.near(Rect(50, 1010, 10, 10))) == {"long", "short"}


def test_an_empty_page_has_no_bounds() -> None:
    assert GridIndex().bounds() is None
