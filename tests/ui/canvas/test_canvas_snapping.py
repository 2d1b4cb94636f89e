"""The search for a place to drop: which seam or slot is nearest, and that it stays the same."""

from __future__ import annotations

from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.selection import Run
from nep_studio.blocks.places import InBody, InInput, InStack
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.editing.snapping import (
    PREFERENCE_PX,
    RADIUS_PX,
    Ends,
    Ground,
    ends_of,
    search,
    slots,
    targets,
)
from nep_studio.ui.canvas.layout.boxes import Measures
from nep_studio.ui.canvas.layout.layout import Gap
from nep_studio.ui.canvas.layout.page import PageLayout, boxes_of
from tests.blocks.block_building import B, build
from tests.ui.canvas.test_canvas_layout import EVERYWHERE

WORDS = studio_language()


@pytest.fixture(scope="module")
def language() -> Language:
    return WORDS


def fits(target) -> None:
    """Everything goes everywhere."""


def page_of(*stacks: list[B], is_mirrored: bool = False) -> PageLayout:
    editor = build(WORDS, *stacks, variables=("times",))
    measures = Measures(18.0, lambda text: 8.0 * len(text), is_mirrored=is_mirrored)
    return PageLayout(editor.project, editor.language, measures)


def say(text: str = "") -> B:
    return B("robot.say", {"text": text})


def story() -> list[B]:
    number = B("math.arithmetic", {}, {"a": B("math.number")})
    inside = [say("in"), B("control.if", bodies={"do": [say("deep")]})]
    return [
        B("event.started"),
        B("control.repeat", {}, {"times": number}, {"do": inside}),
        say("after"),
    ]


@pytest.fixture
def page() -> PageLayout:
    return page_of(story(), [say("loose")])


def stack(page: PageLayout, number: int = 0):
    return page.project.pages["behaviour"][number]


def test_the_nearest_seam_is_found(page):
    chain = page.chains[stack(page).id]

    found = search(Ground(page), Ends(top=(chain.x + 5, chain.y + chain.ys[2] + 4)), fits)

    assert found.target.place == InStack(stack(page).id, 2)


def test_a_seam_in_a_mouth_is_found(page):
    repeat = stack(page).body[1]
    placed = page.placed(repeat)
    mouth = placed.box.mouths[0]

    found = search(Ground(page), Ends(top=(placed.x + mouth.x, placed.y + mouth.y)), fits)

    assert found.target.place == InBody(repeat, "do", 0)


def test_a_slot_inside_a_plugged_block_is_found(page):
    repeat = page.project.blocks[stack(page).body[1]]
    placed = page.placed(repeat.inputs["times"])
    rect = dict(slots(placed))["b"]

    found = search(Ground(page), Ends(output=(rect.x, rect.y + rect.height / 2)), fits)

    assert found.target.place == InInput(repeat.inputs["times"], "b")


def test_nothing_is_found_beyond_the_radius(page):
    chain = page.chains[stack(page).id]
    bottom = chain.y + chain.height

    near = search(Ground(page), Ends(top=(chain.x, bottom + RADIUS_PX - 1)), fits)
    far = search(Ground(page), Ends(top=(chain.x, bottom + RADIUS_PX + 1)), fits)

    assert near.target is not None
    assert far.target is None


def test_the_radius_is_in_pixels_of_the_view(page):
    chain = page.chains[stack(page).id]
    ends = Ends(top=(chain.x, chain.y + chain.height + RADIUS_PX))

    assert search(Ground(page), ends, fits, scale=2.0).target is None
    assert search(Ground(page), ends, fits, scale=0.5).target is not None


def test_the_place_that_is_shown_is_kept_a_little_longer():
    page = page_of([say("loose")])
    chain = page.chains[stack(page).id]
    slack = Ends(top=(chain.x, chain.y + chain.height + RADIUS_PX + PREFERENCE_PX - 1))
    ground = Ground(page)
    shown = search(ground, Ends(top=(chain.x, chain.y + chain.height)), fits).target

    assert search(ground, slack, fits).target is None
    assert search(ground, slack, fits, current=shown).target == shown


def test_between_two_places_the_shown_one_stays(page):
    chain = page.chains[stack(page).id]
    middle = chain.y + (chain.ys[2] + chain.ys[3]) / 2
    ground, x = Ground(page), chain.x
    upper = search(ground, Ends(top=(x, chain.y + chain.ys[2])), fits).target
    lower = search(ground, Ends(top=(x, chain.y + chain.ys[3])), fits).target

    for shown in (upper, lower):
        for shake in (-2, 0, 2):
            ends = Ends(top=(x, middle + shake))
            assert search(ground, ends, fits, current=shown).target == shown


def test_what_does_not_fit_is_passed_over_for_what_does(page):
    chain = page.chains[stack(page).id]
    ends = Ends(top=(chain.x, chain.y + chain.ys[2]), bottom=None)
    blocked = search(Ground(page), ends, fits).target.place

    def why_not(target):
        return "no" if target.place == blocked else None

    found = search(Ground(page), ends, why_not)

    assert found.target is None or found.target.place != blocked


def test_the_reason_is_that_of_the_nearest_place(page):
    chain = page.chains[stack(page).id]
    ends = Ends(top=(chain.x, chain.y + chain.ys[2]))

    found = search(Ground(page), ends, lambda target: f"not at {target.place.index}")

    assert found.target is None
    assert found.reason == "not at 2"


def test_the_gap_that_is_shown_does_not_move_the_places(page):
    chain, stack_id = page.chains[stack(page).id], stack(page).id
    ends = Ends(top=(chain.x, chain.y + chain.ys[2] + 12))
    ground = Ground(page)
    before = search(ground, ends, fits)
    ground.remember(stack_id)

    page.update(page.layout.preview(frozenset(), Gap(stack_id, "", 1, 100.0, 300.0)))

    assert search(ground, ends, fits) == before


def test_carried_blocks_are_no_place_for_themselves(page):
    repeat, last = stack(page).body[1:]
    placed = page.placed(repeat)

    page.update(page.layout.preview(frozenset({repeat, last}), None))

    mouth = placed.box.mouths[0]
    ends = Ends(top=(placed.x + mouth.x, placed.y + mouth.y))
    found = [target.place for target, _ in targets(Ground(page), ends, 30)]
    assert all(getattr(place, "block", "") != repeat for place in found)


def test_selected_blocks_are_gone_around_as_a_whole(page):
    repeat = stack(page).body[1]
    placed, run = page.placed(repeat), Run(repeat, 2)
    ends = Ends(top=(placed.x, placed.y), mouth=(placed.x + 18, placed.y + 30))

    found = search(Ground(page), ends, fits, run=run)

    assert found.target.is_around
    assert found.target.run == run


def test_the_ends_of_a_hat_are_at_its_foot_only():
    page = page_of([B("event.started"), say()])
    chain = page.chains[stack(page).id]

    ends = ends_of(chain)

    assert ends.top is None
    assert ends.bottom == (chain.x, chain.y + chain.height)


def test_the_ends_of_a_cap_are_at_its_top_only():
    page = page_of([B("control.stop_program")])
    ends = ends_of(page.chains[stack(page).id])

    assert (ends.top is None, ends.bottom is None) == (False, True)


def test_an_empty_c_block_has_a_mouth_to_go_around_with():
    page = page_of([B("control.repeat")], [B("control.repeat", bodies={"do": [say()]})])

    empty, full = (ends_of(page.chains[stack(page, n).id]) for n in (0, 1))

    assert empty.mouth is not None
    assert full.mouth is None


def test_a_reporter_has_an_output_only():
    page = page_of([B("math.number")])

    ends = ends_of(page.chains[stack(page).id])

    assert ends.output is not None
    assert (ends.top, ends.bottom, ends.mouth) == (None, None, None)


def all_seams(page: PageLayout):
    """Every seam, found the plain way: by walking through all boxes."""
    waiting = [(stack_id, chain, chain.x, chain.y) for stack_id, chain in page.chains.items()]
    while waiting:
        owner, chain, x, y = waiting.pop()
        for index, top in enumerate(chain.ys):
            yield owner, chain.key, index, x, y + top
        for box, top in zip(chain.boxes, chain.ys, strict=False):
            left = x - box.width if chain.is_mirrored else x
            waiting += [(box.block, m, left + m.x, y + top + m.y) for m in box.mouths]


def all_slots(page: PageLayout):
    """Every slot, found the plain way."""
    for chain in page.chains.values():
        for placed in boxes_of(chain, EVERYWHERE):
            for key, rect in slots(placed):
                yield placed.box.block, key, rect


PAGES = [page_of(story(), [say(), say()], story(), is_mirrored=side) for side in (False, True)]
PLACES = st.tuples(st.floats(-300, 700), st.floats(-20, 900))


@given(st.sampled_from(PAGES), PLACES, st.floats(1, 120))
def test_the_seams_near_a_point_are_those_that_a_plain_search_finds(page, point, radius):
    found = {
        (target.place, target.x, target.y)
        for target, _ in targets(Ground(page), Ends(top=point), radius)
    }

    assert found == {
        (InBody(owner, slot, index) if slot else InStack(owner, index), x, y)
        for owner, slot, index, x, y in all_seams(page)
        if (slot or index) and hypot(x - point[0], y - point[1]) <= radius
    }


@given(st.sampled_from(PAGES), PLACES, st.floats(1, 120))
def test_the_slots_near_a_point_are_those_that_a_plain_search_finds(page, point, radius):
    found = {target.place for target, _ in targets(Ground(page), Ends(output=point), radius)}

    assert found == {
        InInput(block, key)
        for block, key, rect in all_slots(page)
        if rect.distance(*point) <= radius
    }


@given(st.sampled_from(PAGES), PLACES)
def test_the_place_that_is_found_is_the_nearest_of_all(page, point):
    found = search(Ground(page), Ends(top=point), fits).target

    distances = [
        hypot(x - point[0], y - point[1])
        for _, slot, index, x, y in all_seams(page)
        if slot or index
    ]
    if found is None:
        assert min(distances) > RADIUS_PX
    else:
        assert hypot(found.x - point[0], found.y - point[1]) == min(distances)
