"""Listening to one sensor: on either wrist, turned round, at any rate, and what it lacks."""

import tracemalloc
from collections import Counter
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from nep_core.wire.messages import Imu
from nodes.perceptual.recognition.sensor_input import SensorInput
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.streams import mirrored, takes_of
from nodes.perceptual.recognition.training import train
from nodes.perceptual.recognition.validation import match
from nodes.recordings import read_recordings

pytestmark = pytest.mark.long

TURNED = np.array([-1.0, -1.0, 1.0])


def batch_of(t, acc, gyr, **about):
    rows = [tuple(row) for row in np.asarray(acc, float).tolist()]
    turns = None if gyr is None else [tuple(row) for row in np.asarray(gyr, float).tolist()]
    times = np.asarray(t, float).tolist()
    return Imu(**{"source": "watch", "rate_hz": 50, "t": times, "acc": rows, "gyr": turns} | about)


def batches_of(recording, count=100, **about):
    for part in np.array_split(np.arange(len(recording.t)), count):
        gyr = None if recording.gyr is None else recording.gyr[part]
        yield batch_of(recording.t[part], recording.acc[part], gyr, **about)


class Listening:
    """An ear, and what it told."""

    def __init__(self, model, worn="as recorded"):
        self.model, self.worn, self.told, self.ear = model, worn, [], None

    def hear(self, batches):
        found = []
        for batch in batches:
            if self.ear is None:
                make = partial(Spotter, self.model)
                self.ear = SensorInput(batch, self.model, make, self.worn, *[self._tell] * 2)
            found += self.ear.hear(batch)
        return found + self.ear.flush()

    def _tell(self, words):
        self.told.append(str(words))


def names_in(recording):
    return [take.gesture for take in takes_of(recording)]


def names_of(found):
    return [one.gesture for one in found]


@pytest.fixture(scope="module")
def usual(model, brief):
    """What is recognised when nothing is unusual."""
    found = Listening(model).hear(batches_of(brief))
    assert match(takes_of(brief), found).recall == 1.0
    return names_of(found)


def turned(recording):
    return replace(recording, acc=recording.acc * TURNED, gyr=recording.gyr * TURNED)


def test_a_watch_on_the_other_wrist_is_mirrored_and_that_is_told(model, brief, usual):
    acc, gyr = mirrored(brief.acc, brief.gyr)
    left = replace(brief, acc=acc, gyr=gyr)
    listening = Listening(replace(model, wrist="right"))

    found = listening.hear(batches_of(left, wrist="left"))

    assert names_of(found) == usual
    assert listening.told == [
        "watch is not worn on the wrist on which the gestures were recorded: its movement is"
        " mirrored."
    ]


@pytest.mark.parametrize(("wrist", "of_model"), [("", "right"), ("left", ""), ("hand", "left")])
def test_without_two_known_wrists_nothing_is_mirrored(model, brief, usual, wrist, of_model):
    listening = Listening(replace(model, wrist=of_model))

    found = listening.hear(batches_of(brief, wrist=wrist))

    assert names_of(found) == usual
    assert [words for words in listening.told if "not worn where" not in words] == []
    assert bool(listening.told) is (wrist == "hand")


def test_a_watch_that_is_worn_turned_is_understood_when_that_is_said(model, brief, usual):
    assert names_of(Listening(model, "turned").hear(batches_of(turned(brief)))) == usual
    assert names_of(Listening(model).hear(batches_of(turned(brief)))) != usual


def test_how_a_watch_is_worn_is_found_out_from_the_first_gestures(model, stranger):
    for recording, how in ((turned(stranger), "turned round"), (stranger, "as in the recordings")):
        listening = Listening(model, "automatic")

        found = listening.hear(batches_of(recording))

        assert match(takes_of(stranger), found).recall >= 5 / 6
        assert listening.told == [f"watch is worn {how}, as its gestures show."]


def at_rates(recording, *rates_hz, pause_s=0.0):
    """A recording in parts, each at another rate, with a pause between them."""
    parts = np.array_split(np.arange(len(recording.t)), len(rates_hz))
    for number, (part, rate_hz) in enumerate(zip(parts, rates_hz, strict=True)):
        t = np.arange(recording.t[part[0]], recording.t[part[-1]], 1 / rate_hz)
        acc, gyr = (
            np.column_stack([np.interp(t, recording.t, column) for column in values.T])
            for values in (recording.acc, recording.gyr)
        )
        for of_batch in np.array_split(np.arange(len(t)), max(1, len(t) // 5)):
            yield batch_of(t[of_batch] + number * pause_s, acc[of_batch], gyr[of_batch])


@pytest.mark.parametrize("rate_hz", [100, 50, 25, 16])
def test_the_rate_of_the_sensor_does_not_matter(model, stranger, rate_hz):
    totals = match(takes_of(stranger), Listening(model).hear(at_rates(stranger, rate_hz)))

    assert totals.recall >= 5 / 6
    assert totals.fired <= totals.made + 1


def test_a_rate_that_changes_in_the_middle_does_not_matter(model, stranger):
    found = Listening(model).hear(at_rates(stranger, 100, 16, 50, 25))

    assert len(set(names_of(found)) & {"hand_up", "karate"}) == 2
    assert match(takes_of(stranger), found).recall >= 5 / 6


@pytest.mark.parametrize("pause_s", [3.0, -20.0, 1e6])
def test_a_clock_that_jumps_costs_the_gesture_that_was_made_then_and_no_other(
    model, stranger, pause_s
):
    found = Listening(model).hear(at_rates(stranger, 50, 100, 25, pause_s=pause_s))

    made, seen = Counter(names_in(stranger)), Counter(names_of(found))
    assert seen.total() >= made.total() - 2
    assert not seen - made


def halves(session):
    """The first takes of a session, and the others."""
    takes = takes_of(session)
    middle = np.searchsorted(session.t, (takes[4].end_s + takes[5].start_s) / 2)
    for part in (slice(0, middle), slice(middle, None)):
        yield replace(
            session,
            t=session.t[part] - session.t[part][0],
            acc=session.acc[part],
            gyr=session.gyr[part],
            labels=session.labels[part],
        )


@pytest.mark.real_data
def test_real_people_are_understood_at_every_rate(shared_data):
    sessions = [one for one in read_recordings(shared_data / "uhh_gestures") if one.person == "j"]
    chosen = [one for one in sessions if {*one.labels} & {"left", "shake_ud"}]
    parts = [list(halves(one)) for one in chosen]
    model = train([first for first, _ in parts], (), ["gmr"])

    def recall(*rates_hz):
        caught = made = 0
        for _, rest in parts:
            listening = Listening(model)
            make = partial(Spotter, model, method="gmr")
            batches = list(at_rates(rest, *rates_hz))
            listening.ear = SensorInput(
                batches[0], model, make, "as recorded", *[listening.told.append] * 2
            )
            totals = match(takes_of(rest), listening.hear(batches))
            caught, made = caught + totals.right, made + totals.made
        return caught / made

    found = [recall(100), recall(16), recall(100, 16, 50, 25)]
    assert min(found) >= 0.8, found


@pytest.mark.parametrize(
    ("batches", "sentence"),
    [
        (
            [batch_of([n / 4], [(0, 0, 9.8)], None) for n in range(60)],
            "watch sends 4.0 samples a second, too few to tell gestures apart.",
        ),
        (
            [batch_of([n * 50 % 97], [(0, 0, 9.8)], None) for n in range(60)],
            "The times of watch jump: do two watches send under this name",
        ),
        (
            [batch_of([n / 50], [(np.nan, 0, 9.8)], None) for n in range(120)],
            "watch sends numbers that no sensor can measure.",
        ),
        (
            [batch_of([5.0], [(0, 0, 9.8)], None) for n in range(60)],
            "The clock of watch stands still.",
        ),
    ],
)
def test_what_makes_a_sensor_useless_is_told_once(model, batches, sentence):
    listening = Listening(model)

    found = listening.hear([*batches, *batches])

    assert found == []
    assert len(listening.told) == 1
    assert sentence in listening.told[0]


def test_a_flood_of_samples_takes_no_more_memory_the_longer_it_lasts(model):
    chance = np.random.default_rng(0)

    def flood(first_s):
        t = first_s + np.sort(chance.uniform(0, 1, 10_000))
        t[::100] = chance.choice([np.nan, np.inf, 1e300, -5.0, 0.0], 100)
        return batch_of(t, chance.normal(0, 30, (10_000, 3)), chance.normal(0, 9, (10_000, 3)))

    listening = Listening(model)
    listening.hear([flood(0.0)])
    tracemalloc.start()
    listening.hear(flood(float(second)) for second in range(2))
    before, _ = tracemalloc.get_traced_memory()
    listening.hear(flood(float(second)) for second in range(2, 5))
    after, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()

    assert after - before < 100_000
