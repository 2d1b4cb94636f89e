"""Clocks that drift, samples that get lost: measured from what arrives, in bounded memory."""

import random
from itertools import pairwise

import pytest

from nodes.sensory.sample_stream import ClockFit, Flow
from nodes.sensory.smartwatch import Thinning


def arrivals(seconds, *, drift_ppm=0.0, rate_hz=50, delay_s=0.005):
    """Times on the sender's clock and ours; most messages wait a while, some of them long."""
    chance = random.Random(5)
    for number in range(int(seconds * rate_hz)):
        sent_s = number / rate_hz
        waited_s = delay_s + chance.expovariate(50) + (0.5 if chance.random() < 0.02 else 0)
        yield sent_s * (1 - drift_ppm * 1e-6), 1000 + sent_s + waited_s


@pytest.mark.parametrize("drift_ppm", [-300, 0, 50, 2000])
def test_the_drift_of_a_clock_is_found_whatever_some_messages_wait(drift_ppm):
    fit = ClockFit()

    for sent_s, arrived_s in arrivals(200, drift_ppm=drift_ppm):
        fit.add(sent_s, arrived_s)

    assert fit.drift_ppm == pytest.approx(drift_ppm, abs=15)


def test_the_drift_is_not_told_before_it_is_known():
    fit = ClockFit()

    for sent_s, arrived_s in arrivals(20):
        fit.add(sent_s, arrived_s)

    assert fit.drift_ppm is None


def test_the_delay_is_what_messages_usually_wait_above_the_quickest():
    fit = ClockFit()

    for sent_s, arrived_s in arrivals(100, delay_s=3):
        fit.add(sent_s, arrived_s)

    assert fit.delay_s == pytest.approx(0.014, abs=0.006)


def test_a_message_from_the_future_leads():
    fit = ClockFit()
    for sent_s, arrived_s in arrivals(30):
        fit.add(sent_s, arrived_s)

    assert fit.lead_s(30, 1030.01) < 0.1
    assert fit.lead_s(90, 1030.01) == pytest.approx(60, abs=0.1)


def flowing(times):
    flow = Flow()
    for t in times:
        flow.add(t)
    return flow


def test_an_even_flow_loses_nothing():
    chance = random.Random(2)
    flow = flowing(number * 0.02 + chance.gauss(0, 0.002) for number in range(1000))

    assert flow.loss == 0
    assert flow.gaps == 0
    assert flow.rate_hz == pytest.approx(50, rel=0.01)


@pytest.mark.parametrize("share", [0.02, 0.1, 0.3])
def test_what_is_missing_from_the_cadence_is_lost(share):
    chance = random.Random(3)
    times = [number * 0.01 for number in range(3000) if chance.random() > share]

    assert flowing(times).loss == pytest.approx(share, abs=0.03)


def test_gaps_are_counted():
    times = [number * 0.02 + (number // 100) * 0.5 for number in range(500)]

    assert flowing(times).gaps == 4


def test_messages_that_are_missing_from_their_count_are_lost():
    flow = Flow()

    for number in range(100):
        if number % 10:
            flow.add_message(number)

    assert flow.loss == pytest.approx(0.1, abs=0.02)


def test_a_count_that_begins_anew_loses_nothing():
    flow = Flow()

    for number in [*range(50), *range(30), 10_000_000, 10_000_001]:
        flow.add_message(number)

    assert flow.loss == 0


def test_an_hour_of_samples_takes_no_memory():
    flow, fit = Flow(), ClockFit()

    for number in range(3600 * 10):
        flow.add(number * 0.1)
        fit.add(number * 0.1, number * 0.1)

    assert len(flow._times) + len(flow._missed) + len(fit._quickest) < 3_000


@pytest.mark.parametrize(("rate_hz", "kept_hz"), [(100, 100), (1000, 1000), (10_000, 500)])
def test_a_flood_is_thinned_to_what_a_movement_needs(rate_hz, kept_hz):
    thinning, kept, batch = Thinning(), [], rate_hz // 50
    for number in range(500):
        rows = list(range(number * batch, (number + 1) * batch))
        kept += thinning.kept(rows, number / 50)

    after_a_second = [one for one in kept if one >= rate_hz]

    assert len(after_a_second) / 9 == pytest.approx(kept_hz, rel=0.05)
    steps = {after - before for before, after in pairwise(after_a_second)}
    assert len(steps) == 1


def test_a_second_that_comes_at_once_is_not_thinned():
    thinning = Thinning()

    for number in range(10):
        assert len(thinning.kept(list(range(200)), number * 1.0)) == 200
