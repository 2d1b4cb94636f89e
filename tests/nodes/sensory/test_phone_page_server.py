"""The phone page's server, asked as browsers and as strangers ask."""

import json

import pytest

from tests.nodes.sensory.page_client import (
    TOKEN,
    ask,
    batch,
    post,
)
from tests.nodes.sensory.page_serving import client, folder, own_page, page, shared_page

__all__ = ["client", "folder", "own_page", "page", "shared_page"]


def test_the_link_opens_the_page_with_a_certificate_that_is_good_for_it(page):
    status, headers, text = ask(page, f"/{TOKEN}/")

    assert page.urls == [f"https://127.0.0.1:{page.port}/{TOKEN}/"]
    assert status == 200
    assert headers["Content-Type"] == "text/html; charset=utf-8"
    assert "<title>NEP Studio</title>" in text


def test_every_answer_forbids_what_the_page_does_not_need(page):
    for path in (f"/{TOKEN}/", f"/{TOKEN}/page.js", f"/{TOKEN}/nothing", "/wrong/"):
        _, headers, _ = ask(page, path)

        assert headers["Cache-Control"] == "no-store"
        assert headers["X-Frame-Options"] == "DENY"
        assert headers["Referrer-Policy"] == "no-referrer"
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
        assert "unsafe" not in headers["Content-Security-Policy"]
        assert "aiohttp" not in headers["Server"]


@pytest.mark.parametrize(
    "path",
    ["/", "/wrong/", "/wrong/page.js", "/wrong/motion", "/wrong/alive", f"/{TOKEN}x/", "/%00/"],
)
def test_a_wrong_token_is_refused_with_what_to_do(page, path):
    status, _, text = ask(page, path, headers={"Accept-Language": "de-AT,en;q=0.5"})

    assert status == 403
    assert "Scanne den QR-Code" in text


def test_a_language_that_we_do_not_speak_is_answered_in_english(page):
    _, _, text = ask(page, "/wrong/", headers={"Accept-Language": "tlh, *;q=0.1"})

    assert "Scan the QR code that NEP Studio shows now" in text


@pytest.mark.parametrize("path", ["../server.py", "words.toml", "..%2f..%2fpyproject.toml", "a/b"])
def test_only_the_files_of_the_page_are_served(page, path):
    status, _, _ = ask(page, f"/{TOKEN}/{path}")

    assert status in (403, 404)


@pytest.mark.parametrize("host", ["evil.example", "evil.example:{port}", "127.0.0.1:1", ""])
def test_another_name_for_our_address_is_refused(page, host):
    own = {"Host": host.format(port=page.port)}

    status, _, text = ask(page, f"/{TOKEN}/", headers=own)

    assert status == 403
    assert "QR" not in text


@pytest.mark.parametrize("origin", ["https://evil.example", "null", None])
@pytest.mark.parametrize("path", ["motion", "batch"])
def test_pages_of_other_origins_cannot_send(page, origin, path):
    own = {"Origin": origin} if origin else {}
    method = "POST" if path == "batch" else "GET"

    status, _, _ = ask(page, f"/{TOKEN}/{path}", method, data=batch(1.0), headers=own)

    assert status == 403
    assert page.readings() == []


def test_a_batch_by_post_becomes_readings_with_the_phones_clock(page):
    status, _, answer = post(page, batch(1.0, 1.02, device="iPhone", hand="left", lost=3))

    [arrived] = page.readings()
    assert (status, json.loads(answer)) == (200, {"state": "followed"})
    assert arrived.sender == "iPhone 127.0.0.1"
    assert [reading.stamp for reading in arrived.readings] == [1.0, 1.02]
    assert arrived.readings[0].acc == (0, 0, 9.81)
    assert arrived.readings[0].gyr == (0.1, 0.2, 0.3)
    assert arrived.readings[0].stamp_unit_s == 1
    assert arrived.dropped == 3
    assert page.hand == "left"


@pytest.mark.parametrize("text", [b"", b"no JSON", batch(1.0, gyr=[]).encode(), b"\xff"])
def test_rubbish_is_refused_and_nothing_of_it_arrives(page, text):
    status, _, _ = post(page, text)

    assert status == 400
    assert page.readings() == []


def test_too_much_at_once_is_refused(page):
    status, _, _ = post(page, b" " * 200_000)

    assert status == 413
    assert page.readings() == []


@pytest.mark.parametrize(
    "odd",
    [
        {"Sec-WebSocket-Key": "名前=="},
        {"Sec-WebSocket-Key": "g=="},
        {"Sec-WebSocket-Version": "\uff11\uff13"},
        {"Upgrade": "websockét"},
    ],
)
def test_a_talk_that_begins_in_letters_of_no_header_is_refused(page, odd):
    usual = {
        "Origin": f"https://127.0.0.1:{page.port}",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "MDEyMzQ1Njc4OWFiY2RlZg==",
    }

    status, _, _ = ask(page, f"/{TOKEN}/motion", headers=usual | odd)

    assert status == 400
