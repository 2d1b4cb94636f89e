"""The phone page in a real browser: what a phone feels arrives, and the page tells why not."""

from __future__ import annotations

import contextlib
import math
import sys
import time

import pytest

from tests.nodes.sensory.chromium import Chromium, chromium_path, wait_until
from tests.nodes.sensory.page_client import TOKEN
from tests.nodes.sensory.page_serving import folder, page, served, shared_page

__all__ = ["folder", "page", "shared_page"]

pytestmark = [
    pytest.mark.skipif(chromium_path() is None, reason="there is no Chromium here"),
    pytest.mark.long,
]

STATE = "document.body?.dataset.state"
IPHONE = "Mozilla/5.0 (iPhone; CPU iPhone OS 17_5 like Mac OS X) AppleWebKit/605.1.15 Safari/604.1"
ASKS = """
DeviceMotionEvent.requestPermission = async () => {
  window.wasTap = navigator.userActivation.isActive;
  return "%s";
};
"""
NO_WEBSOCKETS = (
    "window.WebSocket = class { constructor() { setTimeout(() => this.onclose(), 1); } };"
)
FACE_UP = """
setInterval(() => dispatchEvent(new DeviceOrientationEvent("deviceorientation",
  {alpha: 0, beta: 0, gamma: 0})), 20);
"""


@pytest.fixture(scope="module")
def browser(folder):
    with served(folder) as page:
        spki = page.certificate.spki_sha256
    browser = Chromium(folder / "profile", spki)
    yield browser
    browser.close()


@pytest.fixture
def server(page):
    """The page's server, with nothing in it from the test before."""
    return page


@pytest.fixture
def phones(browser, server):
    """Opens the page on phones, which are closed at the end."""
    with contextlib.ExitStack() as closing:

        def open_phone(url="", script="", **about):
            phone = browser.page("about:blank", **about)
            closing.callback(phone.close)
            if script:
                phone.before_scripts(script)
            phone.open(url or server.urls[0])
            return phone

        yield open_phone


def allow(phone):
    phone.until(STATE, "ready")
    phone.tap("#allow")


def readings(server, at_least=1):
    found = []

    def look():
        found.extend(server.readings(time.monotonic() + 0.1))
        return sum(len(arrived.readings) for arrived in found)

    wait_until(look, lambda count: count >= at_least)
    return [reading for arrived in found for reading in arrived.readings]


def test_nothing_is_sent_before_the_tap_and_all_that_is_felt_after_it(phones, server):
    phone = phones()
    phone.feel(acc=(1.0, -2.0, 9.5), gyr=(0.5, 1.0, -2.0))
    phone.until(STATE, "ready")

    before = server.readings()
    allow(phone)
    phone.until(STATE, "live")
    found = readings(server, at_least=30)

    assert before == []
    assert found[-1].acc == pytest.approx((1.0, -2.0, 9.5), abs=0.06)
    assert found[-1].gyr == pytest.approx((0.5, 1.0, -2.0), abs=0.01)  # rad/s: browsers say degrees
    assert found[-1].gravity_included
    stamps = [reading.stamp for reading in found]
    rate_hz = (len(stamps) - 1) / (stamps[-1] - stamps[0])
    assert 2 < rate_hz < 70  # 60 where the computer has nothing else to do
    assert found[-1].stamp_unit_s == 1
    phone.until("/^[1-9][0-9]? Hz$/.test(document.querySelector('#rate').textContent)")
    assert phone.value("document.querySelector('#graph').width") > 300


def tap_left(phone):
    phone.tap("input[value=left]")
    return phone.value("document.querySelector('input[value=left]').checked")


def test_the_hand_that_is_chosen_arrives_and_stopping_stops(phones, server):
    phone = phones()
    phone.feel(acc=(0.0, 0.0, 9.81))
    allow(phone)

    wait_until(lambda: tap_left(phone), bool)  # the page moves while it begins to send
    wait_until(lambda: server.readings(time.monotonic() + 0.1) and server.hand, "left".__eq__)
    phone.tap("#allow")
    phone.until(STATE, "ready")
    server.readings(time.monotonic() + 0.1)  # what was on its way

    assert server.hand == "left"
    assert server.readings(time.monotonic() + 0.3) == []


def test_an_iphone_is_asked_in_the_tap_and_its_acceleration_gets_androids_sign(phones, server):
    phone = phones(script=ASKS % "granted", agent=IPHONE)
    phone.feel(acc=(0.0, 3.0, -9.81), gyr=(1.0, 0.0, 0.0))

    allow(phone)
    found = readings(server, at_least=5)

    assert phone.value("window.wasTap") is True
    assert found[-1].acc == pytest.approx((0.0, -3.0, 9.81), abs=0.06)
    assert found[-1].gyr == pytest.approx((1.0, 0.0, 0.0), abs=0.01)


def test_a_phone_whose_gravity_points_the_wrong_way_is_found_by_its_orientation(phones, server):
    phone = phones(script=FACE_UP)
    phone.feel(acc=(0.0, 0.0, -9.81))

    allow(phone)
    found = readings(server, at_least=40)

    assert found[0].acc[2] == pytest.approx(-9.81, abs=0.06)
    assert found[-1].acc[2] == pytest.approx(9.81, abs=0.06)


@pytest.mark.skipif(sys.platform != "linux", reason="settings are elsewhere")
def test_the_node_says_what_the_phone_feels(phones, folder, listener, free_port, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(folder))  # where the node finds the certificate
    listener.start("smartwatch", through="phone_page", port=free_port, token=TOKEN)
    listener.state("ready", f"waits for a phone that opens its page on port {free_port}")
    phone = phones(f"https://127.0.0.1:{free_port}/{TOKEN}/")
    phone.feel(acc=(0.0, 3.0, 9.0), gyr=(1.0, 0.0, -0.5))

    phone.until(STATE, "ready")
    phone.tap("input[value=right]")
    allow(phone)
    batch = listener.batches_until(lambda batch: batch.rate_hz > 0)[-1]

    assert batch.acc[-1] == pytest.approx((0.0, 3.0, 9.0), abs=0.06)
    assert batch.gyr[-1] == pytest.approx((1.0, 0.0, -0.5), abs=0.01)
    assert batch.gravity_included
    assert batch.wrist == "right"
    assert batch.source == "Android 127.0.0.1"


def test_a_refusal_is_told_with_what_to_do(phones):
    phone = phones(script=ASKS % "denied", agent=IPHONE)

    allow(phone)

    phone.until(STATE, "denied")
    assert "scan the QR code again" in phone.value("document.querySelector('#hint').textContent")
    assert phone.value("document.querySelector('#allow').textContent") == "Ask again"


def test_a_device_without_sensors_is_told(phones):
    phone = phones()

    allow(phone)

    phone.until(STATE, "none")
    assert phone.value("document.querySelector('#allow').hidden")


def test_without_websockets_batches_are_posted(phones, folder):
    with served(folder) as own:
        phone = phones(own.urls[0], script=NO_WEBSOCKETS)
        phone.feel(acc=(0.0, 0.0, 9.81))
        allow(phone)
        found = readings(own, at_least=20)
        phone.until(STATE, "live")

    stamps = [reading.stamp for reading in found]
    assert stamps == sorted(stamps)
    assert math.isclose(found[-1].acc[2], 9.81, abs_tol=0.06)


def test_a_second_phone_waits_until_the_first_one_leaves(phones, server):
    first, second = phones(), phones()
    for phone in (first, second):
        phone.feel(acc=(0.0, 0.0, 9.81))

    allow(first)
    first.until(STATE, "live")
    allow(second)
    second.until(STATE, "busy")
    first.open("about:blank")

    second.until(STATE, "live")


def test_a_lost_connection_comes_back_by_itself(phones, folder, server):
    with served(folder) as short:
        phone = phones(short.urls[0])
        phone.feel(acc=(0.0, 0.0, 9.81))
        allow(phone)
        phone.until(STATE, "live")
    phone.until(STATE, "lost")

    with served(folder, port=short.port) as again:
        phone.until(STATE, "live")

        assert readings(again, at_least=5)


def test_a_link_of_yesterday_is_told(phones, folder):
    with served(folder) as short:
        phone = phones(short.urls[0])
        phone.until(STATE, "ready")
    phone.until(STATE, "lost")

    with served(folder, port=short.port, token="another"):
        phone.until(STATE, "refused")

    assert "Scan the QR code" in phone.value("document.querySelector('#hint').textContent")


def test_a_wrong_link_opens_a_page_that_says_what_to_do_in_the_phones_language(phones, server):
    phone = phones(server.urls[0].replace(TOKEN, "wrong"), language="ja")

    phone.until(STATE, "refused")

    assert phone.value("document.documentElement.lang") == "ja"
    assert "コードを読み取って" in phone.value("document.body.innerText")
    ground = phone.value("getComputedStyle(document.querySelector('.state')).backgroundColor")
    assert ground == "rgb(251, 228, 224)"  # its style was not refused by our own policy


def test_the_page_speaks_the_language_of_the_phone(phones):
    phone = phones(language="tlh,de-AT")

    phone.until(STATE, "ready")

    assert phone.value("document.documentElement.lang") == "de"
    assert phone.value("document.querySelector('#allow').textContent") == "Bewegung erlauben"


def test_pages_of_other_origins_are_refused(phones, server):
    stranger = phones("about:blank")
    url = server.urls[0]

    by_socket = stranger.value(
        "new Promise(done => {"
        f" const line = new WebSocket('{url.replace('https', 'wss')}motion');"
        " line.onopen = () => done('open'); line.onclose = () => done('refused'); })"
    )
    by_post = stranger.value(
        f"fetch('{url}batch', {{method: 'POST', mode: 'no-cors', body: '{{}}'}})"
        ".then(() => 'answered', () => 'refused')"
    )

    assert (by_socket, by_post) == ("refused", "refused")
    assert server.readings() == []
